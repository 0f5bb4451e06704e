"""Samples of a function, dense where it is curved, from which the first particles are placed.

An interval is halved while its middle is so far off the straight line between its ends that the area between them,
about |u''| d^3 / 12, exceeds a fraction of int |u|. Its neighbours are halved with it, so that no bend is missed.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.errors import InvalidInput

__all__ = ["adapted_samples", "unseen_share", "varying_samples"]

_FIRST = 129  # equally spaced samples, before any interval is halved
_SHARE = 1e-4  # of int |u|: an interval bent by more is halved; samples are then a fifth of l apart
_MOST = 20_000  # samples
_LEVELS = 80  # of halving
_CONSTANT = 1e-12  # of the values: round-off


def adapted_samples(
    f: Callable[[FloatArray], FloatArray], low: float, high: float, seen: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return places from `low` to `high` in ascending order, and f at them.

    Parameters
    ----------
    f : callable
    low, high : float
    seen : array
        Positions that are sampled first, so that narrow features there are found.

    Raises
    ------
    InvalidInput
        If f is not finite, zero everywhere, or so rough that 20000 samples do not do.
    """
    inside = seen[(seen > low) & (seen < high)]
    x = np.unique(np.concatenate([np.linspace(low, high, _FIRST), inside]))
    u = check.sampled("initial", f, x)
    open_ = np.ones(x.size - 1, dtype=bool)
    for _ in range(_LEVELS):
        gaps = np.diff(x)
        middles = x[:-1] + 0.5 * gaps
        open_ &= (middles > x[:-1]) & (middles < x[1:])
        if not open_.any():
            break
        new = check.sampled("initial", f, middles[open_])
        area = np.zeros(gaps.size)
        area[open_] = np.abs(new - 0.5 * (u[:-1] + u[1:])[open_]) * gaps[open_]
        mass = np.trapezoid(np.abs(u), x)
        bent = area > _SHARE * mass
        bent[1:] |= area[:-1] > _SHARE * mass
        bent[:-1] |= area[1:] > _SHARE * mass
        # Both halves of what is bent are looked at again; the rest is done.
        halves = np.repeat(bent, 1 + open_)
        x, u = (
            np.insert(old, np.flatnonzero(open_) + 1, at)
            for old, at in ((x, middles[open_]), (u, new))
        )
        open_ = halves
        if x.size > _MOST:
            raise InvalidInput("initial", f, "a function with bounded bends", "Smooth it.")
    if not np.any(u):
        raise InvalidInput(
            "initial", "zero at all samples", "values that are not zero", "Name where they are."
        )
    return x, u


def varying_samples(
    f: Callable[[FloatArray], FloatArray], low: float, high: float, seen: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return places and f there, as `adapted_samples` does for f less its median, which may be zero everywhere."""
    x = np.unique(np.concatenate([np.linspace(low, high, _FIRST), np.clip(seen, low, high)]))
    values = f(x)
    middle = float(np.median(values))
    if np.ptp(values) <= _CONSTANT * np.abs(values).max():
        return x, np.full(x.size, middle)
    return adapted_samples(lambda x: f(x) - middle, low, high, seen)


def unseen_share(f: Callable[[FloatArray], FloatArray], x: FloatArray, u: FloatArray) -> float:
    """Return the relative change of int |f| if f is also sampled midway between the positions x; u is f at x.

    Raises
    ------
    InvalidInput
        If f is not finite.
    """
    middles = 0.5 * (x[1:] + x[:-1])
    places = np.arange(1, x.size)
    seen = check.sampled("initial", f, middles)
    finer = float(np.trapezoid(np.abs(np.insert(u, places, seen)), np.insert(x, places, middles)))
    return abs(float(np.trapezoid(np.abs(u), x)) - finer) / finer if finer > 0.0 else 0.0
