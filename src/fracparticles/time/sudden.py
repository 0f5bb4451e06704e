"""Where a function of time changes suddenly: a run is cut there, so that no step passes over a change unseen.

An error-controlled step evaluates the function at a few times only, and does not see a pulse between them. The function
is therefore evaluated before the run, at 1025 times that are not equally spaced. Where one of its values changes by a
tenth of its range from one of these times to the next, bisection finds the jump, or the steepest place. A pulse shorter
than a thousandth of the run may lie between them. So a function that takes many times at once is evaluated at a million
equally spaced times too, at a few places in turn. Those at one place are compared at the finest spacing, and at 4, 16,
64 and 256 times that: a pulse of any width has a spacing at which it is sudden, and which it fills. Shorter pulses may
not be found.

Many pulses, one after the other, have quiet times between them, from which a step might go on over the next pulses. The
run is cut where each quiet time begins and where it ends, and if this is a jump, within it. A wave has no quiet times:
every step sees it.

A jump must be found to the last digits where u is zero before it. Until u is more than nothing, no step into the jump
is accurate to a share of u.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from contextlib import suppress
from itertools import product
from typing import Any

import numpy as np

__all__ = [
    "LOOKS",
    "changes_of_what_comes",
    "instant",
    "irregular_times",
    "pulses",
    "pulses_at",
    "sudden_times",
]

Look = Callable[[float], np.ndarray]

LOOKS = 1024  # intervals between two looks at the function
_GOLDEN = 0.6180339887498949  # golden ratio - 1: the fractions of its multiples spread the times irregularly
_SUDDEN = 0.1  # share of the range of a value: a larger change between two looks is sudden
_NOTICED = 1e-6  # share of the greatest value: a smaller range does not count
_FINEST = 2.0**-44  # share of the run: how closely a sudden change is found
_MOST = 32  # sudden changes that are found exactly
_FINE = 2**20  # fine looks, at all places together
_STRIDES = (1, 4, 16, 64, 256)  # looks at a place from one to the next with which it is compared
_AT_ONCE = 2**16  # times at each place that are handed to a function at once
# Looks without a sudden change that make a quiet time. A wave that changes by _SUDDEN between two looks has half
# a period of pi / (2 _SUDDEN) = 15.7 looks at most.
_QUIET = 16
_RATES = 16  # intervals between the times at which a source is evaluated for the u that it may make
_SHARES = 1.0, 0.1, 0.01  # of the u that it may make: where it is not valid for so much, for less
_MORE = 1.1  # times the greatest |u| at first: less is no other u
_MOST_CUTS = 256  # cuts at evenly chosen looks, if there are more sudden changes


def sudden_times(
    look: Look,
    start: float,
    span: float,
    *,
    at_once: Callable[[np.ndarray], np.ndarray] | None = None,
    known: Collection[float] = (),
    looks: int = LOOKS,
) -> list[float]:
    """Return the times before and after each sudden change, ascending, from `start` to `start + span`.

    Parameters
    ----------
    look : callable
        The values at one time, shape (P,).
    start, span : float
        The first time and the duration.
    at_once : callable, optional
        The values, shape (T, P), at times of shape (T, 1); it replaces T calls of `look`.
    known : collection of float
        Times of `pulses`, which are returned too.
    looks : int
        The number of intervals between two looks.
    """
    found = list(known)
    times = irregular_times(start, span, looks)
    values = np.array([look(t) for t in times]) if at_once is None else at_once(times[:, None])
    scale = np.ptp(values, axis=0)
    seen = np.flatnonzero(scale > _NOTICED * np.abs(values).max(initial=0.0))
    change = np.abs(np.diff(values[:, seen], axis=0)) / scale[seen]
    sudden = np.flatnonzero(change.max(axis=1, initial=0.0) > _SUDDEN)
    quick = sudden.size > _MOST  # the function changes quickly everywhere
    if quick:
        sudden = sudden[:: -(-sudden.size // _MOST_CUTS)]
    sudden = sudden[_hold_none(found, times[sudden], times[sudden + 1])]
    if quick and at_once is None:  # many calls, so that only the first is found closely
        found += times[sudden[1:]].tolist()
        sudden = sudden[:1]
    most = seen[change[sudden].argmax(axis=1)] if seen.size else sudden

    def values_at(t: np.ndarray) -> np.ndarray:
        if at_once is None:
            return np.array([look(one)[place] for one, place in zip(t, most, strict=True)])
        return np.take_along_axis(at_once(t[:, None]), most[:, None], axis=1)[:, 0]

    low, high, jumps = _narrowed(values_at, times[sudden], times[sudden + 1], instant(start, span))
    if quick:
        found += times[sudden[~jumps]].tolist()
        low, high = low[jumps], high[jumps]
    found += [*low.tolist(), *high.tolist()]
    return sorted(t for t in set(found) if start <= t <= start + span)


def pulses(
    few: Callable[[np.ndarray], np.ndarray], places: int, start: float, span: float
) -> set[float]:
    """Return the times before and after each sudden change that the fine looks see, at the finest spacing that does.

    The looks go from one place to the next.

    Parameters
    ----------
    few : callable
        The values at a few places, shape (T, P), at times of shape (T, P).
    places : int
        P.
    start, span : float
        The first time and the duration.
    """
    # None is a simple share of the run, where a function may take a value between those before and after a jump.
    looks = (np.arange(_FINE - _FINE % places) + _GOLDEN) / _FINE
    times = (start + span * looks).reshape(-1, places)
    parts = [few(times[n : n + _AT_ONCE]) for n in range(0, times.shape[0], _AT_ONCE)]
    values = np.concatenate(parts).T.copy()
    scale = values.max(axis=1) - values.min(axis=1)
    seen = np.flatnonzero(scale > _NOTICED * np.abs(values).max())

    found, flanking = set[float](), set[float]()
    width = instant(start, span)
    for stride, place in product(_STRIDES, seen.tolist()):

        def look(t: np.ndarray, place: int = place) -> np.ndarray:
            return few(np.repeat(t[:, None], places, axis=1))[:, place]

        at, change = times[::stride, place], np.abs(np.diff(values[place, ::stride]))
        sudden = np.flatnonzero(change > _SUDDEN * scale[place])
        if sudden.size > _MOST:  # the function changes as quickly again and again
            quiet = np.flatnonzero(np.diff(sudden) > _QUIET)
            first, last = sudden[np.insert(quiet + 1, 0, 0)], sudden[np.append(quiet, -1)]
            for ends, flanks in ((first, first), (last, last + 1)):
                low, high, jumps = _narrowed(look, at[ends], at[ends + 1], width)
                found.update(
                    *(one.tolist() for one in (low[jumps], high[jumps], at[flanks[~jumps]]))
                )
            return found | flanking
        sudden = sudden[_hold_none(found, at[sudden], at[sudden + 1])]
        low, high, jumps = _narrowed(look, at[sudden], at[sudden + 1], width)
        found.update(low.tolist(), high.tolist())
        # A change that is no jump is steepest within it: the run is cut before and after all of it, too.
        flanking.update(at[sudden[~jumps]].tolist(), at[sudden[~jumps] + 1].tolist())
    return found | flanking


def pulses_at(
    function: Callable[..., Any], place: Sequence[np.ndarray], start: float, span: float
) -> set[float]:
    """Return the pulses of a function of places, arrays of shape (P,), and of time; none if it takes one time only."""
    places = place[0].size

    def few(t: np.ndarray) -> np.ndarray:
        return np.broadcast_to(np.asarray(function(*place, t), dtype=float), t.shape)

    times = np.repeat(irregular_times(start, span, 4)[:, None], places, axis=1)
    try:
        together, alone = few(times), [few(t[None])[0] for t in times]
    except Exception:  # a function that takes one time may raise anything
        return set()
    return pulses(few, places, start, span) if np.array_equal(together, alone) else set()


def changes_of_what_comes(
    changes: Callable[[np.ndarray], Collection[float]],
    rate: Callable[[float, np.ndarray], np.ndarray],
    u: np.ndarray,
    start: float,
    span: float,
) -> set[float]:
    """Return the sudden changes of a source for the u that it may make: where u = 0, what multiplies u is not seen.

    Parameters
    ----------
    changes : callable
        Returns the sudden changes for a u.
    rate : callable
        The source at a time for a u.
    u : array
        The u at first.
    start, span : float
        The run is from `start` to `start + span`.
    """
    try:
        rates = np.array([rate(t, u) for t in irregular_times(start, span, _RATES)])
    except Exception:  # a function of the caller's may raise anything for a u that it never meets
        return set()
    most = np.take_along_axis(rates, np.abs(rates).argmax(axis=0)[None], axis=0)[0]
    for share in _SHARES:
        with np.errstate(all="ignore"):
            later = np.asarray(u + share * span * most)
        if np.abs(later).max() <= _MORE * np.abs(u).max():
            break
        with suppress(Exception):  # u may not come so far
            if np.isfinite(later).all() and np.isfinite(rate(start, later)).all():
                return set(changes(later))
    return set()


def instant(start: float, span: float) -> float:
    """Return how closely a sudden change is found, as a time: no step need be so short."""
    return max(_FINEST * span, 64.0 * float(np.spacing(abs(start) + span)))


def irregular_times(start: float, span: float, looks: int = LOOKS) -> np.ndarray:
    """Return times that are not equally spaced, both ends among them, shape (looks + 1,)."""
    k = np.arange(1.0, looks)
    within = (k + 0.5 * (k * _GOLDEN % 1.0)) / looks
    return start + span * np.concatenate([[0.0], within, [1.0]])


def _hold_none(times: Collection[float], low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return which of the intervals from `low` to `high` hold none of the times."""
    known = np.sort(np.array(list(times)))
    return np.asarray(np.searchsorted(known, low, "left") == np.searchsorted(known, high, "right"))


def _narrowed(
    look: Callable[[np.ndarray], np.ndarray], low: np.ndarray, high: np.ndarray, width: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return two times in each interval, at most `width` apart, between which the value changes most.

    Also return whether most of the change is there: a jump.
    """
    at_low, at_high = look(low), look(high)
    whole = np.abs(at_high - at_low)
    while (high - low).max(initial=0.0) > width:
        middle = 0.5 * (low + high)
        now = look(middle)
        first = np.abs(now - at_low) > np.abs(at_high - now)
        low, at_low = np.where(first, low, middle), np.where(first, at_low, now)
        high, at_high = np.where(first, middle, high), np.where(first, now, at_high)
    return low, high, np.abs(at_high - at_low) > 0.5 * whole
