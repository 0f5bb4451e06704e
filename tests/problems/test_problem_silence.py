"""Numbers that were wrong without a word: each now right, or warned of, or refused."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.problems import Problem, solve_problem
from fracparticles.problems.expressions import Coefficient
from fracparticles.problems.moving_particles import solve_with_moving_particles
from fracparticles.problems.rates import Rates
from fracparticles.problems.sudden import sudden_changes
from fracparticles.special import green
from fracparticles.time.krylov import KrylovStep
from fracparticles.time.steps import norm
from sweeps import covering, few

LINE = {"alpha": 1.5, "half_width": 40.0, "spacing": 0.1, "t_final": 1.0}
ON_A_DOMAIN = {"alpha": 1.5, "exterior": "absorbing", "half_width": 1.0, "t_final": 1.0}
TOLERANCE = 1e-6  # the default of rtol
TOLERANCES = {"dop853": TOLERANCE, "rkc2": 1e-4}  # steps of order two are many


def bell(x: np.ndarray) -> np.ndarray:
    return np.exp(-(x**2))


def hat(*place: np.ndarray) -> np.ndarray:
    return np.prod([1.0 - x**2 for x in place], axis=0)


def solved(initial=bell, estimate: bool = False, **fields) -> np.ndarray:
    """To estimate the error of the particles, too, takes as long again."""
    return solve_problem(Problem(**{**LINE, **fields}), initial, estimate=estimate).u.values


@pytest.fixture(scope="module")
def plain() -> np.ndarray:
    return solved()


@pytest.mark.parametrize(
    ("rate", "integrator"), few([(20, "dop853"), (100, "dop853"), (20, "rkc2"), (10, "rkc2")])
)
def test_what_decays_by_many_decades_keeps_its_digits(plain, rate, integrator):
    """The tolerance is of the size of u at the time; each of some `rate` units of time may add one rtol."""
    tolerance = TOLERANCES[integrator]
    u = solved(source=f"-{rate}*u", integrator=integrator, rtol=tolerance)
    assert np.abs(u * np.exp(rate) - plain).max() < rate * tolerance * plain.max()


def test_what_fades_in_a_krylov_space_keeps_its_digits():
    rates = np.linspace(30.0, 90.0, 40)
    u = KrylovStep(
        lambda u: -rates * u, 40, 1e-8, lambda t, u: 1e-8 * np.abs(u).max(), 1.0
    ).advance(np.ones(40), 1.0)
    # The fastest are far below the slowest, which make the norm.
    assert_allclose(u, np.exp(-rates), atol=1e-7 * np.exp(-30.0))


@pytest.mark.parametrize("size", [1e-9, 1e-200])
def test_a_source_that_starts_from_nothing_has_no_unit(size):
    one, small = (solved(lambda x: 0.0 * x, source=f"{s}*t*exp(-x**2)") for s in (1.0, size))
    assert_allclose(small / size, one, rtol=1e-12, atol=1e-12 * one.max())


@pytest.mark.parametrize(("integrator", "size"), [("dop853", 1e-300), ("rkc2", 1e-20)])
def test_a_source_begins_from_next_to_nothing_as_from_nothing(integrator, size):
    fields = {"source": "exp(-x**2) - u**2", "integrator": integrator}
    fields["rtol"] = TOLERANCES[integrator]
    none, next_to_none = (
        solved(lambda x: 0.0 * x, **fields),
        solved(lambda x: size * bell(x), **fields),
    )
    # The steps differ: each run may be off by its tolerance.
    assert np.abs(next_to_none - none).max() < 2.0 * fields["rtol"] * none.max()


def test_a_source_may_be_infinite_where_u_is_nothing():
    """What it makes of nothing is asked for: that is no size, and no warning of numpy. Mirrored, u is that of -u."""
    fields = {**ON_A_DOMAIN, "exterior": "reflecting", "t_final": 0.1, "source": "-0.1/u"}
    up, down = (
        solve_problem(
            Problem(**fields, particles=64), lambda x, s=s: s / (1.0 + x * x), estimate=False
        )
        for s in (1, -1)
    )
    assert_allclose(down.u, -up.u, rtol=1e-12)


@pytest.mark.parametrize(("integrator", "width"), covering(["dop853", "rkc2"], [0.1, 0.01, 0.001]))
def test_a_pulse_is_not_stepped_over(plain, integrator, width):
    fields = {"source": f"where((t > 0.5) & (t < 0.5 + {width}), 1/{width}, 0.0)*exp(-x**2)"}
    tolerance = TOLERANCES[integrator]
    u = solved(**fields, integrator=integrator, rtol=tolerance)
    alone, late = plain, solved(t_final=0.5 - 0.5 * width)  # what came in half-way of the pulse
    # The pulse has a width: of second order in it, and what the rule of its middle leaves at the tolerance.
    assert np.abs(u - alone - late).max() < (0.1 * width**2 + 10.0 * tolerance) * u.max()


def test_a_pulse_of_the_diffusivity_and_one_of_a_function(plain):
    moved = solved(diffusivity="where((t > 0.3) & (t < 0.31), 100.0, 0.0)")
    assert np.abs(moved - plain).max() < 10.0 * TOLERANCE
    by_function = solved(diffusivity=lambda x, t: 100.0 * ((t > 0.3) & (t < 0.31)) + 0.0 * x)
    assert np.abs(moved - by_function).max() < 10.0 * TOLERANCE


def test_sudden_times_are_those_before_and_after_a_jump():
    problem = Problem(**LINE, source="where(t > 0.3, 1.0, 0.0)*exp(-x**2)", velocity="sin(7*t)")
    before, after = sudden_changes(problem, bell(problem.case.x))
    assert before <= 0.3 < after < before + 1e-10
    quick = Problem(**LINE, source="where(sin(500*t) > 0, 1.0, 0.0)*exp(-x**2)")
    found = np.array(sudden_changes(quick, bell(quick.case.x)))
    jumps = np.pi / 500.0 * np.arange(1.0, 160.0)
    later = np.searchsorted(found, jumps)
    assert (found[later] - found[later - 1]).max() <= 2.0**-44
    assert sudden_changes(Problem(**LINE, source="cos(9*t)"), bell(problem.case.x)) == []


@pytest.mark.parametrize(
    "fields",
    [
        {"diffusivity": "1 + 0.9*sin(20*pi*x)"},
        {"diffusivity": "1 + 0.9*cos(20*pi*x)"},
        {"velocity": "cos(20*pi*x)"},
        {"source": "cos(20*pi*x)*exp(-x**2)"},
        {"source": lambda x: 1e4 * np.exp(-(((x - 0.05) / 0.005) ** 2))},
        {"beta": "0.5 + 0.1*sin(20*pi*x)", "alpha": None, "form": "DD"},
    ],
)
def test_a_coefficient_finer_than_the_particles_warns(fields):
    given = {name: value for name, value in {**LINE, **fields}.items() if value is not None}
    with pytest.warns(AccuracyWarning, match="coefficient differs between the particles"):
        solve_problem(Problem(**given), bell)


@pytest.mark.parametrize(
    "fields",
    [
        {"diffusivity": "1 + 0.5*tanh(x)"},
        {"source": "exp(-x**2) - u"},
        {"diffusivity": "1 + 0*x"},
        {"source": lambda x, t: np.ones(801) * bell(np.linspace(-40.0, 40.0, 801))},
    ],
)
def test_one_that_they_resolve_does_not(fields):
    with warnings.catch_warnings():
        warnings.simplefilter("error", AccuracyWarning)
        warnings.filterwarnings("ignore", message=".*varies by")  # of the ends of the lattice
        solved(**fields, estimate=True)


def test_data_between_the_particles_warn():
    with pytest.warns(AccuracyWarning, match="initial data differ between the particles"):
        solved(lambda x: np.exp(-(((x - 0.05) / 0.005) ** 2)) + 1e-3 * bell(x))


def test_a_tolerance_of_the_size_of_the_solution_warns():
    with pytest.warns(AccuracyWarning, match="has fallen.* atol"):
        solved(source="-20*u", atol=1e-6)


def test_a_function_cannot_change_what_it_is_given():
    def source(x, t, u):
        u *= -1.0
        return u

    with pytest.raises(InvalidInput, match="read-only"):
        solved(source=source)


def test_units_of_time_length_and_strength_change_nothing(plain):
    varied = solved(diffusivity="1 + 0.5*tanh(x)", velocity=0.5)
    tiny, huge = 2.0**-70, 2.0**70  # powers of two: the same numbers to round-off of their powers
    slow = solved(
        diffusivity=f"{tiny!r}*(1 + 0.5*tanh(x))", velocity=0.5 * tiny, t_final=1.0 / tiny
    )
    wide = solved(
        lambda x: bell(x / huge),
        diffusivity=f"{huge**1.5!r}*(1 + 0.5*tanh(x/{huge!r}))",
        velocity=0.5 * huge,
        half_width=40.0 * huge,
        spacing=0.1 * huge,
    )
    faint = solved(lambda x: 1e-200 * bell(x), diffusivity="1 + 0.5*tanh(x)", velocity=0.5)
    for other in (slow, wide, faint * 1e200):
        assert np.abs(other - varied).max() < 1e-10 * plain.max()


def test_the_norm_has_no_unit():
    u = np.array([3.0, 4.0])
    for size in (1.0, 1e-200, 1e200):
        assert norm(size * u) == pytest.approx(5.0 * size, rel=1e-15)
    assert norm(np.zeros(3)) == 0.0
    assert np.isnan(norm(np.array([1.0, np.nan])))


@pytest.mark.parametrize(
    ("velocity", "steps", "match"),
    [("-x", 2, "another number of steps"), ("-5*x", 1, "have left"), (100.0, 5, "have left")],
)
def test_moving_particles_say_when_they_are_off(velocity, steps, match):
    problem = Problem(**{**LINE, "t_initial": 1.0, "t_final": 2.0}, velocity=velocity)
    with pytest.warns(AccuracyWarning, match=match):
        solve_with_moving_particles(problem, green(problem.case.x, 1.0, 1.5), steps)


def test_comparisons_are_numbers():
    at = {"x": np.array([-2.0, 0.0, 2.0]), "t": np.array(0.0)}
    for text, values in (
        ("(x > -1) + (x < 1)", [1.0, 2.0, 1.0]),
        ("-(x > 0)*2", [0.0, 0.0, -2.0]),
        ("(x > -1) - (x > 1)", [0.0, 1.0, 0.0]),
        ("(x > -1) & (x < 1) | (x > 1)", [0.0, 1.0, 1.0]),
    ):
        assert_allclose(Coefficient("source", text, ("x", "t"))(at), values)


@pytest.mark.parametrize("spacing", [0.1, 0.4, 0.8])
@pytest.mark.parametrize("velocity", [None, 1.0])
def test_the_error_of_the_waves_is_that_of_the_peak(spacing, velocity):
    """Of a uniform field the symbols say all; a lattice that is too coarse warns."""
    problem = Problem(
        **{**LINE, "spacing": spacing, "t_initial": 1.0, "t_final": 1.5}, velocity=velocity
    )
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run = solve_problem(problem)
    exact = green(run.x.values - 0.5 * (velocity or 0.0), 1.5, 1.5)
    error = np.abs(run.u.values - exact).max() / exact.max()
    assert 0.5 * error < float(run.wave_error) < 2.0 * error
    assert any("waves that the solution holds" in str(one.message) for one in caught) == (
        run.wave_error > 0.05
    )


@pytest.mark.parametrize("domain", ["interval", "square", "disc"])
def test_what_fades_on_a_domain_keeps_its_digits(domain):
    """The factor e^-20 of a source -20 u, to the steps' tolerances; the same where the steps are implicit."""
    particles = {"interval": 60, "square": 16, "disc": 16}[domain]
    fields = {**ON_A_DOMAIN, "domain": domain, "particles": particles}
    u0 = Problem(**fields).bounded_domain.values("u", hat)
    plain = solve_problem(Problem(**fields, rtol=1e-9), u0, estimate=False).u.values
    implicit = {"diffusivity": "1 + 0*t"}
    for more in ({}, implicit) if domain == "interval" else ({},):
        with warnings.catch_warnings():
            warnings.simplefilter("error", AccuracyWarning)
            run = solve_problem(Problem(**fields, **more, source="-20*u"), u0)
        assert np.abs(run.u.values * np.exp(20.0) - plain).max() < 100.0 * TOLERANCE * plain.max()
        assert ("rejected_steps" in run) == (str(run.integrator.values) != "radau")


