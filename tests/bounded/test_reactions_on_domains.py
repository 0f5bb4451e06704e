"""Reactions on an interval: manufactured solutions, closed forms, the front of a constant, blow-up."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.special import gamma

from fracparticles.bounded.disc import Disc
from fracparticles.bounded.interval import Interval
from fracparticles.bounded.square import Square
from fracparticles.errors import InvalidInput, NonFiniteSolution
from fracparticles.problems import Problem, solve_problem
from sweeps import covering


@pytest.mark.parametrize("alpha", [1.1, 1.5, 1.9])
def test_a_manufactured_reaction_with_absorbing_ends(alpha):
    """u = cos(t) (1 - x^2)^(alpha/2) of f = -u^2 + what it takes."""
    line = Interval(alpha=alpha, particles=200)
    shape = (line._unit.left * line._unit.right) ** (0.5 * alpha)

    def source(x, t, u):
        exact = np.cos(t) * shape
        return -np.sin(t) * shape + np.cos(t) * gamma(1.0 + alpha) + exact**2 - u**2

    assert line.react(shape, 1.5, source) == pytest.approx(np.cos(1.5) * shape, abs=2e-7)


def test_decay_multiplies_by_its_factor():
    line = Interval(alpha=1.6, particles=100)
    start = np.cos(0.5 * np.pi * line.x) ** 2
    decayed = line.react(start, 0.7, lambda x, t, u: -0.8 * u, tolerance=1e-10)
    assert decayed == pytest.approx(np.exp(-0.56) * line.evolve(start, 0.7), rel=1e-7, abs=1e-9)


def test_a_constant_follows_the_logistic_law_where_nothing_leaves():
    line = Interval(alpha=1.4, particles=60, exterior="reflecting")
    u = line.react(0.1, 3.0, lambda x, t, u: u * (1.0 - u), tolerance=1e-10)
    assert u == pytest.approx(0.1 * np.exp(3.0) / (0.9 + 0.1 * np.exp(3.0)), rel=1e-8)


def test_a_source_that_does_not_depend_on_u_is_that_of_evolve():
    line = Interval(alpha=1.5, particles=100, exterior="given", ends=(0.0, 3.0))
    ours = line.react(0.2, 0.5, lambda x, t, u: np.sin(3 * t) * x, outside=0.2, tolerance=1e-10)
    exact = line.evolve(0.2, 0.5, source=lambda x, t: np.sin(3 * t) * x, outside=0.2)
    assert ours == pytest.approx(exact, rel=1e-7)


def test_a_solution_that_becomes_infinite_says_when():
    """u' = u^2 from 1/2 where nothing leaves: at t = 2."""
    line = Interval(alpha=1.5, particles=40, exterior="reflecting")
    with pytest.raises(NonFiniteSolution, match=r"stops at t = (1\.99|2)"):
        line.react(0.5, 3.0, lambda x, t, u: u**2, tolerance=1e-6)


def test_what_is_refused():
    line = Interval(alpha=1.5, particles=20)
    for field, call in {
        "source": lambda: line.react(1.0, 1.0, 3.0),
        "time": lambda: line.react(1.0, -1.0, lambda x, t, u: u),
        "outside": lambda: line.react(1.0, 1.0, lambda x, t, u: u, outside=1.0),
    }.items():
        with pytest.raises(InvalidInput, match=f"^{field} = "):
            call()
    with pytest.raises(InvalidInput, match=r"^source = "):
        line.react(1.0, 1.0, lambda x, t, u: u[:3])


@cache
def carried(source=None):
    fields = {"alpha": 1.5, "half_width": 1.0, "exterior": "absorbing", "particles": 32}
    fields |= {"velocity": "1 + x", "times": (0.1, 1.0), "source": source}
    return solve_problem(Problem(**fields), np.cos, estimate=False)


@pytest.mark.parametrize("rate", [3.0, 100.0, 1e6])
def test_a_decay_beside_a_velocity_is_a_factor(rate):
    """exp(-c t) times what there is without it; followed to where it is nothing it took 684 steps, and failed later."""
    plain, run = carried(), carried(f"-{rate}*u")
    fallen = np.exp(-rate * plain.t)
    # By a step's tolerance: the derivatives differ in their last digits.
    assert np.abs(run.u - fallen * plain.u).max() <= 1e-6 * np.abs(fallen * plain.u).max()
    assert int(run.accepted_steps) <= int(plain.accepted_steps) + 2


def test_what_falls_to_nothing_beside_a_velocity_is_followed_to_it():
    """The slope of its source was nothing over nothing."""
    fields = {"alpha": 1.5, "half_width": 1.0, "exterior": "absorbing", "particles": 16}
    fields |= {"velocity": "1 - x**2", "t_final": 1.0, "source": "-1e3*u - u**2", "rtol": 1e-3}
    run = solve_problem(Problem(**fields), np.cos, estimate=False)
    assert np.abs(run.u).max() < 1e-290


# About 1e-300 and 1e300. Powers of two change no digit of the data, and of u none but by the order of sums.
UNITS = [2.0**-998, 2.0**996]


@pytest.mark.parametrize(
    ("unit", "domain"),
    covering(UNITS, [Square(1.5, 8), Disc(1.5, 8, 8), Interval(alpha=1.5, particles=16)]),
)
def test_a_reaction_has_no_unit_of_u(domain, unit):
    """The tolerance was below the least number: of a u of 1e-300 nothing was right, and a square refused it."""

    def given(*place):
        return np.prod([(1.0 - z * z) ** 2 for z in place], axis=0)

    one, other = (
        domain.react(lambda *at, s=s: s * given(*at), 0.1, lambda *at: -60.0 * at[-1])
        for s in (1.0, unit)
    )
    assert np.abs(other / unit - one).max() <= 1e-13 * one.max()


@pytest.mark.parametrize("unit", UNITS)
def test_implicit_steps_have_no_unit_of_u(unit):
    """Of a u of 1e-300 an eighth was wrong with a diffusivity that changes in time."""
    problem = Problem(
        alpha=1.5, exterior="absorbing", half_width=1.0, t_final=0.1, particles=24,
        diffusivity="1 + 0.5*sin(5*t)",
    )  # fmt: skip
    one, other = (
        solve_problem(problem, lambda x, s=s: s * (1.0 - x * x), estimate=False).u.values
        for s in (1.0, unit)
    )
    assert np.abs(other / unit - one).max() <= 1e-13 * one.max()
