"""A velocity on a disc of few rings: layers at its edge, waves along the rings that half of its angles do not see."""

from __future__ import annotations

import warnings
from functools import lru_cache

import numpy as np
import pytest

from fracparticles.errors import (
    AccuracyWarning,
    FracparticlesWarning,
    NonFiniteSolution,
    StabilityWarning,
)
from fracparticles.problems.domain_rates import DomainRates
from fracparticles.problems.fewer_particles import among
from fracparticles.problems.problem import Problem
from fracparticles.problems.solve import solve_problem

FIELDS = {"half_width": 1.0, "exterior": "absorbing", "domain": "disc"}
ONTO_A_RING = ("x*(20 - 40*(x**2 + y**2))", "y*(20 - 40*(x**2 + y**2))")
CELLS = ("2.58*sin(pi*x)*cos(pi*y)", "-2.58*cos(pi*x)*sin(pi*y)")


def dome(x, y):
    return (1.0 - x**2 - y**2) ** 2


@pytest.mark.parametrize("rings", [8, 12])
def test_a_layer_that_the_rings_do_not_resolve_is_said_and_adds_nothing(rings):
    """The layer is (1/10)^20 wide, the outermost ring 1e-3 or 1e-4 from the edge: int u^2 falls, as div a = 0.

    Differences that were one-sided at the edge made waves of it that grew, at rates of 2e2 and 2e3.
    """
    problem = Problem(
        **FIELDS, alpha=1.05, particles=rings, velocity=("10 + 0*x", "0*x"), times=(0.05, 0.1), rtol=1e-4
    )  # fmt: skip
    with pytest.warns(AccuracyWarning, match="do not resolve the solution"):
        run = solve_problem(problem, dome, estimate=False)
    norm = problem.bounded_domain.norm
    sizes = [norm(u) for u in (dome(*problem.bounded_domain.points), *run.u.values)]
    assert sizes[0] > sizes[1] > sizes[2]


@pytest.mark.parametrize(("until", "said"), [(0.2, StabilityWarning), (3.0, NonFiniteSolution)])
def test_a_wave_that_grows_where_u_is_pressed_together_is_said_or_refused(until, said):
    """Onto the ring r = 0.7, where eight rings are too few; of the equation int |u| falls."""
    problem = Problem(
        **FIELDS, alpha=1.05, particles=8, velocity=ONTO_A_RING, t_final=until, rtol=1e-3
    )
    found = DomainRates(problem).growth(0.0)
    assert found > 0.0
    expected = pytest.raises if said is NonFiniteSolution else pytest.warns
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        with expected(said, match=rf"grow by exp\({found * until:.3g}\).*presses u together"):
            solve_problem(problem, dome, estimate=False)


@pytest.mark.parametrize(("until", "said"), [(0.2, StabilityWarning), (2.0, NonFiniteSolution)])
def test_one_on_a_square_too(until, said):
    """Into the middle, to a width of (1/30)^20. That it is not resolved was said, but not that it grows."""
    problem = Problem(
        alpha=1.05, half_width=1.0, exterior="absorbing", domain="square", particles=8,
        velocity=("-30*x", "-30*y"), t_final=until,
    )  # fmt: skip
    found = DomainRates(problem).growth(0.0)
    assert found < DomainRates(problem).pressed(0.0)
    expected = pytest.raises if said is NonFiniteSolution else pytest.warns
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        with expected(said, match=rf"grow by exp\({found * until:.3g}\) on the square"):
            solve_problem(problem, lambda x, y: (1.0 - x * x) * (1.0 - y * y), estimate=False)


def test_a_layer_that_they_resolve_is_not_said():
    with warnings.catch_warnings():
        warnings.simplefilter("error", FracparticlesWarning)
        problem = Problem(
            **FIELDS, alpha=1.5, particles=12, velocity=("1 + 0*x", "0*x"), t_final=0.02
        )
        solve_problem(problem, dome)


WAVES = {"alpha": 1.2, "velocity": CELLS, "t_final": 0.237, "rtol": 1e-4}


@lru_cache
def on_forty_rings():
    problem = Problem(**FIELDS, **WAVES, particles=40)
    return problem, solve_problem(problem, dome, estimate=False).u.values


def off_of_forty_rings(few, run):
    """The greatest difference over the greatest of the solution."""
    exact = among(on_forty_rings()[0], few, on_forty_rings()[1])
    return np.abs(run.u.values - exact).max() / exact.max()


@pytest.mark.parametrize("rings", [16, 19, 23])
def test_waves_along_the_rings_are_told_apart_or_said(rings):
    """Half of 19 rings have the same eight angles: they agreed to 0.026 on a u that was off by 0.39."""
    few = Problem(**FIELDS, **WAVES, particles=rings)
    with pytest.warns(AccuracyWarning, match="do not resolve the solution"):
        run = solve_problem(few, dome)
    off = off_of_forty_rings(few, run)
    assert off > 0.1  # else the warning were none
    assert float(run.unresolved_share) < off < 4.0 * float(run.unresolved_share)


def test_where_a_quarter_of_the_rings_is_too_few_half_of_them_say_it_all():
    """Twelve angles and eight: the error of waves that they are too few for is no third of what the two differ by."""
    few = Problem(**FIELDS, **WAVES, particles=24)
    with pytest.warns(AccuracyWarning, match="leave an error"):
        run = solve_problem(few, dome)
    off = off_of_forty_rings(few, run)
    assert off / 2.0 < float(run.space_error) < 2.0 * off
