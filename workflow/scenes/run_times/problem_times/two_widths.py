"""A contest of two blobs, one far narrower than the other and far away from it: u_t = -(-Laplacian)^(alpha/2) u.

The equation is linear with constant coefficients: who knows the two blobs apart can solve each on a lattice of its own.
"""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from scipy.fft import irfft, rfft

from fracparticles.adaptive.follow import follow
from fracparticles.time.whole_space import evolve
from fracstudy.blobs import Blobs
from scenes.run_times.problem_times.contest import Contest, Solve

_MARGIN = 60.0  # of one lattice for both, beyond their middle


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

    def error(parts: list[_Part]) -> float:
        return float(sum((p.volumes * np.abs(p.u - blobs(p.x, time, p.who))).sum() for p in parts))

    def adaptive(step: float) -> tuple[int, list[_Part]]:
        where: dict[str, Any] = {"window": blobs.window, "where": (0.0, blobs.distance)}
        (state,) = follow(lambda x: blobs(x, 0.0), time, alpha=alpha, step=step, **where)
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

    def evolved(u: np.ndarray, h: float) -> np.ndarray:
        return evolve(u, h, alpha=alpha, time=time)

    def fourier(u: np.ndarray, h: float) -> np.ndarray:
        k = np.pi / (0.5 * u.size * h) * np.arange(u.size // 2 + 1.0)
        return np.asarray(irfft(np.exp(-time * k**alpha) * rfft(u), u.size))

    ours: dict[str, Solve] = {
        "adaptive particles": adaptive,
        "evolve, one lattice": partial(lattice, evolved),
        "evolve, two lattices": superposed,
    }
    peers = {"Fourier, circle": partial(lattice, fourier)}
    return Contest(error, ours, peers)
