"""The kernels against their Fourier definitions (B.11)-(B.13), mpmath, and moment conditions."""

from __future__ import annotations

import math
from dataclasses import FrozenInstanceError
from functools import cache

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import j0, j1

from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import KERNELS, PAPER_ORDERS, kernel, kernel_transform
from fracparticles.kernels.printed import PRINTED
from fracparticles.special import reduced_green
from sweeps import covering, few

ALPHAS = (1.01, 1.1, 1.5, 1.9, 1.99)
ALL = [
    (name, n, order)
    for name, k in KERNELS.items()
    for n in k.dims
    for order in k.orders
    if order in PAPER_ORDERS
]

SPHERE = {1: 2.0, 2: 2 * np.pi, 3: 4 * np.pi}  # surface of the unit sphere


def eta_hat(k: np.ndarray, order: int) -> np.ndarray:
    """The transforms (B.3) of (8) and (9), with k = 2 pi f."""
    narrow = np.exp(-k * k / 4)
    return narrow if order == 2 else 2 * narrow - np.exp(-k * k / 2)


def tanh_sinh(end: float) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights on (0, end), for integrands with a power singularity at 0."""
    y = np.arange(-5.4, 5.4, 0.01)  # the smallest node is 1e-151: k^0.1 is negligible there
    u = np.exp(-np.pi * np.sinh(y))
    node = end / (1 + u)
    return node, 0.01 * node * np.pi * np.cosh(y) * u / (1 + u)


def bessel_mean(k: np.ndarray, r: float, n: int) -> np.ndarray:
    """Mean of exp(i k.r) over the directions of k."""
    z = k * r
    if n == 1:
        return np.cos(z)
    return j0(z) if n == 2 else np.sinc(z / np.pi)


def bessel_slope(k: np.ndarray, r: float, n: int) -> np.ndarray:
    """Mean of (k.r / |k| |r|) sin(k.r): the slope of `bessel_mean` with its sign turned."""
    z = k * r
    if n == 1:
        return np.sin(z)
    if n == 2:
        return j1(z)
    return (np.sin(z) - z * np.cos(z)) / z**2


@pytest.mark.parametrize(("one", "alpha"), covering(ALL, [1.1, 1.5, 1.9]))
def test_kernel_is_the_inverse_transform(one, alpha):
    """K(r) = (2 pi)^-n int K^(k) exp(i k.r) dk; for vectors i k/|k| g(k) gives -int g sin."""
    name, n, order = one
    # The end is where exp(-k^2/4), for E exp(-k^alpha), has fallen to 1e-18.
    k, weight = tanh_sinh(42.0 ** (1 / alpha) if name == "E" else 13.0)
    weight = weight * SPHERE[n] * k ** (n - 1) / (2 * np.pi) ** n
    transform = kernel_transform(name, k, alpha, dim=n, order=order)
    # Absolute accuracy: a few hundred roundings of the integral of the moduli.
    tolerance = 1e-13 * (weight * abs(transform)).sum()
    for r in (0.05, 0.7, 1.9, 4.3):
        odd = KERNELS[name].parity == "odd"
        wave = -bessel_slope(k, r, n) if odd else bessel_mean(k, r, n)
        expected = (weight * transform * wave).sum()
        assert abs(kernel(name, r, alpha, dim=n, order=order) - expected) <= tolerance


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("alpha", ALPHAS)
def test_transforms_are_the_papers(alpha, order):
    """(B.11)-(B.13) for unit smoothing length; K^ is the integral of k^(alpha-1) eta^ beyond k."""
    k = np.linspace(0.01, 12.0, 200)
    for n in (1, 2, 3):
        for name, expected in {
            "eta": eta_hat(k, order),
            "kappa": k ** (alpha - 2) * eta_hat(k, order),
            "F": k ** (alpha - 1) * eta_hat(k, order),
            "G": -(k**alpha) * eta_hat(k, order),
        }.items():
            np.testing.assert_allclose(
                kernel_transform(name, k, alpha, dim=n, order=order), expected, rtol=1e-13
            )
    nodes, weights = tanh_sinh(1.0)
    beyond = k[:, None] + (14.0 - k[:, None]) * nodes
    tail = (beyond ** (alpha - 1) * eta_hat(beyond, order)) @ weights * (14.0 - k)
    # What lies beyond 14 (1e-20), and the roundings of the sum, relative to K^(0) of size 1.
    np.testing.assert_allclose(kernel_transform("K", k, alpha, order=order), tail, atol=1e-13)
    np.testing.assert_array_equal(kernel_transform("E", k, alpha), np.exp(-(k**alpha)))
    assert kernel_transform("kappa", 0.0, alpha, order=order) == np.inf


@cache  # both orders, and kernels that differ by a factor, take the same
def confluent(a: mp.mpf, b: mp.mpf, z: mp.mpf) -> mp.mpf:
    return mp.hyp1f1(a, b, z)


def exact(name: str, r: float, alpha: float, n: int, order: int) -> tuple[mp.mpf, mp.mpf]:
    """Equations (8)-(32) as they are printed, with the errata; and the size of what cancels."""
    with mp.workdps(40):
        r, alpha = mp.mpf(r), mp.mpf(alpha)
        z, pi_n = r * r, mp.pi ** (mp.mpf(n) / 2)
        narrow, wide = mp.exp(-z) / pi_n, mp.exp(-z / 2) / (2 * mp.pi) ** (mp.mpf(n) / 2)
        if name == "eta":
            return (narrow, narrow) if order == 2 else (2 * narrow - wide, 2 * narrow + wide)
        if name == "Phi":
            return (2 * narrow, narrow) if order == 2 else (4 * narrow - wide, narrow + wide)
        if name == "eta1":
            polynomial = 2 if order == 2 else n + 4 - 2 * z
            return -polynomial * r * narrow, (n + 4 + 2 * z) * abs(r) * narrow
        b2 = {"kappa": 0, "F": 2, "K": 2, "G": 0}[name]
        power = alpha - 2 if name == "kappa" else alpha
        a, b = (power + n) / 2, mp.mpf(n + b2) / 2
        constant = 2**power * mp.gamma(a) / (pi_n * mp.gamma(b) * mp.factorial(b2))
        value = confluent(a, b, -z)
        size = max(mp.exp(-z), abs(value - mp.exp(-z))) if name == "G" else value
        if order == 4:
            other = confluent(a, b, -z / 2)
            core = mp.exp(-z / 2)
            other_size = max(core, abs(other - core)) if name == "G" else other
            value, size = 2 * value - other / 2**a, 2 * size + other_size / 2**a
        sign = {"kappa": 1, "K": 1, "G": -1, "F": -r}[name]
        return sign * constant * value, abs(sign * constant) * size


@pytest.mark.parametrize(("name", "n", "order"), [key for key in ALL if key[0] != "E"])
def test_agrees_with_mpmath(name, n, order):
    """Relative 1e-11: the Gaussian exp(-r^2) alone costs r^2 roundings, up to 1e-13 at r = 26."""
    r = np.array(few([0.0, 1e-8, 0.3, 1.0, 1.7, 2.9, 5.0, 7.99, 8.0, 11.4, 26.0, 1e3, 1e8], 7))
    for alpha in (*ALPHAS, 1.0001, 1.9999):
        value = kernel(name, r, alpha, dim=n, order=order)
        for distance, v in zip(r, value, strict=True):
            reference, size = exact(name, distance, alpha, n, order)
            assert abs(v - reference) <= 1e-12 * size + np.finfo(float).tiny, (alpha, distance)


def test_green_kernel_is_the_reduced_green_function():
    """(39), at x = 0: Gamma(1 + 1/alpha) / pi; (58) at r = 0: Gamma(2/alpha) / (2 pi alpha)."""
    assert kernel("E", 0.0, 1.5) == pytest.approx(math.gamma(1 + 1 / 1.5) / math.pi, rel=1e-14)
    centre = math.gamma(2 / 1.5) / (2 * math.pi * 1.5)
    assert kernel("E", 0.0, 1.5, dim=2) == pytest.approx(centre, rel=1e-14)
    r = np.linspace(0.0, 40.0, 9)
    for n in (1, 2, 3):
        np.testing.assert_array_equal(kernel("E", r, 1.5, dim=n), reduced_green(r, 1.5, n))


@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("order", [2, 4])
def test_moments_of_the_gaussian_kernels(n, order):
    """Order IV: the moments that make the leading error vanish."""
    r, weight = tanh_sinh(13.0)
    weight = weight * SPHERE[n] * r ** (n - 1)

    def moment(name: str, power: int) -> float:
        return float((weight * r**power * kernel(name, r, 1.5, dim=n, order=order)).sum())

    assert moment("eta", 0) == pytest.approx(1.0, rel=1e-13)
    assert moment("Phi", 2) == pytest.approx(n, rel=1e-13)
    assert moment("eta1", 1) == pytest.approx(-n, rel=1e-13)
    if order == 4:
        # Zero against moments of size n^2 of the two parts.
        assert abs(moment("eta", 2)) < 1e-12
        assert abs(moment("eta1", 3)) < 1e-12
        assert abs(moment("Phi", 4)) < 1e-12


SYMBOL_ERROR = {
    # Relative deviation of the scheme's symbol from its limit, in powers of k: order II and IV.
    "eta": lambda k, a, o: kernel_transform("eta", k, a, order=o) - 1,
    "eta1": lambda k, a, o: kernel_transform("eta1", k, a, order=o) / k - 1,
    "Phi": lambda k, a, o: (
        (2 * (kernel_transform("Phi", 0.0, a, order=o) - kernel_transform("Phi", k, a, order=o)))
        / k**2
        - 1
    ),
    "kappa": lambda k, a, o: kernel_transform("kappa", k, a, order=o) * k ** (2 - a) - 1,
    "F": lambda k, a, o: kernel_transform("F", k, a, order=o) * k ** (1 - a) - 1,
    "G": lambda k, a, o: -kernel_transform("G", k, a, order=o) * k**-a - 1,
    "K": lambda k, a, o: (
        (a * (kernel_transform("K", 0.0, a, order=o) - kernel_transform("K", k, a, order=o))) / k**a
        - 1
    ),
}


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("name", SYMBOL_ERROR)
def test_order_of_the_symbol(name, order, alpha):
    """Doubling k multiplies the deviation by 2^order, up to the next even power (relative k^2)."""
    k = np.array([0.1, 0.2])
    error = SYMBOL_ERROR[name](k, alpha, order)
    assert abs(error[0]) > 1e-7
    assert math.log2(error[1] / error[0]) == pytest.approx(order, abs=0.05)


@pytest.mark.parametrize(
    "name", [name for name in KERNELS if math.isfinite(KERNELS[name].decay(1.5))]
)
@pytest.mark.parametrize("alpha", [1.1, 1.9])
def test_decay(name, alpha):
    for n in KERNELS[name].dims:
        values = kernel(name, np.array([1e5, 2e5]), alpha, dim=n)
        # The next term of the far field is a factor of at least r^-alpha < 1e-5 smaller.
        exponent = -math.log2(values[1] / values[0])
        assert exponent == pytest.approx(KERNELS[name].decay(alpha, n), abs=1e-4)


def test_gaussian_kernels_have_no_power_law():
    assert all(KERNELS[name].decay(1.5) == math.inf for name in ("eta", "eta1", "Phi"))


@given(
    key=st.sampled_from(ALL),
    alpha=st.floats(1.001, 1.999),
    r=st.floats(0.0, 1e150),
)
def test_parity_and_finiteness(key, alpha, r):
    name, n, order = key
    value = kernel(name, r, alpha, dim=n, order=order)
    assert math.isfinite(value)
    if n == 1:
        sign = -1.0 if KERNELS[name].parity == "odd" else 1.0
        assert kernel(name, -r, alpha, order=order) == sign * value


def test_sign_of_k():
    """Order II is positive; order IV turns negative at beta = 0.9."""
    r = np.linspace(0.0, 20.0, 2001)
    for alpha in ALPHAS:
        assert (kernel("K", r, alpha) > 0.0).all()
    assert kernel("K", r, 1.9, order=4).min() < 0.0


def test_g_has_its_maximum_where_the_paper_says():
    """Section 3.1: negative at 0, positive maximum for 1 < r < 2."""
    r = np.linspace(0.0, 20.0, 2001)
    for alpha in ALPHAS:
        g = kernel("G", r, alpha)
        assert g[0] < 0.0 < g.max()
        assert 1.0 < r[g.argmax()] < 2.0


def test_shapes_and_types():
    r = np.arange(24.0).reshape(2, 3, 4)
    for name, n, order in ALL:
        assert type(kernel(name, 1, 1.5, dim=n, order=order)) is float
        assert type(kernel_transform(name, np.float64(1.0), 1.5, dim=n, order=order)) is float
        assert kernel(name, r, 1.5, dim=n, order=order).shape == r.shape
        assert kernel_transform(name, r, 1.5, dim=n, order=order).shape == r.shape
        assert kernel(name, [], 1.5, dim=n, order=order).shape == (0,)


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("name", {"name": "k"}),
        ("name", {"name": None}),
        ("dim", {"dim": 0}),
        ("dim", {"dim": 4}),
        ("dim", {"name": "E", "dim": 4}),
        ("order", {"order": 3}),
        ("order", {"name": "E", "order": 4}),
        ("alpha", {"alpha": 1.0}),
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


def test_the_refusal_names_the_kernels():
    with pytest.raises(InvalidInput, match="eta, eta1, Phi, kappa, F, G, K, E"):
        kernel("unknown", 1.0, 1.5)


def test_refuses_distances_and_wavenumbers():
    for r in (np.nan, "1", None, 1j, np.inf, -1e151):
        with pytest.raises(InvalidInput, match=r"^r (=|is missing)"):
            kernel("K", r, 1.5)
    with pytest.raises(InvalidInput, match=r"^r = "):
        kernel("K", [0.0, -1.0], 1.5, dim=2)
    for k in (np.nan, "1", -1.0, np.inf):
        with pytest.raises(InvalidInput, match=r"^k = "):
            kernel_transform("K", k, 1.5)


def test_the_kernels_of_the_paper_stay_what_they_are():
    before = kernel("G", 0.5, 1.5)
    with pytest.raises(FrozenInstanceError):
        KERNELS["G"].orders = ()  # type: ignore[misc]
    assert kernel("G", 0.5, 1.5) == before


def test_a_family_has_order_two_on_the_line_unless_it_is_told_otherwise():
    for name in KERNELS:
        assert PRINTED.kernel(name, 0.5, 1.5) == kernel(name, 0.5, 1.5, dim=1, order=2)
        of_two = kernel_transform(name, 0.5, 1.5, dim=1, order=2)
        assert PRINTED.kernel_transform(name, 0.5, 1.5) == of_two
