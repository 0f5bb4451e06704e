"""Diffusion alone, with a D that does not change within a step, so that a step may have any length.

A D that depends only on time is 1 in the time

    s = int D(t) dt,    u_s = A u.

If D depends on the place as well, its mean in time is taken at each place, from output time to output time. If these
are many, a mean goes on up to the one at which the run has lasted twice as long. A kink or a jump has spread by
int D dt at its own place, see `frozen`. The operators of two times do not commute; this is left out.

A step may also be longer than the run. Then D is its mean up to an output time, and values outside stay as they are at
first.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np

from fracparticles.problems.expressions import Coefficient
from fracparticles.problems.problem import Problem

__all__ = ["diffused", "doubling", "frozen", "in_own_time", "is_steady"]

_LOOKS = 64  # times from one output time to the next at which D is evaluated

Solve = Callable[[Problem, Any], list[np.ndarray]]


def in_own_time(problem: Problem) -> Problem:
    """Return the problem without its velocity and its source, in the time s if D depends only on time."""
    alone = problem.model_copy(update={"velocity": None, "source": None})
    if alone.diffusion.depends_on != {"t"} or not _is_steady(alone.outside):
        return alone
    times = (alone.t_initial, *alone.output_times)
    s = np.cumsum([(late - early) * _mean(alone, early, late) for early, late in pairwise(times)])
    update = {"diffusivity": 1.0, "t_initial": 0.0, "times": tuple(s), "t_final": float(s[-1])}
    return alone.model_copy(update=update)


def is_steady(problem: Problem) -> bool:
    """Whether neither D nor the values outside depend on time."""
    return _is_steady(problem.diffusion) and _is_steady(problem.outside)


def frozen(problem: Problem, until: float) -> Problem:
    """Return the problem with the mean of D from the start until a time, and the values outside of the start."""
    start, update = problem.t_initial, {}
    if not _is_steady(problem.diffusion):
        update["diffusivity"] = _mean_at_places(problem, start, until)
    if not _is_steady(problem.outside):
        update["exterior_data"] = _at_first(problem)
    return problem.model_copy(update=update)


def diffused(problem: Problem, initial: Any, solve: Solve) -> list[np.ndarray]:
    """Return u at the output times of a problem on a bounded domain without a velocity or a source."""
    if _is_steady(problem.diffusion):
        return solve(problem, initial)
    found: list[np.ndarray] = []
    for start, *later in doubling((problem.t_initial, *problem.output_times)):
        update = {"t_initial": start, "times": tuple(later), "t_final": later[-1]}
        update["diffusivity"] = _mean_at_places(problem, start, later[-1])
        found += solve(problem.model_copy(update=update), found[-1] if found else initial)
    return found


def doubling(times: tuple[float, ...]) -> list[tuple[float, ...]]:
    """Return the times in pieces that share their ends; each ends where the run has lasted twice as long."""
    pieces, start = [], 0
    for n, t in enumerate(times):
        if n == len(times) - 1 or (n and t - times[0] >= 2.0 * (times[start] - times[0])):
            pieces.append(times[start : n + 1])
            start = n
    return pieces


def _is_steady(one: Coefficient | None) -> bool:
    return one is None or "t" not in one.depends_on


def _middles(before: float, after: float) -> np.ndarray:
    return before + (after - before) * (np.arange(_LOOKS) + 0.5) / _LOOKS


def _mean(problem: Problem, before: float, after: float) -> float:
    anywhere = dict.fromkeys(problem.diffusion.variables, 0.0)
    return float(problem.diffusion({**anywhere, "t": _middles(before, after)}).mean())


def _mean_at_places(problem: Problem, before: float, after: float) -> Callable[..., Any]:
    times, d = _middles(before, after), problem.diffusion
    return _of_places(problem, lambda at: sum(d(at | {"t": t}) for t in times) / _LOOKS)


def _at_first(problem: Problem) -> Callable[..., Any]:
    outside, start = problem.outside, problem.t_initial
    assert outside is not None
    return _of_places(problem, lambda at: outside(at | {"t": start}))


def _of_places(problem: Problem, of: Callable[[dict[str, Any]], Any]) -> Callable[..., Any]:
    """Return a function of x, or of x and y, from one of both by name."""

    def on_a_line(x: Any) -> Any:
        return of({"x": x})

    def in_the_plane(x: Any, y: Any) -> Any:
        return of({"x": x, "y": y})

    return on_a_line if problem.dim == 1 else in_the_plane
