"""Right numbers of the companions where plain formulae lose them, and what is refused or warned of instead.

The values come from mpmath, closed forms and sums written out.
"""

from __future__ import annotations

import threading
from fractions import Fraction
from itertools import pairwise
from math import factorial, pi, sqrt

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fracparticles.errors import AccuracyWarning, InvalidInput, NonFiniteSolution, StabilityWarning
from fracparticles.markers import (
    SHAPES,
    Gaussian,
    MarkerVelocity,
    Ramp,
    Square,
    equal_weight,
    random,
    run,
    uniform,
)
from fracparticles.markers.burgers import PointSource
from fracparticles.markers.kdv import Soliton, kdv
from fracparticles.markers.nonlinear import Lines, NonlinearDiffusion
from fracparticles.markers.plane import TwoBlobs
from fracparticles.markers.source import GaussianSource, advance_weights
from fracparticles.moving.lagrangian import advance, quotient_velocity
from fracparticles.moving.random_walk import stable_variates
from fracparticles.moving.remeshing import eliminate, remesh
from fracparticles.moving.scattered import NonuniformFourierSum, ScatteredKernel
from fracparticles.pse import (
    GAUSSIAN_20,
    TENT_27,
    GaussianKernel,
    SplineKernel,
    StrengthExchange,
    Tent,
    cell_volumes,
    construct,
    construct_laplacian,
    construct_stencil,
    derivative,
    lattice_moment,
    moment,
    reconstruct,
)
from fracparticles.pse.moments import absolute_moment
from fracparticles.sph import ParticleLine, rl_derivative
from fracparticles.sph.closed_forms import FUNCTIONS, Exponential, ShiftedPower
from fracparticles.sph.derivatives import gradient, second_derivative
from fracparticles.sph.integrals import power_integral, power_sum
from sweeps import covering

EPS = float(np.finfo(float).eps)


# --- SPH ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", [int, np.int32, np.uint8, np.float32, complex])
def test_derivatives_do_not_cut_what_they_are_given(kind):
    x = np.linspace(0.0, 1.0, 11)
    volumes, inner = np.full(11, 0.1), slice(3, -3)
    line, parabola = np.arange(11), np.arange(11) ** 2  # 10 x and 100 x^2
    found = gradient(x, x, volumes, line.astype(kind), 0.11)[inner]
    assert found == pytest.approx(np.full(5, 10.0), rel=1e-12)
    # eta^2 / s^2 = 1e-8 (1.1 h)^2 at most is what the regularisation costs.
    found = second_derivative(x, parabola.astype(kind), x, volumes, parabola.astype(kind), 0.11)
    assert found[inner] == pytest.approx(np.full(5, 200.0), rel=1e-8)
    lists = gradient(x.tolist(), x.tolist(), 0.1, line.tolist(), 0.11)[inner]
    assert lists == pytest.approx(np.full(5, 10.0), rel=1e-12)


def test_imaginary_parts_are_kept():
    x = np.linspace(0.0, 1.0, 11)
    f = x + 1j * x**2
    for sums in (
        lambda f: gradient(x, x, 0.1, f, 0.11),
        lambda f: second_derivative(x, f, x, 0.1, f, 0.11),
        lambda f: power_sum(x, x, f, np.zeros(11), 0.1),
        lambda f: reconstruct(x, x, f, 0.1, 0.2, GAUSSIAN_20),
        lambda f: derivative(x, f, x, f, 0.1, 0.2, GAUSSIAN_20, 2),
    ):
        whole = sums(f)
        assert whole == pytest.approx(sums(f.real) + 1j * sums(f.imag), rel=1e-12, abs=1e-12)
        assert np.abs(whole.imag).max() > 0.1
    # Real values at the points and complex ones of the particles, and the contrary.
    mixed = second_derivative(x, f.real, x, 0.1, f, 0.11)
    assert mixed.dtype == complex


