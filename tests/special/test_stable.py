"""The stable density against mpmath, its invariants, its limits, and what must be refused."""

from __future__ import annotations

import contextlib
from functools import cache
from itertools import product

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import erf, erfc

from fracparticles.errors import InvalidInput
from fracparticles.special import (
    central_mass,
    green,
    green_asymptotic,
    green_flux,
    green_rate,
    green_series,
    green_slope,
    mean_radius,
    reduced_green,
    tail_mass,
)
from known import pieces_of_the_line
from sweeps import at_once, covering, few

# The worst path is a quadrature: a sum of about 180 positive terms, each with an exponential of an
# argument up to 40, and then 18 steps of Horner's rule: a few hundred roundings of 1.1e-16.
TOLERANCE = 5e-14
EPSILON = np.finfo(float).eps

ALPHAS = (1.001, 1.01, 1.1, 1.3, 1.5, 1.7, 1.8, 1.9, 1.95, 1.99, 1.999, 1.9999999)
NEAR = (0.0, 1e-8, 0.1, 0.49, 0.5, 0.77)
MIDDLE = (1.4, 2.2, 3.2, 3.99, 5.1, 6.2, 7.1, 8.3, 9.9, 12.4, 14.7, 16.0, 17.5)
FAR = (25.0, 1e2, 1e4, 1e6, 1e10, 1e100)


# Of the same numbers at every distance, with 120 digits each.
precise_gamma = cache(mp.gamma)


def exact(x: float, alpha: float) -> tuple[mp.mpf, mp.mpf]:
    """Density at x and mass outside [-x, x] from (A.2), if it converges to 25 digits, or (A.1)."""
    with mp.workdps(120):
        x, alpha = mp.mpf(x), mp.mpf(alpha)
        if x > 1:
            density, tail, previous = mp.mpf(0), mp.mpf(0), mp.inf
            for m in range(1, 500):
                size = precise_gamma(1 + alpha * m) / mp.factorial(m) * x ** (-alpha * m - 1)
                if size > previous or size < mp.mpf(10) ** -30 * abs(density) * (2 - alpha):
                    break
                previous = size
                term = size * mp.sin(mp.pi * (2 - alpha) * m / 2) / mp.pi
                density += term
                tail += 2 * term * x / (alpha * m)
            # The Gaussian core is not in (A.2): leave room for it, whatever alpha is.
            left_out = max(size, mp.exp(-x * x / 4) if alpha > 1.5 else 0)
            if left_out < mp.mpf(10) ** -25 * density:
                return density, tail
        density, central, j = mp.mpf(0), mp.mpf(0), 0
        while True:
            m = 2 * j + 1
            term = (-1) ** j * precise_gamma(1 + m / alpha) / mp.factorial(m) * x ** (m - 1) / mp.pi
            density += term
            central += 2 * term * x / m
            if j > 2 and abs(term) < mp.mpf(10) ** -40 * abs(density):
                return density, 1 - central
            j += 1


@pytest.mark.parametrize("alpha", few(ALPHAS, 6))
def test_agrees_with_mpmath(alpha):
    x = np.array(few(NEAR + MIDDLE + FAR, 13))
    density = reduced_green(x, alpha)
    outside = tail_mass(x, 1.0, alpha)
    inside = central_mass(x, 1.0, alpha)
    for i, point in enumerate(x):
        reference, beyond = exact(point, alpha)
        assert abs(density[i] - reference) <= TOLERANCE * reference, point
        assert abs(outside[i] - beyond) <= TOLERANCE * beyond, point
        assert abs(inside[i] - (1 - beyond)) <= TOLERANCE * (1 - beyond), point


@pytest.mark.parametrize("alpha", few([1.0001, 1.001, 1.05]))
def test_agrees_with_the_integral_close_to_one(alpha):
    """Where neither series is of use; both sides of 1 are on the second piece of the table."""
    with mp.workdps(30):
        for x in (0.9, 1.0, 1.1):
            reference = (
                mp.quad(lambda k: mp.cos(k * x) * mp.exp(-(k**alpha)), mp.linspace(0, 75, 16))  # noqa: B023
                / mp.pi
            )
            assert abs(reduced_green(x, alpha) - reference) <= TOLERANCE * reference


