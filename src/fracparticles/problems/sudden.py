"""Where the coefficients of a problem change suddenly in time, at some of its particles: see `time.sudden`."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from fracparticles.errors import InvalidInput
from fracparticles.problems.expressions import Coefficient
from fracparticles.problems.problem import Problem
from fracparticles.time.sudden import (
    LOOKS,
    changes_of_what_comes,
    instant,
    irregular_times,
    pulses,
    sudden_times,
)

__all__ = ["sudden_changes"]

Index = tuple[Any, ...]
Places = dict[str, np.ndarray]

_PLACES = 33  # particles that are looked at, equally spaced, and as many by the mass of the data
# If a function has to be evaluated at all particles: the most values in all, and the fewest times.
_NUMBERS, _FEWEST = 2**21, 64
_FEW = 0.05, -0.32  # coordinates of the places of the fine looks, in half-widths


def sudden_changes(problem: Problem, u0: np.ndarray) -> list[float]:
    """Return the times before and after each sudden change, ascending, between t_initial and t_final.

    The particles that are looked at are chosen by u0, the initial strengths.

    Values outside a bounded domain are not looked at here: `bounded.given` refuses those that jump.

    Raises
    ------
    InvalidInput
        If a coefficient is not a finite number at one of the times.
    """
    lattice = problem.places | {"u": u0}
    chosen = _places(u0)
    some = {name: np.broadcast_to(x, u0.shape)[chosen] for name, x in lattice.items()}
    found: set[float] = set()
    for one in (problem.diffusion, *problem.transport, problem.reaction):
        if one is not None and "t" in one.depends_on:
            found |= set(_changes(one, problem, lattice, some, chosen))
    source = problem.reaction
    if source is not None and "t" in source.depends_on:
        if not u0.any():
            found |= _beginning(source, problem, lattice)
        if "u" in source.depends_on:
            found |= _of_what_comes(source, problem, lattice, chosen)
    return sorted(found)


def _of_what_comes(
    source: Coefficient, problem: Problem, lattice: Places, chosen: Index
) -> set[float]:
    u0 = lattice["u"]

    def rate(t: float, u: np.ndarray) -> np.ndarray:
        return source.checked(_of(source, lattice | {"u": u}, np.array(t)))

    def changes(u: np.ndarray) -> list[float]:
        later = lattice | {"u": u}
        some = {name: np.broadcast_to(x, u0.shape)[chosen] for name, x in later.items()}
        return _changes(source, problem, later, some, chosen)

    return changes_of_what_comes(changes, rate, u0, problem.t_initial, problem.span)


def _changes(
    one: Coefficient, problem: Problem, lattice: Places, some: Places, chosen: Index
) -> list[float]:
    start, span = problem.t_initial, problem.span

    def at_once(t: Any) -> np.ndarray:
        return one.checked(_of(one, some, np.asarray(t)))

    if isinstance(one.given, str) or _takes_many_times(one, some, start, span):
        if isinstance(one.given, str) and "u" not in one.depends_on:
            given = one.field, one.given, one.variables
            known = _of_a_text(*given, problem.half_width, start, span)
        else:
            places = {name: x[_few_of(x.size)] for name, x in some.items()}
            known = _pulses(one, places, start, span)
        return sudden_times(at_once, start, span, at_once=at_once, known=known)
    if _takes_any_points(one, some, lattice, chosen, np.array(start)):
        return sudden_times(at_once, start, span)
    return sudden_times(
        lambda t: one.checked(_of(one, lattice, np.array(t)))[chosen],
        start,
        span,
        looks=_looks(lattice),
    )


def _beginning(source: Coefficient, problem: Problem, lattice: Places) -> set[float]:
    """Return the times before and after the first at which the source is not zero at some particle, if there is one.

    Until then u is zero, and no step into a jump is accurate to a share of it: see `time.sudden`. The particle may not
    be among those that are looked at, as where an edge moves.
    """
    start, span = problem.t_initial, problem.span

    def is_on(t: float) -> bool:
        return bool(np.any(source(_of(source, lattice, np.array(t))) != 0.0))

    low = start
    for high in irregular_times(start, span, _looks(lattice)):
        if is_on(high):
            break
        low = high
    else:
        return set()
    while high - low > instant(start, span):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if is_on(middle) else (middle, high)
    return {float(low), float(high)}


def _looks(lattice: Places) -> int:
    """Return how many intervals there are between looks at all particles."""
    return max(_FEWEST, min(LOOKS, _NUMBERS // lattice["u"].size))


def _takes_any_points(
    one: Coefficient, some: Places, lattice: Places, chosen: Index, t: np.ndarray
) -> bool:
    """Whether a coefficient can be evaluated at some of the particles: a function may be valid only at all of them."""
    try:
        alone, all_of_them = one(_of(one, some, t)), one(_of(one, lattice, t))
    except InvalidInput:
        return False
    return np.array_equal(alone, all_of_them[chosen], equal_nan=True)


def _takes_many_times(one: Coefficient, some: Places, start: float, span: float) -> bool:
    """Whether a function can be evaluated at many times at once, with the values that it has at each."""
    few = irregular_times(start, span, 4)
    try:
        together = one(_of(one, some, few[:, None]))
        alone = [one(_of(one, some, np.array(t))) for t in few]
    except InvalidInput:
        return False
    return np.array_equal(together, alone, equal_nan=True)


def _places(u0: np.ndarray) -> Index:
    """The indices of some particles: equally spaced, by the mass of the data, and the middle."""
    u = np.abs(u0.reshape(-1))
    equally = np.linspace(0, u.size - 1, _PLACES).astype(int)
    mass = np.cumsum(u / max(float(u.max()), 1e-300))
    by_mass = np.searchsorted(mass, mass[-1] * (np.arange(_PLACES) + 0.5) / _PLACES)
    middle = np.ravel_multi_index(tuple(n // 2 for n in u0.shape), u0.shape)
    some = np.unique(np.concatenate([equally, np.minimum(by_mass, u.size - 1), [middle]]))
    return np.unravel_index(some, u0.shape)


@lru_cache(maxsize=32)
def _of_a_text(
    field: str, text: str, variables: tuple[str, ...], half_width: float, start: float, span: float
) -> frozenset[float]:
    """Return the pulses of a text without u; runs on fewer particles ask for them again."""
    one = Coefficient(field, text, variables)
    places = {name: half_width * np.array(_FEW) for name in variables}
    return _pulses(one, places, start, span)


def _pulses(one: Coefficient, places: Places, start: float, span: float) -> frozenset[float]:
    return frozenset(pulses(lambda t: one.checked(_of(one, places, t)), len(_FEW), start, span))


def _few_of(count: int) -> list[int]:
    """Return as many as `_FEW` of some places: the middle, and one beside it."""
    return [int(share * count) for share in (0.5, 0.68)]


def _of(one: Coefficient, at: Places, t: np.ndarray) -> Places:
    every = {**at, "t": t}
    return {name: every[name] for name in one.variables}
