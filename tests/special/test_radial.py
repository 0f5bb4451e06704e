"""The fundamental solution in one, two and three dimensions, and the tables behind it (n = 1 to 5)."""

from __future__ import annotations

import math
from functools import cache

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import gamma, gammainc, gammaincc, j0, j1

from fracparticles.errors import InvalidInput
from fracparticles.special import (
    central_mass,
    green,
    green_flux,
    green_rate,
    green_slope,
    radial,
    reduced_green,
    tail_mass,
)
from known import pieces_of_the_line
from sweeps import covering, few

# As in test_stable: a few hundred roundings of 1.1e-16 in a sum of positive terms; 20 times the
# roundings of the largest part where n = 5 cancels next to r = 1/2.
TOLERANCE = 1e-13
EPSILON = np.finfo(float).eps
SURFACE = {1: 2.0, 2: 2 * np.pi, 3: 4 * np.pi}

# Both sides of 3/2, where the saddle point begins to count, and both ends of the open interval.
ALPHAS = (1.001, 1.1, 1.5, 1.5 + 1e-9, 1.7, 1.95, 1.999, 2.0 - EPSILON)
NEAR = (0.0, 1e-8, 0.49, 0.5)
MIDDLE = (1.4, 2.2, 3.99, 5.1, 7.1, 11.2, 14.7, 17.5)
FAR = (25.0, 1e2, 1e4, 1e8, 1e50)


# Of the same numbers at every distance, with 130 digits each.
precise_gamma = cache(mp.gamma)


def exact(r: float, alpha: float, n: int) -> tuple[mp.mpf, mp.mpf]:
    """Density and mass outside from the tail's series, if it gives 25 digits, or the near one."""
    with mp.workdps(130):
        r, a, half = mp.mpf(r), mp.mpf(alpha), mp.mpf(n) / 2
        surface = 2 * mp.pi**half / precise_gamma(half)
        if r > 1:
            density, tail, previous = mp.mpf(0), mp.mpf(0), mp.inf
            for m in range(1, 500):
                size = 2 ** (a * m) * precise_gamma(a * m / 2 + half) * precise_gamma(a * m / 2 + 1)
                size *= r ** (-a * m - n) / (mp.factorial(m) * mp.pi ** (half + 1))
                if (m > 9 and size > previous) or size < mp.mpf(10) ** -30 * abs(density) * (2 - a):
                    break
                previous = size
                term = size * mp.sin(mp.pi * (2 - a) * m / 2)
                density += term
                tail += surface * term * r**n / (a * m)
            # The integral of |k^(a m) / m! exp(i k r)| along the ray on which k^a is imaginary.
            left_out = size * mp.sin(mp.pi / (2 * a)) ** -(a * m + n)
            if left_out < mp.mpf(10) ** -25 * density:
                return density, tail
        assert alpha > 1.05 or r < 0.9, "neither converges here"
        density, central, k = mp.mpf(0), mp.mpf(0), 0
        constant = 2 / (a * (4 * mp.pi) ** half)
        while True:
            term = constant * (-1) ** k * precise_gamma((2 * k + n) / a) * (r / 2) ** (2 * k)
            term /= mp.factorial(k) * precise_gamma(k + half)
            density += term
            central += surface * term * r**n / (2 * k + n)
            if k > 2 and abs(term) < mp.mpf(10) ** -40 * abs(density):
                return density, 1 - central
            k += 1


def table_values(r: np.ndarray, alpha: float, n: int) -> tuple[np.ndarray, ...]:
    table = radial.radial_table(alpha, n)
    density, outside, inside = (np.empty_like(r) for _ in range(3))
    radial.density(r, table, density)
    radial.mass(r, table, False, outside)
    radial.mass(r, table, True, inside)
    return density, outside, inside


@pytest.mark.parametrize(("alpha", "n"), covering(ALPHAS, [2, 3, 4, 5]))
def test_agrees_with_mpmath(alpha, n):
    r = np.array(few(NEAR + MIDDLE + FAR, 9))
    for point, density, outside, inside in zip(r, *table_values(r, alpha, n), strict=True):
        value, beyond = exact(point, alpha, n)
        # The smallest normal number is the end of relative accuracy.
        assert abs(density - value) <= TOLERANCE * value + np.finfo(float).tiny, point
        assert abs(outside - beyond) <= TOLERANCE * beyond, point
        assert abs(inside - (1 - beyond)) <= TOLERANCE * (1 - beyond), point


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5])
@pytest.mark.parametrize("above", [EPSILON, 1e-12, 1e-6, 1e-3, 0.02])
def test_a_table_next_to_three_halves_is_no_larger_than_another(n, above):
    """There the wave of the saddle point decays ever more slowly, and is none of the density's."""
    other = radial.radial_table(1.9, n).density.shape[0]
    assert radial.radial_table(1.5 + above, n).density.shape[0] <= other


