"""Where coefficients change suddenly in time: there a run is cut, so that no step passes over what it does not see.

An error-controlled step looks at a few times, and what is on only between them does not exist for it. So the
coefficients are evaluated before the run, at some places and at 1025 times that are not equally spaced. Where one
changes between two of these times by a tenth of its range at that place, bisection finds the jump, or where it is
steepest. What lasts less than a thousandth of the run, or happens between the places, is not found.
Of a function on a large lattice there are fewer times, 64 at least.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from fracparticles.errors import InvalidInput
from fracparticles.problems.expressions import Coefficient
from fracparticles.problems.problem import Problem

__all__ = ["sudden_times"]

Index = tuple[Any, ...]
Places = dict[str, np.ndarray]

_LOOKS = 1024
_NUMBERS, _FEWEST = (
    2**21,
    64,
)  # of a function, which is evaluated at all particles: values, and looks
_GOLDEN = 0.6180339887498949
_PLACES = 33  # equally spaced, and as many by the mass of the data
_SUDDEN = 0.1  # of the range at a place
_NOTICED = 1e-6  # of the greatest value, a range that counts
_FINEST = 2.0**-36  # of the run
_MOST = 32  # cuts that are found exactly


def sudden_times(problem: Problem, u0: np.ndarray) -> list[float]:
    """Return the times before and after each sudden change, ascending, between t_initial and t_final.

    Raises
    ------
    InvalidInput
        If a coefficient is not a finite number at one of the times.
    """
    start, end = problem.t_initial, problem.t_final
    lattice = dict(zip(("x", "y"), problem.case.positions, strict=False)) | {"u": u0}
    chosen = _places(u0)
    found: set[float] = set()
    for one in problem.coefficients:
        if "t" not in one.depends_on:
            continue
        at, pick = (
            {name: np.broadcast_to(x, u0.shape)[chosen] for name, x in lattice.items()},
            (...,),
        )
        if not _takes_any_points(one, at, lattice, chosen, np.array(start)):
            at, pick = lattice, chosen
        values, times = _looked_at(one, at, pick, start, problem.span)
        scale = np.ptp(values, axis=0)
        seen = scale > _NOTICED * np.abs(values).max()
        if not seen.any():
            continue
        change = np.abs(np.diff(values[:, seen], axis=0)) / scale[seen]
        sudden = np.flatnonzero(change.max(axis=1) > _SUDDEN)
        if sudden.size > _MOST:  # it is quick everywhere
            found |= set(times[sudden[:: -(-sudden.size // 256)]].tolist())
            continue
        for k in sudden:
            place = np.flatnonzero(seen)[change[k].argmax()]
            found |= set(
                _narrowed(_at_place(one, at, pick, place), times[k], times[k + 1], start, end)
            )
    return sorted(t for t in found if start < t < end)


def _takes_any_points(
    one: Coefficient, at: Places, lattice: Places, chosen: Index, t: np.ndarray
) -> bool:
    """Whether it can be evaluated at some of the particles alone: a function may know no other points than all."""
    if isinstance(one.given, str):
        return True
    try:
        return np.array_equal(
            one(_of(one, at, t)), one(_of(one, lattice, t))[chosen], equal_nan=True
        )
    except InvalidInput:
        return False


def _looked_at(
    one: Coefficient, at: Places, pick: Index, start: float, span: float
) -> tuple[np.ndarray, np.ndarray]:
    """The values at the chosen places, shape (times, places), and the times."""
    looks = max(_FEWEST, min(_LOOKS, _NUMBERS // at["u"].size))
    k = np.arange(1.0, looks)
    within = (k + 0.5 * (k * _GOLDEN % 1.0)) / looks
    times = start + span * np.concatenate([[0.0], within, [1.0]])
    if isinstance(one.given, str):
        return one.checked(_of(one, at, times[:, None])), times
    return np.array([one.checked(_of(one, at, np.array(t)))[pick] for t in times]), times


def _at_place(one: Coefficient, at: Places, pick: Index, place: int) -> Callable[[float], float]:
    if isinstance(one.given, str):
        there = {name: x[place] for name, x in at.items()}
        return lambda t: float(one.checked(_of(one, there, np.array(t))))
    return lambda t: float(one.checked(_of(one, at, np.array(t)))[pick][place])


def _narrowed(
    f: Callable[[float], float], low: float, high: float, start: float, end: float
) -> tuple[float, float]:
    """Where between two times f changes most, as closely as times can be told apart."""
    width = max(_FINEST * (end - start), 64.0 * float(np.spacing(max(abs(start), abs(end)))))
    at_low, at_high = f(low), f(high)
    while high - low > width:
        middle = 0.5 * (low + high)
        now = f(middle)
        if abs(now - at_low) > abs(at_high - now):
            high, at_high = middle, now
        else:
            low, at_low = middle, now
    return low, high


def _places(u0: np.ndarray) -> Index:
    """The indices of some particles: equally spaced, by the mass of the data, and the middle."""
    u = np.abs(u0.reshape(-1))
    equally = np.linspace(0, u.size - 1, _PLACES).astype(int)
    mass = np.cumsum(u / max(float(u.max()), 1e-300))
    by_mass = np.searchsorted(mass, mass[-1] * (np.arange(_PLACES) + 0.5) / _PLACES)
    middle = np.ravel_multi_index(tuple(n // 2 for n in u0.shape), u0.shape)
    some = np.unique(np.concatenate([equally, np.minimum(by_mass, u.size - 1), [middle]]))
    return np.unravel_index(some, u0.shape)


def _of(one: Coefficient, at: Places, t: np.ndarray) -> Places:
    every = {**at, "t": t}
    return {name: every[name] for name in one.variables}