@pytest.mark.parametrize("short", [1, 10, 12])
def test_arrays_that_do_not_fit_are_refused(short):
    line, x, v = ParticleLine(0.0, 1.0, 11), np.linspace(0.0, 1.0, 11), np.full(11, 0.1)
    few = np.ones(short)
    for call in (
        lambda: power_integral(line, few, x, np.zeros(11)),
        lambda: power_integral(line, x, x, few),
        lambda: power_sum(x, x, few, 0.5, 0.1),
        lambda: second_derivative(x, few, x, v, x, 0.11),
        lambda: second_derivative(x, x, x, v, few, 0.11),
        lambda: gradient(x, x, few, x, 0.11),
        lambda: remesh(x, few, 0.1, "M4'"),
        lambda: eliminate(x, few, 0.0),
    ):
        with pytest.raises(InvalidInput, match="shape"):
            call()


def test_a_point_without_neighbours_has_no_corrected_gradient():
    x = np.linspace(0.0, 1.0, 11)
    with pytest.raises(InvalidInput, match=r"^z = 5"):
        gradient([0.5, 5.0], x, 0.1, x, 0.11)
    assert gradient([5.0], x, 0.1, x, 0.11, corrected=False).tolist() == [0.0]


def exact_integral(beta, n, x, mu):
    """I^mu (x + beta)^n, term by term with 120 digits."""
    with mp.workdps(120):
        beta, x, mu = mp.mpf(beta), mp.mpf(x), mp.mpf(mu)
        terms = (
            mp.binomial(n, k)
            * beta ** (n - k)
            * mp.gamma(k + 1)
            / mp.gamma(k + 1 + mu)
            * x ** (k + mu)
            for k in range(n + 1)
        )
        return float(sum(terms))


@pytest.mark.parametrize(
    ("place", "n"),
    covering([(-1.0, 1), (-1.0, 0.3), (-0.7, 5.0), (2.0, 3.0), (1e-60, 2.0)], [200, 60, 40, 6, 2]),
)
def test_high_powers_keep_their_digits(place, n):
    beta, x = place
    # An even power has one sign: the error is n ulp of the value, for the powers and for the recurrence.
    power = ShiftedPower(beta, n)
    for mu in (1e-3, 0.5, 0.99):
        expected = exact_integral(beta, n, x, mu)
        assert power.rl([x], -mu)[0] == pytest.approx(expected, rel=4 * n * EPS)
        derivative = n * exact_integral(beta, n - 1, x, 1.0 - mu)
        # f' has both signs on the way: the size of |f'| counts, at most that from the larger end.
        size = n * max(abs(beta), abs(x + beta)) ** (n - 1) * x ** (1.0 - mu) / (1.0 - mu)
        assert power.caputo([x], mu)[0] == pytest.approx(derivative, abs=8 * n * EPS * size)


def test_the_power_of_the_line():
    # 1/sqrt(pi) int_0^1 t^(-1/2) t^60 dt = 1 / (60.5 sqrt(pi)).
    assert ShiftedPower(-1, 60).rl([1], -0.5)[0] == pytest.approx(
        1.0 / (60.5 * sqrt(pi)), rel=1e-14
    )


def test_powers_that_overflow_are_refused():
    with pytest.raises(InvalidInput):
        ShiftedPower(1e10, 60).rl([1.0], -0.5)
    with pytest.raises(InvalidInput):
        Exponential(1.0).value([800.0])


@pytest.mark.parametrize("name", ["sin", "exp", "cubic"])
@pytest.mark.parametrize("order", [0.5, 0.9, 0.999])
@pytest.mark.parametrize("side", ["left", "right"])
def test_a_completed_derivative_converges_at_both_ends(name, order, side):
    """First order at the end where the integral stops, for every order; as printed the error stays for order 1."""
    f, errors = FUNCTIONS[name], []
    for count in (101, 201, 401):
        line = ParticleLine(0.0, 5.0, count)
        values = f.value(line.x_all)
        if side == "right":
            values = f.value(5.0 - line.x_all)
        ours = rl_derivative(line, values, order, side=side, method="completed").real
        ours = ours if side == "left" else ours[::-1]
        exact = f.rl(line.x[-6:], order)
        errors.append(np.abs(ours[-6:] - exact).max())
    assert np.log2(errors[0] / errors[1]) > 0.85
    assert np.log2(errors[1] / errors[2]) > 0.85


