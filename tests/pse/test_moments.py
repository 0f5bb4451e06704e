"""Moments, kernels made from moment conditions, the sums over particles, and the exchange of strength."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from fractions import Fraction
from math import factorial, sqrt

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from fracparticles.errors import AccuracyWarning, InvalidInput, StabilityWarning
from fracparticles.pse import (
    GAUSSIAN_20,
    TENT_27,
    GaussianKernel,
    SplineKernel,
    Stencil,
    StrengthExchange,
    cell_volumes,
    construct,
    construct_laplacian,
    construct_stencil,
    derivative,
    gaussian_moment,
    lattice,
    lattice_moment,
    moment,
    reconstruct,
    regularised,
    required_moments,
)
from fracparticles.pse.construction import solve_exactly, taylor_constant
from fracparticles.pse.moments import absolute_moment
from fracparticles.time import STEP_POLYNOMIALS, step

EPS = float(np.finfo(float).eps)
DERIVATIVES, ACCURACIES = st.integers(0, 6), st.integers(1, 8)


def exact_moment(kernel, k: int) -> Fraction:
    """M_k of a polynomial times a Gaussian, from its coefficients."""
    return sum(
        (c * gaussian_moment(k + kernel.parity + 2 * j) for j, c in enumerate(kernel.coefficients)),
        Fraction(0),
    )


# --- moments --------------------------------------------------------------------------------------


@pytest.mark.parametrize("dim", [1, 2, 3])
@pytest.mark.parametrize("k", [0, 2, 8])
def test_moments_of_the_gaussian(dim, k):
    # int |z|^k pi^(-d/2) exp(-z^2) dz in polar coordinates.
    sphere = 2 * mpmath.pi ** (mpmath.mpf(dim) / 2) / mpmath.gamma(mpmath.mpf(dim) / 2)
    radial = mpmath.quad(lambda r: r ** (k + dim - 1) * mpmath.exp(-(r**2)), [0, 2, mpmath.inf])
    exact = sphere * radial / mpmath.pi ** (mpmath.mpf(dim) / 2)
    assert float(gaussian_moment(k, dim)) == pytest.approx(float(exact), rel=1e-13)


def test_odd_moments_of_the_gaussian_vanish():
    assert [gaussian_moment(k) for k in (1, 3, 5)] == [0, 0, 0]


@pytest.mark.parametrize("k", range(0, 13))
def test_quadrature_of_a_smooth_kernel_is_exact_to_round_off(k):
    kernel = construct(2, 6)
    # Cancellation in the polynomial: its absolute values add up to about 40 times the kernel.
    assert abs(moment(kernel, k) - float(exact_moment(kernel, k))) < 100 * EPS * absolute_moment(
        kernel, k
    )


def test_moments_of_the_tent():
    # 2 int_0^2 x^k 2 (1 - x/2) dx = 2^(k+3) / ((k + 1) (k + 2)) for even k.
    for k in range(0, 9, 2):
        assert moment(TENT_27, k) == pytest.approx(2.0 ** (k + 3) / ((k + 1) * (k + 2)), rel=1e-14)
    assert float(lattice_moment(TENT_27, 2)) == 2.0
    assert lattice_moment(TENT_27, 2, [1.0, 50.5]) == pytest.approx([2.0, 8.0 / 3.0], abs=1e-3)


@pytest.mark.parametrize("s", [0.5, 0.8, 1.0, 1.5])
def test_discrete_moment_of_the_gaussian_is_its_poisson_sum(s):
    """M^_2 - M_2 = -sum_l eta^''(2 pi l s) with eta^(k) = 4 exp(-k^2 / 4)."""
    k = 2.0 * np.pi * s * np.arange(1, 12)
    aliases = -2.0 * (4.0 * (0.25 * k * k - 0.5) * np.exp(-0.25 * k * k)).sum()
    assert float(lattice_moment(GAUSSIAN_20, 2, s)) - 2.0 == pytest.approx(aliases, abs=1e-14)


def test_lattice_moments_far_from_a_particle():
    # Between the particles the aliases change their sign.
    on = float(lattice_moment(GAUSSIAN_20, 0, 1.0))
    between = float(lattice_moment(GAUSSIAN_20, 0, 1.0, offset=0.5))
    assert on - 4.0 == pytest.approx(4.0 - between, rel=1e-9)


@pytest.mark.parametrize("overlap", [0.0, -1.0, np.nan, np.inf])
def test_a_bad_overlap_is_refused(overlap):
    with pytest.raises(InvalidInput, match="overlap"):
        lattice_moment(GAUSSIAN_20, 2, overlap)


# --- shapes ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("q", [1, 2, 3, 5])
def test_splines_are_those_of_scipy_with_the_second_moment_two(q):
    kernel = SplineKernel(q)
    knots = np.arange(q + 2) - kernel.reach
    z = np.linspace(-kernel.reach, kernel.reach, 101)[1:-1]
    expected = 24.0 / (q + 1) * BSpline.basis_element(knots)(z)
    np.testing.assert_allclose(kernel(z), expected, rtol=1e-12, atol=1e-15)
    assert moment(kernel, 2) == pytest.approx(2.0, rel=1e-14)
    assert not kernel(np.array([kernel.reach, -kernel.reach - 1.0])).any()


@pytest.mark.parametrize("degree", [0, -1, 1.5, True])
def test_a_spline_without_a_second_derivative_of_its_sum_is_refused(degree):
    with pytest.raises(InvalidInput, match="degree"):
        SplineKernel(degree)


@given(DERIVATIVES, ACCURACIES)
def test_kernels_are_below_round_off_beyond_their_reach(beta, r):
    kernel = construct(beta, r)
    z = np.linspace(-kernel.reach, kernel.reach, 401)
    beyond = np.linspace(kernel.reach, kernel.reach + 3.0, 50)
    assert np.abs(kernel(beyond)).max() < EPS * np.abs(kernel(z)).max()


# --- construction ---------------------------------------------------------------------------------


def test_conditions_of_the_second_derivative():
    assert required_moments(2, 2) == {1: 0, 2: 2, 3: 0}


def test_the_gaussian_of_the_note_is_found():
    assert construct(2, 2).coefficients == GAUSSIAN_20.coefficients == (4,)


@given(DERIVATIVES, ACCURACIES)
def test_constructed_kernels_meet_their_conditions_exactly(beta, r):
    kernel = construct(beta, r)
    for k, wanted in required_moments(beta, r).items():
        assert exact_moment(kernel, k) == wanted
    # The symmetry (19).
    z = np.linspace(0.0, 4.0, 33)
    np.testing.assert_array_equal(kernel(-z), (-1) ** beta * kernel(z))


@given(DERIVATIVES, st.sampled_from([1, 3, 5]))
def test_an_odd_accuracy_gives_one_more(beta, r):
    assert construct(beta, r).coefficients == construct(beta, r + 1).coefficients


@pytest.mark.parametrize("beta", range(1, 6))
@pytest.mark.parametrize("r", [2, 4])
def test_the_integral_is_exact_for_polynomials(beta, r):
    """(17) has no term left for x^k, k < beta + r; the constant of the first one is that of `taylor_constant`."""
    kernel, epsilon = construct(beta, r), 0.5
    x = np.array([-1.0, 0.3, 2.0])
    for k in range(beta + r + 1):
        exact = np.polynomial.Polynomial.basis(k).deriv(beta)(x)
        found = regularised(lambda y, k=k: y**k, x, epsilon, kernel, beta)
        if k == beta + r:
            exact = exact + float(taylor_constant(kernel, beta, r)) * epsilon**r * factorial(k)
        # |x| + epsilon reach < 6 to the power k, over epsilon^beta, is what cancels.
        assert found == pytest.approx(exact, rel=1e-9, abs=EPS * 6.0**k / epsilon**beta * 100)


@pytest.mark.parametrize("overlap", [0.7, 1.0, 1.6])
@pytest.mark.parametrize("beta", [1, 2, 3])
def test_kernels_of_a_lattice_make_its_sum_exact_for_polynomials(beta, overlap):
    h, r = 0.25, 2
    kernel = construct(beta, r, overlap)
    epsilon = overlap * h
    particles = lattice(-12.0 * epsilon - 1.0, 12.0 * epsilon + 1.0, h)
    x = h * np.array([-2.0, 0.0, 3.0])
    for k in range(beta + r):
        exact = np.polynomial.Polynomial.basis(k).deriv(beta)(x)
        found = derivative(x, x**k, particles, particles**k, h, epsilon, kernel, beta)
        size = max(abs(float(c)) for c in kernel.coefficients) * 3.0**k / epsilon**beta
        assert found == pytest.approx(exact, abs=1000 * EPS * size)


def test_a_lattice_with_too_few_particles_in_a_kernel_is_refused():
    with pytest.raises(InvalidInput, match="overlap"):
        construct(4, 6, overlap=0.3)


@pytest.mark.parametrize(
    ("beta", "r", "field"),
    [
        (-1, 2, "derivative"),
        (1.0, 2, "derivative"),
        (2, 0, "accuracy"),
        (2, True, "accuracy"),
        (10, 20, "accuracy"),
    ],
)
def test_bad_orders_are_refused(beta, r, field):
    with pytest.raises(InvalidInput, match=field):
        construct(beta, r)


def test_the_laplacian_in_one_dimension_is_the_second_derivative():
    assert construct_laplacian(6, 1).coefficients == construct(2, 6).coefficients


@pytest.mark.parametrize("dim", [2, 3])
def test_laplacians_are_exact_for_polynomials(dim):
    """Lap x^2 = 2, Lap x^4 = 12 x^2, and Lap (x^2 y^2) = 2 (x^2 + y^2), by a sum over a fine enough lattice."""
    kernel = construct_laplacian(4, dim)
    epsilon, s = 0.5, 2.5  # aliases of exp(-(pi s)^2): none
    n = int(kernel.reach * s) + 1
    grid = np.meshgrid(*[np.arange(-n, n + 1) / s] * dim, indexing="ij")
    distance = np.sqrt(sum(z**2 for z in grid))
    weights = kernel(distance) / s**dim / epsilon**2
    at = np.arange(1.0, dim + 1.0) / 4.0
    x, y = at[0] - epsilon * grid[0], at[1] - epsilon * grid[1]

    def laplacian(f):
        return float((weights * (f(x, y) - f(at[0], at[1]))).sum())

    assert laplacian(lambda x, y: x**2) == pytest.approx(2.0, rel=1e-12)
    assert laplacian(lambda x, y: x**4) == pytest.approx(12.0 * at[0] ** 2, rel=1e-11)
    assert laplacian(lambda x, y: x**2 * y**2) == pytest.approx(2.0 * (at**2)[:2].sum(), rel=1e-11)
    assert laplacian(lambda x, y: x * y) == pytest.approx(0.0, abs=1e-12)


def test_a_laplacian_in_four_dimensions_is_refused():
    with pytest.raises(InvalidInput, match="dim"):
        construct_laplacian(2, 4)


def test_stencils_are_the_centred_differences():
    third = Fraction(1, 3)
    assert construct_stencil(2, 2).values == (1, 0, 1)
    assert construct_stencil(2, 4).values == (-third / 4, 4 * third, 0, 4 * third, -third / 4)
    # With f(x_i - m h) eta(m): the sign of an antisymmetric one is that of (18).
    assert construct_stencil(1, 2).values == (Fraction(1, 2), 0, Fraction(-1, 2))


@given(st.integers(1, 5), st.sampled_from([2, 4, 6]))
def test_stencils_meet_the_discrete_conditions_exactly(beta, r):
    stencil = construct_stencil(beta, r)
    n = len(stencil.values) // 2
    for k, wanted in required_moments(beta, r).items():
        assert sum(Fraction(i) ** k * v for i, v in enumerate(stencil.values, -n)) == wanted
    assert stencil(np.array([n + 1.0, -n - 7.0])).tolist() == [0.0, 0.0]


def test_a_stencil_for_the_function_itself_is_refused():
    with pytest.raises(InvalidInput, match="derivative"):
        construct_stencil(0, 2)


@given(
    st.lists(st.lists(st.integers(-5, 5), min_size=3, max_size=3), min_size=3, max_size=3),
    st.lists(st.fractions(max_denominator=9), min_size=3, max_size=3),
)
def test_linear_systems_are_solved_exactly(matrix, solution):
    # Made regular by a dominant diagonal, its rows in another order.
    rows = [[Fraction(v + 20 * (i == j)) for j, v in enumerate(r)] for i, r in enumerate(matrix)]
    rows = [rows[2], rows[0], rows[1]]
    right = [sum((a * x for a, x in zip(r, solution, strict=True)), Fraction(0)) for r in rows]
    assert solve_exactly(rows, right) == solution


# --- sums -----------------------------------------------------------------------------------------


def test_smooth_particles_approximate_to_the_order_of_the_kernel():
    x = np.linspace(-1.0, 1.0, 21)
    for r in (2, 4):
        kernel, errors = construct(0, r), []
        for epsilon in (0.2, 0.1):
            particles = lattice(-3.0, 3.0, 0.5 * epsilon)
            found = reconstruct(x, particles, np.cos(particles), 0.5 * epsilon, epsilon, kernel)
            errors.append(np.abs(found - np.cos(x)).max())
        # The next term is smaller by epsilon^2 C_(r+2) / C_r < 0.25 * 0.04.
        assert np.log2(errors[0] / errors[1]) == pytest.approx(r, abs=0.02)


def test_a_bad_radius_is_refused():
    with pytest.raises(InvalidInput, match="epsilon"):
        reconstruct([0.0], np.zeros(1), np.ones(1), 1.0, 0.0, GAUSSIAN_20)


# --- exchange of strength -------------------------------------------------------------------------


def any_particles(seed: int, n: int = 30, dim: int = 1):
    random = np.random.default_rng(seed)
    x = random.uniform(0.0, 3.0, (n, dim))
    return x, random.exponential(0.1, n) + 1e-3, random.normal(size=n)


@pytest.mark.filterwarnings("ignore::fracparticles.errors.StabilityWarning")  # of order 4
@given(st.integers(0, 2**32), st.integers(1, 3), st.sampled_from([2, 4]))
def test_symmetric_kernels_conserve_on_any_particles(seed, dim, r):
    x, v, q = any_particles(seed, dim=dim)
    exchange = StrengthExchange(x, v, 0.4, construct_laplacian(r, dim))
    # Each of the N^2 terms is rounded, in two sums.
    bound = 4.0 * EPS * len(q) * np.abs(exchange.matrix @ np.diag(q)).sum()
    assert abs(exchange.apply(q).sum()) <= bound


@given(st.integers(0, 2**32))
def test_a_uniform_density_is_steady_and_squares_decay(seed):
    x, v, q = any_particles(seed)
    exchange = StrengthExchange(x, v, 0.4, GAUSSIAN_20)
    assert np.abs(exchange.apply(v)).max() <= 100.0 * EPS * exchange.rate * v.max()
    # d/dt sum Q^2 / V = -(D / eps^2) sum_ip V_i V_p eta (f_i - f_p)^2.
    assert (q / v) @ exchange.apply(q) <= 100.0 * EPS * exchange.rate * ((q / v) @ q)


@pytest.mark.parametrize("dim", [1, 2])
def test_the_exchange_is_the_sum_over_pairs(dim):
    x, v, q = any_particles(7, dim=dim)
    epsilon, d = 0.3, 0.7
    kernel = construct_laplacian(2, dim)
    expected = np.zeros_like(q)
    for i in range(len(q)):
        for p in range(len(q)):
            z = np.linalg.norm(x[i] - x[p]) / epsilon
            eta = kernel(z) / epsilon**dim
            expected[i] += d / epsilon**2 * (q[p] * v[i] - q[i] * v[p]) * eta
    exchange = StrengthExchange(x, v, epsilon, kernel, d)
    np.testing.assert_allclose(exchange.apply(q), expected, atol=1e-13 * np.abs(expected).max())
    out = np.arange(len(q), dtype=float)
    exchange.combine(q, out, 2.0, -1.0, 0.5)
    wanted = 2.0 * expected - q + 0.5 * np.arange(len(q))
    np.testing.assert_allclose(out, wanted, atol=1e-12 * np.abs(wanted).max())


def test_the_lattice_kernel_gives_centred_differences():
    h, n = 0.125, 9
    matrix = StrengthExchange(h * np.arange(n), h, h, TENT_27, 3.0).matrix.toarray()
    inner = matrix[1:-1] * h * h / 3.0
    expected = np.eye(n - 2, n) - 2.0 * np.eye(n - 2, n, 1) + np.eye(n - 2, n, 2)
    np.testing.assert_array_equal(inner, expected)


def test_a_skewed_kernel_conserves_on_a_lattice_only():
    """Its odd part cancels where every distance has its opposite: on an infinite lattice, not elsewhere."""
    kernel = construct(1, 2)  # antisymmetric
    n, h = 200, 0.1
    x = h * np.arange(n)
    q = np.exp(-((x - 10.0) ** 2))
    regular = StrengthExchange(x, h, 2.0 * h, kernel).apply(q)
    assert abs(regular.sum()) < 1e-10 * np.abs(regular).sum()
    moved = x + 0.3 * h * np.random.default_rng(1).uniform(-1.0, 1.0, n)
    irregular = StrengthExchange(moved, h, 2.0 * h, kernel).apply(q)
    assert abs(irregular.sum()) > 1e-4 * np.abs(irregular).sum()


def test_the_rate_bounds_the_spectrum_and_the_integrators_take_it():
    x, v, q = any_particles(3)
    exchange = StrengthExchange(x, v, 0.4, GAUSSIAN_20)
    assert np.abs(np.linalg.eigvals(exchange.matrix.toarray())).max() <= exchange.rate
    final = step(exchange, STEP_POLYNOMIALS["rk4"], 2.0 / exchange.rate, 50, q)
    assert final.sum() == pytest.approx(q.sum(), abs=1e-12 * np.abs(q).sum())


def test_cells_of_sorted_particles():
    x = np.array([0.0, 1.0, 3.0, 4.0])
    assert cell_volumes(x).tolist() == [1.0, 1.5, 1.5, 1.0]


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"volumes": [1.0, 0.0]}, "volumes"),
        ({"volumes": [1.0, np.nan]}, "volumes"),
        ({"epsilon": -1.0}, "epsilon"),
        ({"x": [0.0, np.inf]}, "x"),
    ],
)
def test_bad_particles_are_refused(change, field):
    good = {"x": [0.0, 1.0], "volumes": 1.0, "epsilon": 1.0, "kernel": GAUSSIAN_20}
    with pytest.raises(InvalidInput, match=f"^{field} = "):
        StrengthExchange(**(good | change))


def test_the_bump_of_eq_10_has_unit_mass_with_the_radius_outside_the_root():
    epsilon = 0.3
    x = np.linspace(-4.0, 4.0, 2001)
    bump = np.exp(-(x**2) / (2.0 * epsilon**2))
    mass = bump.sum() * (x[1] - x[0])
    assert mass / (sqrt(2.0 * np.pi) * epsilon) == pytest.approx(1.0, rel=1e-13)
    assert mass / sqrt(2.0 * np.pi * epsilon) == pytest.approx(sqrt(epsilon), rel=1e-13)


# --- what particles cannot do ---------------------------------------------------------------------


@pytest.mark.parametrize("n", [40, 200])
@pytest.mark.parametrize(("overlap", "grows"), [(1.0, True), (4.0, False)])
def test_growth_of_kernels_that_are_negative_somewhere_is_warned_of(n, overlap, grows):
    h = 16.0 / n
    x = np.sort(h * (np.arange(n) + 0.5 * np.random.default_rng(1).uniform(-1.0, 1.0, n)))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        exchange = StrengthExchange(x, cell_volumes(x), overlap * h, construct(2, 6))
    greatest = np.linalg.eigvals(exchange.matrix.toarray()).real.max()
    assert bool(greatest > 1e-5 * exchange.rate) is grows
    told = [str(w.message) for w in caught if issubclass(w.category, StabilityWarning)]
    assert bool(told) is grows
    if grows:
        assert float(told[0].split("exp(")[1].split()[0]) == pytest.approx(greatest, rel=0.01)


@dataclass(frozen=True)
class Lopsided:
    reach: float = 7.0
    breaks: tuple[float, ...] = ()

    def __call__(self, z):
        return GAUSSIAN_20(z) * (1.0 + 0.1 * z)


def test_a_kernel_that_is_not_symmetric_is_warned_of():
    with pytest.warns(AccuracyWarning, match="does not conserve"):
        StrengthExchange(np.arange(9.0), 1.0, 2.0, Lopsided())


def test_particles_out_of_reach_of_one_another_are_warned_of():
    with pytest.warns(AccuracyWarning, match="at 9 of 9 particles .* from 0 to 0 of the moment"):
        exchange = StrengthExchange(np.arange(9.0), 1.0, 0.01, GAUSSIAN_20)
    assert exchange.apply(np.arange(9.0)).tolist() == [0.0] * 9
    with pytest.warns(AccuracyWarning, match="of the moment"):
        StrengthExchange(np.arange(9.0), 5.0, 2.0, GAUSSIAN_20)
    x = np.arange(9.0)
    with pytest.warns(AccuracyWarning, match="at 1 of 2 points"):
        found = derivative([4.0, 50.0], [16.0, 2500.0], x, x * x, 1.0, 1.0, GAUSSIAN_20, 2)
    assert found[0] == pytest.approx(2.0, rel=0.01)
    assert found[1] == 0.0


@pytest.mark.filterwarnings("error")
def test_enough_particles_are_not():
    x = np.arange(-20.0, 21.0)
    StrengthExchange(x, 1.0, 2.0, construct(2, 4))
    derivative(x, x * x, x, x * x, 1.0, 2.0, GAUSSIAN_20, 2)


@pytest.mark.parametrize("volume", [5e-324, 1e307])
def test_volumes_whose_products_lose_digits_are_refused(volume):
    with pytest.raises(InvalidInput, match="volumes"):
        StrengthExchange(np.arange(9.0), volume, 2.0, GAUSSIAN_20)


def test_the_rate_is_twice_the_greatest_loss():
    """Gershgorin by columns: what a particle gives is what the others take, whatever the volumes."""
    x, v, _ = any_particles(5)
    exchange = StrengthExchange(x, v, 0.4, GAUSSIAN_20)
    assert exchange.rate == pytest.approx(-2.0 * exchange.matrix.diagonal().min(), rel=1e-13)


@pytest.mark.parametrize("terms", [1, 2, 6, 12])
@pytest.mark.parametrize("largest", [0.5, 1.0, 1e6])
def test_the_reach_solves_its_equation(terms, largest):
    """z^2 - q log z = 40 + log of the greatest coefficient, that of z^q, or 40 alone for a smaller one."""
    kernel = GaussianKernel((0,) * (terms - 1) + (largest,))
    z, q = kernel.reach, 2 * (terms - 1)
    assert z * z - q * np.log(z) == pytest.approx(40.0 + max(np.log(largest), 0.0), rel=1e-12)


def test_at_no_points_there_is_nothing():
    assert regularised(np.cos, [], 0.1, GAUSSIAN_20, 2).shape == (0,)


def test_splines_up_to_degree_three_hundred():
    # The variance of a B-spline of degree q is (q + 1) / 12, so that the Gaussian of the central limit is
    # eta(0) = 24 / (q + 1) sqrt(6 / (pi (q + 1))), with an error of 3 / (20 (q + 1)).
    limit = 24.0 / 301.0 * sqrt(6.0 / (np.pi * 301.0))
    assert float(SplineKernel(300)(0.0)) == pytest.approx(limit, rel=1.1 * 3.0 / (20.0 * 301.0))
    with pytest.raises(InvalidInput, match="300"):
        SplineKernel(301)


def test_kernels_given_by_their_coefficients_are_well_conditioned():
    assert GaussianKernel((1.0,)).condition == 1.0
    assert Stencil((Fraction(1), Fraction(0), Fraction(1))).condition == 1.0
