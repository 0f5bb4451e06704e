"""Where a function of time changes suddenly: there a run is cut, so that no step passes over what it does not see.

An error-controlled step looks at a few times, and what is on only between them does not exist for it. So the function
is evaluated before the run, at 1025 times that are not equally spaced. Where one of its values changes between two of
these by a tenth of its range, bisection finds the jump, or where it is steepest. What lasts less than a thousandth of
the run is not found.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

__all__ = ["LOOKS", "instant", "irregular_times", "sudden_times"]

Look = Callable[[float], np.ndarray]

LOOKS = 1024
_GOLDEN = 0.6180339887498949  # its multiples make times that are not equally spaced
_SUDDEN = 0.1  # of the range of a value: a larger change between two looks is sudden
_NOTICED = 1e-6  # of the greatest value: a smaller range does not count
_FINEST = 2.0**-36  # of the run
_MOST = 32  # cuts that are found exactly
_MOST_CUTS = 256  # where there are more, at looks that are evenly chosen


def sudden_times(
    look: Look,
    start: float,
    span: float,
    *,
    at_once: Callable[[np.ndarray], np.ndarray] | None = None,
    looks: int = LOOKS,
) -> list[float]:
    """Return the times before and after each sudden change, ascending, after `start` and before `start + span`.

    Parameters
    ----------
    look : callable
        The values at one time, shape (P,).
    start, span : float
    at_once : callable, optional
        The values at times of shape (T, 1), shape (T, P).
    looks : int
        How many intervals are looked at.
    """
    times = irregular_times(start, span, looks)
    values = np.array([look(t) for t in times]) if at_once is None else at_once(times[:, None])
    scale = np.ptp(values, axis=0)
    seen = np.flatnonzero(scale > _NOTICED * np.abs(values).max(initial=0.0))
    if not seen.size:
        return []
    change = np.abs(np.diff(values[:, seen], axis=0)) / scale[seen]
    sudden = np.flatnonzero(change.max(axis=1) > _SUDDEN)
    found: set[float] = set()
    if sudden.size > _MOST:  # it is quick everywhere
        found = set(times[sudden[:: -(-sudden.size // _MOST_CUTS)]].tolist())
        sudden = sudden[:0]
    width = instant(start, span)
    for interval in sudden:
        low, high = times[interval : interval + 2]
        found |= set(_narrowed(look, int(seen[change[interval].argmax()]), low, high, width))
    return sorted(t for t in found if start < t < start + span)


def instant(start: float, span: float) -> float:
    """Return how closely a sudden change is found: no step need be taken in so short a time."""
    return max(_FINEST * span, 64.0 * float(np.spacing(abs(start) + span)))


def irregular_times(start: float, span: float, looks: int = LOOKS) -> np.ndarray:
    """Return times that are not equally spaced, and with both ends, shape (looks + 1,)."""
    k = np.arange(1.0, looks)
    within = (k + 0.5 * (k * _GOLDEN % 1.0)) / looks
    return start + span * np.concatenate([[0.0], within, [1.0]])


def _narrowed(look: Look, one: int, low: float, high: float, width: float) -> tuple[float, float]:
    """Where between two times one of the values changes most, as closely as is asked for."""
    at_low, at_high = look(low)[one], look(high)[one]
    while high - low > width:
        middle = 0.5 * (low + high)
        now = look(middle)[one]
        if abs(now - at_low) > abs(at_high - now):
            high, at_high = middle, now
        else:
            low, at_low = middle, now
    return low, high