@pytest.mark.parametrize("order", [0.95, 0.99, 0.999])
def test_an_end_that_does_not_converge_is_warned_of(order):
    line = ParticleLine(0.0, 5.0, 401)
    with pytest.warns(AccuracyWarning, match="completed"):
        rl_derivative(line, np.sin(line.x_all), order)


def test_a_line_finer_than_its_digits_is_refused():
    with pytest.raises(InvalidInput, match="count"):
        ParticleLine(1e10, 1e10 + 1.0, 100)
    line = ParticleLine(np.float32(0.0), Fraction(5), np.int64(401))
    assert line.spacing == 0.0125  # not in single precision


# --- the PSE note ---------------------------------------------------------------------------------


@pytest.mark.parametrize("dim", [1, 2, 3])
def test_a_kernel_of_another_dimension_is_refused(dim):
    x = np.zeros((3, dim)) + np.arange(3.0)[:, None]
    for other in {1, 2, 3} - {dim}:
        with pytest.raises(InvalidInput, match="kernel"):
            StrengthExchange(x, 1.0, 1.0, construct_laplacian(2, other))
    line = np.arange(3.0)
    if dim > 1:
        kernel = construct_laplacian(2, dim)
        for call in (
            lambda: derivative(line, line, line, line, 1.0, 1.0, kernel, 2),
            lambda: reconstruct(line, line, line, 1.0, 1.0, kernel),
            lambda: moment(kernel, 2),
            lambda: lattice_moment(kernel, 2),
        ):
            with pytest.raises(InvalidInput, match="kernel"):
                call()


@pytest.mark.parametrize("dim", [1, 2])
def test_the_exchange_diffuses_at_the_right_rate(dim):
    """d/dt sum |x|^2 Q = 2 d D sum Q, from a unit strength in the middle of a lattice."""
    h, n = 0.5, 15
    axis = h * np.arange(-n, n + 1)
    x = np.stack(np.meshgrid(*[axis] * dim, indexing="ij"), axis=-1).reshape(-1, dim)
    exchange = StrengthExchange(x, h**dim, 1.0, construct_laplacian(2, dim))
    q = (np.abs(x).max(axis=1) == 0.0).astype(float)
    # The lattice has eps / h = 2: aliases of exp(-(2 pi)^2) and less.
    assert (x**2).sum(axis=1) @ exchange.apply(q) == pytest.approx(2.0 * dim, rel=1e-12)


@pytest.mark.parametrize("overlap", [0.01, 0.05, 0.1, 0.24])
def test_a_kernel_that_is_nothing_between_its_particles_is_refused(overlap):
    with pytest.raises(InvalidInput, match="overlap"):
        construct(2, 2, overlap)


@given(st.integers(0, 4), st.sampled_from([2, 4, 6]), st.floats(0.25, 4.0))
def test_kernels_of_a_lattice_are_no_larger_than_they_must_be(derivative, accuracy, overlap):
    try:
        kernel = construct(derivative, accuracy, overlap)
    except InvalidInput:
        return
    found = lattice_moment(kernel, derivative, overlap)
    z = np.linspace(-kernel.reach, kernel.reach, 2001)
    lattice = np.arange(-40, 41) / overlap
    # exp(1/s^2) <= 9e6 between neighbours, once more by the polynomial.
    assert np.abs(kernel(z)).max() < 1e9 * np.abs(kernel(lattice)).max()
    assert found == pytest.approx((-1) ** derivative * factorial(derivative), rel=1e-5)


@pytest.mark.parametrize("offset", [0.0, 0.3, 0.5, 0.9])
@pytest.mark.parametrize("whole", [1, 100, -7, 10**6])
def test_a_lattice_looks_the_same_from_all_its_points(offset, whole):
    # z is rounded to an ulp of the offset.
    for k in (0, 1, 2):
        here, there = (lattice_moment(GAUSSIAN_20, k, 1.0, o) for o in (offset, offset + whole))
        assert there == pytest.approx(float(here), abs=100 * EPS * max(abs(whole), 1))
    assert lattice_moment(GAUSSIAN_20, 0, 1.0, 100.0) == pytest.approx(4.0, abs=1e-3)


