"""What a lattice does not hold: it is what it says, and it is said where a wrong peak shows."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from scipy.fft import rfftn

import fracparticles as fp
from fracparticles.time.short_waves import ShortWaves
from sweeps import covering


def of(u: np.ndarray, dim: int) -> ShortWaves:
    return ShortWaves(rfftn(u, axes=range(-dim, 0)), dim, u.shape[-1])


@pytest.mark.parametrize("dim", [1, 2])
def test_a_spectrum_that_falls_like_an_exponential_is_continued(dim):
    """u^ = exp(-q m) along each axis, m up to 50: from 40 on a is exp(-40 q), and it falls by exp(-50 q) to 2 K."""
    points, q = 101, 0.05
    line = np.fft.irfft(np.exp(-q * np.arange(points // 2 + 1)), points)
    u = line if dim == 1 else np.multiply.outer(line, line)
    expected = 2.0 * dim * np.exp(-90.0 * q)
    assert of(u, dim).of_the_integral == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("dim", [1, 2, 3])
@pytest.mark.parametrize("points", [9, 16])
def test_the_bound_holds_at_any_time_and_for_many_data(dim, points):
    u = np.random.default_rng(dim).standard_normal((3, *(points,) * dim))
    many = of(u, dim)
    for tau in (1e-9, 0.1, 3.0, 1e6):
        wrong = many.of_a_peak(1.5, tau)
        assert (np.array(wrong) <= np.array(many.at_most(1.5, tau)) * (1.0 + 1e-12)).all()
        assert wrong == pytest.approx([of(one, dim).of_a_peak(1.5, tau)[0] for one in u], rel=1e-9)


def test_nothing_lacks_nothing_and_one_point_lacks_all():
    assert (of(np.zeros((2, 16)), 1).of_the_integral == 0.0).all()
    assert of(np.zeros((2, 16)), 1).of_a_peak(1.5, 1.0) == [0.0, 0.0]
    assert of(np.eye(16)[8], 1).of_the_integral == 2.0  # u^ = 1: both 2 K and -2 K


@pytest.mark.parametrize("alpha", [np.nextafter(1.0, 2.0), 1.0001, 1.5, np.nextafter(2.0, 1.0)])
@pytest.mark.parametrize("tau", [1e-300, 1e-9, 1.0, 1e100])
def test_the_bounds_are_ordered_at_the_ends_of_alpha_and_of_time(alpha, tau):
    many = of(np.random.default_rng(5).standard_normal((3, 16)), 1)
    with np.errstate(all="raise", under="ignore"):
        wrong, bound = np.array(many.of_a_peak(alpha, tau)), np.array(many.at_most(alpha, tau))
    assert (wrong <= bound * (1.0 + 1e-12)).all()


def spike(x: np.ndarray, width: float, alpha: float, time: float) -> np.ndarray:
    """exp(-x^2 / w^2) after a time, by the Fourier integral: 1e-12 by as many nodes."""
    k, weights = np.polynomial.legendre.leggauss(400)
    k, weights = 7.0 / width * (k + 1.0), 7.0 / width * weights
    u = np.sqrt(np.pi) * width * np.exp(-((0.5 * k * width) ** 2) - time * k**alpha)
    return np.cos(np.multiply.outer(x, k)) @ (weights * u) / np.pi


@pytest.mark.parametrize(
    ("hill", "width", "tau"),
    covering([0.0, 20.0, 100.0], [0.5, 0.8, 1.5, 2.0], [1e-6, 0.01, 0.3, 3.0], together=2),
)
def test_a_spike_is_spoken_of_on_a_hill_too(hill, width, tau):
    """The hill has all of the integral; the spike, whose peak is the hill's, is what the lattice does not hold."""
    x, near = np.arange(-400.0, 400.0), np.arange(-6.0, 7.0)
    wide = np.exp(-((x / (hill or 1.0)) ** 2)) if hill else 0.0
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        u = fp.evolve(np.exp(-((x / width) ** 2)) + wide, 1.0, 1.5, tau, tail=())
    exact = spike(near, width, 1.5, tau) + (spike(near, hill, 1.5, tau) if hill else 0.0)
    wrong = np.abs(u[394:407] - exact).max() / u.max()
    if wrong > 3e-3:
        assert any("does not resolve" in str(one.message) for one in said)
    if wrong < 1e-5:
        assert not said
