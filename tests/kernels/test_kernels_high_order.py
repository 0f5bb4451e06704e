"""Kernels of order 2 to 12: mpmath, moments, Fourier inversion, far field, convergence on a lattice."""

from __future__ import annotations

import math
from functools import cache

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import j0, j1, poch

from fracparticles.errors import InvalidInput
from fracparticles.kernels import families as kernels
from fracparticles.kernels.high_order import (
    NAMES,
    ORDERS,
    kernel,
    kernel_transform,
    wavenumber_reach,
)
from fracparticles.pse import construct
from sweeps import covering

ALPHAS = (1.001, 1.1, 1.5, 1.9, 1.9999)
ODD = ("eta1", "F")
GAUSSIAN = ("eta", "eta1", "Phi")
SPHERE = {1: 2.0, 2: 2 * np.pi, 3: 4 * np.pi}  # surface of the unit sphere

orders = pytest.mark.parametrize("order", ORDERS)
dims = pytest.mark.parametrize("n", [1, 2, 3])


@cache  # the orders share their terms
def confluent(a: mp.mpf, b: mp.mpf, z: mp.mpf) -> mp.mpf:
    return mp.hyp1f1(a, b, z)


def exact(name: str, r: float, alpha: float, n: int, order: int) -> tuple[mp.mpf, mp.mpf]:
    """The sum of 1F1, or Laguerre times Gaussian; and the size of what cancels."""
    with mp.workdps(40):
        r, alpha, m = mp.mpf(r), mp.mpf(alpha), order // 2
        x, half = r * r, mp.mpf(n) / 2
        if name in GAUSSIAN:
            upper = half if name == "eta" else half + 1
            factor = {"eta": 1, "Phi": 2, "eta1": -2 * r}[name] * mp.exp(-x) / mp.pi**half
            # L(-x) is the sum of the moduli of the terms of L(x).
            value, size = mp.laguerre(m - 1, upper, x), mp.laguerre(m - 1, upper, -x)
            return factor * value, abs(factor) * size
        b2 = {"kappa": 0, "F": 2, "K": 2, "G": 0}[name]
        power = alpha - 2 if name == "kappa" else alpha
        a, b = (power + n) / 2, half + mp.mpf(b2) / 2
        constant = 2**power * mp.gamma(a) / (mp.pi**half * mp.gamma(b) * mp.factorial(b2))
        constant *= {"kappa": 1, "K": 1, "G": -1, "F": -r}[name]
        terms = [mp.rf(a, j) / mp.factorial(j) * confluent(a + j, b, -x) for j in range(m)]
        # G of order II: next to its zero exp(-x) and the rest cancel.
        size = mp.fsum(map(abs, terms)) + (mp.exp(-x) if name == "G" else 0)
        return constant * mp.fsum(terms), abs(constant) * size


@pytest.mark.parametrize(("name", "n", "order"), covering(NAMES, [1, 2, 3], ORDERS, together=2))
def test_agrees_with_mpmath(name, n, order):
    """1e-12 of what cancels: the Gaussian costs r^2 roundings, the table those of a piece, where it falls by e^2.

    The floor, a few tens of roundings of the largest value, does not grow with the order.
    """
    r = np.array([0.0, 1e-8, 0.3, 1.1, 1.7, 2.6, 3.7, 5.0, 7.1, 8.9, 9.0, 11.4, 26.0, 1e4])
    for alpha in ALPHAS[:1] if name in GAUSSIAN else ALPHAS:
        value = kernel(name, r, alpha, dim=n, order=order)
        pairs = [exact(name, distance, alpha, n, order) for distance in r]
        largest = max(abs(reference) for reference, _ in pairs)
        for distance, v, (reference, size) in zip(r, value, pairs, strict=True):
            assert abs(v - reference) <= 1e-12 * size + np.finfo(float).tiny, (alpha, distance)
            assert abs(v - reference) <= 1e-14 * largest, (alpha, distance)