@pytest.mark.parametrize("k", [0, 1, 2, 3, 5, 9])
def test_absolute_moments(k):
    # int |z|^k 4 exp(-z^2) dz / sqrt(pi) = 4 Gamma((k+1)/2) / sqrt(pi); 4 / sqrt(pi) = 2.25676 for k = 1.
    exact = 4.0 * float(mp.gamma(mp.mpf(k + 1) / 2)) / sqrt(pi)
    assert absolute_moment(GAUSSIAN_20, k) == pytest.approx(exact, rel=1e-13)
    # A kernel that changes its sign where z is sqrt(3/2): 3/2 - z^2.
    with mp.workdps(25):
        integral = 2 * mp.quad(
            lambda z: z**k * abs(mp.mpf(3) / 2 - z * z) * mp.exp(-z * z), [0, mp.sqrt(1.5), 4, 12]
        )
    exact = float(integral / mp.sqrt(mp.pi))
    assert absolute_moment(construct(0, 4), k) == pytest.approx(exact, rel=1e-12)
    assert absolute_moment(TENT_27, k) == pytest.approx(
        2.0 ** (k + 3) / ((k + 1) * (k + 2)), rel=1e-13
    )


@pytest.mark.parametrize("k", [30, 60])
def test_high_moments(k):
    exact = 4.0 * float(mp.gamma(mp.mpf(k + 1) / 2)) / sqrt(pi)
    assert moment(GAUSSIAN_20, k) == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("degree", [12, 13, 30, 100, 200])
def test_splines_of_a_high_degree(degree):
    kernel = SplineKernel(degree)
    # Positive terms in q steps: q ulp.
    assert moment(kernel, 2) == pytest.approx(2.0, rel=4 * degree * EPS)
    assert moment(kernel, 0) == pytest.approx(24.0 / (degree + 1), rel=4 * degree * EPS)
    z = np.array([0.0, 0.25 * kernel.reach])
    with mp.workdps(degree + 60):
        exact = [
            sum(
                (-1) ** k
                * mp.binomial(degree + 1, k)
                * max(mp.mpf(kernel.reach) - mp.mpf(v) - k, 0) ** degree
                for k in range(degree + 1)
            )
            * 24
            / mp.factorial(degree)
            / (degree + 1)
            for v in z
        ]
    assert kernel(z) == pytest.approx(np.array(exact, dtype=float), rel=4 * degree * EPS)
    assert not kernel(np.array([kernel.reach + 1.0, np.inf])).any()


def test_a_stencil_has_no_values_between_its_points():
    stencil = construct_stencil(2, 2)
    assert stencil([-1.0, 1.0 + 1e-9, 2.5, np.inf]).tolist() == [1.0, 1.0, 0.0, 0.0]
    for call in (
        lambda: stencil(0.5),
        lambda: moment(stencil, 2),
        lambda: lattice_moment(stencil, 2, 1.5),
        lambda: StrengthExchange([0.0, 0.9], 1.0, 1.0, stencil),
    ):
        with pytest.raises(InvalidInput, match=r"^z = "):
            call()


def test_kernels_take_no_argument_that_they_ignore():
    with pytest.raises(TypeError):
        Tent(3.0)
    with pytest.raises(TypeError):
        Square(5.0)
    for coefficients in ((), (0.0, 0.0), (np.nan,)):
        with pytest.raises(InvalidInput):
            GaussianKernel(coefficients)
    assert construct(np.int64(2), np.uint8(2)).coefficients == (4,)


def test_kernels_are_zero_at_any_distance():
    for kernel in (GAUSSIAN_20, TENT_27, construct(3, 4)):
        assert not kernel(np.array([1e10, -1e200, np.inf])).any()


@pytest.mark.parametrize("x", [[], [1.0], [0.0, 0.0], [1.0, 0.0], [0.0, np.nan]])
def test_cells_need_two_particles_in_order(x):
    with pytest.raises(InvalidInput, match="x"):
        cell_volumes(x)


