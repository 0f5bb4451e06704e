"""Contests of two blobs, one far narrower than the other and far away from it, see `fracstudy.blobs`.

Alone they are linear with constant coefficients: who knows the two apart can solve each on a lattice of its own. One
Fourier transform or two lattices cannot do them drawn together or competing. (A frame that shrinks makes one Fourier
transform of the velocity -x, which nobody here is told.)
"""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from scipy.fft import irfft, rfft

from fracparticles.adaptive.follow import Followed, follow
from fracparticles.time.whole_space import evolve
from fracstudy.blobs import Blobs
from scenes.run_times.problem_times.blob_peers import Answer, Circle, State, on_circle, on_elements
from scenes.run_times.problem_times.contest import Contest, Solve

_MARGIN = 60.0  # of one lattice for both, beyond their middle
_ON_CIRCLE = 1e-3  # below, a source at millions of points takes minutes

Field = Callable[[np.ndarray, float], np.ndarray]


class _Part(NamedTuple):
    """Some of u: at places that stand for volumes, and who is in it."""

    x: np.ndarray
    volumes: float | np.ndarray
    u: np.ndarray
    who: tuple[int, ...] = (0, 1)


def two_widths(alpha: float, narrow: float) -> Contest:
    """Two fundamental solutions of mass 1/2, of widths `narrow` and 1, until the first is 2^(1/alpha) times as wide.

    The error is int |u - exact|, of parts the sum of theirs.
    """
    blobs = Blobs(alpha, (narrow, 1.0))
    time = blobs.grown
    evolved = partial(evolve, alpha=alpha, time=time)

    def error(parts: list[_Part]) -> float:
        return float(sum((p.volumes * np.abs(p.u - blobs(p.x, time, p.who))).sum() for p in parts))

    def adaptive(step: float) -> tuple[int, list[_Part]]:
        (state,) = _followed(blobs, blobs, time, step)
        return state.u.size, [_Part(state.particles.x, state.particles.volumes, state.u)]

    def lattice(
        solve: Callable[[np.ndarray, float], np.ndarray], spacing: float
    ) -> tuple[int, list[_Part]]:
        n = round(_MARGIN / spacing)
        x = 0.5 * blobs.distance + spacing * np.arange(-n, n)
        return x.size, [_Part(x, spacing, solve(blobs(x, 0.0), spacing))]

    def superposed(points: int, reach: float) -> tuple[int, list[_Part]]:
        parts = []
        for k, width in enumerate(blobs.widths):
            h = 2.0 * reach * width / points
            x = k * blobs.distance + h * np.arange(-(points // 2), points // 2)
            parts.append(_Part(x, h, evolved(blobs(x, 0.0, (k,)), h), (k,)))
        return 2 * points, parts

    def fourier(u: np.ndarray, h: float) -> np.ndarray:
        k = np.pi / (0.5 * u.size * h) * np.arange(u.size // 2 + 1.0)
        return np.asarray(irfft(np.exp(-time * k**alpha) * rfft(u), u.size))

    one = partial(lattice, evolved)
    ours: dict[str, Solve] = {"adaptive particles": adaptive, "evolve, one lattice": one}
    ours["evolve, two lattices"] = superposed
    return Contest(error, ours, {"Fourier, circle": partial(lattice, fourier)})


def drawn_together(alpha: float, narrow: float) -> Contest:
    """Velocity -x to t = 1, from blobs of widths `narrow` and 1 at 0 and 50."""
    blobs = Blobs(alpha, (narrow, 1.0))
    exact = blobs.drawn_together
    ours = _ours(blobs, exact, velocity=lambda x, t: -x)
    peers = {"Fourier, circle": _circle(blobs, exact, velocity=np.negative)}
    return Contest(_error(exact), ours, peers)


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
    return Contest(_error(exact), _ours(blobs, exact, source=source), peers)


def _followed(blobs: Blobs, exact: Field, times: Any, step: float, **acts: Any) -> list[Followed]:
    where: dict[str, Any] = {"window": blobs.window, "where": (0.0, blobs.distance)}
    return follow(lambda x: exact(x, 0.0), times, alpha=blobs.alpha, step=step, **where, **acts)


def _ours(blobs: Blobs, exact: Field, **acts: Any) -> dict[str, Solve]:
    """The states, and the greatest number of particles at one of the times."""

    def solve(step: float, tolerance: float) -> Answer:
        found = _followed(blobs, exact, [blobs.grown, 1.0], step, tolerance=tolerance, **acts)
        states: list[State] = [(s.time, s.particles.x, s.u, s.particles.volumes) for s in found]
        return max(s.u.size for s in found), states

    return {"adaptive particles": solve}


def _circle(blobs: Blobs, exact: Field, **acts: Any) -> Solve:
    def solve(half_width: float, points: float, tolerance: float) -> Answer:
        circle = Circle(blobs.alpha, 0.5 * blobs.distance, half_width, blobs.widths[0], points)
        return on_circle(circle, lambda x: exact(x, 0.0), [blobs.grown, 1.0], tolerance, **acts)

    return solve


def _error(exact: Field) -> Callable[[list[State]], float]:
    """int |u - exact| over int |exact|, the greater of two times, of which the end alone is easier.

    They are when the narrow one is 2^(1/alpha) times as wide as at the start, and when it is as wide as the other.
    """

    def missed(t: float, x: np.ndarray, u: np.ndarray, volumes: np.ndarray | float) -> float:
        there = exact(x, t)
        return float((volumes * np.abs(u - there)).sum() / (volumes * there).sum())

    return lambda states: max(missed(*state) for state in states)
