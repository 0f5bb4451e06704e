"""The methods of the literature: their weights, their published order, and the reference problem."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import mpmath as mp
import numpy as np
import pytest
from scipy.sparse.linalg import LinearOperator, expm_multiply

from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import kernel
from fracparticles.lattice.exterior import tabulated_far_field
from fracparticles.run.orders import observed_order
from fracparticles.schemes.spectrum import dense_matrix
from fracparticles.special import central_mass, green, mean_radius
from fracparticles.special.tails import tail_constant
from fracparticles.time.propagator import propagator_weights
from fracstudy.peers import (
    PEERS,
    duo_wyk_zhang,
    fractional_centred,
    huang_oberman,
    mapped_fourier,
    peer,
    sinc_lattice,
)
from fracstudy.peers.lattice import _spectral_interval

ALPHAS = [1.1, 1.5, 1.9]
MODULES = (huang_oberman, duo_wyk_zhang, fractional_centred, sinc_lattice)
LATTICE = {module.PEER.name: module for module in MODULES}
OFFSETS = [0, 1, 2, 3, 4, 5, 14, 15, 16, 17, 100, 101, 1000, 100_001]
VARIANTS = [
    pytest.param(name, exterior, propagation, id=f"{name}-{exterior}-{propagation}")
    for name, p in LATTICE.items()
    for exterior in p.PEER.exteriors
    for propagation in p.PEER.propagations
]


def prepared(name: str, alpha: float, half_width: float, count: int, time: float = 1.0, **more):
    """The peer with about `count` points; the periodic box wants an even number."""
    count += name == "exact-symbol"
    return peer(name).prepare(alpha=alpha, half_width=half_width, count=count, time=time, **more)


def reference_error(solver, alpha: float, shift: float = 0.0) -> float:
    """The error (48) of the fundamental solution taken from t = 0.5 to 1.5."""
    u = solver.solve(green(solver.x - shift, 0.5, alpha))
    radius = 5.0 * mean_radius(alpha)
    inside = np.abs(solver.x) <= radius
    deviation = np.abs(u - green(solver.x - shift, 1.5, alpha))
    return float(solver.volumes[inside] @ deviation[inside] / central_mass(radius, 1.5, alpha))


def gaussian_error(name: str, alpha: float, half_width: float, count: int) -> float:
    """The largest error of A eta, which is the kernel G of order II (10), (11)."""
    solver = prepared(name, alpha, half_width, count)
    ours = solver.apply(kernel("eta", solver.x, alpha))
    return float(np.abs(ours - kernel("G", solver.x, alpha)).max())


# --- the registry ---------------------------------------------------------------------------------


def test_the_registry():
    assert set(PEERS) == {
        "huang-oberman",
        "duo-wyk-zhang",
        "fractional-centred",
        "sinc-lattice",
        "mapped-fourier",
        "exact-symbol",
    }
    for name, p in PEERS.items():
        assert peer(name) is p
        assert p.label
        assert p.reference


@pytest.mark.parametrize("name", ["sinc", None, []])
def test_an_unknown_peer(name):
    with pytest.raises(InvalidInput, match="one of huang-oberman"):
        peer(name)


@pytest.mark.parametrize("name", PEERS)
@pytest.mark.parametrize(
    ("field", "changes"),
    [
        ("alpha", {"alpha": 2.0}),
        ("half_width", {"half_width": 0.0}),
        ("time", {"time": -1.0}),
        ("spacing", {"spacing": float("nan"), "count": None}),
        ("spacing and count", {"spacing": 0.1}),
        ("spacing and count", {"count": None}),
        ("count", {"count": 1}),
    ],
)
def test_invalid_input(name, field, changes):
    given = {"alpha": 1.5, "half_width": 5.0, "time": 1.0, "count": 20 + (name != "exact-symbol")}
    peer(name).prepare(**given)
    with pytest.raises(InvalidInput) as caught:
        peer(name).prepare(**{**given, **changes})
    assert caught.value.field == field


def test_what_a_peer_does_not_have():
    given = {"alpha": 1.5, "half_width": 5.0, "time": 1.0}
    with pytest.raises(InvalidInput, match="exterior"):
        sinc_lattice.PEER.prepare(**given, count=21, exterior="periodic")
    with pytest.raises(InvalidInput, match="propagation"):
        sinc_lattice.PEER.prepare(**given, count=21, propagation="dense")
    with pytest.raises(InvalidInput, match="an odd number"):
        sinc_lattice.PEER.prepare(**given, count=20)
    with pytest.raises(InvalidInput, match="an even number"):
        peer("exact-symbol").prepare(**given, count=21)
    with pytest.raises(InvalidInput, match="at most 8001"):
        mapped_fourier.PEER.prepare(**given, count=8003)


@pytest.mark.parametrize("name", PEERS)
def test_spacing_and_count_give_the_same_grid(name):
    by_spacing = peer(name).prepare(alpha=1.5, half_width=8.0, spacing=0.25, time=1.0)
    by_count = peer(name).prepare(alpha=1.5, half_width=8.0, count=by_spacing.x.size, time=1.0)
    assert np.array_equal(by_spacing.x, by_count.x)
    assert (np.diff(by_spacing.x) > 0.0).all()
    assert np.diff(by_spacing.x).min() == pytest.approx(0.25, rel=0.02)
    # The rectangle rule and its image under x = L cot s converge exponentially for a Gaussian.
    assert by_spacing.volumes @ kernel("eta", by_spacing.x, 1.5) == pytest.approx(1.0, rel=1e-12)


# --- weights against the published formulae -------------------------------------------------------


def mp_fractional_centred(alpha, m):
    bottom = mp.gamma(alpha / 2 - m + 1) * mp.gamma(alpha / 2 + m + 1)
    return -((-1) ** m) * mp.gamma(alpha + 1) / bottom


def mp_sinc(alpha, m):
    hyper = mp.hyp1f2((1 + alpha) / 2, mp.mpf(1) / 2, (3 + alpha) / 2, -((mp.pi * m / 2) ** 2))
    return -(mp.pi**alpha) / (1 + alpha) * hyper


def mp_constant(alpha):
    top = alpha * 2 ** (alpha - 1) * mp.gamma((1 + alpha) / 2)
    return top / (mp.sqrt(mp.pi) * mp.gamma(1 - alpha / 2))


def mp_duo_wyk_zhang(alpha, k):
    gamma = 1 + alpha / 2
    nu = gamma - alpha
    factor = mp_constant(alpha) / (2 * nu)
    return factor * (mp.mpf(2) ** nu if k == 1 else ((k + 1) ** nu - (k - 1) ** nu) / k**gamma)


def mp_huang_oberman(alpha, j):
    c = mp_constant(alpha)

    def g(t):
        return c * t ** (2 - alpha) / ((2 - alpha) * (alpha - 1) * alpha)

    def g1(t):
        return c * t ** (1 - alpha) / ((alpha - 1) * alpha)

    if j == 0:
        return -2 * (c / (2 - alpha) + c / alpha)
    if j == 1:
        return c / (2 - alpha) + c / alpha - (g1(3) + 3 * g1(1)) / 2 + g(3) - g(1)
    if j % 2 == 0:
        return 2 * (g1(j + 1) + g1(j - 1) - g(j + 1) + g(j - 1))
    return -(g1(j + 2) + 6 * g1(j) + g1(j - 2)) / 2 + g(j + 2) - g(j - 2)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_constant(alpha):
    assert tail_constant(alpha) == pytest.approx(float(mp_constant(mp.mpf(alpha))), rel=1e-14)


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize(
    ("module", "formula"),
    [
        (fractional_centred, mp_fractional_centred),
        (sinc_lattice, mp_sinc),
        (duo_wyk_zhang, mp_duo_wyk_zhang),
        (huang_oberman, mp_huang_oberman),
    ],
)
def test_weights(module, formula, alpha):
    a = module.weights(alpha, OFFSETS[-1] + 1)
    assert a.size == OFFSETS[-1] + 1
    offsets = OFFSETS[1:] if module is duo_wyk_zhang else OFFSETS
    for m in offsets:
        with mp.workdps(30):
            exact = float(formula(mp.mpf(alpha), m))
        # The recurrence of the centred differences adds up to half an ulp a step; the quadrature of the sinc weights
        # is good to its nodes, 1e-14 of a_0; the differences of G lose digits to its size.
        room = 1e-14 * abs(a[0]) if module is sinc_lattice else 0.0
        if module is huang_oberman and 0 < m < 8:
            room = 1e-15 * tail_constant(alpha) * m ** (2 - alpha) / ((2 - alpha) * (alpha - 1))
        assert a[m] == pytest.approx(exact, rel=1e-13 + 1.1e-16 * m, abs=room)


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("name", LATTICE)
def test_weights_sum_to_nil(name, alpha):
    """Constants have no fractional Laplacian: a_0 + 2 sum'' a_m + 2 C / (alpha M^alpha) = 0, trapezoidal at M."""
    last = 4001
    a = LATTICE[name].weights(alpha, last + 1)
    rest = 2.0 * tail_constant(alpha) / alpha * float(last) ** -alpha
    total = a[0] + 2.0 * a[1:].sum() - a[-1] + rest
    # The end correction, at most |a'(M)|, and a few ulp of a_0 for each term at random.
    assert abs(total) <= 3.0 * abs(a[-1]) / last + 1e-14 * abs(a[0])


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("power", [0, 1, 2])
def test_huang_and_oberman_integrate_quadratics(alpha, power):
    """For a second difference (M - y)^p the rule is exact on (1, M), and has f(1) y^2 on (0, 1)."""
    last, c = 41, tail_constant(alpha)
    a = huang_oberman.weights(alpha, last)
    f = (last - np.arange(last + 1.0)) ** power
    # The panel that ends at M gives M the weight G'' - (G'(M-2) + 3 G'(M)) / 2 + G(M) - G(M-2): a_1 mirrored.
    t = np.array([last - 2.0, last])
    g = c * t ** (2.0 - alpha) / ((2.0 - alpha) * (alpha - 1.0) * alpha)
    g1 = c * t ** (1.0 - alpha) / ((alpha - 1.0) * alpha)
    end = -c / alpha * last**-alpha - 0.5 * (g1[0] + 3.0 * g1[1]) + g[1] - g[0]
    outer = mp.quad(lambda y: (last - y) ** power * y ** (-1 - alpha), [1, 3, 10, last])
    exact = c * (f[1] / (2.0 - alpha) + float(outer))
    assert a[1:] @ f[1:-1] + end * f[-1] == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("alpha", [1.01, *ALPHAS, 1.99])
@pytest.mark.parametrize("module", [huang_oberman, duo_wyk_zhang, fractional_centred])
def test_positive_weights(module, alpha):
    a = module.weights(alpha, 5000)
    assert a[0] < 0.0
    assert (a[1:] > 0.0).all()


# --- the published order --------------------------------------------------------------------------


@pytest.mark.parametrize("alpha", [1.3, 1.5, 1.7, 1.9])
@pytest.mark.parametrize(
    ("name", "order"),
    [
        ("huang-oberman", lambda alpha: 4.0 - alpha),  # published: 3 - alpha, see the module
        ("duo-wyk-zhang", lambda alpha: 2.0),
        ("fractional-centred", lambda alpha: 2.0),
    ],
)
def test_order_of_the_operator(name, order, alpha):
    counts = np.array([401, 801, 1601])
    errors = [gaussian_error(name, alpha, 8.0, count) for count in counts]
    observed = observed_order(16.0 / (counts - 1), np.array(errors))
    # The next term of the weighted trapezoidal rule is of order 4 - alpha, only 2 - alpha higher: it approaches slowly.
    assert observed[-1] == pytest.approx(order(alpha), abs=0.1)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_sinc_scheme_is_spectral(alpha):
    """A eta: the lattice leaves out exp(-(pi / h)^2 / 4), times k^alpha."""
    for count in (51, 71, 101):
        wave = np.pi * (count - 1) / 16.0
        lost = 4.0 * wave**alpha * np.exp(-0.25 * wave**2)
        round_off = 1e-14 * wave**alpha
        assert gaussian_error("sinc-lattice", alpha, 8.0, count) <= lost + round_off


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_mapped_method_is_spectral(alpha):
    errors = [gaussian_error("mapped-fourier", alpha, 3.0, count) for count in (41, 81, 161)]
    assert errors[1] < 1e-3 * errors[0]
    # N^alpha ulp of the operator's norm, with |eta| < 1.
    assert errors[2] < 161.0**alpha * 4e-16 * 10.0


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_symbol_is_exact_on_the_box(alpha):
    solver = prepared("exact-symbol", alpha, 3.0, 63, time=0.7)
    k = np.pi * 5.0 / 3.0
    wave = np.cos(k * solver.x + 0.3)
    assert solver.apply(wave) == pytest.approx(-(k**alpha) * wave, rel=0, abs=1e-12 * 33**alpha)
    assert solver.solve(wave) == pytest.approx(np.exp(-0.7 * k**alpha) * wave, rel=0, abs=1e-15)


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("scale", [1.0, 1.7])
def test_the_mapped_operator_on_rational_functions(alpha, scale):
    """1 / (1 - i x) has the transform 2 pi exp(-k), k > 0: it becomes -Gamma(1+alpha) (1 - i x)^(-1-alpha)."""
    solver = prepared("mapped-fourier", alpha, scale, 161)
    function = 1.0 / (1.0 - 1j * solver.x)
    exact = -float(mp.gamma(1.0 + alpha)) * (1.0 - 1j * solver.x) ** (-1.0 - alpha)
    # The coefficients are geometric, ((L - 1) / (L + 1))^k.
    for ours, wanted in (
        (solver.apply(function.real), exact.real),
        (solver.apply(function.imag), exact.imag),
    ):
        assert ours == pytest.approx(wanted, rel=0, abs=161.0**alpha * 4e-15)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_galerkin_matrix(alpha):
    ours = mapped_fourier.galerkin_matrix(alpha, 12)
    for j, k in ((1, 1), (1, 2), (3, 7), (12, 12), (5, 12)):

        def integrand(t, j=j, k=k):
            return (
                t ** (1 + alpha) * mp.exp(-t) * mp.laguerre(j - 1, 1, t) * mp.laguerre(k - 1, 1, t)
            )

        with mp.workdps(25):
            exact = mp.quad(integrand, [0, 1, 5, 15, 40, 80, 150]) / mp.sqrt(j * k)
        assert ours[j - 1, k - 1] == pytest.approx(
            float(exact), rel=1e-12, abs=1e-13 * ours[-1, -1]
        )
    assert ours == pytest.approx(ours.T, rel=1e-13, abs=1e-15)
    assert (np.linalg.eigvalsh(mapped_fourier.galerkin_matrix(alpha, 60)) > 0.0).all()


# --- the exterior ---------------------------------------------------------------------------------


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("name", LATTICE)
def test_exterior_sums(name, alpha):
    n = 40
    last, long = 4 * n + 1, 400_000
    a = LATTICE[name].weights(alpha, long)
    far = tabulated_far_field(a[: last + 1], n, alpha, [tail_constant(alpha)])
    for i in (-n, -7, 0, 23, n - 1, n):
        k = np.arange(n + 1, long + i - 1)
        exact = (a[k - i] * (n / k) ** (1.0 + alpha))[::-1].sum()
        # What the end of the sum at M leaves is at most the slope of the summand there.
        end = np.abs(a[last - 1 : last + 1]).max() * (n / (last + i)) ** (1.0 + alpha)
        room = (2.0 + 2.0 * alpha) / (last - n) * end
        assert far.right[0, i + n] == pytest.approx(exact, abs=room + 1e-14)
    assert np.array_equal(far.left, far.right[:, ::-1])


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_open_operator_on_an_algebraic_function(alpha):
    """(-Laplacian)^(alpha/2) (1+x^2)^-b = 2^alpha Gamma(b+alpha/2) Gamma((1+alpha)/2) / (Gamma(b) Gamma(1/2)) 2F1."""
    b = 0.5 * (1.0 + alpha)
    factor = 2**alpha * mp.gamma(b + alpha / 2) * mp.gamma(0.5 + alpha / 2)
    factor /= mp.gamma(b) * mp.gamma(0.5)
    errors = {}
    for exterior in ("truncated", "open"):
        solver = prepared("sinc-lattice", alpha, 20.0, 401, exterior=exterior)
        ours = solver.apply((1.0 + solver.x**2) ** -b)
        places = [200, 205, 213, 180]
        exact = [
            -float(factor * mp.hyp2f1(0.5 + alpha / 2, b + alpha / 2, 0.5, -(solver.x[i] ** 2)))
            for i in places
        ]
        errors[exterior] = np.abs(ours[places] - exact).max()
    # Truncation leaves out 2 C int_D^inf y^(-2-2 alpha) dy; the closure is good to b / D^2 of it.
    left_out = 2.0 * tail_constant(alpha) / (1.0 + 2.0 * alpha) * 20.0 ** (-1.0 - 2.0 * alpha)
    assert errors["truncated"] > 0.5 * left_out
    assert errors["open"] < 2.0 * b / 400.0 * left_out + 1e-12


# --- in time --------------------------------------------------------------------------------------


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("exterior", ["truncated", "open"])
@pytest.mark.parametrize("name", LATTICE)
def test_the_spectral_interval(name, exterior, alpha):
    solver = prepared(name, alpha, 30.0, 61, exterior=exterior)
    low, high = _spectral_interval(LATTICE[name].weights(alpha, 61))
    eigenvalues = np.linalg.eigvals(dense_matrix(solver.operator))
    assert np.abs(eigenvalues.imag).max() < 1e-12 * -low
    assert eigenvalues.real.min() > low
    assert eigenvalues.real.max() < high
    # The interval is not wasteful: the number of sums grows with the root of its length.
    assert low > 1.05 * eigenvalues.real.min()
    assert high == 0.0


@pytest.mark.parametrize("exterior", ["truncated", "open"])
@pytest.mark.parametrize("name", LATTICE)
def test_the_series_is_the_exponential(name, exterior):
    solver = prepared(name, 1.5, 10.0, 101, exterior=exterior)
    matrix = dense_matrix(solver.operator)
    linear = LinearOperator(
        matrix.shape,
        matvec=lambda v: matrix @ v.ravel(),
        rmatvec=lambda v: matrix.T @ v.ravel(),
        dtype=float,
    )
    u0 = green(solver.x - 0.3, 0.5, 1.5)
    expected = expm_multiply(linear, u0, traceA=float(np.trace(matrix)))
    # |A t| = (pi / h)^1.5 = 62: so many ulp in either.
    assert solver.solve(u0) == pytest.approx(expected, rel=0, abs=1e-13)
    assert solver.applications == solver.series.operator_applications


@pytest.mark.parametrize("count", [9, 11, 17, 27, 41, 63, 101, 155])
@pytest.mark.parametrize("name", LATTICE)
def test_the_interval_holds_for_any_number_of_points(name, count):
    """Whatever length the transform of the row has: the waves of two spacings are among those that are looked at."""
    for alpha in (1.001, 1.5, 1.999):
        for exterior in ("truncated", "open"):
            solver = prepared(name, alpha, 1.0, count, exterior=exterior)
            eigenvalues = np.linalg.eigvals(dense_matrix(solver.operator))
            low, high = solver.interval
            assert low < eigenvalues.real.min()
            assert eigenvalues.real.max() < high == 0.0


@pytest.mark.parametrize("lives", [0.01, 1.0, 15.0])
@pytest.mark.parametrize("name", LATTICE)
def test_a_stiff_series_is_right(name, lives):
    """T |lambda| up to 5e6 for the fastest mode, by the eigenvectors; the slowest decays by exp(-lives)."""
    matrix = dense_matrix(prepared(name, 1.9, 1.0, 601).operator)
    eigenvalues, modes = np.linalg.eigh(0.5 * (matrix + matrix.T))
    time = lives / -eigenvalues.max()
    solver = prepared(name, 1.9, 1.0, 601, time=time)
    u0 = np.exp(-np.square(4.0 * solver.x))
    expected = modes @ (np.exp(eigenvalues * time) * (modes.T @ u0))
    # At the end of the interval T_k turns an ulp of its argument into k^2 of them.
    room = 4.0 * np.finfo(float).eps * (1e3 + solver.applications**2)
    assert solver.solve(u0) == pytest.approx(expected, rel=0, abs=room * expected.max())


@pytest.mark.parametrize("exterior", ["truncated", "open"])
@pytest.mark.parametrize("name", LATTICE)
def test_a_stiff_run_is_the_same_in_ten_pieces(name, exterior):
    """h = 0.005, T |lambda| = 3e5 to 6e5."""
    u0 = np.exp(-np.square(np.linspace(-1.0, 1.0, 401)))
    whole = prepared(name, 1.9, 1.0, 401, time=10.0, exterior=exterior).solve(u0)
    piece, u = prepared(name, 1.9, 1.0, 401, time=1.0, exterior=exterior), u0
    for _ in range(10):
        u = piece.solve(u)
    # Each of some ten pieces, on either side, is good to 1e-10 of its size by its own account.
    assert whole == pytest.approx(u, rel=0, abs=1e-8 * np.abs(u).max())


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize("name", ["fractional-centred", "sinc-lattice"])
def test_the_convolution_is_the_exponential_on_a_wide_lattice(name, alpha):
    h, n, wide = 0.25, 40, 2000
    short = prepared(name, alpha, n * h, 2 * n + 1, propagation="convolution")
    long = prepared(name, alpha, wide * h, 2 * wide + 1)
    u0 = np.zeros(2 * wide + 1)
    u0[wide - n : wide + n + 1] = kernel("eta", short.x - 0.5, alpha)
    expected = long.solve(u0)[wide - n : wide + n + 1]
    # What leaves the wide lattice and comes back: 2 int_D^inf (t^2 / 2) (C y^(-1-alpha))^2 dy.
    back = tail_constant(alpha) ** 2 / (1.0 + 2.0 * alpha) * (wide * h) ** (-1.0 - 2.0 * alpha)
    ours = short.solve(u0[wide - n : wide + n + 1])
    assert ours == pytest.approx(expected, rel=0, abs=1.1 * back + 1e-13)
    assert short.applications == 1


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_propagator_of_the_sinc_scheme_is_the_fundamental_solution(alpha):
    """e_m = h G(m h, t), but for the waves beyond pi / h: one step of GPSE over the whole time."""
    h = 0.1  # exp(-(pi / h)^1.1) = 5e-20
    e = propagator_weights(lambda theta: np.exp(-((theta / h) ** alpha)), alpha, h**-alpha, 400)
    exact = h * green(np.arange(400) * h, 1.0, alpha)
    # The images are taken off up to the fourth term, of order (4096 h)^(-1-4 alpha); the rest is round-off of e_0.
    assert e == pytest.approx(exact, rel=0, abs=1e-14)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_two_mapped_solves_make_one(alpha):
    half, whole = (prepared("mapped-fourier", alpha, 8.0, 101, time=t) for t in (0.5, 1.0))
    u0 = green(half.x - 0.4, 0.5, alpha)
    assert half.solve(half.solve(u0)) == pytest.approx(whole.solve(u0), rel=0, abs=1e-13)


# --- the reference problem ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "order"),
    [("huang-oberman", 2.5), ("duo-wyk-zhang", 2.0), ("fractional-centred", 2.0)],
)
@pytest.mark.parametrize("exterior", ["truncated", "open"])
def test_the_reference_problem_converges_with_the_order(name, exterior, order):
    counts = np.array([401, 801, 1601])
    errors = [
        reference_error(prepared(name, 1.5, 40.0, count, exterior=exterior), 1.5)
        for count in counts
    ]
    observed = observed_order(80.0 / (counts - 1), np.array(errors))
    assert observed[-1] == pytest.approx(order, abs=0.15)
    assert errors[-1] < 1e-4


@pytest.mark.parametrize("propagation", ["series", "convolution"])
def test_the_sinc_scheme_is_left_with_the_exterior(propagation):
    """Truncation leaves an error of order D^(-1-2 alpha); the closure takes nearly all of it away."""
    errors = {
        (exterior, half_width): reference_error(
            prepared(
                "sinc-lattice",
                1.5,
                half_width,
                int(10 * half_width) + 1,
                exterior=exterior,
                propagation=propagation,
            ),
            1.5,
        )
        for exterior in ("truncated", "open")
        for half_width in (40.0, 80.0)
    }
    ratio = errors["truncated", 40.0] / errors["truncated", 80.0]
    assert np.log2(ratio) == pytest.approx(4.0, abs=0.2)
    assert errors["open", 40.0] < 3e-9
    assert errors["open", 40.0] < 0.01 * errors["truncated", 40.0]


def test_the_mapped_method_converges_like_the_tail_of_the_solution():
    """|s|^(1+alpha) at s = 0: order 1 + alpha = 2.5 in N."""
    counts = np.array([201, 401, 801])
    errors = [reference_error(prepared("mapped-fourier", 1.5, 8.0, c), 1.5) for c in counts]
    assert observed_order(1.0 / counts, np.array(errors))[-1] == pytest.approx(2.5, abs=0.1)
    assert errors[-1] < 2e-9


def test_the_box_is_left_with_its_images():
    """The nearest images add 2 t C (2 D)^(-1-alpha) and more of them sum: order 1 + alpha in 1 / D."""
    widths = np.array([40.0, 80.0, 160.0])
    errors = [
        reference_error(prepared("exact-symbol", 1.5, d, 10 * int(d) - 1), 1.5) for d in widths
    ]
    assert observed_order(1.0 / widths, np.array(errors))[-1] == pytest.approx(2.5, abs=0.1)


@pytest.mark.parametrize(("name", "exterior", "propagation"), VARIANTS)
def test_every_variant_on_shifted_data(name, exterior, propagation):
    """Not symmetric about x = 0: the two ends are not mixed up."""
    solver = prepared(name, 1.5, 40.0, 1601, exterior=exterior, propagation=propagation)
    assert reference_error(solver, 1.5, shift=0.77) < 1e-4


@pytest.mark.parametrize(
    ("name", "half_width", "most"), [("mapped-fourier", 16.0, 1e-8), ("exact-symbol", 160.0, 1e-5)]
)
def test_the_others_on_shifted_data(name, half_width, most):
    solver = prepared(name, 1.5, half_width, 20 * int(half_width) + 1)
    assert reference_error(solver, 1.5, shift=0.77) < most


@pytest.mark.parametrize("name", PEERS)
def test_threads_may_share_a_solver(name):
    solver = prepared(name, 1.5, 10.0, 201)
    data = np.random.default_rng(5).normal(size=(32, solver.x.size))
    expected = [solver.solve(u0) for u0 in data]
    with ThreadPoolExecutor(8) as threads:
        for ours, right in zip(threads.map(solver.solve, data), expected, strict=True):
            assert np.array_equal(ours, right)
