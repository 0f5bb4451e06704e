"""The schemes: their printed formulas term by term, their symbols, and what they conserve."""

from __future__ import annotations

from math import cos, gamma, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from combinations import combinations_without
from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import FAMILIES, kernel
from fracparticles.schemes import ALL_SCHEMES, SCHEMES, Setting, dpse, fpse, riesz, scheme
from fracparticles.schemes.spectrum import dense_matrix
from fracparticles.special import green

N = 24  # half the number of intervals where the matrix is looked at
H, S, DIFFUSIVITY = 0.25, 2.0, 1.7


def setting(combination, alpha=1.5, n=N, **other) -> Setting:
    _, order, exterior = combination
    given_ = {"spacing": H, "overlap": S, "diffusivity": DIFFUSIVITY, **other}
    return Setting(n=n, alpha=alpha, order=order, exterior=exterior, **given_)


def matrix(combination, **other) -> np.ndarray:
    return dense_matrix(SCHEMES[combination[0]].operator(setting(combination, **other)))


# --- the printed formulas -------------------------------------------------------------------------


def printed_formula(name: str, order: int, alpha: float, u: np.ndarray) -> np.ndarray:
    """du/dt of the truncated scheme, as the paper prints it: particles at x_i, volumes V, length epsilon."""
    beta, epsilon, volume = alpha - 1.0, S * H, H
    x = np.arange(-N, N + 1) * H
    r = x[:, None] - x[None, :]

    def k(kernel_name):
        if kernel_name == "K*":
            return riesz.kernel_star(r / epsilon, alpha) / epsilon
        return kernel(kernel_name, r / epsilon, alpha, order=order) / epsilon

    def exchange(weights, v, sign=-1.0):
        return np.array([(volume * (v + sign * v[i]) * weights[i]).sum() for i in range(x.size)])

    match name:
        case "DD":  # (10)
            return DIFFUSIVITY / epsilon**alpha * (volume * u * k("G")).sum(axis=1)
        case "DPSE":  # (13), (16)
            v = epsilon ** (1.0 - beta) * (volume * u * k("kappa")).sum(axis=1)
            return 2.0 * DIFFUSIVITY / epsilon**2 * exchange(k("Phi"), v)
        case "FPSE":  # (19), (25)
            q = -1.0 / epsilon**beta * (volume * u * k("F")).sum(axis=1)
            return -DIFFUSIVITY / epsilon * exchange(k("eta1"), q, sign=1.0)
        case "KPSE":  # (34)
            return DIFFUSIVITY * alpha / epsilon**alpha * exchange(k("K"), u)
        case "GPSE":  # (41)
            return DIFFUSIVITY / epsilon**alpha * exchange(k("E"), u)
        case "PSE29":  # (29)
            return DIFFUSIVITY / epsilon**alpha * exchange(k("G"), u)
        case "RIESZ":  # 3.2.3, second remark
            return DIFFUSIVITY * alpha / epsilon**alpha * exchange(k("K*"), u)
    raise AssertionError(name)


def printed_finite_differences(alpha: float, u: np.ndarray) -> np.ndarray:
    """The reconstruction of [41]: theta = 1/2, divided by |cos(pi alpha / 2)|, u = 0 outside."""
    beta, size = alpha - 1.0, u.size
    v = np.concatenate([[0.0], u, [0.0]])  # v[j + 1] = u_j, j = -1 .. size

    def omega(j):
        return (H * j) ** (1.0 - beta) / gamma(2.0 - beta) if j > 0 else 0.0

    delta = {j: (v[j + 1] - v[j]) / H for j in range(size + 1)}

    def left(i):
        return sum((omega(i - j + 1) - omega(i - j)) * delta[j] for j in delta if j <= i)

    def right(i):
        return sum((omega(j - i) - omega(j - 1 - i)) * delta[j] for j in delta if j > i)

    scale = DIFFUSIVITY / (2.0 * H * abs(cos(pi * alpha / 2.0)))
    return np.array(
        [scale * (left(i + 1) - left(i) + right(i) - right(i - 1)) for i in range(size)]
    )


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize("combination", combinations_without(exterior="truncated"))
def test_the_operator_is_the_printed_formula(combination, alpha):
    name, order, _ = combination
    u = np.random.default_rng(5).standard_normal(2 * N + 1)
    operator = SCHEMES[name].operator(setting(combination, alpha=alpha))
    expected = (
        printed_finite_differences(alpha, u)
        if name == "FD"
        else printed_formula(name, order, alpha, u)
    )
    # Kernels are good to 1e-11; sums of 49 terms cancel by about the factor 10.
    assert np.abs(operator.apply(u) - expected).max() <= 1e-11 * 10 * np.abs(expected).max()