# --- markers --------------------------------------------------------------------------------------


def phi(z, reynolds):
    return (mp.erfc(z) + mp.exp(-reynolds) * mp.erfc(-z)) / 2


@pytest.mark.parametrize("mu", [0.1, 2e-3, 1.6e-3, 1e-4, 1e-6])
def test_a_shock_of_any_reynolds_number(mu):
    """f, its integral and its inverse against mpmath; the shock is at sqrt(2)."""
    source = PointSource(mu, 1.0)
    x = np.array([-0.1, 0.0, 0.3, 0.7, 1.2, 1.4, 1.4142, 1.42, 1.45, 3.0])
    reynolds_ulp = 8.0 * EPS * max(source.reynolds, 10.0)
    with mp.workdps(80):
        m, big = mp.mpf(mu), 1 / (2 * mp.mpf(mu))
        s = 2 * mp.sqrt(m)
        z = [mp.mpf(v) / s for v in x]
        slope = [(1 - mp.exp(-big)) * mp.exp(-v * v) / (s * mp.sqrt(mp.pi)) for v in z]
        f = np.array([2 * m * a / phi(v, big) for a, v in zip(slope, z, strict=True)], dtype=float)
        g = np.array([-2 * m * mp.log(phi(v, big)) for v in z], dtype=float)
    assert source.value(x, 1.0) == pytest.approx(f, rel=reynolds_ulp, abs=1e-300)
    assert source.cumulative(x, 1.0) == pytest.approx(g, abs=8.0 * EPS)
    parts = np.array([1e-300, 1e-12, 0.1, 0.5, 0.9, 1.0 - 1e-9, 1.0 - 1e-15])
    found = source.quantile(parts, 1.0)
    assert np.isfinite(found).all()
    assert (np.diff(found) > 0.0).all()
    inner = slice(1, 5)
    assert source.cumulative(found, 1.0)[inner] == pytest.approx(parts[inner], abs=reynolds_ulp)


def left_of(x, t):
    """int_-inf^x of the square's solution, with digits to spare."""
    s, x = 2 * mp.sqrt(mp.mpf(t)), mp.mpf(float(x))

    def i(u):
        return mp.exp(-u * u) / mp.sqrt(mp.pi) - u * mp.erfc(u)

    return s / 2 * (i(-(x + 1) / s) - i((1 - x) / s))


@pytest.mark.parametrize("t", [1e-6, 0.01, 1.0, 90.0, 101.0, 1e6, 1e40])
def test_quantiles_of_the_square(t):
    g = np.array([1e-300, 1e-30, 1e-12, 9e-11, 1e-3, 0.5, 1.0])
    found = Square().quantile(g, t)
    assert (np.diff(found) > 0.0).all()
    with mp.workdps(400):
        back = np.array([left_of(x, t) for x in found], dtype=float)
    # A relative rounding of x by an ulp moves the tail by 2 (x/s)^2 ulp, at most 1400; and by |x|/s^2 for small s.
    s = 2.0 * sqrt(t)
    allowed = (
        16.0
        * EPS
        * (1.0 + 2.0 * (np.abs(found) / s) ** 2 * np.minimum(1.0, s) + np.abs(found) / s**2)
    )
    inner = allowed < 1e-3
    assert (np.abs(back / g - 1.0) <= np.maximum(allowed, 1e-12))[inner].all()
    mirrored = Square().quantile(2.0 - g[3:], t)
    assert mirrored == pytest.approx(
        -Square().quantile(2.0 - (2.0 - g[3:]), t), rel=1e-12, abs=1e-13 * s + 4.0 * EPS
    )


