"""Contests of two blobs, one far narrower than the other, that one Fourier transform or two lattices cannot do.

Both, drawn together and competing, run until the narrow one is as wide as the other, see `fracstudy.blobs`. The error
is int |u - exact| over int |exact|, the greater of two times: when the narrow one is 2^(1/alpha) times as wide as at
the start, and at the end. (Who wants the end alone need not resolve it. A frame that shrinks makes one Fourier
transform of the velocity -x, which nobody here is told.)
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from fracparticles.adaptive.follow import Followed, follow
from fracstudy.blobs import Blobs
from scenes.run_times.problem_times.blob_peers import Answer, Circle, State, on_circle, on_elements
from scenes.run_times.problem_times.contest import Contest, Solve

_ON_CIRCLE = 1e-3  # below, a source at millions of points takes minutes

Field = Callable[[np.ndarray, float], np.ndarray]


def drawn_together(alpha: float, narrow: float) -> Contest:
    """Velocity -x to t = 1, from blobs of widths `narrow` and 1 at 0 and 50."""
    blobs = Blobs(alpha, (narrow, 1.0))
    exact = blobs.drawn_together
    return Contest(
        _error(exact),
        {"adaptive particles": _ours(blobs, exact, velocity=lambda x, t: -x)},
        {"Fourier, circle": _circle(blobs, exact, velocity=np.negative)},
    )


def competing(alpha: float, narrow: float) -> Contest:
    """Decay and competition to t = 1, from blobs of widths `narrow` and 1 at 0 and 50."""
    blobs = Blobs(alpha, (narrow, 1.0))
    exact, source = blobs.competing, blobs.competition

    def elements(step: float, tolerance: float) -> Answer:
        # A mesh as good as any: that of the particles at the start, as dense as `step` says.
        (state,) = _followed(blobs, exact, 0.0, step)
        until = [*(narrow * 2.0 ** np.arange(0.0, np.log2(1.0 / narrow))) ** alpha, 1.0]
        count, states = on_elements(
            alpha, lambda x: exact(x, 0.0), state.particles.x, until, tolerance, source
        )
        return count, [states[0], states[-1]]

    peers: dict[str, Solve] = {"elements, graded": elements}
    if narrow > _ON_CIRCLE:
        peers["Fourier, circle"] = _circle(blobs, exact, source=source)
    ours = _ours(blobs, exact, source=source)
    return Contest(_error(exact), {"adaptive particles": ours}, peers)


def _followed(blobs: Blobs, exact: Field, times: Any, step: float, **acts: Any) -> list[Followed]:
    where: dict[str, Any] = {"window": blobs.window, "where": (0.0, blobs.distance)}
    return follow(lambda x: exact(x, 0.0), times, alpha=blobs.alpha, step=step, **where, **acts)


def _ours(blobs: Blobs, exact: Field, **acts: Any) -> Solve:
    """The states, and the greatest number of particles at one of the times."""

    def solve(step: float, tolerance: float) -> Answer:
        found = _followed(blobs, exact, [blobs.grown, 1.0], step, tolerance=tolerance, **acts)
        states: list[State] = [(s.time, s.particles.x, s.u, s.particles.volumes) for s in found]
        return max(s.u.size for s in found), states

    return solve


def _circle(blobs: Blobs, exact: Field, **acts: Any) -> Solve:
    def solve(half_width: float, points: float, tolerance: float) -> Answer:
        circle = Circle(blobs.alpha, 0.5 * blobs.distance, half_width, blobs.widths[0], points)
        return on_circle(circle, lambda x: exact(x, 0.0), [blobs.grown, 1.0], tolerance, **acts)

    return solve


def _error(exact: Field) -> Callable[[list[State]], float]:
    def error(states: list[State]) -> float:
        found = []
        for t, x, u, volumes in states:
            there = exact(x, t)
            found.append(float((volumes * np.abs(u - there)).sum() / (volumes * there).sum()))
        return max(found)

    return error