@pytest.mark.parametrize(("alpha", "r"), few([(1.0001, 1.0), (1.01, 1.1), (1.03, 0.9)]))
def test_agrees_with_the_integral_close_to_one(alpha, r):
    """Where neither series is of use; (58) for n = 2."""
    with mp.workdps(25):
        ends = mp.linspace(0, 75, 16)

        def integral(function):
            return mp.quad(
                lambda k: function(k, k * mp.mpf(r)) * mp.exp(-(k ** mp.mpf(alpha))), ends
            )

        references = {
            2: integral(lambda k, z: k * mp.besselj(0, z)) / (2 * mp.pi),
            3: integral(lambda k, z: k * mp.sin(z)) / (2 * mp.pi**2 * r),
            4: integral(lambda k, z: k * k * mp.besselj(1, z)) / (4 * mp.pi**2 * r),
            5: integral(lambda k, z: k * (mp.sin(z) - z * mp.cos(z))) / (4 * mp.pi**3 * r**3),
        }
        for n, reference in references.items():
            value = table_values(np.array([r]), alpha, n)[0][0]
            assert abs(value - reference) <= TOLERANCE * reference


@pytest.mark.parametrize("alpha", ALPHAS)
def test_value_at_the_centre(alpha):
    """Phi_n(0) = 2 Gamma(n/alpha) / (alpha (4 pi)^(n/2) Gamma(n/2))."""
    for n in (1, 2, 3):
        closed = 2 * math.gamma(n / alpha) / (alpha * (4 * math.pi) ** (n / 2) * math.gamma(n / 2))
        assert reduced_green(0.0, alpha, n) == pytest.approx(closed, rel=1e-14)


def test_limits_in_alpha():
    r = np.linspace(0.0, 30.0, 601)
    delta = 1e-9
    for n in (1, 2, 3):
        half = 0.5 * (n + 1)
        cauchy = gamma(half) / (np.pi * (1 + r * r)) ** half
        # The derivative in alpha is of the size of Phi log r; 20 n is above it on this range.
        np.testing.assert_allclose(reduced_green(r, 1 + delta, n), cauchy, rtol=20 * n * delta)
        gauss = np.exp(-r * r / 4) / (4 * np.pi) ** (n / 2)
        close = {"rtol": 20 * n * delta, "atol": delta}  # plus a power law of weight 2 - alpha
        np.testing.assert_allclose(reduced_green(r, 2 - delta, n), gauss, **close)
        inside, outside = gammainc(n / 2, r * r / 4), gammaincc(n / 2, r * r / 4)
        np.testing.assert_allclose(central_mass(r, 1.0, 2 - delta, n), inside, **close)
        np.testing.assert_allclose(tail_mass(r, 1.0, 2 - delta, n), outside, **close)


@pytest.mark.parametrize("dim", [1, 2, 3])
@pytest.mark.parametrize("alpha", [1.05, 1.5, 1.95])
def test_mass_is_the_integral_of_the_density(alpha, dim):
    low, high, r, weights = pieces_of_the_line()
    shell = SURFACE[dim] * r ** (dim - 1) * reduced_green(r, alpha, dim)
    pieces = (shell @ weights) * 0.5 * (high - low)
    # All terms positive: the relative error of the sum is that of its terms.
    inside = np.cumsum(pieces)
    np.testing.assert_allclose(inside, central_mass(high, 1.0, alpha, dim), rtol=TOLERANCE)
    rest = tail_mass(high[-1], 1.0, alpha, dim)
    outside = np.cumsum(pieces[::-1])[::-1] + rest
    np.testing.assert_allclose(outside, tail_mass(low, 1.0, alpha, dim), rtol=TOLERANCE)
    assert inside[-1] + rest == pytest.approx(1.0, rel=TOLERANCE)