def test_far_weights_of_the_finite_differences_are_third_differences():
    """Beyond the switch to the Taylor series, against 40 digits."""
    import mpmath as mp

    with mp.workdps(40):
        for m in (199, 200, 1000, 10**6):
            for alpha in (mp.mpf("1.1"), mp.mpf("1.9")):
                p = 2 - alpha
                third = sum(
                    c * mp.mpf(m + k) ** p for c, k in ((1, 2), (-3, 1), (3, 0), (-1, -1))
                ) / mp.gamma(p + 1)
                exact = float(third / (2 * abs(mp.cos(mp.pi * alpha / 2))))
                ours = SCHEMES["FD"].weights(np.array([float(m)]), Setting(alpha=float(alpha)))[0]
                # The near branch cancels down to m^-3 of its terms; round-off 1e-16 of these.
                assert ours == pytest.approx(exact, rel=1e-15 * 200.0**3 if m < 200 else 1e-12)


# --- fast and naive sums --------------------------------------------------------------------------


def test_naive_and_fft_agree(combination):
    u = np.random.default_rng(6).standard_normal(121)
    fast, naive = (
        SCHEMES[combination[0]].operator(setting(combination, n=60, summation=how)).apply(u)
        for how in ("fft", "naive")
    )
    assert np.abs(fast - naive).max() <= 1e-12 * np.abs(naive).max()


def test_combine_is_apply_and_two_multiples(combination):
    operator = SCHEMES[combination[0]].operator(setting(combination))
    u, v = np.random.default_rng(7).standard_normal((2, 2 * N + 1))
    expected = 0.3 * operator.apply(u) - 2.0 * u + 0.7 * v
    operator.combine(u, v, 0.3, -2.0, 0.7)
    assert v == pytest.approx(expected, rel=1e-13, abs=1e-13 * np.abs(expected).max())


# --- symbols --------------------------------------------------------------------------------------

FAR = 200_000
THETA = np.array([0.4, 1.0, 2.2, np.pi])


def fourier_sum(weights: np.ndarray, theta: np.ndarray, parity: int = 1) -> np.ndarray:
    """sum_m w_m e^{-i m theta} (without -i if odd) over |m| <= FAR, by Clenshaw-free direct summation."""
    m = np.arange(1, weights.size)
    wave = np.cos if parity > 0 else np.sin
    sums = np.array([2.0 * (weights[1:] * wave(m * t)).sum() for t in theta])
    return sums + (weights[0] if parity > 0 else 0.0)


def left_out(weights: np.ndarray, theta: np.ndarray) -> np.ndarray:
    """Bound of the terms beyond FAR: they fall monotonically, |sum| <= 2 w_FAR / sin(theta / 2) (Abel)."""
    return 2.0 * np.abs(weights[-1]) / np.sin(theta / 2.0) + 1e-13 * np.abs(weights).sum()


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize("name", ["DD", "KPSE", "GPSE", "FD", "RIESZ"])
def test_the_symbol_is_the_fourier_sum_of_the_weights(name, alpha):
    module = SCHEMES[name]
    m = np.arange(FAR + 1.0)
    for order in module.orders:
        given_ = Setting(alpha=alpha, order=order, overlap=S)
        weights = module.weights(m, given_)
        direct = fourier_sum(weights, THETA)
        symbol = module.symbol(THETA, given_)
        if name not in ("DD", "FD"):  # an exchange: less the sum of the weights, which cancels here
            direct, symbol = direct - direct[0], symbol - symbol[0]
        room = left_out(weights, THETA) + left_out(weights, THETA[:1])
        assert (np.abs(direct - symbol) <= room).all(), order


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize("order", [2, 4])
def test_the_symbol_of_fpse_is_the_product_of_two_sums(alpha, order):
    m = np.arange(FAR + 1.0)
    given_ = Setting(alpha=alpha, order=order, overlap=S)
    flux = fpse.flux_weights(m, given_)
    divergence = fpse.divergence_weights(m[:60], given_)
    # (-i)(-i) = -1 for two odd sums
    direct = -fourier_sum(flux, THETA, -1) * fourier_sum(divergence, THETA, -1)
    room = left_out(flux, THETA) * np.abs(divergence).sum() * 2.0
    assert (np.abs(direct - SCHEMES["FPSE"].symbol(THETA, given_)) <= room).all()


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
@pytest.mark.parametrize("order", [2, 4])
def test_the_symbol_of_dpse_is_the_product_of_two_sums(alpha, order):
    m = np.arange(FAR + 2.0)
    given_ = Setting(alpha=alpha, order=order, overlap=S)
    potential = dpse.potential_weights(m, given_)
    # The potential's sum hardly converges, that of its second differences does: they multiply it by 2 - 2 cos.
    curved = np.empty(FAR + 1)
    curved[0] = 2.0 * (potential[0] - potential[1])
    curved[1:] = 2.0 * potential[1:-1] - potential[:-2] - potential[2:]
    laplacian = dpse.laplacian_weights(m[:60], given_)
    change = fourier_sum(laplacian, THETA) - fourier_sum(laplacian, np.zeros(1))
    factor = change / (2.0 - 2.0 * np.cos(THETA))
    room = (left_out(curved, THETA) + 1e-11 * np.abs(potential[:1])) * np.abs(factor)
    direct = fourier_sum(curved, THETA) * factor
    assert (np.abs(direct - SCHEMES["DPSE"].symbol(THETA, given_)) <= room).all()


