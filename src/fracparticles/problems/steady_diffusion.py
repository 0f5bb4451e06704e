"""Diffusion alone, with a D that does not change within a step, so that a step may have any length.

A D that depends only on time is 1 in the time

    s = int D(t) dt,    u_s = A u.

If D depends on the place as well, its mean in time is taken at each place, from output time to output time. If these
are many, a mean goes on up to the one at which the run has lasted twice as long. A kink or a jump has spread by
int D dt at its own place, see `frozen`. The operators of two times do not commute; this is left out.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np

from fracparticles.problems.problem import Problem

__all__ = ["diffused"]

_LOOKS = 64  # times from one output time to the next at which D is evaluated

Solve = Callable[[Problem, Any], list[np.ndarray]]


def diffused(problem: Problem, initial: Any, solve: Solve) -> list[np.ndarray]:
    """Return u at the output times of a problem on a bounded domain, without its velocity and its source."""
    alone = problem.model_copy(update={"velocity": None, "source": None})
    if "t" not in alone.diffusion.depends_on:
        return solve(alone, initial)
    times = (alone.t_initial, *alone.output_times)
    steady_outside = alone.outside is None or "t" not in alone.outside.depends_on
    if steady_outside and alone.diffusion.depends_on == {"t"}:
        s = np.cumsum(
            [(late - early) * _mean(alone, early, late) for early, late in pairwise(times)]
        )
        scaled = {"diffusivity": 1.0, "t_initial": 0.0, "times": tuple(s), "t_final": float(s[-1])}
        return solve(alone.model_copy(update=scaled), initial)
    found: list[np.ndarray] = []
    for start, *later in _doubling(times):
        update = {"t_initial": start, "times": tuple(later), "t_final": later[-1]}
        update["diffusivity"] = _mean_at_places(alone, start, later[-1])
        found += solve(alone.model_copy(update=update), found[-1] if found else initial)
    return found


def _doubling(times: tuple[float, ...]) -> list[tuple[float, ...]]:
    """Return the times in pieces that share their ends; each ends where the run has lasted twice as long."""
    pieces, start = [], 0
    for n, t in enumerate(times):
        if n == len(times) - 1 or (n and t - times[0] >= 2.0 * (times[start] - times[0])):
            pieces.append(times[start : n + 1])
            start = n
    return pieces


def _middles(before: float, after: float) -> np.ndarray:
    return before + (after - before) * (np.arange(_LOOKS) + 0.5) / _LOOKS


def _mean(problem: Problem, before: float, after: float) -> float:
    anywhere = dict.fromkeys(problem.diffusion.variables, 0.0)
    return float(problem.diffusion({**anywhere, "t": _middles(before, after)}).mean())


def _mean_at_places(problem: Problem, before: float, after: float) -> Callable[..., Any]:
    times, d = _middles(before, after), problem.diffusion

    def on_a_line(x: Any) -> Any:
        return sum(d({"x": x, "t": t}) for t in times) / _LOOKS

    def in_the_plane(x: Any, y: Any) -> Any:
        return sum(d({"x": x, "y": y, "t": t}) for t in times) / _LOOKS

    return on_a_line if problem.dim == 1 else in_the_plane
