"""A radius that is too large for the field is warned of, and one that is not is not."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from fracparticles import pse
from fracparticles.errors import AccuracyWarning, InvalidInput
from sweeps import covering

KERNELS = {
    "Gaussian": (pse.GAUSSIAN_20, 2),
    "spline": (pse.SplineKernel(5), 2),
    "slope": (pse.construct(1, 2), 1),
    "slope, order 4": (pse.construct(1, 4), 1),
    "curvature, order 4": (pse.construct(2, 4), 2),
}


def warned(call, *arguments) -> tuple[np.ndarray, bool]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", AccuracyWarning)
        return call(*arguments), any("too large for the" in str(w.message) for w in caught)


@pytest.mark.parametrize("name", list(KERNELS))
def test_the_derivative_of_a_wave(name):
    """sin(k x + 1/2) for k epsilon from 0.02 to 4. The limit is 5 per cent with order two, and lower with more."""
    kernel, order = KERNELS[name]
    x, verdicts = np.linspace(-1.0, 1.0, 41), set()
    for epsilon in (0.02, 0.1, 0.4):
        particles = np.arange(-6.0, 6.0, epsilon / 2.0)
        for k in (1.0, 3.0, 10.0):

            def f(y, d=0):
                return k**d * np.sin(k * y + 0.5 + 0.5 * np.pi * d)  # noqa: B023

            found, spoken = warned(
                pse.derivative,
                x,
                f(x),
                particles,
                f(particles),
                epsilon / 2.0,
                epsilon,
                kernel,
                order,
            )
            error = np.abs(found - f(x, order)).max() / np.abs(f(x, order)).max()
            if error > 0.1:
                assert spoken, (epsilon, k, error)
            if error < 0.01:
                assert not spoken, (epsilon, k, error)
            verdicts.add(spoken)
    assert verdicts == {True, False}


def test_smooth_particles():
    """By (9) the wave becomes exp(-(k epsilon)^2 / 4) of itself with a Gaussian: 0.4 of it is lost at 1.43."""
    x, particles, gaussian = (
        np.linspace(-1.0, 1.0, 9),
        np.arange(-6.0, 6.0, 0.1),
        pse.construct(0, 2),
    )
    for k, lost in ((7.15, True), (0.5, False)):
        found, spoken = warned(
            pse.reconstruct, x, particles, np.cos(k * particles), 0.1, 0.2, gaussian
        )
        assert found == pytest.approx(np.exp(-((0.2 * k) ** 2) / 4.0) * np.cos(k * x), abs=1e-10)
        assert spoken is lost


def test_where_the_particles_end_nothing_is_said_of_the_radius():
    x = np.linspace(-1.0, 1.0, 21)
    _, spoken = warned(pse.reconstruct, x, x, np.exp(x), 0.1, 0.2, pse.construct(0, 2))
    assert not spoken


@pytest.mark.filterwarnings("error")
def test_what_is_zero_but_for_round_off_is_no_error():
    x, particles = np.linspace(-1.0, 1.0, 9), np.arange(-6.0, 6.0, 0.1)
    for f in (lambda y: 3.0 - 2.0 * y, lambda y: np.cos(y) ** 2 + np.sin(y) ** 2):
        pse.derivative(x, f(x), particles, f(particles), 0.1, 0.2, pse.GAUSSIAN_20, 2)


def test_a_ragged_list_is_refused():
    with pytest.raises(InvalidInput):
        pse.reconstruct([0.0], [[1.0], [2.0, 3.0]], [1.0], 0.1, 0.2, pse.GAUSSIAN_20)


@pytest.mark.filterwarnings("error")
def test_of_a_stencil_nothing_is_known():
    x = np.arange(-5.0, 6.0)
    stencil = pse.construct_stencil(2, 2)
    pse.derivative(x[1:-1], x[1:-1] ** 2, x, x**2, 1.0, 1.0, stencil, 2)


@pytest.mark.parametrize(("order", "jitter"), covering([2, 4], [0.0, 0.3]))
def test_the_strengths_that_are_exchanged(order, jitter):
    """exp(i k x) on a lattice and beside it: A is -k^2 but for the smoothing, and scattering costs what it costs."""
    kernel = pse.construct_laplacian(order, 2)
    epsilon, h, verdicts = 0.2, 0.1, set()
    # Four epsilon from the ends a kernel has fallen to exp(-16). The waves run along x.
    long, wide = (h * (np.arange(count) + 0.5) for count in (30.0, 18.0))
    points = np.stack(np.meshgrid(long, wide, indexing="ij"), axis=-1).reshape(-1, 2)
    middle = (np.abs(points - [1.5, 0.9]) < [0.7, 0.1]).all(axis=1)
    moved = points + h * np.random.default_rng(2).uniform(-jitter, jitter, points.shape)
    exact = pse.StrengthExchange(points, h * h, epsilon, kernel)
    for k in (0.25, 1.0, 2.5, 5.0, 10.0):
        waves = [h * h * np.exp(1j * k * x[:, 0]) for x in (points, moved)]
        off = np.abs(exact.apply(waves[0]) / waves[0] / -(k * k) - 1.0)[middle].max()
        exchange = pse.StrengthExchange(moved, h * h, epsilon, kernel)
        _, spoken = warned(exchange.apply, waves[1])
        assert spoken or off < 0.1, (k, off)
        assert not spoken or off > 0.01, (k, off)
        assert not warned(exchange.apply, waves[1])[1]
        verdicts.add(spoken)
    assert verdicts == {True, False}


@pytest.mark.filterwarnings("error")
def test_a_uniform_density_is_smooth_enough():
    x = np.random.default_rng(3).uniform(0.0, 1.0, 200)
    volumes = np.full(200, 1.0 / 200)
    exchange = pse.StrengthExchange(x, volumes, 0.1, pse.GAUSSIAN_20)
    assert exchange.apply(3.0 * volumes) == pytest.approx(0.0, abs=1e-10)