@pytest.mark.parametrize("beta", [0.1, 0.5, 0.9])
def test_long_waves_decay_as_they_should(combination, beta):
    """symbol -> -|theta|^alpha; the error is (s theta / 2)^2 for order II and its square for order IV."""
    name, order, _ = combination
    alpha, theta = 1.0 + beta, 1e-3
    given_ = Setting(alpha=alpha, order=order, overlap=S)
    symbol = SCHEMES[name].symbol(np.array([theta]), given_)[0]
    first_order = theta / (2.0 * np.tan(0.5 * np.pi * beta))
    slack = {"FD": first_order, "RIESZ": (S * theta) ** (2.0 - alpha)}.get(name, (S * theta) ** 1.0)
    if name == "GPSE":
        slack = (S * theta) ** alpha
    # The aliases of K and E at theta = 0 and overlap 2, exp(-(2 pi)^2), leave a relative 1e-13 of theta^-2.
    assert symbol == pytest.approx(-(theta**alpha), rel=2.0 * slack + 1e-6)


# --- what they conserve ---------------------------------------------------------------------------

STRENGTHS = arrays(float, 2 * N + 1, elements=st.floats(-1e6, 1e6))


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("name", [n for n, s in SCHEMES.items() if s.conservative])
@given(u=STRENGTHS)
def test_conservative_schemes_keep_the_total_strength(name, order, u):
    if order not in SCHEMES[name].orders:
        return
    operator = _operator(name, order)
    change = operator.apply(u)
    # Rounding of N terms of size |A| |u|, and underflow.
    assert abs(change.sum()) <= 1e-13 * _norm(name, order) * np.abs(u).sum() + 1e-300


_CACHE: dict = {}


def _operator(name, order):
    if (name, order) not in _CACHE:
        operator = SCHEMES[name].operator(setting((name, order, "truncated")))
        _CACHE[name, order] = operator, np.abs(dense_matrix(operator)).sum(axis=0).max()
    return _CACHE[name, order][0]


def _norm(name, order):
    return _CACHE[name, order][1]


@pytest.mark.parametrize("name", ["DD", "FD"])
def test_the_others_do_not(name):
    columns = matrix((name, 2, "truncated")).sum(axis=0)
    assert np.abs(columns).max() > 1e-3 * np.abs(matrix((name, 2, "truncated"))).max()


@pytest.mark.parametrize("alpha", [1.1, 1.9])
def test_which_matrices_are_symmetric(combination, alpha):
    name, _, exterior = combination
    a = matrix(combination, alpha=alpha)
    asymmetry = np.abs(a - a.T).max() / np.abs(a).max()
    if name in ("FPSE", "DPSE") or exterior == "open":
        assert asymmetry > 1e-4
    else:
        assert asymmetry <= 1e-13


def test_mirror_symmetry(combination):
    a = matrix(combination)
    assert np.abs(a - a[::-1, ::-1]).max() <= 1e-13 * np.abs(a).max()


def test_translation_inside_the_lattice():
    for name in ("DD", "FD"):
        a = matrix((name, 2, "truncated"))
        assert np.abs(a[1:, 1:] - a[:-1, :-1]).max() <= 1e-13 * np.abs(a).max()