@pytest.mark.parametrize(
    ("x", "t"), [(0.0, 1e30), (1e15, 1e30), (-200.0, 150.0), (30.0, 1.0), (12.0, 1.0)]
)
def test_the_square_far_out_and_late(x, t):
    with mp.workdps(60):
        s = 2 * mp.sqrt(mp.mpf(t))
        exact = float((mp.erfc((abs(x) - 1) / s) - mp.erfc((abs(x) + 1) / s)) / 2)
        slope = float(
            (mp.exp(-(((x + 1) / s) ** 2)) - mp.exp(-(((x - 1) / s) ** 2))) / s / mp.sqrt(mp.pi)
        )
    # exp(-z^2) magnifies the rounding of z by 2 z^2.
    allowed = 8.0 * EPS * (1.0 + 2.0 * (x * x / (4.0 * t)))
    assert Square().value(x, t) == pytest.approx(exact, rel=allowed)
    assert Square().slope(x, t) == pytest.approx(
        slope, rel=2 * allowed, abs=0.0 if x else 1e-13 / (4.0 * t)
    )
    assert Square().cumulative(1e30, t if t < 10 else 1.0) == pytest.approx(2.0, rel=1e-13)


@pytest.mark.parametrize("s", [0.01, 1.0, 19.9, 20.1])
@pytest.mark.parametrize("y", [0.1, 1.0, 2.5, 4.9, 5.1, 12.0])
def test_flanks_keep_their_digits(s, y):
    """A distance of y widths beyond the square, or the middle of the bell: f and what lies beyond, to round-off."""
    x, t = -1.0 - y * s, (0.5 * s) ** 2
    with mp.workdps(200):
        width = 2 * mp.sqrt(mp.mpf(t))
        f = float((mp.erfc(-(x + 1) / width) - mp.erfc((1 - x) / width)) / 2)
        left = float(left_of(x, t))
        beyond = float(mp.erfc(y)) * 0.5 * sqrt(pi)
    # y = -(x + 1) / s is off by an ulp of x over s, and exp(-y^2) by 2 y times that.
    allowed = 64.0 * EPS * (1.0 + y * y + y * abs(x) / s + (s + 1.0 / s))
    assert Square().value(x, t) == pytest.approx(f, rel=allowed)
    assert Square().cumulative(x, t) == pytest.approx(left, rel=allowed)
    assert Square().quantile(left, t) == pytest.approx(x, rel=allowed)
    assert Gaussian().cumulative(-y) == pytest.approx(beyond, rel=allowed)
    assert GaussianSource(2.0).cumulative(-y) == pytest.approx(2.0 * beyond, rel=allowed)


@pytest.mark.parametrize("part", [1e-300, 1e-20, 1e-9, 9e-5, 2e-4, 0.3])
def test_quantiles_of_the_gaussian(part):
    x = float(Gaussian().quantile(part * Gaussian.total, 2.0)) / 3.0
    with mp.workdps(40):
        back = float(mp.erfc(-mp.mpf(x)) / 2)
    # x to 2 x^2 ulp, but erfinv keeps only what is left of 1e-16 at 1e-4.
    allowed = 4.0 * EPS / 1e-4 if part > 1e-4 else 16.0 * EPS * (1.0 + 2.0 * x * x)
    assert back == pytest.approx(part, rel=allowed)


@given(
    st.lists(st.floats(1e-300, 1.0 - 1e-15), min_size=2, max_size=20, unique=True),
    st.floats(0.0, 1e6),
)
def test_quantiles_are_finite_and_rise(parts, t):
    parts = np.sort(parts)
    for profile, times in (
        (Square(), (t,)),
        (Gaussian(), (t,)),
        (Ramp(3.0), ()),
        (PointSource(1e-4, 1.0), (t + 0.1,)),
    ):
        g = parts * profile.total
        g = g[(g > 0.0) & (g < profile.total)]
        x = profile.quantile(g, *times)
        assert np.isfinite(x).all()
        # Round-off may exchange parts that are closer than 1e-12 of themselves.
        apart = np.diff(g) > 1e-9 * np.minimum(g[1:], 1.0)
        assert (np.diff(x)[apart] >= 0.0).all()
    x = TwoBlobs(1.0).quantile(parts)
    assert np.isfinite(x).all()