@pytest.mark.parametrize("alpha", [1.2, 1.7])
def test_each_is_the_marginal_of_the_next(alpha):
    """Phi_n(r) = 2 int Phi_{n+1}(sqrt(r^2 + y^2)) dy, also for odd n, which does not use it."""
    r = np.array([0.0, 0.4, 1.5, 6.0])[:, None]
    v = np.arange(-25.0, 25.0, 0.05)  # y = exp(v - exp(-v)): double exponential at 0
    y = np.exp(v - np.exp(-v))
    weight = 0.05 * y * (1.0 + np.exp(-v))
    for n in (1, 2):
        marginal = 2.0 * reduced_green(np.hypot(r, y), alpha, n + 1) @ weight
        np.testing.assert_allclose(marginal, reduced_green(r[:, 0], alpha, n), rtol=2 * TOLERANCE)


@given(
    alpha=st.floats(1.0001, 1.9999),
    dim=st.integers(1, 3),
    r=st.floats(0.0, 1e9),
    factor=st.floats(1.0001, 3.0),
)
def test_even_positive_decreasing(alpha, dim, r, factor):
    value = reduced_green(r, alpha, dim)
    assert value > 0.0
    assert reduced_green(-r, alpha, dim) == value
    # Strictly decreasing, up to the relative error of two values.
    assert reduced_green(r * factor, alpha, dim) <= value * (1.0 + 2 * TOLERANCE)
    assert green_slope(r, 1.0, alpha, dim) <= 0.0 <= green_flux(r, 1.0, alpha, dim)
    inside, outside = central_mass(r, 1.0, alpha, dim), tail_mass(r, 1.0, alpha, dim)
    assert abs(inside + outside - 1.0) <= 2 * EPSILON


@given(alpha=st.floats(1.001, 1.999), n=st.integers(2, 5), border=st.integers(1, 44))
def test_no_jump_between_pieces(alpha, n, border):
    r = 0.5 * border
    sides = np.array([np.nextafter(r, 0.0), r])
    for below, above in table_values(sides, alpha, n):
        # A relative step of eps |r f'/f|, where |r f'/f| < r^2 + n + 2, and the two errors.
        assert abs(above / below - 1.0) <= 2 * TOLERANCE + (r * r + n + 2) * EPSILON


@pytest.mark.parametrize("dim", [1, 2, 3])
@pytest.mark.parametrize("alpha", [1.05, 1.5, 1.95])
def test_slope_is_the_derivative(alpha, dim):
    """Chebyshev interpolation on short intervals, differentiated."""
    points = np.polynomial.chebyshev.chebpts1(20)
    for middle in (0.6, 1.7, 4.2, 30.0):
        r = middle + 0.2 * points
        interpolant = np.polynomial.Chebyshev.fit(r, green(r, 1.5, alpha, dim), 19)
        slope = green_slope(middle, 1.5, alpha, dim)
        # Differentiating costs a factor of at most degree / half-width, in units of the value.
        assert abs(interpolant.deriv()(middle) - slope) <= TOLERANCE * 100 * interpolant(middle)
    assert green_slope(0.0, 1.5, alpha, dim) == 0.0


def fourier(kind: str, r: float, t: float, alpha: float, n: int) -> tuple[float, float]:
    """Flux or rate from the transforms -i k |k|^(alpha-2) exp(-t k^alpha), -k^alpha exp(-t k^alpha).

    And the integral of the moduli. Tanh-sinh rule up to where exp(-t k^alpha) is 1e-18.
    """
    y = np.arange(-5.0, 5.0, 0.008)
    u = np.exp(-np.pi * np.sinh(y))
    k = (42.0 / t) ** (1 / alpha) / (1 + u)
    weight = 0.008 * k * np.pi * np.cosh(y) * u / (1 + u) * np.exp(-t * k**alpha)
    weight *= SURFACE[n] * k ** (n - 1) / (2 * np.pi) ** n
    z = k * r
    if kind == "rate":
        weight *= k**alpha
        wave = -(np.cos(z) if n == 1 else j0(z) if n == 2 else np.sinc(z / np.pi))
    else:
        weight *= k ** (alpha - 1)
        # For n = 3 the spherical Bessel function, by its series where it cancels.
        bessel = np.where(z < 1e-3, z / 3, (np.sin(z) - z * np.cos(z)) / z**2)
        wave = np.sin(z) if n == 1 else j1(z) if n == 2 else bessel
    return float((weight * wave).sum()), float(weight.sum())


@pytest.mark.parametrize("dim", [1, 2, 3])
@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_flux_and_rate_are_the_fourier_integrals(alpha, dim):
    t = 0.5
    for r in (0.05, 0.7, 1.9, 4.3):
        for kind, function in (("rate", green_rate), ("flux", green_flux)):
            expected, size = fourier(kind, r, t, alpha, dim)
            # Some roundings of the integral of the moduli; the series left out is 1e-3^3.
            assert abs(function(r, t, alpha, dim) - expected) <= 1e-12 * size, (kind, r)


