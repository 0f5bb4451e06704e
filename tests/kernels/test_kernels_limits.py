"""Kernels, potentials and weights where beta nears zero or one: what nearly cancels there, against mpmath."""

from __future__ import annotations

from functools import cache

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

import fracparticles as fp
from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import kernel, kernel_transform
from fracparticles.kernels.tabulated import tabulated
from fracparticles.schemes import SCHEMES, Setting, dpse, riesz
from fracparticles.schemes.spectrum import dense_matrix
from sweeps import covering

EPS = np.finfo(float).eps
LIMITS = (1e-12, 1e-6, 1.0 - 1e-6, 1.0 - 1e-12)
FORMS = [(2, "printed"), (4, "printed"), (4, "gamma"), (6, "gamma"), (12, "gamma")]
RADII = np.array([0.0, 1e-3, 0.3, 1.0, 2.0, 3.3, 5.0, 7.9, 8.1, 20.0, 100.0, 1e4])


@cache
def confluent(a, b, x, digits: int):
    """M(a, b, x) with the digits that mpmath is set to; the orders share theirs."""
    return mp.hyp1f1(a, b, x)


def one_f_one(a, b, x, order: int, family: str):
    """The sum that stands for M(a, b, x) in this order, and the sum of its moduli."""
    if family == "gamma":
        terms = [
            mp.rf(a, j) / mp.factorial(j) * confluent(a + j, b, -x, mp.mp.dps)
            for j in range(order // 2)
        ]
    else:
        terms = [confluent(a, b, -x, mp.mp.dps)]
        if order == 4:
            terms = [2 * terms[0], -(2 ** (-a)) * confluent(a, b, -x / 2, mp.mp.dps)]
    return mp.fsum(terms), mp.fsum(map(abs, terms))


def exact(name: str, r: float, alpha: float, n: int, order: int, family: str):
    alpha, half = mp.mpf(alpha), mp.mpf(n) / 2
    b2 = 2 if name == "K" else 0
    power = alpha - 2 if name == "kappa" else alpha
    a, b = (power + n) / 2, half + mp.mpf(b2) / 2
    constant = 2**power * mp.gamma(a) / (mp.pi**half * mp.gamma(b) * mp.factorial(b2))
    value, size = one_f_one(a, b, mp.mpf(r) ** 2, order, family)
    # G of order II: exp(-x) and the rest cancel next to its zero.
    size += mp.exp(-(mp.mpf(r) ** 2)) if name == "G" else 0
    return (-1 if name == "G" else 1) * constant * value, constant * size


@pytest.mark.parametrize(
    ("name", "n", "beta"), covering(["kappa", "G", "K"], [1, 2, 3], LIMITS, together=2)
)
def test_no_kernel_loses_digits_in_the_limits(name, n, beta):
    """The order alpha is taken as the double that it is. Beyond r = 8 what falls like exp(-r^2) is left out."""
    for order, family in FORMS:
        ours = kernel(name, RADII, 1.0 + beta, dim=n, order=order, family=family)
        with mp.workdps(60):
            for r, value in zip(RADII, ours, strict=True):
                expected, size = exact(name, r, 1.0 + beta, n, order, family)
                assert abs(value - expected) <= 1e-12 * size + (1e-24 if r > 8.0 else 0.0), (
                    order,
                    family,
                    r,
                )


@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("beta", [1e-15, 1e-12, 1e-6])
def test_the_green_function_nears_that_of_cauchy(n, beta):
    """dPhi / dbeta is bounded: 7 Phi covers it up to r = 1000."""
    r = np.array([0.0, 0.3, 0.49, 0.51, 1.0, 1.7, 5.0, 30.0, 1e3])
    power = 0.5 * (n + 1)
    constant = {1: 1.0 / np.pi, 2: 0.5 / np.pi, 3: 1.0 / np.pi**2}[n]
    cauchy = constant * (1.0 + r * r) ** -power
    assert fp.green(r, 1.0, 1.0 + beta, n) == pytest.approx(cauchy, rel=7.0 * beta + 2e-14)


@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("beta", [1.0 - 1e-15, 1.0 - 1e-12, 1.0 - 1e-6])
def test_the_green_function_nears_that_of_gauss(n, beta):
    """And keeps its tail, which is proportional to 1 - beta."""
    r, alpha = np.array([0.0, 0.3, 0.49, 0.51, 1.0, 1.7, 3.0]), 1.0 + beta
    gauss = np.exp(-0.25 * r * r) * (4.0 * np.pi) ** (-0.5 * n)
    room = (2.0 - alpha) + 2e-14
    assert fp.green(r, 1.0, alpha, n) == pytest.approx(gauss, rel=room)
    with mp.workdps(40):
        a = mp.mpf(alpha)
        tail = mp.gamma(1 + a) * mp.sin(mp.pi * (2 - a) / 2) / mp.pi
        tail *= mp.gamma((a + n) / 2) / mp.gamma((a + 1) / 2) / mp.pi ** (mp.mpf(n - 1) / 2)
        expected = float(tail * mp.mpf(1e6) ** (-a - n))
    # The second term is below 20 r^-2 of the first.
    assert fp.green(1e6, 1.0, alpha, n) == pytest.approx(expected, rel=1e-10)


# --- DPSE: the potential is the constant 1 / beta and little more --------------------------------------------------


def potential(m: int, alpha: float, order: int, overlap: float):
    """b_m - b_0."""
    a, s = mp.mpf(alpha), mp.mpf(overlap)
    at, _ = one_f_one((a - 1) / 2, mp.mpf(1) / 2, (m / s) ** 2, order, "printed")
    zero, _ = one_f_one((a - 1) / 2, mp.mpf(1) / 2, mp.mpf(0), order, "printed")
    return s ** (1 - a) * 2 ** (a - 2) * mp.gamma((a - 1) / 2) / mp.pi * (at - zero)


@pytest.mark.parametrize(
    ("order", "overlap", "beta"),
    covering([2, 4], [0.25, 1.0, 2.0, 8.0], [1e-15, 1e-12, 1e-6, 4.9e-3], together=2),
)
def test_differences_of_the_potential_keep_their_digits(order, overlap, beta):
    ours = dpse.potential_differences(
        np.arange(400.0), Setting(alpha=1.0 + beta, order=order, overlap=overlap)
    )
    assert ours[0] == 0.0
    with mp.workdps(60):
        for m in (1, 2, 5, 20, 399):
            # Sums of m terms of one sign, each good to 1e-14.
            assert ours[m] == pytest.approx(
                float(potential(m, 1.0 + beta, order, overlap)), rel=2e-14
            )


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("beta", [1e-15, 1e-12, 1e-9, 1e-3, 4.9e-3, 5.1e-3, 0.01])
def test_dpse_is_the_product_of_its_two_matrices(order, beta):
    """Element by element, from many digits: the constant 1 / beta leaves no roundings that make mass."""
    setting = Setting(n=12, spacing=0.1, alpha=1.0 + beta, order=order)
    ours = dense_matrix(SCHEMES["DPSE"].operator(setting))
    m = np.arange(setting.size)
    lag = np.abs(m[:, None] - m)
    with mp.workdps(60):
        b = np.array([float(potential(int(k), 1.0 + beta, order, 2.0)) for k in m])
    c = dpse.laplacian_weights(m.astype(float), setting)[lag]
    np.fill_diagonal(c, 0.0)
    laplacian = c - np.diag(c.sum(axis=1))
    expected = setting.rate * laplacian @ b[lag]
    # Where the constant is kept it costs 1 / beta, at most 200; FFT and two products round log N and N terms.
    size = setting.rate * (np.abs(laplacian) @ np.abs(b[lag])).max()
    kept = 1.0 if beta < 5e-3 else 1.0 / beta
    assert np.abs(ours - expected).max() <= 20.0 * kept * EPS * size
    assert np.abs(ours.sum(axis=0)).max() <= 50.0 * kept * EPS * size


@given(beta=st.floats(-15.0, -0.1), order=st.sampled_from([2, 4]), time=st.floats(-3.0, 3.0))
def test_dpse_keeps_the_mass_however_small_beta(beta, order, time):
    setting = Setting(n=20, spacing=0.1, alpha=1.0 + 10.0**beta, order=order)
    matrix = dense_matrix(SCHEMES["DPSE"].operator(setting))
    u0 = np.random.default_rng(8).uniform(size=setting.size)
    u = expm(10.0**time * matrix / np.abs(matrix).max()) @ u0
    # Each of the digits that the constant may cost (200), times T |A| of the longest run.
    room = 200.0 * 20.0 * EPS * max(1.0, 10.0**time)
    assert u.sum() == pytest.approx(u0.sum(), rel=room)


# --- FD: differences of nearly linear or nearly constant powers ----------------------------------------------------

FD = SCHEMES["FD"]


def finite_difference_weight(m: int, alpha: float):
    p = 2 - mp.mpf(alpha)

    def omega(z: int):
        return mp.mpf(z) ** p / mp.gamma(p + 1) if z > 0 else mp.mpf(0)

    def g(k: int):
        return omega(k + 1) - omega(k) if k >= 0 else mp.mpf(0)

    def one_sided(k: int):
        return g(k + 1) - 2 * g(k) + g(k - 1)

    mirrored = one_sided(-m) if m <= 1 else 0
    return (one_sided(m) + mirrored) / 2 / abs(mp.cos(mp.pi * mp.mpf(alpha) / 2))


@pytest.mark.parametrize(
    "beta", [1e-15, 1e-12, 1e-6, 1e-3, 4.9e-3, 0.9951, 0.999, 1 - 1e-6, 1 - 1e-12]
)
def test_weights_of_the_finite_differences_in_the_limits(beta):
    """The third difference cancels to 2 / m^2 of its terms near beta = 0, to 2 / m^3 near 1, below the far series."""
    m = np.array([0, 1, 2, 3, 10, 100, 199, 200, 1000, 10**5])
    ours = FD.weights(m, Setting(alpha=1.0 + beta))
    with mp.workdps(60):
        for k, value in zip(m, ours, strict=True):
            expected = float(finite_difference_weight(int(k), 1.0 + beta))
            # log m is what the powers have beyond 1 or z.
            room = 4.0 * EPS * max(10.0, k**3.0 * np.log(k + 2.0)) if k < 200 else 1e-12
            assert value == pytest.approx(expected, rel=room), k


@pytest.mark.parametrize("beta", [1e-12, 1e-6, 1e-3, 0.999, 1.0 - 1e-9])
def test_the_symbol_of_the_finite_differences_is_the_sum_of_its_weights(beta):
    theta = np.array([0.4, 1.0, 2.2, np.pi])
    m = np.arange(1.0, 200_001.0)
    setting = Setting(alpha=1.0 + beta)
    w0, w = FD.weights(np.zeros(1), setting)[0], FD.weights(m, setting)
    direct = np.array([w0 + 2.0 * (w * np.cos(m * t)).sum() for t in theta])
    left_out = 2.0 * w[-1] / np.sin(0.5 * theta)
    room = np.abs(left_out) + 1e-12 * abs(w0)
    assert (np.abs(FD.symbol(theta, setting) - direct) <= room).all()


@pytest.mark.parametrize("beta", [0.9951, 0.999, 1.0 - 1e-6, 1.0 - 1e-12])
def test_the_symbol_of_the_finite_differences_near_the_pole_of_zeta(beta):
    """Its two zeta functions are 1 / (1 - beta) each, of which nothing is left."""
    theta = np.array([1e-3, 0.4, 1.0, 2.2, np.pi])
    ours = FD.symbol(theta, Setting(alpha=1.0 + beta))
    with mp.workdps(50):
        p = 3 - mp.mpf(1.0 + beta)
        for t, value in zip(theta, ours, strict=True):
            turns = mp.mpf(t) / (2 * mp.pi)
            quarter = mp.exp(-mp.j * mp.pi * p / 2)
            aliases = quarter * mp.zeta(p, turns) + mp.conj(quarter) * mp.zeta(p, 1 - turns)
            flux = -4 * mp.sin(mp.mpf(t) / 2) ** 2 * aliases / (2 * mp.pi) ** p
            exact = ((mp.exp(mp.j * t) - 1) * flux).real / abs(mp.cos(mp.pi * (3 - p) / 2))
            assert value == pytest.approx(float(exact), rel=1e-13, abs=1e-14)


@pytest.mark.parametrize("beta", [*LIMITS, 1e-3, 0.999])
def test_the_regularised_potential_in_the_limits(beta):
    """K* at the origin and its transform, which is alpha-smooth: neither has 1 / beta left."""
    alpha = 1.0 + beta
    with mp.workdps(60):
        b = mp.mpf(alpha) - 1
        constant = mp.gamma(b / 2) / (2 ** (1 - b) * mp.sqrt(mp.pi) * mp.gamma((1 - b) / 2))
        nu = (1 + b) / 2
        for x in (0.0, 0.7, 30.0):
            expected = float(b * constant * (1 + mp.mpf(x) ** 2) ** (-b / 2 - 1))
            assert riesz.kernel_star(np.array([x]), alpha)[0] == pytest.approx(expected, rel=1e-13)
        for k in (1e-3, 0.5, 4.0):
            wave = (mp.mpf(k) / 2) ** nu * mp.besselk(nu, k)
            expected = float(b * constant * 2 * mp.sqrt(mp.pi) / mp.gamma(nu + 0.5) * wave)
            ours = riesz.kernel_star_transform(np.array([k]), alpha)[0]
            assert ours == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(("beta", "form"), covering(LIMITS, FORMS))
def test_transforms_in_the_limits(beta, form):
    """K^ from dK^/dk = -k^beta eta^, by quadrature up to exp(-100); G^ and F^ are a power of k times eta^."""
    order, family = form
    alpha = 1.0 + beta
    ours = kernel_transform("K", np.array([0.0, 1e-3, 0.7, 3.0]), alpha, order=order, family=family)
    with mp.workdps(20):
        taylor = [1 / mp.factorial(j) for j in range(order // 2)]

        def eta(k):
            z = k * k / 4
            if family == "gamma":
                return mp.exp(-z) * mp.fsum(c * z**j for j, c in enumerate(taylor))
            return mp.exp(-z) if order == 2 else 2 * mp.exp(-z) - mp.exp(-2 * z)

        for k, value in zip((0.0, 1e-3, 0.7, 3.0), ours, strict=True):
            expected = mp.quad(lambda q: q ** mp.mpf(alpha - 1.0) * eta(q), [k, 1, 2, 4, 8, 20])
            assert value == pytest.approx(float(expected), rel=1e-13 * order)


# --- tables -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("step", [1e-6, 1e-3])
@pytest.mark.parametrize("factor", [1.001, 1e3, 1e100])
def test_a_table_that_no_memory_holds_is_refused(step, factor):
    with pytest.raises(InvalidInput, match=r"^kernel_table = .*at least"):
        tabulated(step)("K", np.array([0.0, 2.0**25 * step * factor]), 1.5)


def test_a_table_is_exact_at_its_points_and_takes_no_distances_at_all():
    r = np.array([0.0, 0.25, 3.0, 17.5])
    values = tabulated(0.25)("G", r, 1.5)
    assert values == pytest.approx(kernel("G", r, 1.5), rel=1e-14)
    assert tabulated(0.25)("G", np.empty(0), 1.5).size == 0


@pytest.mark.parametrize(("name", "parity"), [("F", -1.0), ("eta1", -1.0), ("K", 1.0), ("G", 1.0)])
def test_a_table_keeps_the_sign_of_distances_on_the_line(name, parity):
    r = np.array([0.3, 2.0])
    values = tabulated(1e-3)(name, r, 1.5)
    assert tabulated(1e-3)(name, -r, 1.5) == pytest.approx(parity * values, rel=1e-15)
    assert values == pytest.approx(kernel(name, r, 1.5), rel=1e-5)


@pytest.mark.parametrize(
    ("step", "r", "dim", "field"),
    [
        (0.0, 1.0, 1, "kernel_table"),
        ("a", 1.0, 1, "kernel_table"),
        (0.1, "a", 1, "r"),
        (0.1, np.nan, 1, "r"),
        (0.1, np.inf, 1, "r"),
        (0.1, -1.0, 2, "r"),
    ],
)
def test_a_table_refuses_what_the_kernels_do(step, r, dim, field):
    with pytest.raises(InvalidInput, match=rf"^{field} = "):
        tabulated(step)("K", r, 1.5, dim=dim)


@pytest.mark.parametrize("order", [np.array([2, 4]), [2], "2", None, True, 3])
def test_orders_that_are_none_are_refused(order):
    for function in (kernel, kernel_transform):
        with pytest.raises(InvalidInput, match=r"^order (=|is missing)"):
            function("K", 1.0, 1.5, order=order)


def test_the_transform_of_the_potential_is_infinite_next_to_zero_too():
    assert kernel_transform("kappa", 5e-324, 1.0 + EPS) == np.inf
