"""Burgers, Korteweg-de Vries and a source by markers, and their exact solutions."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fracparticles.errors import InvalidInput
from fracparticles.markers import SHAPES, Gaussian, MarkerVelocity, equal_weight, run, uniform
from fracparticles.markers.burgers import PointSource, burgers
from fracparticles.markers.fourier import FourierMarkerVelocity
from fracparticles.markers.kdv import Soliton, kdv
from fracparticles.markers.source import GaussianSource, advance_weights, source_flux
from fracparticles.moving.lagrangian import FieldNotPositive
from scenes.lewandowski.marker_velocities.study import kdv_residual

# --- Burgers --------------------------------------------------------------------------------------


@pytest.mark.parametrize("reynolds", [0.1, 5.0, 100.0])
def test_the_point_source_solves_burgers(reynolds):
    """The formula with mpmath, derivatives by mpmath.diff at 50 digits."""
    mu, total = 1.0 / reynolds, 2.0
    exact = PointSource(mu, total)
    with mpmath.workdps(50):

        def f(x, t):
            s = 2 * mpmath.sqrt(mpmath.mpf(mu) * t)
            r = mpmath.mpf(total) / (2 * mpmath.mpf(mu))
            phi = 1 - (1 - mpmath.exp(-r)) * mpmath.erfc(-x / s) / 2
            slope = (
                (1 - mpmath.exp(-r)) * mpmath.exp(-((x / s) ** 2)) / (s * mpmath.sqrt(mpmath.pi))
            )
            return 2 * mpmath.mpf(mu) * slope / phi

        for x in (mpmath.mpf("0.3"), mpmath.mpf("1.1")):
            t = mpmath.mpf("0.7")
            rate = mpmath.diff(lambda t, x=x: f(x, t), t)
            slope, curvature = (mpmath.diff(lambda x, t=t: f(x, t), x, n) for n in (1, 2))
            assert abs(rate + f(x, t) * slope - mu * curvature) < 1e-12
            assert exact.value(float(x), 0.7) == pytest.approx(float(f(x, t)), rel=1e-12)


@given(part=st.floats(1e-9, 1.0 - 1e-9), reynolds=st.floats(0.05, 200.0), t=st.floats(0.1, 4.0))
def test_the_quantile_is_the_inverse(part, reynolds, t):
    exact = PointSource(1.0 / reynolds, 2.0)
    x = exact.quantile(2.0 * part, t)
    assert math.isfinite(x)
    # log phi is known to round-off, relative for the left end, absolute times 2 mu for the right one.
    assert exact.cumulative(x, t) == pytest.approx(
        2.0 * part, rel=1e-6, abs=1e-12 * (1.0 + 2.0 / reynolds)
    )


def test_markers_follow_burgers():
    exact, count = PointSource(0.1, 2.0), 128
    g = 2.0 * (np.arange(count) + 0.5) / count
    velocity = FourierMarkerVelocity(0.14, burgers(0.1))
    end = run(
        exact.quantile(g, 0.5), np.full(count, 2.0 / count), velocity, dt=0.01, steps=50, start=0.5
    )
    # Markers stay where the exact velocity, which keeps the total to the left, carries them.
    middle = slice(count // 8, -count // 8)
    assert np.abs(end.x - exact.quantile(g, 1.0))[middle].max() < 0.02 * 0.14
    assert end.history.overtaking_steps == 0


# --- Korteweg-de Vries ------------------------------------------------------------------------------


@given(c=st.floats(4.0, 9.0), background=st.floats(0.0, 2.0))
def test_the_velocity_of_the_soliton(c, background):
    # Continued periodically f has kinks at the ends, of 4 c^(3/2) exp(-12 sqrt(c)) <= 1.2e-9; the series makes that
    # a spike of f_xx that is 1 / spacing = 21 times as high. The flux is of order 10.
    assert kdv_residual(Soliton(c, background), half=12.0) < 1e-7


def test_soliton():
    assert Soliton(4.0).velocity(np.array([0.1, 2.0])) == pytest.approx(4.0)
    assert Soliton(4.0, 0.5).value(7.0 * 0.3, 0.3) == pytest.approx(2.5)
    with pytest.raises(InvalidInput):
        Soliton(4.0, -0.1)


def test_markers_carry_a_soliton():
    soliton, period, epsilon = Soliton(4.0, 0.5), 16.0, 0.4
    x, weights = uniform(lambda x: soliton.value(x - 8.0), (0.0, period), 192)
    velocity = MarkerVelocity(SHAPES["S8"], epsilon, kdv, derivatives=2, period=period)
    end = run(x, weights, velocity, dt=1e-3, steps=100)
    z = np.linspace(0.0, period, 200)
    f = soliton.value(z - 8.0, 0.1)
    # Smoothing by S8 alone: its fourth moment -3/4 gives eps^4 max |f^(4)| / 32 = 0.026, f^(4) = 2 * 16.
    assert np.abs(end.field(z) - f).max() < 0.026
    # Standing still would leave an error of speed t max |f_x| = 0.7 * 0.8 * 2.
    assert np.abs(soliton.value(z - 8.0) - f).max() > 0.5


def test_a_bare_soliton_stops_and_says_where():
    soliton = Soliton(4.0)
    x, weights = uniform(soliton.value, (-6.0, 6.0), 128)
    velocity = MarkerVelocity(SHAPES["S8"], 0.3, kdv, derivatives=2)
    with pytest.raises(FieldNotPositive, match=r"from t = .* at the particle x = "):
        run(x, weights, velocity, dt=1e-3, steps=1000)


# --- a source ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("derivative", [0, 2])
def test_the_solution_with_a_source(derivative):
    """f = g + int_0^t of the heat flow of Q, by mpmath."""
    source = GaussianSource(0.7, derivative)
    x, t = 0.8, 1.3
    with mpmath.workdps(25):

        def g(x, s):
            return mpmath.exp(-x * x / (1 + 4 * s)) / mpmath.sqrt(1 + 4 * s)

        integral = mpmath.quad(
            lambda s: mpmath.diff(lambda y: g(y, s), x, derivative), [0, mpmath.mpf(t)]
        )
        expected = float(g(x, t) + mpmath.mpf("0.7") * integral)
    assert source.solution(np.array([x, -x]), t) == pytest.approx([expected] * 2, rel=1e-13)


@pytest.mark.parametrize("derivative", [0, 2])
def test_cumulative_source(derivative):
    source = GaussianSource(0.7, derivative)
    nodes, weights = np.polynomial.legendre.leggauss(60)
    low, high = -7.0, 0.4
    z = 0.5 * (high - low) * nodes + 0.5 * (high + low)
    assert 0.5 * (high - low) * weights @ source.rate(z) == pytest.approx(
        float(source.cumulative(np.float64(high))), abs=1e-12
    )
    assert source.cumulative(np.array([9.0]))[0] == pytest.approx(source.total, abs=1e-15)


def test_weights_gain_the_total_and_a_velocity_cannot():
    source = GaussianSource(0.5)
    x, w = equal_weight(Gaussian(), 128)
    velocity = FourierMarkerVelocity(0.35)
    _, changed = advance_weights(x, w, velocity, source.rate, dt=0.02, steps=25)
    # Markers of volume W / F sum Q as the loading sums f: the tails beyond them, 1/128 of it each side, and eps.
    assert changed.sum() - w.sum() == pytest.approx(0.5 * source.total, rel=0.01)
    end = run(
        x, w, FourierMarkerVelocity(0.35, source_flux(source.cumulative)), dt=0.005, steps=100
    )
    assert end.weights.sum() == w.sum()
    z = np.linspace(-5.0, 5.0, 401)
    missing = np.abs(end.field(z) - source.solution(z, 0.5)).sum() * 0.025
    assert missing >= 0.99 * 0.5 * source.total


# --- the ends of the numbers ----------------------------------------------------------------------


@pytest.mark.parametrize("total", [1e-100, 1e-10, 0.1, 100.0])
@pytest.mark.parametrize("x", [-10.0, -1.0, 0.0, 3.0])
def test_the_cumulative_of_a_weak_source_keeps_its_digits(total, x):
    """-2 mu log phi with mpmath, phi = 1 - tiny."""
    with mpmath.workdps(250):
        part = (1 - mpmath.exp(-mpmath.mpf(total) / 2)) * mpmath.erfc(-mpmath.mpf(x) / 2) / 2
        exact = float(-2 * mpmath.log(1 - part))
    assert PointSource(1.0, total).cumulative(x, 1.0) == pytest.approx(exact, rel=1e-13)


def test_a_strong_source_overflows_or_is_right():
    for derivative in (0, 2):
        strong = GaussianSource(1e300, derivative)
        assert strong.rate([1e100]).tolist() == [0.0]
        assert strong.cumulative([-1e100]).tolist() == [0.0]
        assert strong.solution([0.0], 0.0).tolist() == [1.0]
    with pytest.raises(InvalidInput, match="do not overflow"):
        GaussianSource(1e300).solution([0.0], 1e100)
