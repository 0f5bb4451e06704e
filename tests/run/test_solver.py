"""Whole runs: own initial data, restarts, convergence, linearity, and what is refused."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import fracparticles as fp
from fracparticles.errors import InvalidInput, NonFiniteSolution, StabilityWarning
from fracparticles.run.case import Case
from fracparticles.run.solution import relative_l1_error
from fracparticles.run.solver import compute, initial_strengths
from fracparticles.special import central_mass, green, mean_radius

GIVEN = {"scheme": "KPSE", "beta": 0.5, "half_width": 10.0, "spacing": 0.25}


def case(**changes) -> Case:
    given = {**GIVEN, "integrator": "exponential", **changes}
    return Case(**{name: value for name, value in given.items() if value is not None})


def run(the_case, initial=None):
    return compute(the_case, initial).u


def error(**changes) -> float:
    solution = compute(case(**changes))
    return relative_l1_error(solution.case, solution.u)


# --- initial data ---------------------------------------------------------------------------------


def bump(x):
    return np.exp(-x * x)


def test_array_and_callable_are_the_same_run():
    c = case()
    assert np.array_equal(run(c, bump(c.x)), run(c, bump))


def test_the_default_is_the_fundamental_solution():
    c = case(diffusivity=2.0)
    u0, origin = initial_strengths(c)
    assert np.array_equal(u0, green(c.x, 1.0, 1.5))
    assert origin == "fundamental solution at t = 0.5"
    assert np.array_equal(run(c), run(c, lambda x: green(x, 1.0, 1.5)))


def test_own_data_may_start_at_zero():
    c = case(t_initial=0.0, t_final=1.0, initial="own.nc")
    assert np.array_equal(run(c, bump), run(case(t_initial=0.5, t_final=1.5), bump))


def test_the_initial_data_are_left_alone():
    c = case()
    u0 = bump(c.x)
    run(c, u0)
    assert np.array_equal(u0, bump(c.x))


@pytest.mark.parametrize("exterior", ["truncated", "open"])
def test_a_restart_from_a_file_continues_the_run(tmp_path, exterior):
    """0.5 -> 1.0 -> 1.5 is 0.5 -> 1.5 for the exponential, which has no time error."""
    path = tmp_path / "half.nc"
    fp.write(fp.solve(case(t_final=1.0, exterior=exterior)), path)
    whole = run(case(exterior=exterior))
    for restarted in (
        run(case(t_initial=1.0, exterior=exterior, initial=str(path))),
        run(case(t_initial=1.0, exterior=exterior), path),
    ):
        assert np.abs(restarted - whole).max() <= 1e-14 * np.abs(whole).max() * 10


@pytest.mark.parametrize(
    "data",
    [
        np.zeros(80),
        np.zeros((81, 1)),
        0.0,
        [],
        np.full(81, np.nan),
        np.full(81, np.inf),
        np.full(81, 1j),
        np.full(81, 1.0 + 0.0j),
        ["a"] * 81,
        [[1.0], [1.0, 2.0]],
        lambda x: x[:-1],
        lambda x: x + 1j,
        lambda x: None,
        {},
        object(),
    ],
    ids=range(15),
)
def test_data_that_cannot_be_used_are_refused(data):
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # as numpy warns when an imaginary part is dropped
        with pytest.raises(InvalidInput) as refused:
            run(case(), data)
    assert refused.value.field == "initial"
    assert "\n" not in str(refused.value)


# --- refused or reported --------------------------------------------------------------------------


def test_an_unstable_step_is_announced_with_the_numbers():
    c = case(integrator="rk2", dt=0.5, t_final=1.5)
    with pytest.warns(StabilityWarning, match=r"dt = 0\.5 lies outside .* at most 0\.27"):
        fp.solve(c)


def test_a_stable_step_is_not(recwarn):
    fp.solve(case(integrator="rk2", dt=0.25))
    fp.solve(case())
    assert not recwarn.list


@pytest.mark.parametrize("evaluation", ["series", "stepping"])
@pytest.mark.filterwarnings("ignore::fracparticles.errors.StabilityWarning")
def test_a_blow_up_names_scheme_step_and_time(evaluation):
    c = case(integrator="euler", dt=1.0, t_final=2000.5, evaluation=evaluation)
    with pytest.raises(
        NonFiniteSolution,
        match=r"KPSE \(order 2\): .*step \d+ of 2000, [\d.]+ after the start: .*Take a smaller dt",
    ):
        run(c, np.random.default_rng(1).standard_normal(c.particles))


# --- what a run computes --------------------------------------------------------------------------


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"integrator": "rk2", "dt": 0.01},
        {"integrator": "rk4", "dt": 0.01, "evaluation": "stepping"},
        {"scheme": "FPSE", "order": 4},
        {"scheme": "DPSE", "order": 4},
        {"scheme": "GPSE", "integrator": None},
        {"exterior": "open"},
    ],
    ids=str,
)
def test_linearity(changes):
    c = case(**changes)
    u, v = np.random.default_rng(2).standard_normal((2, c.particles))
    both = run(c, 2.0 * u - 3.0 * v)
    assert both == pytest.approx(2.0 * run(c, u) - 3.0 * run(c, v), abs=1e-12 * 10)


@pytest.mark.parametrize("changes", [{}, {"scheme": "DD"}, {"scheme": "FD"}, {"exterior": "open"}])
def test_time_scales_with_the_diffusivity(changes):
    """A run with D from t to t' is that with 1 from D t to D t', step D dt."""
    d = 4.0
    for integrator, dt in (("exponential", None), ("rk2", 0.01)):
        fast = case(**changes, integrator=integrator, dt=dt, diffusivity=d)
        slow = case(
            **changes,
            integrator=integrator,
            dt=None if dt is None else d * dt,
            t_initial=0.5 * d,
            t_final=1.5 * d,
        )
        assert run(fast) == pytest.approx(run(slow), rel=1e-11, abs=1e-14)


def test_lengths_scale_too():
    """With x -> 2 x and t -> 2^alpha t the fundamental solution is halved, and so is the run."""
    scale = 2.0**1.5
    wide = case(half_width=20.0, spacing=0.5, t_initial=0.5 * scale, t_final=1.5 * scale)
    assert 2.0 * run(wide) == pytest.approx(run(case()), rel=1e-11)


def test_conservative_runs_keep_their_mass():
    for scheme in ("KPSE", "FPSE", "DPSE", "GPSE", "RIESZ"):
        solution = compute(
            case(scheme=scheme, integrator=None if scheme == "GPSE" else "exponential")
        )
        assert solution.u.sum() == pytest.approx(solution.u0.sum(), rel=1e-12)


def test_kpse_keeps_order_and_sign():
    u0 = np.abs(np.random.default_rng(3).standard_normal(81))
    u = run(case(integrator="euler", dt=0.01), u0)
    assert (u > 0.0).all()
    assert u.max() <= u0.max()


@pytest.mark.parametrize(
    ("scheme", "order"), [("DD", 2), ("FPSE", 2), ("KPSE", 2), ("KPSE", 4), ("DD", 4)]
)
def test_order_of_convergence_in_space(scheme, order):
    """With the open exterior and the exponential nothing but the smoothing is left."""
    spacings = np.array([0.2, 0.1, 0.05]) if order == 2 else np.array([0.24, 0.12, 0.06])
    errors = [
        error(scheme=scheme, order=order, half_width=24.0, exterior="open", spacing=h)
        for h in spacings
    ]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders[-1] == pytest.approx(order, abs=0.15)


def test_finite_differences_are_of_first_order():
    errors = [error(scheme="FD", half_width=100.0, spacing=h) for h in (0.2, 0.1, 0.05)]
    # the truncation at 100 adds a few 1e-4 to the errors, 4e-3 at the finest
    assert np.log2(errors[1] / errors[2]) == pytest.approx(1.0, abs=0.15)


@pytest.mark.parametrize("integrator", ["euler", "rk2", "rk4"])
def test_order_of_convergence_in_time(integrator):
    exact = run(case())
    steps = np.array([8, 16, 32])
    errors = [np.abs(run(case(integrator=integrator, dt=1.0 / k)) - exact).max() for k in steps]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders[-1] == pytest.approx({"euler": 1, "rk2": 2, "rk4": 4}[integrator], abs=0.15)


def test_the_error_is_that_of_equation_48():
    c = case(half_width=30.0)
    exact = green(c.x, 1.5, 1.5)
    assert relative_l1_error(c, exact) == 0.0
    inside = np.abs(c.x) <= 5.0 * mean_radius(1.5)
    expected = 0.25 * inside.sum() * 1e-3 / central_mass(5.0 * mean_radius(1.5), 1.5, 1.5)
    assert relative_l1_error(c, exact + 1e-3) == pytest.approx(expected, rel=1e-12)


def test_on_a_narrow_lattice_the_error_runs_over_the_lattice():
    c = case(half_width=2.0)
    expected = c.particle_spacing * c.particles * 1e-3 / central_mass(2.0, 1.5, 1.5)
    exact = green(c.x, 1.5, 1.5)
    assert relative_l1_error(c, exact + 1e-3) == pytest.approx(expected, rel=1e-12)


def test_a_point_mass_is_no_start_but_data_of_ones_own_are():
    c = case(half_width=10.0, t_initial=0.0)
    with pytest.raises(InvalidInput, match="a point mass at t = 0"):
        compute(c)
    assert compute(c, lambda x: np.exp(-(x**2))).u.max() < 1.0


# --- far from units near one ----------------------------------------------------------------------


@pytest.mark.parametrize(("length", "rate"), [(1e95, 1e50), (1e-95, 1e-50), (1e60, 1e-6)])
def test_a_run_does_not_depend_on_its_units(length, rate):
    """In three dimensions A u, which has the unit of 1 / (length^3 time), is no number there."""
    cube = {
        "dim": 3,
        "exterior": "open",
        "half_width": 10.0,
        "spacing": 1.0,
        "t_initial": 1.0,
        "t_final": 2.0,
    }
    time = length**1.5 / rate
    lengths = {name: length * cube[name] for name in ("half_width", "spacing")}
    times = {name: time * cube[name] for name in ("t_initial", "t_final")}
    near, far = case(**cube), case(**{**cube, **lengths, **times, "diffusivity": rate})
    u, v = compute(near), compute(far)
    assert np.abs(v.u * length**3 - u.u).max() < 1e-11 * u.u.max()
    bare = fp.prepare(far).solve(v.u0)
    assert np.array_equal(bare, v.u)


def test_strengths_next_to_the_end_of_float64_are_run():
    c = case(diffusivity=1e6, t_initial=0.5e-6, t_final=1.5e-6, half_width=1.0, spacing=0.02)
    u = run(c, bump)
    assert np.array_equal(run(c, lambda x: 2.0**1000 * bump(x)), 2.0**1000 * u)
    assert np.array_equal(run(c, lambda x: 2.0**-900 * bump(x)), 2.0**-900 * u)


def test_strengths_that_overflow_when_they_grow_are_refused():
    unstable = case(integrator="euler", dt=0.5, t_final=10.5)
    with (
        pytest.warns(StabilityWarning),
        pytest.raises(NonFiniteSolution, match="strengths overflow: change the unit of u"),
    ):
        run(unstable, lambda x: 1e305 * np.cos(np.pi * x / 0.5))


# --- what is no case, and no operator of it ----------------------------------------------------------


@pytest.mark.parametrize("junk", [None, "KPSE", 1.0, {"scheme": "KPSE"}])
def test_what_is_no_case_is_refused(junk):
    for takes in (fp.solve, fp.prepare):
        with pytest.raises(InvalidInput, match=r"^case (=|is missing)"):
            takes(junk)


def test_who_passes_a_problem_is_sent_on():
    problem = fp.Problem(alpha=1.5, half_width=10.0, spacing=0.1, t_final=1.0)
    for call in (fp.solve, fp.prepare, fp.estimate_error):
        with pytest.raises(InvalidInput, match=r"is for fp\.solve_problem"):
            call(problem)
    with pytest.raises(InvalidInput, match=r"is for fp\.solve\."):
        fp.solve_problem(problem.case)


def test_a_word_is_no_flag():
    with pytest.raises(InvalidInput, match="estimate = 'no'"):
        fp.solve(case(), estimate="no")


def test_an_operator_of_another_lattice_is_refused():
    other = fp.prepare(case(half_width=5.0)).operator
    with pytest.raises(InvalidInput, match=r"^operator = 'one of 41' .* the 81 particles"):
        fp.prepare(case(), other)
    with pytest.raises(InvalidInput, match=r"^operator = 1\.0 "):
        fp.prepare(case(), 1.0)


# --- what grows is spoken of ----------------------------------------------------------------------------


def test_growth_from_the_ends_of_the_lattice_is_spoken_of():
    ends = {
        "scheme": "FPSE",
        "order": 10,
        "overlap": 3.0,
        "beta": 0.98,
        "half_width": 60.0,
        "spacing": 1.0,
    }
    with pytest.warns(StabilityWarning, match=r"at the ends of the lattice, .* by exp\(10\.59\)"):
        fp.prepare(case(**ends, t_initial=0.0, t_final=1e6))


def test_growth_from_a_kernel_table_is_spoken_of():
    table = {"scheme": "FPSE", "order": 4, "half_width": 60.0, "spacing": 1.0, "kernel_table": 1.0}
    with pytest.warns(StabilityWarning, match="with kernel_table = 1, whatever the time step"):
        fp.prepare(case(**table, t_initial=0.0, t_final=1e3))


def test_a_step_between_the_limit_of_the_matrix_and_that_of_the_symbol_is_spoken_of():
    a = fp.stability_limit("KPSE", 0.98, 12, 8.0)
    steps = {"order": 12, "overlap": 8.0, "beta": 0.98, "half_width": 150.0, "spacing": 1.0}
    with pytest.warns(StabilityWarning, match="lies outside the stability interval"):
        fp.prepare(case(**steps, integrator="rk2", dt=a, t_initial=0.0, t_final=200 * a))


def test_a_step_at_the_limit_itself_is_not_spoken_of():
    lattice = {"half_width": 8.0, "spacing": 1.0, "t_initial": 0.0, "integrator": "rk2"}
    a = case(**lattice, dt=1.0).largest_stable_step
    with warnings.catch_warnings():
        warnings.simplefilter("error", StabilityWarning)
        fp.prepare(case(**lattice, dt=a, t_final=17 * a))
    with pytest.warns(StabilityWarning):
        fp.prepare(case(**lattice, dt=1.001 * a, t_final=17 * 1.001 * a))