def test_limits_in_alpha():
    x = np.linspace(0.0, 30.0, 601)
    cauchy = 1.0 / (np.pi * (1.0 + x * x))
    delta = 1e-9
    # The derivative in alpha is of the size of L log x; 20 is above it on this range.
    np.testing.assert_allclose(reduced_green(x, 1.0 + delta), cauchy, rtol=20 * delta)
    np.testing.assert_allclose(
        tail_mass(x, 1.0, 1.0 + delta), 1 - 2 / np.pi * np.arctan(x), rtol=20 * delta
    )
    gauss = np.exp(-x * x / 4) / np.sqrt(4 * np.pi)
    # Gaussian plus a power law of weight 2 - alpha.
    np.testing.assert_allclose(reduced_green(x, 2.0 - delta), gauss, rtol=20 * delta, atol=delta)
    np.testing.assert_allclose(central_mass(x, 1.0, 2.0 - delta), erf(x / 2), rtol=20 * delta)
    np.testing.assert_allclose(
        tail_mass(x, 1.0, 2.0 - delta), erfc(x / 2), rtol=20 * delta, atol=delta
    )


@pytest.mark.parametrize("alpha", [1.0 + EPSILON, 2.0 - EPSILON])
def test_the_ends_of_the_open_interval(alpha):
    x = np.concatenate([np.linspace(0.0, 20.0, 401), 10.0 ** np.arange(2, 15)])
    density = reduced_green(x, alpha)
    assert (density > 0.0).all()
    assert (np.diff(density) < 0.0).all()


@given(
    alpha=st.floats(1.0001, 1.9999),
    x=st.floats(0.0, 1e9),
    factor=st.floats(1.0001, 3.0),
)
def test_even_positive_decreasing(alpha, x, factor):
    value = reduced_green(x, alpha)
    assert value > 0.0
    assert reduced_green(-x, alpha) == value
    farther = x * factor
    # Strictly decreasing, up to the relative error of two values.
    assert reduced_green(farther, alpha) <= value * (1.0 + 2 * TOLERANCE)
    inside, outside = central_mass(x, 1.0, alpha), tail_mass(x, 1.0, alpha)
    assert abs(inside + outside - 1.0) <= 2 * EPSILON


@given(alpha=st.floats(1.001, 1.999), border=st.integers(1, 44))
def test_no_jump_between_pieces(alpha, border):
    x = 0.5 * border
    below, above = reduced_green(np.array([np.nextafter(x, 0.0), x]), alpha)
    # Two neighbouring numbers: a relative step of 2 eps |x L'/L| < x^2 eps, and the two errors.
    assert abs(above / below - 1.0) <= 2 * TOLERANCE + x * x * EPSILON


@pytest.mark.parametrize("alpha", [1.05, 1.5, 1.95])
def test_mass_is_the_integral_of_the_density(alpha):
    low, high, x, weights = pieces_of_the_line()
    pieces = (reduced_green(x, alpha) @ weights) * (high - low)  # both sides: twice a half
    # All terms positive: the relative error of the sum is that of its terms.
    inside = np.cumsum(pieces)
    np.testing.assert_allclose(inside, central_mass(high, 1.0, alpha), rtol=2 * TOLERANCE)
    rest = tail_mass(high[-1], 1.0, alpha)
    outside = np.cumsum(pieces[::-1])[::-1] + rest
    np.testing.assert_allclose(outside, tail_mass(low, 1.0, alpha), rtol=2 * TOLERANCE)


@pytest.mark.parametrize("alpha", [1.2, 1.5, 1.8])
def test_mean_radius_is_the_first_moment(alpha):
    """R = int P(|X| > x) dx; beyond X the power law C x^-alpha gives C X^(1-alpha) / (alpha-1)."""
    nodes, weights = np.polynomial.legendre.leggauss(30)
    edges = np.concatenate([np.arange(0.0, 24.0, 0.5), 24.0 * 1.5 ** np.arange(0, 60)])
    low, width = edges[:-1], np.diff(edges)
    x = low[:, None] + 0.5 * width[:, None] * (1.0 + nodes)
    end = edges[-1]
    body = ((tail_mass(x, 1.0, alpha) @ weights) * 0.5 * width).sum()
    rest = tail_mass(end, 1.0, alpha) * end / (alpha - 1.0)
    assert end**-alpha < TOLERANCE  # the next term of the tail does not count
    assert mean_radius(alpha) == pytest.approx(body + rest, rel=2 * TOLERANCE)


def test_printed_radii():
    """Table A.4: every printed digit."""
    printed = [6.688, 3.544, 2.512, 2.005, 1.705, 1.509, 1.371, 1.269, 1.190]
    assert [round(mean_radius(1.0 + 0.1 * i), 3) for i in range(1, 10)] == printed


@pytest.mark.parametrize("alpha", [1.1, 1.9])
def test_scaling_in_time(alpha):
    x = np.linspace(-30.0, 30.0, 121)
    t = 2.5
    scale = t ** (-1.0 / alpha)
    np.testing.assert_array_equal(green(x, t, alpha), scale * reduced_green(x * scale, alpha))
    np.testing.assert_array_equal(
        central_mass(abs(x), t, alpha), central_mass(abs(x) * scale, 1.0, alpha)
    )