@pytest.mark.parametrize("domain", ["interval", "square", "disc", None])
def test_what_a_source_takes_away_warns(domain):
    """u = e^(-20 t) of a source that does not know u: what early steps miss does not fall so fast."""
    fields, places = {**LINE}, 1
    if domain is not None:
        particles = {"interval": 60, "square": 16, "disc": 16}[domain]
        fields = {**ON_A_DOMAIN, "domain": domain, "particles": particles}
        places = 1 if domain == "interval" else 2
    problem = Problem(**fields)
    if domain is None:
        u0 = bell(problem.case.x)
        rate = Rates(problem)(0.0, u0)
    else:
        u0 = problem.bounded_domain.values("u", hat)
        rate = problem.bounded_domain.applied(u0)

    def source(*at):
        return -np.exp(-20.0 * at[places]) * (20.0 * u0 + rate)

    with pytest.warns(AccuracyWarning, match="has fallen"):
        run = solve_problem(Problem(**fields, source=source), u0, estimate=False)
    assert float(run.atol_share) > 1.0


def test_a_tolerance_on_a_domain_that_is_of_its_size_warns():
    with pytest.warns(AccuracyWarning, match="has fallen"):
        run = solve_problem(Problem(**ON_A_DOMAIN, particles=60, source="-20*u", atol=1e-9), hat)
    assert float(run.atol_share) == pytest.approx(1e-9 / float(run.u.max()))