def test_scaling_with_spacing_and_diffusivity(combination):
    unit = matrix(combination, spacing=1.0, diffusivity=1.0)
    ours = matrix(combination)
    assert np.abs(ours - unit * DIFFUSIVITY / H**1.5).max() <= 1e-13 * np.abs(ours).max()


@pytest.mark.parametrize("name", ["KPSE", "GPSE", "RIESZ"])
def test_positive_weights_keep_the_solution_positive(name):
    """u + dt A u has no negative entry as long as dt times the greatest diagonal element is below one."""
    a = matrix((name, 2, "truncated"))
    off = a - np.diag(np.diag(a))
    assert off.min() >= 0.0
    step = np.eye(a.shape[0]) + a / np.abs(np.diag(a)).max()
    assert step.min() >= -1e-15


def test_order_four_gives_positivity_up_at_large_beta():
    m = np.arange(40.0)
    assert (SCHEMES["KPSE"].weights(m, Setting(alpha=1.7, order=4, overlap=S)) > 0.0).all()
    assert (SCHEMES["KPSE"].weights(m, Setting(alpha=1.9, order=4, overlap=S)) < 0.0).any()


def test_a_green_step_is_the_convolution_with_the_fundamental_solution():
    """u + dt A u = V sum_j G(x_i - x_j, D dt) u_j, and what the sum leaves of u_i (41)."""
    alpha = 1.5
    dt = (S * H) ** alpha / DIFFUSIVITY
    u = np.random.default_rng(8).random(2 * N + 1)
    operator = SCHEMES["GPSE"].operator(setting(("GPSE", 2, "truncated"), alpha=alpha))
    x = np.arange(-N, N + 1) * H
    g = H * np.asarray(green(x[:, None] - x[None, :], DIFFUSIVITY * dt, alpha))
    assert u + dt * operator.apply(u) == pytest.approx(g @ u + (1.0 - g.sum(axis=1)) * u, rel=1e-12)


def test_unknown_schemes_are_refused():
    for name in ("kpse", "", None, ["DD"], 3):
        with pytest.raises(InvalidInput, match=r"^scheme (=|is missing)"):
            scheme(name)


def test_every_scheme_describes_itself():
    for name, module in SCHEMES.items():
        assert scheme(name) is module
        assert name == module.name
        assert module.title
        assert module.equation
        high = name in ("DD", "FPSE", "KPSE")
        assert set(module.orders) <= ({2, 4, 6, 8, 10, 12} if high else {2, 4})
        assert (FAMILIES if high else ()) == module.families
        assert bool(module.box_orders) == (2 in module.dims)
        assert set(module.exteriors) <= {"truncated", "open"}


def test_an_operator_says_whether_its_matrix_is_symmetric(combination):
    """Where it says so, the series takes the interval for proved, and the eigenvalues come from Lanczos' method."""
    operator = SCHEMES[combination[0]].operator(setting(combination))
    a = dense_matrix(operator)
    assert operator.symmetric == (np.abs(a - a.T).max() <= 1e-12 * np.abs(a).max())


def test_the_schemes_stand_in_the_order_of_the_paper():
    names = ["DD", "DPSE", "FPSE", "KPSE", "GPSE", "DVM", "FD", "PSE29", "RIESZ"]
    assert list(ALL_SCHEMES) == names
    assert [one.name for one in ALL_SCHEMES.values() if one.rejected] == ["PSE29", "RIESZ"]
    assert [one.name for one in ALL_SCHEMES.values() if one.moving] == ["DVM"]


def test_a_setting_is_in_units_of_the_spacing_and_of_the_diffusivity_unless_it_says_otherwise():
    plain = Setting(alpha=1.5)
    assert plain.rate == 1.0
    assert plain == Setting(alpha=1.5, spacing=1.0, diffusivity=1.0)


def test_a_particle_s_own_weight_costs_dpse_no_digits():
    """c_1 / c_0 = exp(-16) at overlap 1/4: A of three particles by hand, b_m - b_0 times c_1."""
    setting = Setting(n=1, alpha=1.5, overlap=0.25)
    b = dpse.potential_weights(np.arange(3.0), setting)
    c = dpse.laplacian_weights(np.array([1.0]), setting)[0]
    # What particle 1 adds to the row of particle 0; particle 2 adds e^-64.
    corner = c * (b[1] - b[0])
    assert dense_matrix(SCHEMES["DPSE"].operator(setting))[0, 0] == pytest.approx(corner, rel=1e-13)