def test_far_tail_neither_overflows_nor_loses_digits():
    alpha = 1.5
    coefficient = float(mp.gamma(2.5) * mp.sin(mp.pi * 0.75) / mp.pi)
    x = 10.0 ** np.arange(12.0, 120.0, 7.0)  # x^-2.5 stays above the smallest normal number
    np.testing.assert_allclose(reduced_green(x, alpha) * x**1.5 * x, coefficient, rtol=TOLERANCE)
    assert reduced_green(1e300, alpha) == 0.0
    assert reduced_green(-np.inf, alpha) == 0.0
    assert tail_mass(np.inf, 1.0, alpha) == 0.0
    assert central_mass(np.inf, 1.0, alpha) == 1.0
    assert green(1e300, 1e-300, alpha) == 0.0


@pytest.mark.parametrize(("alpha", "dim"), covering([1.0 + 1e-9, 1.5, 2.0 - 1e-9], [1, 2, 3]))
def test_far_out_the_functions_are_those_of_the_first_term(alpha, dim):
    """Where r is so large that Phi is zero in float64, and G = c t x^(-n-alpha) is not: of 1000 x and t."""
    generator = np.random.default_rng(dim)
    with mp.workdps(30):
        a, n = mp.mpf(alpha), dim
        c = mp.gamma(1 + a) * mp.sin(mp.pi * a / 2) / mp.pi
        c *= mp.gamma((a + n) / 2) / mp.gamma((a + 1) / 2) / mp.pi ** (mp.mpf(n - 1) / 2)
        looked_at = 0
        for _ in range(1000):
            x, t = (float(10.0**power) for power in generator.uniform(-300, 300, 2))
            if x * mp.mpf(t) ** (-1 / a) < 1e18:
                continue
            rate = c * mp.mpf(x) ** (-n - a)
            for function, exact in (
                (green, rate * t),
                (green_slope, -(n + a) * rate * t / x),
                (green_flux, rate * x / a),
                (green_rate, rate),
            ):
                if 1e-290 < abs(exact) < 1e300:
                    with contextlib.suppress(InvalidInput):
                        assert function(x, t, alpha, n) == pytest.approx(float(exact), rel=1e-12)
                        looked_at += 1
    assert looked_at > 100


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_partial_sums(alpha):
    x = np.array([0.2, 1.0, 3.0])
    with mp.workdps(40):
        a = mp.mpf(alpha)
        for terms in (1, 2, 7, 20):
            series = green_series(x, alpha, terms)
            asymptotic = green_asymptotic(x, alpha, terms)
            for i, point in enumerate(x):
                q = mp.mpf(point)
                near = [
                    (-1) ** j * mp.gamma(1 + m / a) / mp.factorial(m) * q ** (m - 1) / mp.pi
                    for j, m in ((j, mp.mpf(2 * j + 1)) for j in range(terms))
                ]
                size = [
                    mp.gamma(1 + a * m) / mp.factorial(m) * q ** (-a * m - 1) / mp.pi
                    for m in range(1, terms + 1)
                ]
                far = -sum(
                    (-1) ** m * mp.sin(a * m * mp.pi / 2) * term for m, term in enumerate(size, 1)
                )
                # Plain sums: accurate relative to the largest term, whose logarithm (up to 100)
                # multiplies the rounding error.
                assert abs(series[i] - sum(near)) <= 500 * EPSILON * max(map(abs, near))
                assert abs(asymptotic[i] - far) <= 500 * EPSILON * max(size)


def test_partial_sums_overflow_to_infinity_not_to_nan():
    assert green_series(1e200, 1.5, 4) == -np.inf
    assert green_series(1e200, 1.5, 5) == np.inf
    assert abs(green_asymptotic(0.0, 1.5, 3)) == np.inf
    x = 10.0 ** np.linspace(-300, 300, 61)
    for terms in (1, 40, 400):
        assert not np.isnan(green_series(x, 1.1, terms)).any()
        assert not np.isnan(green_asymptotic(x, 1.9, terms)).any()
    assert green_series(0.0, 1.5, 300) == pytest.approx(reduced_green(0.0, 1.5), rel=TOLERANCE)


