"""The error that the particles leave, as half and a quarter of them say."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from fracparticles.errors import AccuracyWarning, NonFiniteSolution
from fracparticles.problems import Problem, solve_problem
from fracparticles.problems.fewer_particles import _still_to_come, space_errors
from fracparticles.special import green
from sweeps import covering

LINE = {"alpha": 1.5, "half_width": 20.0, "t_final": 0.5}
ENDS = {"alpha": 1.5, "half_width": 1.0, "exterior": "absorbing", "t_final": 0.1}


def bell(*place):
    return np.exp(-8.0 * sum(x * x for x in place))


def tent(x):
    return np.maximum(0.0, 1.0 - np.abs(x - 0.8))


@pytest.mark.parametrize(("order", "spacing"), covering([2, 4], [0.2, 0.1]))
def test_it_is_the_error_of_a_known_solution(order, spacing):
    """With d_2 it is that of the order p, without (2^p - 1) / 3 of it: from 1 to 5."""
    problem = Problem(
        **{**LINE, "t_initial": 1.0, "t_final": 1.5}, spacing=spacing, order=order, velocity=1.0
    )
    run = solve_problem(problem)
    exact = green(run.x.values - 0.5, 1.5, 1.5)
    error = np.abs(run.u.values - exact).max() / exact.max()
    assert 0.5 * error < float(run.space_error) < 5.0 * error


def test_a_source_that_jumps_in_space_warns():
    """Nothing else saw it. The reference has a quarter of the spacing: at order one it is off by a third at most."""
    fields = {**LINE, "t_final": 0.1, "order": 12, "source": "where(x > 0.79, -5*u, 0)"}
    fields |= {
        "form": "exchange",
        "diffusivity": "1.001 + tanh(x - 0.79)",
        "velocity": "x/(1 + x**2)",
    }
    with pytest.warns(AccuracyWarning, match="leave an error of about") as caught:
        run = solve_problem(Problem(**fields, spacing=0.1), tent)
    assert not [one for one in caught if "leave an error" not in str(one.message)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fine = solve_problem(Problem(**fields, spacing=0.025), tent)
    error = np.abs(run.u.values - fine.u.values[::4]).max() / fine.u.values.max()
    assert error / 3.0 < float(run.space_error) < 3.0 * error


@pytest.mark.parametrize(
    ("domain", "places", "particles"), [("interval", 1, 64), ("square", 2, 24), ("disc", 2, 32)]
)
def test_it_is_that_of_more_particles_on_a_domain(domain, places, particles):
    """Half of the particles are some 2^-p better, p two or more; they are compared by their greatest values."""
    fields = {**ENDS, "domain": domain, "velocity": ("-2*y", "2*x") if places == 2 else "2*x"}

    def shifted(*place):
        return bell(place[0] - 0.2, *place[1:])

    one = solve_problem(Problem(**fields, particles=particles), shifted)
    two = solve_problem(Problem(**fields, particles=2 * particles), shifted)
    assert 0.0 < float(two.space_error) < 0.5 * float(one.space_error) < 0.03
    off = abs(float(one.u.max() - two.u.max())) / float(two.u.max())
    # The greatest of other particles is lower by the bend of u between them.
    assert off < float(one.space_error) + 8.0 / particles**2 * 16.0


def test_layers_that_the_particles_resolve_are_no_reason_to_warn():
    """Beside an end that u is carried to, the fast modes hold much of u, and the particles are graded for that."""
    fields = {**ENDS, "exterior": "given", "alpha": 1.1, "diffusivity": 0.05, "t_final": 0.01}
    fields |= {"exterior_data": "cos(3*t)", "velocity": "5*sin(pi*x)", "source": "5*u*(1 - u)"}
    with warnings.catch_warnings():
        warnings.simplefilter("error", AccuracyWarning)
        run = solve_problem(Problem(**fields, particles=100), bell)
    assert float(run.unresolved_share) > 0.02


@pytest.mark.parametrize(
    "fields",
    [
        {
            **LINE,
            "spacing": 0.1,
            "source": lambda x, t: np.ones(401) * bell(np.linspace(-20, 20, 401)),
        },
        {**ENDS, "particles": 24},
    ],
)
def test_where_there_is_nothing_to_compare_it_is_left_out(fields):
    assert "space_error" not in solve_problem(Problem(**fields), bell)


def test_data_that_know_their_own_particles_are_no_reason_to_fail():
    """Whatever they raise at others; what the package raises is not hidden."""
    problem = Problem(**ENDS, particles=64)

    def own(x):
        assert x.size != 32
        return bell(x)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert "space_error" not in solve_problem(problem, own)

    def broken(problem, initial):
        raise RuntimeError

    # A diffusivity, too, which is asked for on three times as many.
    def of_these(x):
        assert x.size != 192
        return 1.0 + 0.0 * x

    solve_problem(Problem(**ENDS | {"diffusivity": of_these}, particles=64), bell)
    u = problem.bounded_domain.values("u", bell)
    with pytest.raises(RuntimeError):
        space_errors(problem, bell, [u], broken)


def test_where_half_of_the_particles_make_something_infinite_nothing_is_known():
    def blows_up(problem, initial):
        raise NonFiniteSolution("the solution stops")

    problem = Problem(**ENDS, particles=64)
    u = problem.bounded_domain.values("u", bell)
    assert space_errors(problem, bell, [u, u], blows_up) == [np.inf, np.inf]


@pytest.mark.parametrize(
    ("first", "second", "factor"),
    [
        (1.0, 4.0, 1.0 / 3.0),
        (1.0, 2.0, 1.0),
        (1.0, 1.0, 1.0),
        (1.0, 1e3, 1 / 32),
        (0.0, 0.0, 1.0),
        (1.0, np.inf, 1.0),
    ],
)
def test_what_is_still_to_come_is_a_geometric_series(first, second, factor):
    """Of the order p 1 / (2^p - 1): a third of the order two, all of the order one; where it does not fall, all."""
    assert _still_to_come(np.array([first]), np.array([second])) == pytest.approx([factor])


def test_a_far_field_of_more_terms_needs_no_lattice_that_fewer_particles_have_not():
    """Seven smoothing lengths of half of the particles are too few for the powers, and not for a comparison."""
    fields = {"alpha": 1.5, "half_width": 15.0, "spacing": 0.2, "order": 2, "far_terms": 3}
    fields |= {"t_initial": 0.2, "t_final": 0.25, "velocity": 1.0}
    run = solve_problem(Problem(**fields))
    exact = green(run.x.values - 0.05, 0.25, 1.5)
    error = np.abs(run.u.values - exact).max() / exact.max()
    assert float(run.space_error) > 0.5 * error


@pytest.mark.parametrize("fields", [{**LINE, "spacing": 0.1}, {**ENDS, "particles": 64}])
def test_values_instead_of_a_function_say_the_same(fields):
    problem = Problem(**fields)
    u0 = bell(problem.places["x"])
    by_values, by_function = (solve_problem(problem, one).space_error for one in (u0, bell))
    # A spline through the values at spacing h is off by h^4 / 16 or so of the fourth derivative.
    assert np.abs(by_values - by_function).max() < 1e-3


def test_other_units_and_sizes_change_nothing():
    run = solve_problem(Problem(**ENDS, particles=64, diffusivity="1 + x/2"), bell)
    faint = solve_problem(
        Problem(**ENDS, particles=64, diffusivity="1 + x/2"), lambda x: 1e-200 * bell(x)
    )
    assert float(faint.space_error) == pytest.approx(float(run.space_error), rel=1e-6)


def test_a_peak_at_an_end_hides_nothing_of_the_inside():
    """u is carried to the walls; the particles know its peak there to a hundredth, and int |u| not to a tenth."""
    fields = {**ENDS, "exterior": "reflecting", "alpha": 1.001, "form": "exchange", "t_final": 0.5}
    fields |= {"diffusivity": "0.05*(0.05 + abs(x + 0.475))", "velocity": "5*sin(pi*x)"}
    fields |= {"source": "5*u*(1 - u)*(u - 0.3)", "rtol": 1e-4}
    with pytest.warns(AccuracyWarning, match="leave an error of about"):
        solve_problem(Problem(**fields, particles=80), lambda x: np.abs(x + 0.475))