@pytest.mark.parametrize("xi", [1e-300, 1e-30, 1e-11, 1.0 - 1e-11, 1.0 - 2.0**-50])
def test_quantiles_of_two_blobs(xi):
    x = float(TwoBlobs(1.0).quantile(xi))
    with mp.workdps(40):
        part = (mp.erfc(-mp.mpf(x) + 1) + mp.erfc(-mp.mpf(x) - 1)) / 4
        beyond = (mp.erfc(mp.mpf(x) - 1) + mp.erfc(mp.mpf(x) + 1)) / 4
    if xi < 0.5:
        assert float(part) == pytest.approx(xi, rel=16.0 * EPS * (1.0 + 2.0 * x * x))
    else:
        assert float(beyond) == pytest.approx(1.0 - xi, rel=16.0 * EPS * (1.0 + 2.0 * x * x))


@pytest.mark.parametrize(
    "f", [1e-300, 1e-160, 1e-16, 1e-8, 0.1, 0.49, 0.51, 3.0, 700.0, -0.2, -3.0]
)
def test_the_potential(f):
    with mp.workdps(60 if abs(f) > 1e-20 else 700):
        exact = float(10 * (1 - (1 + mp.mpf(f)) * mp.exp(-mp.mpf(f))))
    assert NonlinearDiffusion().potential(f) == pytest.approx(exact, rel=8.0 * EPS, abs=1e-320)


def test_what_a_source_and_a_steady_state_mean():
    for other in (1, -1, 3, True, 2.0):
        with pytest.raises(InvalidInput, match="derivative"):
            GaussianSource(1.0, other)
    for other in (-1, 3, True, 1.0):
        with pytest.raises(InvalidInput, match="derivative"):
            NonlinearDiffusion().steady([0.0], other)
    # Far out the solution has no source: what is left is the heat that came there, zero at x = 1e8.
    assert GaussianSource(1.0).solution([1e8, -1e8], 1.0).tolist() == [0.0, 0.0]
    assert NonlinearDiffusion().steady([1e90], 2).tolist() == [0.0]


@pytest.mark.parametrize("dt", [1e2, 1e3, 1e4])
@pytest.mark.parametrize("shape", ["S4", "S8"])
def test_markers_that_lose_one_another_are_warned_of(dt, shape):
    x, w = equal_weight(Square(), 50)
    with pytest.warns(StabilityWarning, match="smaller dt"):
        run(x, w, MarkerVelocity(SHAPES[shape], 0.7), dt=dt, steps=2)


@pytest.mark.parametrize("dt", [1e2, 1e3, 1e4])
def test_another_flux_is_warned_of_by_where_it_leads(dt):
    x, w = uniform(Soliton(4.0, 1.0).value, (-3.0, 3.0), 40)
    velocity = MarkerVelocity(SHAPES["S8"], 0.3, lambda x, fields: x * fields[0])
    with pytest.warns(StabilityWarning, match="out of the reach"):
        run(x, w, velocity, dt=dt, steps=1)
    assert kdv(x, np.ones((3, 40))).tolist() == [4.0] * 40


@pytest.mark.parametrize("dt", [0.3, 0.5, 1.0])
@pytest.mark.filterwarnings("ignore::fracparticles.errors.StabilityWarning")
def test_weights_keep_their_sign_or_the_run_stops(dt):
    """A sink that takes a marker's weight in a step: exp(-int Q/F) is positive, 1 - dt Q/F is not."""
    x, w = uniform(Gaussian().value, (-2.0, 2.0), 60)
    with pytest.raises(NonFiniteSolution, match=r"sign|field"):
        advance_weights(
            x, w, MarkerVelocity(SHAPES["S4"], 1.5), GaussianSource(-20.0).rate, dt=dt, steps=4
        )
    small = advance_weights(
        x, w, MarkerVelocity(SHAPES["S4"], 1.5), GaussianSource(-0.5).rate, dt=0.01, steps=4
    )[1]
    assert (small > 0.0).all()


@pytest.mark.parametrize(
    ("f", "times"),
    [
        (1.0, [-1.0, 1.0]), (1.0, [1.0, 0.5]), (1.0, [0.0]), (1.0, []), (1.0, [np.nan]),
        (-1.0, [1.0]), (np.nan, [1.0]), (0.0, [1.0]),
    ],
)  # fmt: skip
def test_lines_take_what_has_a_meaning(f, times):
    lines = Lines(NonlinearDiffusion(), 3.0, 20, 2.0)
    with pytest.raises(InvalidInput):
        lines.solve(np.full(20, f), times)


