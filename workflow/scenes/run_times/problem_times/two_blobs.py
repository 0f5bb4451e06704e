"""Contests of two blobs, one far narrower than the other, that one Fourier transform or two lattices cannot do.

Both run until the narrow one is as wide as the other. The error is int |u - exact| over int |exact|, the greater of two
times: when the narrow one is 2^(1/alpha) times as wide as at the start, and at the end. (Who wants the end alone need
not resolve it.)

- A stable process drawn back to the origin, u_t = (x u)_x - (-Laplacian)^(alpha/2) u: the blobs stay stable densities,
  the time (1 - exp(-alpha t)) / alpha older, and come together. (A frame that shrinks makes one Fourier transform of
  it, which nobody here is told.)
- Decay and competition, f = -u + kappa u (exp(-t) B(x, t) - u), B the blobs of the equation without f: exp(-t) B
  again. This is not linear: the blobs cannot be told apart.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from fracparticles.adaptive.follow import follow
from fracparticles.special import green
from scenes.run_times.problem_times.blob_peers import Answer, Circle, State, on_circle, on_elements
from scenes.run_times.problem_times.contest import OURS, PEER, Contender, Contest

__all__ = ["competing", "drawn_together"]

_DISTANCE = 50.0
_WINDOW = -0.4 * _DISTANCE, 1.6 * _DISTANCE
_KAPPA = 10.0
_ON_CIRCLE = 1e-3  # below, a source at millions of points takes minutes

Field = Callable[[np.ndarray, float], np.ndarray]


def drawn_together(alpha: float, narrow: float) -> Contest:
    """Velocity -x to t = 1, from blobs of widths `narrow` and 1 at 0 and 50."""
    times = [narrow**alpha, 1.0]

    def exact(x: np.ndarray, t: float) -> np.ndarray:
        past, shrunk = -np.expm1(-alpha * t) / alpha, np.exp(-alpha * t)
        first = green(x, narrow**alpha * shrunk + past, alpha)
        second = green(x - _DISTANCE * np.exp(-t), shrunk + past, alpha)
        return np.asarray(0.5 * first + 0.5 * second)

    def ours(step: float, tolerance: float) -> Answer:
        return _followed(alpha, exact, times, step, tolerance, velocity=lambda x, t: -x)

    def circle(half_width: float, points: float, tolerance: float) -> Answer:
        grid = Circle(alpha, 0.5 * _DISTANCE, half_width, narrow, points)
        return on_circle(grid, lambda x: exact(x, 0.0), times, tolerance, velocity=np.negative)

    return Contest(
        _error(exact),
        {
            "adaptive particles": Contender(OURS, ours),
            "Fourier, circle": Contender(PEER, circle),
        },
    )


def competing(alpha: float, narrow: float) -> Contest:
    """Decay and competition to t = 1, from blobs of widths `narrow` and 1 at 0 and 50."""
    times = [narrow**alpha, 1.0]

    def exact(x: np.ndarray, t: float) -> np.ndarray:
        first = green(x, narrow**alpha + t, alpha)
        return np.asarray(0.5 * np.exp(-t) * (first + green(x - _DISTANCE, 1.0 + t, alpha)))

    def source(x: np.ndarray, t: float, u: np.ndarray) -> np.ndarray:
        return np.asarray(u * (_KAPPA * (exact(x, t) - u) - 1.0))

    def ours(step: float, tolerance: float) -> Answer:
        return _followed(alpha, exact, times, step, tolerance, source=source)

    def circle(half_width: float, points: float, tolerance: float) -> Answer:
        grid = Circle(alpha, 0.5 * _DISTANCE, half_width, narrow, points)
        return on_circle(grid, lambda x: exact(x, 0.0), times, tolerance, source=source)

    def elements(step: float, tolerance: float) -> Answer:
        # A mesh as good as any: that of the particles at the start, as dense as `step` says.
        (state,) = follow(
            lambda x: exact(x, 0.0), 0.0, alpha=alpha, window=_WINDOW, where=(0.0, _DISTANCE), step=step
        )  # fmt: skip
        nodes = state.particles.x
        until = [*(narrow * 2.0 ** np.arange(0.0, np.log2(1.0 / narrow))) ** alpha, 1.0]
        count, states = on_elements(alpha, lambda x: exact(x, 0.0), nodes, until, tolerance, source)
        return count, [states[0], states[-1]]

    contenders = {
        "adaptive particles": Contender(OURS, ours),
        "elements, graded": Contender(PEER, elements),
    }
    if narrow > _ON_CIRCLE:
        contenders["Fourier, circle"] = Contender(PEER, circle)
    return Contest(_error(exact), contenders)


def _followed(
    alpha: float, exact: Field, times: list[float], step: float, tolerance: float, **acts: Any
) -> Answer:
    """The states, and the greatest number of particles at one of the times."""
    found = follow(
        lambda x: exact(x, 0.0), times, alpha=alpha, window=_WINDOW, where=(0.0, _DISTANCE), step=step,
        tolerance=tolerance, **acts,
    )  # fmt: skip
    states: list[State] = [(s.time, s.particles.x, s.u, s.particles.volumes) for s in found]
    return max(s.u.size for s in found), states


def _error(exact: Field) -> Callable[[list[State]], float]:
    def error(states: list[State]) -> float:
        found = []
        for t, x, u, volumes in states:
            there = exact(x, t)
            found.append(float((volumes * np.abs(u - there)).sum() / (volumes * there).sum()))
        return max(found)

    return error