def test_shapes_and_types():
    assert type(reduced_green(1, 1.5)) is float
    assert type(green(np.float32(1.0), 1, 1.5)) is float
    assert type(central_mass(np.array(1.0), 1.0, 1.5)) is float
    assert type(green_series(1.0, 1.5, 3)) is float
    assert type(mean_radius(1.5)) is float
    x = np.arange(24.0).reshape(2, 3, 4)
    for function in (
        lambda x: reduced_green(x, 1.5),
        lambda x: green(x, 1.0, 1.5),
        lambda x: tail_mass(x, 1.0, 1.5),
        lambda x: green_series(x, 1.5, 4),
        lambda x: green_asymptotic(x, 1.5, 4),
    ):
        assert function(x).shape == x.shape
        assert function([]).shape == (0,)
        np.testing.assert_array_equal(function(x[:, ::2].T), function(x)[:, ::2].T)
    integers = np.arange(-3, 4)
    np.testing.assert_array_equal(reduced_green(integers, 1.5), reduced_green(1.0 * integers, 1.5))


@pytest.mark.parametrize("alpha", [1.0, 2.0, 0.5, -1.5, np.nan, np.inf, "1.5", None, 1.5j, True])
def test_refuses_alpha(alpha):
    for call in (
        lambda: reduced_green(1.0, alpha),
        lambda: green(1.0, 1.0, alpha),
        lambda: mean_radius(alpha),
        lambda: central_mass(1.0, 1.0, alpha),
        lambda: green_series(1.0, alpha, 3),
    ):
        with pytest.raises(InvalidInput, match="alpha"):
            call()


@pytest.mark.parametrize("x", [np.nan, [0.0, np.nan], "1", None, 1j, [[1.0], [1.0, 2.0]], True])
def test_refuses_x(x):
    for call in (
        lambda: reduced_green(x, 1.5),
        lambda: green(x, 1.0, 1.5),
        lambda: tail_mass(x, 1.0, 1.5),
        lambda: green_asymptotic(x, 1.5, 3),
    ):
        with pytest.raises(InvalidInput, match=r"^x (=|is missing)"):
            call()


@pytest.mark.parametrize("t", [0.0, -1.0, np.nan, np.inf, "1", None, 1j, True])
def test_refuses_t(t):
    for call in (lambda: green(1.0, t, 1.5), lambda: central_mass(1.0, t, 1.5)):
        with pytest.raises(InvalidInput, match=r"^t (=|is missing)"):
            call()


@pytest.mark.parametrize("several", [[1.0, 2.0], (1.0,), np.array([1.0, 2.0])])
def test_several_times_are_told_that_one_is_meant(several):
    with pytest.raises(InvalidInput, match=r"^t = .*Give one number, not several\.$"):
        green(1.0, several, 1.5)


def test_refuses_the_rest():
    with pytest.raises(InvalidInput, match="dim"):
        green(1.0, 1.0, 1.5, dim=4)
    with pytest.raises(InvalidInput, match="x = "):
        central_mass(-1.0, 1.0, 1.5)
    with pytest.raises(InvalidInput, match="x = "):
        green_series(np.inf, 1.5, 3)
    for terms in (0, -1, 1.5, "3", True, 10**400):
        with pytest.raises(InvalidInput, match="terms"):
            green_series(1.0, 1.5, terms)


@at_once(
    product(
        [green, green_slope, green_flux, green_rate, tail_mass],
        [1.0 + 1e-15, 1.5, 2.0 - 1e-15],
        [1, 2, 3],
        [5e-324, 1e-310, 1e-200, 1e-100, 1e200, 1.7e308],
    )
)
def test_at_any_time_the_values_are_finite_or_the_time_is_refused(function, alpha, dim, t):
    """Close to t = 0 the peak is above the largest float64, never an infinity, a nan or another's exception."""
    x = np.array([0.0, 1e-300, 1.0, 1e300, np.inf])
    if t < 1e-90:
        with contextlib.suppress(InvalidInput):
            assert np.isfinite(function(x, t, alpha, dim)).all()
    else:
        assert np.isfinite(function(x, t, alpha, dim)).all()


def test_a_time_too_short_is_refused_by_its_name():
    for t, alpha, dim in ((5e-324, 1.0 + 1e-15, 1), (1e-310, 1.5, 2), (1e-200, 1.5, 3)):
        with pytest.raises(InvalidInput, match=r"^t = "):
            green(np.array([0.0, 1.0]), t, alpha, dim)


def test_a_peak_that_float64_holds_is_not_refused():
    for t, alpha, dim in ((1e-300, 1.5, 1), (1e-150, 1.5, 3), (1e-308, 1.05, 1)):
        peak = float(mp.mpf(t) ** (-mp.mpf(dim) / mp.mpf(alpha)))
        assert green(0.0, t, alpha, dim) == pytest.approx(
            peak * reduced_green(0.0, alpha, dim), rel=1e-12
        )
