"""An interval: closed forms, a spectral method, invariants and orders."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from scipy.special import gamma

from fracparticles.adaptive.inverse import InverseExchange
from fracparticles.bounded.interval import Interval
from fracparticles.bounded.interval_jacobi import jacobi_eigenvalues
from fracparticles.bounded.interval_no_flux import no_flux_state
from fracparticles.errors import InvalidInput, NonFiniteSolution
from fracparticles.special import tail_constant

ALPHAS = [1.1, 1.5, 1.9]


def getoor(line: Interval) -> np.ndarray:
    """(1 - x^2)^(alpha/2), of which -A is Gamma(1 + alpha); by the distances from the ends."""
    unit = line._unit
    return (unit.left * unit.right) ** (0.5 * line.alpha)


def orders(errors: list[float]) -> np.ndarray:
    """Observed orders for numbers of particles that double."""
    return np.log2(np.abs(errors[:-1]) / np.abs(errors[1:]))


def test_the_spectral_method_has_the_known_eigenvalues():
    assert jacobi_eigenvalues(1.0)[0] == pytest.approx(1.1577738836977, abs=1e-11)
    n = np.arange(1, 9)
    assert jacobi_eigenvalues(2.0, 8) == pytest.approx((0.5 * np.pi * n) ** 2, rel=1e-11)
    # Kwasnicki, J. Funct. Anal. 262 (2012) 2379: up to O(1 / n).
    for alpha in ALPHAS:
        guess = (0.5 * np.pi * n - (2.0 - alpha) * np.pi / 8.0) ** alpha
        assert (np.abs(jacobi_eigenvalues(alpha, 8) - guess) < 0.1 * (2.0 - alpha) / n + 1e-9).all()


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_first_eigenvalue_has_six_digits_with_a_hundred_particles(alpha):
    line = Interval(alpha=alpha, particles=100)
    assert line.eigenvalues()[0] == pytest.approx(jacobi_eigenvalues(alpha)[0], rel=1e-6)


@pytest.mark.parametrize("alpha", ALPHAS)
@pytest.mark.parametrize(
    ("near", "degree", "first"), [(1, 8.0, 100), (2, 8.0, 100), (3, 4.0, 100), (0, 4.0, 200)]
)
def test_the_order_is_that_of_the_weights_or_of_the_ends(alpha, near, degree, first):
    exact = jacobi_eigenvalues(alpha)[0]
    errors = [
        Interval(alpha=alpha, particles=n, near=near, degree=degree).eigenvalues()[0] - exact
        for n in (first, 2 * first)
    ]
    # Without weights the next order is 4 - alpha, 2 away, and where alpha is near 2 all is slow.
    assert orders(errors)[0] == pytest.approx(min(2 * near + 2 - alpha, degree), abs=0.1)


def test_equal_volumes_have_the_order_one():
    exact = jacobi_eigenvalues(1.5)[0]
    errors = [
        Interval(alpha=1.5, particles=n, degree=1.0).eigenvalues()[0] - exact for n in (100, 200)
    ]
    assert orders(errors)[0] == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_stationary_solution_of_a_constant_source_is_getoors(alpha):
    line = Interval(alpha=alpha, particles=200)
    u = line.stationary(gamma(1.0 + alpha))
    assert u == pytest.approx(getoor(line), abs=1e-7)
    # Scaled: x = 3 + 2 s has the operator of s over 2^alpha.
    other = Interval(alpha=alpha, particles=200, ends=(1.0, 5.0), diffusivity=0.3)
    scaled = other.stationary(0.3 * gamma(1.0 + alpha) / 2.0**alpha)
    assert scaled == pytest.approx(u, rel=1e-12)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_greatest_error_is_at_the_ends(alpha):
    """Like d^(alpha/2) there, d ~ N^(-p): of the order p alpha/2; int |error| has the order p."""
    greatest, mean = [], []
    for n in (200, 400):
        line = Interval(alpha=alpha, particles=n, degree=4.0)
        error = np.abs(line.stationary(gamma(1.0 + alpha)) - getoor(line))
        greatest.append(error.max())
        mean.append(line.volumes @ error)
    assert orders(greatest)[0] == pytest.approx(2.0 * alpha, abs=0.1)
    assert orders(mean)[0] == pytest.approx(4.0, abs=0.1)


def test_the_first_mode_decays_by_its_eigenvalue_to_the_ends():
    line = Interval(alpha=1.5, particles=200)
    mode = line.modes(1)[1][:, 0]
    assert line.volumes @ mode**2 == pytest.approx(1.0, rel=1e-12)
    factor = np.exp(-0.8 * jacobi_eigenvalues(1.5)[0])
    assert line.evolve(mode, 0.8) == pytest.approx(factor * mode, rel=1e-7)
    late = line.evolve(1.0, 12.0)
    assert late / late.max() == pytest.approx(mode / mode.max(), rel=1e-9, abs=0.0)


def test_a_source_brings_the_solution_to_the_stationary_one():
    line = Interval(alpha=1.3, particles=100)
    steady = line.stationary(gamma(2.3))
    assert line.evolve(0.0, 40.0, source=gamma(2.3)) == pytest.approx(steady, rel=1e-10)


def test_a_manufactured_solution_that_depends_on_time():
    """u = cos(3 t) (1 - x^2)^(alpha/2), f = u_t + cos(3 t) Gamma(1 + alpha)."""
    line = Interval(alpha=1.5, particles=200)
    shape = getoor(line)

    def source(x, t):
        return -3.0 * np.sin(3.0 * t) * shape + np.cos(3.0 * t) * gamma(2.5)

    u = line.evolve(shape, 2.0, source=source)
    assert u == pytest.approx(np.cos(6.0) * shape, abs=1e-7)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_reflecting_ends_keep_the_mass_and_the_constant(alpha):
    line = Interval(alpha=alpha, particles=200, exterior="reflecting", ends=(0.0, 3.0))
    start = np.exp(-8.0 * (line.x - 0.7) ** 2)
    mass = line.volumes @ start
    for time in (1e-3, 0.1, 10.0):
        assert line.volumes @ line.evolve(start, time) == pytest.approx(mass, rel=1e-12)
    assert line.evolve(2.0, 0.3) == pytest.approx(2.0, rel=1e-12)
    assert line.evolve(start, 1e3) == pytest.approx(mass / 3.0, rel=1e-11)
    assert line.eigenvalues(2)[0] == 0.0
    grown = line.evolve(start, 0.5, source=lambda x, t: 2.0 * t + 0.0 * x)
    assert line.volumes @ grown == pytest.approx(mass + 3.0 * 0.25, rel=1e-12)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_the_regional_operator_on_a_parabola(alpha):
    """int (y^2 - x^2) |x - y|^(-1-alpha) dy, in parts (y - x)^2 + 2 x (y - x), in the middle of the interval."""
    errors = []
    for n in (100, 200):
        line = Interval(alpha=alpha, particles=n, exterior="reflecting", near=2)
        x = line.x
        inside = np.abs(x) < 0.5
        lower, upper = line._unit.left, line._unit.right
        exact = (upper ** (2 - alpha) + lower ** (2 - alpha)) / (2 - alpha)
        exact += 2 * x * (upper ** (1 - alpha) - lower ** (1 - alpha)) / (1 - alpha)
        deviation = line.matrix() @ x**2 - tail_constant(alpha) * exact
        errors.append(np.abs(deviation[inside]).max())
    # The place of the maximum moves.
    assert orders(errors)[0] == pytest.approx(6.0 - alpha, abs=0.15)


def test_reflecting_eigenvalues_have_the_order_of_the_weights():
    first, second, third = (
        Interval(alpha=1.5, particles=n, exterior="reflecting", near=2).eigenvalues(2)[1]
        for n in (50, 100, 200)
    )
    assert np.log2((first - second) / (second - third)) == pytest.approx(4.5, abs=0.15)


def test_a_constant_outside_is_met_by_the_constant_inside():
    line = Interval(alpha=1.7, particles=150, exterior="given", ends=(-2.0, 5.0))
    assert line.stationary(outside=2.5) == pytest.approx(2.5, rel=1e-12)
    assert line.evolve(2.5, 0.2, outside=2.5) == pytest.approx(2.5, rel=1e-12)
    assert line.evolve(0.0, 1e3, outside=lambda y, t: 2.5 + 0 * y) == pytest.approx(2.5, rel=1e-9)


@pytest.mark.parametrize("alpha", ALPHAS)
def test_values_outside_and_a_source_reproduce_a_function_of_the_whole_line(alpha):
    """u = 1 / (1 + x^2): its operator in closed form is minus the source, itself is what is outside."""
    line = Interval(alpha=alpha, particles=200, exterior="given")
    power = 1.0 + alpha
    x = line.x
    source = gamma(power) * (1 + x**2) ** (-0.5 * power) * np.cos(power * np.arctan(x))
    u = line.stationary(source, outside=lambda y: 1.0 / (1.0 + y * y))
    assert u == pytest.approx(1.0 / (1.0 + x**2), abs=1e-7)
    # The same, swinging in time.
    swung = line.evolve(
        1.0 / (1.0 + x**2),
        0.7,
        source=lambda x, t: np.cos(2 * t) * source - 2 * np.sin(2 * t) / (1 + x * x),
        outside=lambda y, t: np.cos(2 * t) / (1.0 + y * y),
    )
    assert swung == pytest.approx(np.cos(1.4) / (1.0 + x**2), abs=1e-7)


def test_the_inverse_is_that_of_the_matrix():
    """Against a plain inverse, where there is one: volumes that are nearly equal."""
    line = Interval(alpha=1.5, particles=40, degree=1.5)
    identity = line._inverse.apply(line._unit.volumes[:, None] * -line.matrix())
    assert identity == pytest.approx(np.eye(40), abs=1e-11)
    closed = Interval(alpha=1.5, particles=40, degree=1.5, exterior="reflecting")
    mean = closed.volumes / closed.volumes.sum()
    projector = closed._inverse.apply(closed._unit.volumes[:, None] * -closed.matrix())
    assert projector == pytest.approx(np.eye(40) - mean, abs=1e-11)
    assert isinstance(closed._inverse, InverseExchange)


def test_what_is_refused_in_one_line():
    line = Interval(alpha=1.5, particles=20)
    given = Interval(alpha=1.5, particles=20, exterior="given")
    closed = Interval(alpha=1.5, particles=20, exterior="reflecting")
    bad = {
        "alpha": lambda: Interval(alpha=2.0),
        "ends": lambda: Interval(alpha=1.5, ends=(1.0, -1.0)),
        "exterior": lambda: Interval(alpha=1.5, exterior="open"),
        "particles": lambda: Interval(alpha=1.5, particles=3),
        "near": lambda: Interval(alpha=1.5, near=7),
        "degree": lambda: Interval(alpha=1.5, degree=0.5),
        "diffusivity": lambda: Interval(alpha=1.5, diffusivity=-1.0),
        "count": lambda: line.eigenvalues(11),
        "source": lambda: closed.stationary(1.0),
        "outside": lambda: line.stationary(1.0, outside=1.0),
        "time": lambda: line.evolve(1.0, 1e-12),
        "initial": lambda: line.evolve(np.full(20, np.nan), 1.0),
        "tolerance": lambda: line.evolve(1.0, 1.0, tolerance=1.0),
    }
    for field, call in bad.items():
        with pytest.raises(InvalidInput, match=f"^{field} = ") as error:
            call()
        assert "\n" not in str(error.value)
    with pytest.raises(InvalidInput, match=r"^outside is missing"):
        given.evolve(0.0, 1.0)
    for g in (lambda y, t: y * y, lambda y, t: np.abs(y) ** 1.5):
        with pytest.raises(InvalidInput, match="do not grow"):
            given.evolve(0.0, 1.0, outside=g)
    assert np.isfinite(given.evolve(0.0, 1.0, outside=lambda y, t: np.log1p(y * y))).all()
    assert (line.evolve(1.0, 1e300) == 0.0).all()
    with pytest.raises(NonFiniteSolution, match="not finite at t = 1:"):
        line.evolve(1.7e308, 1.0)
    with pytest.raises(NonFiniteSolution, match="degree 512"):
        given.evolve(0.0, 1.0, outside=lambda y, t: np.sign(t - 1 / 3) + 0.0 * y)


def test_a_source_that_jumps_is_solved_from_jump_to_jump():
    line = Interval(alpha=1.5, particles=50)
    first = line.evolve(0.0, 1 / 3, source=-1.0)
    exact = line.evolve(first, 2 / 3, source=1.0)
    ours = line.evolve(0.0, 1.0, source=lambda x, t: np.sign(t - 1 / 3) + 0.0 * x)
    assert ours == pytest.approx(exact, abs=1e-8)


def test_the_state_without_flux_has_a_constant_potential():
    """Its mass is one, and int u(y) |x - y|^(1-alpha) dy the same everywhere: with y = cos t, by mpmath."""
    for alpha in (1.2, 1.5):
        unit = float(no_flux_state(np.zeros(1), alpha)[0])

        def around(x, power, alpha=alpha):
            def integrand(t):
                return mp.sin(t) ** (alpha - 1) * abs(mp.cos(t) - x) ** power

            return float(mp.quad(integrand, [0, mp.acos(x), mp.pi]))

        assert unit * around(0.6, 0) == pytest.approx(1.0, rel=1e-8)
        assert around(0.6, 1 - alpha) == pytest.approx(around(0.1, 1 - alpha), rel=1e-6)
    assert no_flux_state(np.array([0.5]), 1.5, 3.0) == pytest.approx(
        3.0 * no_flux_state(np.zeros(1), 1.5) * 0.75**-0.25
    )
    with pytest.raises(InvalidInput, match=r"^x = "):
        no_flux_state(np.array([1.0]), 1.5)