@pytest.mark.parametrize(
    ("name", "n", "order"), covering(["kappa", "F", "G", "K"], [1, 2, 3], ORDERS, together=2)
)
def test_far_field(name, n, order):
    """The order has no part in it: eta^ = 1 - O(k^2m) leaves the singularity of |k|^alpha alone.

    Relative: the power of r = 1e8 costs 2 ln(r) a < 100 roundings.
    """
    for alpha in ALPHAS:
        power = alpha - 2 if name == "kappa" else alpha
        with mp.workdps(30):
            # The Fourier transform of |k|^power (Gelfand and Shilov), F and K by the gradient.
            leading = mp.mpf(2) ** power * mp.gamma((mp.mpf(n) + power) / 2)
            leading *= mp.rgamma(-mp.mpf(power) / 2) / mp.pi ** (mp.mpf(n) / 2)
            leading *= mp.mpf(10) ** (-8 * (n + mp.mpf(power)))
            leading *= {"kappa": 1, "G": -1, "F": 1e8 / alpha, "K": -1 / mp.mpf(alpha)}[name]
        value = kernel(name, 1e8, alpha, dim=n, order=order)
        assert value == pytest.approx(float(leading), rel=2e-14)


def test_the_first_orders_are_the_papers():
    r = np.linspace(0.0, 30.0, 301)
    k = np.linspace(0.1, 12.0, 60)
    for alpha in (1.1, 1.9):
        for n in (1, 2, 3):
            for name in NAMES:
                ours, papers = (f(name, r, alpha, dim=n) for f in (kernel, kernels.kernel))
                # Next to the zero of G: relative to the parts that cancel, of the size of the Gaussian.
                np.testing.assert_allclose(ours, papers, rtol=1e-12, atol=1e-14)
                transforms = (kernel_transform, kernels.kernel_transform)
                ours, papers = (f(name, k, alpha, dim=n) for f in transforms)
                np.testing.assert_allclose(ours, papers, rtol=1e-12)
            # (24)
            ours, papers = (f("eta1", r, alpha, dim=n, order=4) for f in (kernel, kernels.kernel))
            np.testing.assert_allclose(ours, papers, rtol=1e-12, atol=1e-14)


@orders
def test_eta_solves_the_moment_conditions(order):
    """It is the only such polynomial times exp(-r^2): as constructed from the conditions, exactly."""
    r = np.linspace(0.0, 6.0, 61)
    ours = kernel("eta", r, 1.5, order=order)
    # Its coefficients in powers of r^2 cancel: 2^-52 times the sum of their moduli, e^(r^2) L(-r^2) < 1e3.
    np.testing.assert_allclose(ours, construct(0, order)(r), atol=1e-12)


@orders
@dims
def test_moments(n, order):
    """Zero up to order 2m - 2; the first that is not, from eta^ = 1 - z^m / m!: (-1)^(m+1) (n/2)_m."""
    m = order // 2
    nodes, weights = np.polynomial.legendre.leggauss(200)
    r = 6.5 * (nodes + 1.0)  # to 13, where all is zero
    weights = 6.5 * weights * SPHERE[n] * r ** (n - 1)
    for name, first, unit in (("eta", 0, 1.0), ("eta1", 1, -n), ("Phi", 2, n)):
        values = weights * kernel(name, r, 1.5, dim=n, order=order)
        for p in range(m):
            moment = (values * r ** (first + 2 * p)).sum()
            # A few hundred roundings of the sum of the moduli.
            tolerance = 1e-13 * (abs(values) * r ** (first + 2 * p)).sum()
            assert abs(moment - (unit if p == 0 else 0.0)) <= tolerance, (name, p)
    values = weights * kernel("eta", r, 1.5, dim=n, order=order) * r**order
    expected = (-1) ** (m + 1) * poch(0.5 * n, m)
    assert values.sum() == pytest.approx(expected, abs=1e-13 * abs(values).sum())


def wave(z: np.ndarray, n: int, odd: bool) -> np.ndarray:
    """Mean of exp(i k.r) over the directions of k, z = |k| |r|; odd: minus its slope."""
    if n == 1:
        return np.sin(z) if odd else np.cos(z)
    if n == 2:
        return j1(z) if odd else j0(z)
    return (np.sin(z) - z * np.cos(z)) / z**2 if odd else np.sin(z) / z


@pytest.mark.parametrize(("name", "n", "order"), covering(NAMES, [1, 2, 3], ORDERS, together=2))
def test_kernel_is_the_inverse_transform(name, n, order):
    """K(r) = (2 pi)^-n int K^(k) exp(i k.r) dk, by Gauss-Legendre quadrature in t, k = t^10.

    For these alpha k^alpha and dk are whole powers of t.
    """
    nodes, weights = np.polynomial.legendre.leggauss(400)
    end = wavenumber_reach(order) ** 0.1
    t = 0.5 * end * (nodes + 1.0)
    k = t**10
    weights = 5.0 * end * weights * t**9 * SPHERE[n] * k ** (n - 1) / (2.0 * np.pi) ** n
    for alpha in (1.1, 1.5, 1.9):
        values = weights * kernel_transform(name, k, alpha, dim=n, order=order)
        for r in (0.05, 0.7, 1.9, 4.3):
            sign = -1.0 if name in ODD else 1.0
            expected = sign * (values * wave(k * r, n, name in ODD)).sum()
            # Absolute: a few hundred roundings of the integral of the moduli.
            tolerance = 1e-13 * abs(values).sum()
            assert abs(kernel(name, r, alpha, dim=n, order=order) - expected) <= tolerance