def test_random_loadings_need_a_generator():
    for other in (1, None, "seed", np.random.RandomState(1)):
        with pytest.raises(InvalidInput, match="generator"):
            random(Square(), 5, other)
        with pytest.raises(InvalidInput, match="generator"):
            stable_variates(1.5, 5, other)


# --- particles ------------------------------------------------------------------------------------


@pytest.mark.parametrize("bad", [np.inf, -np.inf, np.nan])
def test_an_infinite_strength_eliminates_nothing(bad):
    with pytest.raises(InvalidInput, match="strength"):
        eliminate([0.0, 1.0], [1.0, bad], 0.0)
    with pytest.raises(InvalidInput, match="strength"):
        remesh([0.0, 1.0], [1.0, bad], 0.5, "Lambda3")


def counted(x, after):
    """Steps that changed the order, from advance: `after` are the positions after each step."""
    path = iter(v for p in after for v in (None, p))
    here = [np.asarray(x, dtype=float)]

    def velocity(y, strength):
        target = next(path)
        if target is None:
            return np.zeros_like(y)
        v = np.asarray(target, dtype=float) - here[0]
        here[0] = here[0] + v
        return v

    return advance(x, np.ones(len(x)), velocity, dt=1.0, steps=len(after))[2]


@given(st.lists(st.permutations([0, 1, 2, 3]), min_size=2, max_size=9))
def test_overtaking_counts_the_steps_that_changed_the_order(places):
    """Against the ranks before and after each step, whatever the order in which the particles are given."""
    changed = sum(a != b for a, b in pairwise(places))
    history = counted(places[0], places[1:])
    assert history.overtaking_steps == changed
    assert history.largest_spacing == 1.0


def test_an_order_that_lasts_is_counted_once():
    # The second step exchanges two, and all later ones keep them so.
    assert counted([0, 1, 2], [[0, 1, 2], [1, 0, 2], [1, 0, 3], [2, 0, 4]]).overtaking_steps == 1
    # Particles in one place have no order to lose.
    assert counted([0, 1, 1], [[0, 2, 1], [0, 1, 1], [0, 1, 2]]).overtaking_steps == 0
    assert counted([2, 1, 0], [[2.5, 1, 0], [2, 1, 0]]).overtaking_steps == 0


@pytest.mark.parametrize("returned", [1.0, np.ones(2), "text", np.ones(3) * 1j, None])
def test_a_velocity_of_another_shape_is_refused(returned):
    with pytest.raises(InvalidInput, match="velocity"):
        advance([0.0, 1.0, 2.0], np.ones(3), lambda x, u: returned, dt=0.1, steps=1)


def test_a_velocity_that_overflows_says_so_without_a_warning():
    with pytest.raises(NonFiniteSolution, match="infinity"):
        advance([0.0, 1.0], np.ones(2), lambda x, u: np.full(2, 1e308), dt=1e10, steps=1)
    with pytest.raises(NonFiniteSolution, match="not finite"):
        quotient_velocity(np.array([np.inf, 1.0]), np.array([1.0, 1.0]), np.zeros(2))


def test_threads_may_share_a_sum_of_transforms():
    sums = NonuniformFourierSum([ScatteredKernel(lambda r: np.exp(-r * r), 12.0)], 0.1)
    sets = [np.random.default_rng(i).uniform(-1.0 - i, 1.0 + i, 400) for i in range(8)]
    exact = [np.exp(-(((x[:, None] - x) / 0.1) ** 2)).sum(axis=1) / 0.1 for x in sets]
    found: dict[int, np.ndarray] = {}

    def work(i):
        for _ in range(5):
            found[i] = sums(sets[i], np.ones(400))[0]

    threads = [threading.Thread(target=work, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for i, y in enumerate(exact):
        assert found[i] == pytest.approx(y, abs=1e-9 * y.max())
