"""Transport by moving particles: exact where they land on the lattice, else of the order of what it is made of."""

from __future__ import annotations

import numpy as np
import pytest

from fracparticles.errors import InvalidInput
from fracparticles.problems import Problem
from fracparticles.problems.moving_particles import solve_with_moving_particles
from fracparticles.special import green

LINE = {"alpha": 1.5, "half_width": 50.0, "spacing": 0.1, "t_initial": 1.0, "t_final": 2.0}


def error(steps: int, exact, remeshing: str = "Lambda3", **fields) -> float:
    problem = Problem(**{**LINE, **fields})
    x = problem.case.x
    u = solve_with_moving_particles(problem, green(x, 1.0, 1.5), steps, remeshing)
    return float(np.abs(u - exact(x)).max() / exact(x).max())


def shifted(x: np.ndarray) -> np.ndarray:
    return green(x - 1.0, 2.0, 1.5)


def test_whole_spacings_are_exact():
    # Of the tails, which are continued about the origin.
    assert error(10, shifted, velocity=1.0) < 2e-6


@pytest.mark.parametrize(("remeshing", "order"), [("Lambda3", 4.0), ("M4'", 3.0)])
def test_a_uniform_field_leaves_the_error_of_the_remeshing(remeshing, order):
    errors = [error(7, shifted, remeshing, velocity=1.0, spacing=h) for h in (0.2, 0.1)]
    assert np.log2(errors[0] / errors[1]) > order - 0.5


def test_the_splitting_is_of_second_order_in_time():
    scale = np.exp(-1.5) + (1.0 - np.exp(-1.5)) / 1.5
    errors = [
        error(n, lambda x: green(x, scale, 1.5), velocity="-x", spacing=0.025) for n in (3, 6)
    ]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.15)


@pytest.mark.parametrize(
    "fields", [{}, {"velocity": 1.0, "source": "-u"}, {"velocity": 1.0, "diffusivity": "1 + t"}]
)
def test_other_problems_are_refused(fields):
    with pytest.raises(InvalidInput, match="problem"):
        solve_with_moving_particles(Problem(**LINE, **fields), np.ones(1001), 3)