@pytest.mark.parametrize("dim", [1, 2, 3])
@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_rate_balances_the_flux(alpha, dim):
    """The rate integrated over a ball is minus the flux through its surface."""
    nodes, weights = np.polynomial.legendre.leggauss(30)
    edges = np.arange(0.0, 12.5, 0.5)
    r = edges[:-1, None] + 0.25 * (1.0 + nodes)
    shell = SURFACE[dim] * r ** (dim - 1) * green_rate(r, 0.7, alpha, dim)
    gain = np.cumsum((shell @ weights) * 0.25)
    size = np.cumsum((abs(shell) @ weights) * 0.25)
    out = SURFACE[dim] * edges[1:] ** (dim - 1) * green_flux(edges[1:], 0.7, alpha, dim)
    assert (abs(gain + out) <= TOLERANCE * size).all()


@pytest.mark.parametrize("dim", [1, 2, 3])
def test_self_similarity(dim):
    alpha, t = 1.3, 2.5
    r = np.linspace(0.0, 30.0, 121)
    s = t ** (-1 / alpha)
    rounded = {"rtol": 1e-14, "atol": 1e-15}  # a few roundings; the rate has a zero
    np.testing.assert_allclose(
        green(r, t, alpha, dim), s**dim * reduced_green(r * s, alpha, dim), rtol=1e-14
    )
    for function, power in ((green_slope, dim + 1), (green_flux, dim + alpha - 1)):
        np.testing.assert_allclose(
            function(r, t, alpha, dim), s**power * function(r * s, 1.0, alpha, dim), **rounded
        )
    np.testing.assert_allclose(
        green_rate(r, t, alpha, dim),
        s ** (dim + alpha) * green_rate(r * s, 1.0, alpha, dim),
        **rounded,
    )
    for function in (central_mass, tail_mass):
        np.testing.assert_array_equal(function(r, t, alpha, dim), function(r * s, 1.0, alpha, dim))


@pytest.mark.parametrize("dim", [1, 2, 3])
def test_parity_and_infinity(dim):
    r = np.array([0.0, 0.3, 2.0, 1e3, 1e160, np.inf])
    for function, sign in ((green, 1), (green_rate, 1), (green_slope, -1), (green_flux, -1)):
        value = function(r, 0.5, 1.5, dim)
        np.testing.assert_array_equal(function(-r, 0.5, 1.5, dim), sign * value)
        assert np.isfinite(value).all()
        assert value[-1] == 0.0
        assert function(1e300, 1e-300, 1.5, dim) == 0.0
    assert tail_mass(np.inf, 1.0, 1.5, dim) == 0.0
    assert central_mass(np.inf, 1.0, 1.5, dim) == 1.0


def test_shapes_and_types():
    r = np.arange(24.0).reshape(2, 3, 4)
    for dim in (1, 2, np.int64(3)):
        for function in (green, green_slope, green_flux, green_rate, central_mass, tail_mass):
            assert type(function(1, 1, 1.5, dim)) is float
            assert function(r, 1.0, 1.5, dim).shape == r.shape
            assert function([], 1.0, 1.5, dim).shape == (0,)
        assert reduced_green(r, 1.5, dim).shape == r.shape


@pytest.mark.parametrize("dim", [0, 4, -1, 1.0, "2", None, True])
def test_refuses_dim(dim):
    for function in (green, green_slope, green_flux, green_rate, central_mass, tail_mass):
        with pytest.raises(InvalidInput, match=r"^dim (=|is missing)"):
            function(1.0, 1.0, 1.5, dim)
    with pytest.raises(InvalidInput, match=r"^dim (=|is missing)"):
        reduced_green(1.0, 1.5, dim)


def test_refuses_the_rest():
    for function in (green, green_slope, green_flux, green_rate, central_mass, tail_mass):
        for bad, field in (
            ((np.nan, 1.0, 1.5), "x"),
            (("1", 1.0, 1.5), "x"),
            ((1.0, 0.0, 1.5), "t"),
            ((1.0, np.inf, 1.5), "t"),
            ((1.0, 1.0, 2.0), "alpha"),
            ((1.0, 1.0, "1.5"), "alpha"),
        ):
            with pytest.raises(InvalidInput, match=f"^{field} = "):
                function(*bad, 2)
    for function in (central_mass, tail_mass):
        with pytest.raises(InvalidInput, match=r"^x = "):
            function(-1.0, 1.0, 1.5, 3)
