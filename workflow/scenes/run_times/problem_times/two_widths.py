"""A contest of two blobs, one far narrower than the other and far away from it: u_t = -(-Laplacian)^(alpha/2) u.

The equation is linear with constant coefficients: who knows the two blobs apart can solve each on a lattice of its own.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.fft import irfft, rfft

from fracparticles.adaptive.follow import follow
from fracparticles.special import green
from fracparticles.time.whole_space import evolve
from scenes.run_times.problem_times.contest import OURS, PEER, Contender, Contest

__all__ = ["two_widths"]

_DISTANCE = 50.0
_MARGIN = 60.0  # of one lattice for both, beyond their middle


class _Part(NamedTuple):
    """Some of u: at places that stand for volumes, and who is in it."""

    x: np.ndarray
    volumes: float | np.ndarray
    u: np.ndarray
    who: tuple[int, ...]


def two_widths(alpha: float, narrow: float) -> Contest:
    """Two fundamental solutions of mass 1/2, of widths `narrow` and 1, until the first is 2^(1/alpha) times as wide.

    The error is int |u - exact|, of parts the sum of theirs.
    """
    widths, time = (narrow, 1.0), narrow**alpha

    def blobs(x: np.ndarray, t: float, who: tuple[int, ...] = (0, 1)) -> np.ndarray:
        return np.asarray(
            sum(0.5 * green(x - k * _DISTANCE, widths[k] ** alpha + t, alpha) for k in who)
        )

    def error(parts: list[_Part]) -> float:
        return float(sum((p.volumes * np.abs(p.u - blobs(p.x, time, p.who))).sum() for p in parts))

    def adaptive(step: float) -> tuple[int, list[_Part]]:
        window = -0.4 * _DISTANCE, 1.6 * _DISTANCE
        (state,) = follow(
            lambda x: blobs(x, 0.0), time, alpha=alpha, window=window, where=(0.0, _DISTANCE), step=step,
        )  # fmt: skip
        return state.u.size, [_Part(state.particles.x, state.particles.volumes, state.u, (0, 1))]

    def lattice(
        solve: Callable[[np.ndarray, float], np.ndarray], spacing: float
    ) -> tuple[int, list[_Part]]:
        n = round(_MARGIN / spacing)
        x = 0.5 * _DISTANCE + spacing * np.arange(-n, n)
        return x.size, [_Part(x, spacing, solve(blobs(x, 0.0), spacing), (0, 1))]

    def superposed(points: int, reach: float) -> tuple[int, list[_Part]]:
        parts = []
        for k, width in enumerate(widths):
            half = reach * width
            h = 2.0 * half / points
            x = k * _DISTANCE + h * np.arange(-(points // 2), points // 2)
            parts.append(_Part(x, h, ours(blobs(x, 0.0, (k,)), h), (k,)))
        return 2 * points, parts

    def ours(u: np.ndarray, h: float) -> np.ndarray:
        return evolve(u, h, alpha=alpha, time=time)

    def fourier(u: np.ndarray, h: float) -> np.ndarray:
        k = np.pi / (0.5 * u.size * h) * np.arange(u.size // 2 + 1.0)
        return np.asarray(irfft(np.exp(-time * k**alpha) * rfft(u), u.size))

    return Contest(
        error,
        {
            "adaptive particles": Contender(OURS, adaptive),
            "evolve, one lattice": Contender(OURS, partial(lattice, ours)),
            "evolve, two lattices": Contender(OURS, superposed),
            "Fourier, circle": Contender(PEER, partial(lattice, fourier)),
        },
    )
