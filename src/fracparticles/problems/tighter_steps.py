"""The error that the steps in time leave, from the problem on fewer particles with a tenth of the tolerance.

A step keeps its own error within the tolerance. The equation may let this error grow afterwards: at a threshold between
two ends, near a blow-up, or ahead of a front, where u grows from almost nothing. A step may also pass over what a
coefficient does in a short time. A run with a tenth of rtol leaves a tenth of the error, so that the distance of two
such runs is the error of the first, within a tenth of it. Both are on a quarter of the particles along each axis. If
they are far apart, this may be due to the few particles. Then two more runs on half of them decide.

There is nothing to compare if the equation is linear and its coefficients are constant in time: no error grows then.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fracparticles.errors import InvalidInput, NonFiniteSolution
from fracparticles.problems.fewer_particles import (
    SPACE_ERROR,
    Estimates,
    Solve,
    among,
    distance,
    halved,
    quietly,
    with_error,
)
from fracparticles.problems.problem import Problem

__all__ = ["TIME_ERROR", "time_errors", "with_time_error"]

TIME_ERROR = SPACE_ERROR
"""The error over the greatest |u| from which there is a warning."""

_TIGHTER = 0.1  # the tolerance of the second run over that of the first
_FINEST = 1e-12  # the least tolerance of the second run: below, all that changes is round-off
_FINEST_STABILISED = 1e-9  # likewise for rkc2
_QUARTER, _HALF = 2, 1  # halvings of the number of particles


def time_errors(problem: Problem, initial: Any, solve: Solve) -> list[float] | None:
    """Return the relative error at each output time; None if there is nothing to compare.

    Parameters
    ----------
    problem : Problem
    initial : callable, array or None
        The initial data: a function, values at the particles, or nothing.
    solve : callable
        Returns u at each output time for a problem and its initial data.
    """
    finest = _FINEST_STABILISED if problem.integrator == "rkc2" else _FINEST
    steady = problem.is_linear and problem.is_autonomous
    if steady or problem.rtol * _TIGHTER < finest:
        return None
    found = None
    for halvings in (_QUARTER, _HALF):
        apart = _apart(problem, initial, solve, halvings)
        if apart is not None:
            found = apart if found is None else list(np.minimum(found, apart))
        if found is not None and max(found) <= TIME_ERROR:
            break
    return found


def _apart(problem: Problem, initial: Any, solve: Solve, halvings: int) -> list[float] | None:
    """Return the distances of the two runs; None if the first becomes infinite, or a function needs all particles."""
    problem, initial = _on_fewer(problem, initial, halvings)
    tighter: dict[str, float] = {"rtol": problem.rtol * _TIGHTER}
    if problem.atol:
        tighter["atol"] = problem.atol * _TIGHTER
    try:
        first = quietly(solve, problem, initial)
    except (InvalidInput, NonFiniteSolution):
        return None
    try:
        second = quietly(solve, problem.model_copy(update=tighter), initial)
    except NonFiniteSolution:
        return [np.inf] * len(first)
    return [distance(problem, v, u) for u, v in zip(first, second, strict=True)]


def _on_fewer(problem: Problem, initial: Any, halvings: int) -> tuple[Problem, Any]:
    """Return a problem and its data on particles that are halved as often as they can be."""
    for _ in range(halvings):
        try:
            fewer = halved(problem)
        except InvalidInput:  # too few
            break
        if not (initial is None or callable(initial)):
            initial = among(problem, fewer, initial)
        problem = fewer
    return problem, initial


def with_time_error(found: Estimates, *given: Any) -> Estimates:
    """Return the estimates, together with that of `time_errors` if there is one."""
    meaning = "estimated relative error of the steps in time, from fewer particles and a tenth of the tolerance"
    return with_error(found, "time_error", meaning, time_errors(*given))