@orders
def test_transforms(order):
    """The printed sum, e^-z sum_j z^j / j!; K^ is the integral of k^(alpha-1) eta^ beyond k."""
    m, alpha = order // 2, 1.3
    k = np.linspace(0.05, 15.0, 40)
    z = 0.25 * k * k
    eta = np.exp(-z) * sum(z**j / math.factorial(j) for j in range(m))
    for name, expected in {
        "eta": eta,
        "eta1": k * eta,
        "kappa": k ** (alpha - 2) * eta,
        "F": k ** (alpha - 1) * eta,
        "G": -(k**alpha) * eta,
    }.items():
        # e^-z costs up to z = 56 roundings.
        np.testing.assert_allclose(kernel_transform(name, k, alpha, order=order), expected, 1e-13)
    for name, power in (("K", alpha), ("Phi", 2.0)):
        values = kernel_transform(name, np.array([0.0, 0.4, 3.0]), alpha, order=order)
        for start, value in zip((0.0, 0.4, 3.0), values, strict=True):

            def integrand(q: float, power: float = power) -> float:
                return q ** (power - 1.0) * kernel_transform("eta", q, alpha, order=order)

            tail, _ = quad(integrand, start, wavenumber_reach(order), epsabs=1e-13, limit=200)
            assert value == pytest.approx(tail, rel=1e-10)
        total = 2.0**power / power * math.gamma(m + 0.5 * power) / math.factorial(m - 1)
        assert values[0] == pytest.approx(total, rel=1e-14)
    reach = wavenumber_reach(order)
    assert kernel_transform("eta", reach, alpha, order=order) == pytest.approx(1e-22, rel=1e-6)
    assert kernel_transform("kappa", 0.0, alpha, order=order) == np.inf


@orders
@pytest.mark.parametrize("alpha", [1.1, 1.9])
def test_order_of_the_symbols(order, alpha):
    """DD: -z^m / m!. FPSE, its square: twice that. KPSE: alpha / (alpha + 2 m) times that."""
    m = order // 2
    k = np.array([0.4, 0.6])
    z = 0.25 * k * k
    leading = z**m / math.factorial(m)
    f, e, g, kk, k0 = (
        kernel_transform(name, q, alpha, order=order)
        for name, q in (("F", k), ("eta1", k), ("G", k), ("K", k), ("K", np.zeros(2)))
    )
    for symbol, factor in (
        (-g, 1.0),
        (f * e, 2.0),
        (alpha * (k0 - kk), alpha / (alpha + 2 * m)),
    ):
        # The next term is less than z of the first; roundings of K^(0) against k^alpha.
        room = z * factor * leading + 1e-15 * (1.0 + k0 / k**alpha)
        assert (abs(symbol / k**alpha - 1.0 + factor * leading) <= room).all()


def lattice_error(order: int, alpha: float, epsilon: float) -> list[float]:
    """Largest errors in |x| <= 4 of DD (10), FPSE (25) and KPSE (34) applied to u = exp(-x^2), nothing truncated.

    The exact -(-Laplacian)^(alpha/2) u is sqrt(pi) G of order II. An overlap of 3 leaves no aliases.
    """
    overlap = 3.0
    h = epsilon / overlap

    def lattice(half_width: float) -> np.ndarray:
        n = round(half_width / h)
        return h * np.arange(-n, n + 1)

    def sums(name: str, y: np.ndarray, x: np.ndarray, u: np.ndarray) -> np.ndarray:
        return kernel(name, (y[:, None] - x) / epsilon, alpha, order=order) @ u / overlap

    x, y = lattice(4.0), lattice(6.5)  # u is zero beyond 6.5
    u = np.exp(-y * y)
    reached = lattice(4.0 + 9.0 * epsilon)  # by the divergence
    flux = -sums("F", reached, y, u) / epsilon ** (alpha - 1.0)
    # eta1 is odd: the sum of the terms with Q_i vanishes on the infinite lattice; that of K is K^(0).
    total = kernel_transform("K", 0.0, alpha, order=order)
    exact = np.sqrt(np.pi) * kernel("G", x, alpha)
    results = (
        sums("G", x, y, u) / epsilon**alpha,
        -sums("eta1", x, reached, flux) / epsilon,
        alpha / epsilon**alpha * (sums("K", x, y, u) - total * np.exp(-x * x)),
    )
    return [float(abs(result - exact).max()) for result in results]


@orders
@pytest.mark.parametrize("alpha", [1.1, 1.9])
def test_order_of_the_schemes_on_a_lattice(order, alpha):
    """Halving epsilon at a fixed overlap divides the error by 2^(2m), less what the next terms take.

    The error is greatest at x = 0, where it is int |k|^alpha e^(-k^2/4) P, P = 1 - Q(m, z), z = (epsilon k)^2 / 4, with
    z^m / m! (1 - m z / (m + 1)) <= P <= z^m / m!, and the mean of z is epsilon^2 (alpha + 2m + 1) / 2 under the moment
    of order alpha + 2m. KPSE has more of the small wavenumbers. FPSE has 2 P (1 - P / 2), P <= z / m.
    """
    m, epsilon = order // 2, 0.3
    z = 0.5 * epsilon**2 * (alpha + order + 1.0)
    coarse, fine = lattice_error(order, alpha, epsilon), lattice_error(order, alpha, epsilon / 2)
    for before, after, extra in zip(coarse, fine, (0.0, 0.5 / m, 0.0), strict=True):
        least = order + math.log2(1.0 - (m / (m + 1.0) + extra) * z)
        # 0.01: round-off, 1e-14 of at least 1e-11.
        assert least - 0.01 <= math.log2(before / after) <= order + 0.01


@given(
    name=st.sampled_from(NAMES),
    n=st.integers(1, 3),
    order=st.sampled_from(ORDERS),
    alpha=st.floats(1.001, 1.999),
    r=st.floats(0.0, 1e150),
)
def test_parity_and_finiteness(name, n, order, alpha, r):
    value = kernel(name, r, alpha, dim=n, order=order)
    assert math.isfinite(value)
    if n == 1:
        sign = -1.0 if name in ODD else 1.0
        assert kernel(name, -r, alpha, order=order) == sign * value


@orders
@dims
def test_continuous_from_near_to_far(n, order):
    """Both forms hold around x = 80; the slope moves K by 2e-12 of itself between the two points."""
    edge = math.sqrt(80.0)
    below, above = np.nextafter(edge, 0.0), np.nextafter(edge, 9.0)
    assert below**2 < 80.0 <= above**2
    for name in ("kappa", "G", "K"):
        near, far = kernel(name, np.array([below, above]), 1.9, dim=n, order=order)
        assert near == pytest.approx(far, rel=1e-13)


def test_shapes_and_types():
    r = np.arange(24.0).reshape(2, 3, 4)
    for name in NAMES:
        for f in (kernel, kernel_transform):
            assert type(f(name, 1, 1.5, order=12)) is float
            assert f(name, r, 1.5, dim=2, order=8).shape == r.shape
            assert f(name, [], 1.5, order=6).shape == (0,)


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("name", {"name": "E"}),
        ("name", {"name": None}),
        ("dim", {"dim": 4}),
        ("order", {"order": 3}),
        ("order", {"order": 14}),
        ("order", {"order": True}),
        ("alpha", {"alpha": 2.0}),
        ("alpha", {"name": "eta", "alpha": None}),
    ],
)
def test_refuses_what_does_not_exist(field, arguments):
    arguments = {"name": "K", "alpha": 1.5, **arguments}
    with pytest.raises(InvalidInput, match=rf"^{field} (=|is missing)"):
        kernel(r=1.0, **arguments)
    with pytest.raises(InvalidInput, match=rf"^{field} (=|is missing)"):
        kernel_transform(k=1.0, **arguments)


def test_refuses_distances_and_wavenumbers():
    for r in (np.nan, "1", None, np.inf, -1e151):
        with pytest.raises(InvalidInput, match=r"^r (=|is missing)"):
            kernel("K", r, 1.5)
    with pytest.raises(InvalidInput, match=r"^r = "):
        kernel("K", [0.0, -1.0], 1.5, dim=2)
    for k in (np.nan, "1", -1.0, np.inf):
        with pytest.raises(InvalidInput, match=r"^k = "):
            kernel_transform("K", k, 1.5)
    with pytest.raises(InvalidInput, match=r"^order = "):
        wavenumber_reach(5)
