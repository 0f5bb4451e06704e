"""The error that the particles leave: what is known of it, and the rest by the problem on half and a quarter of them.

Known is what they make of the initial data alone, see `frozen` and `finer_particles`: the largest such error, where the
data are an array and may be one or the other thing between the particles. That of the smoothest of these is taken off
each u before they are compared, where that brings them together. With d_1 the distance between u and what half of the
particles along each axis make of it, and d_2 that between half and a quarter, each half of the spacing leaves
r = d_1 / d_2 of the distance before. All those that are still to come are the rest of the error,

    d_1 (r + r^2 + ..) = d_1 r / (1 - r),

of an order p d_1 / (2^p - 1), but at least d_1 / 32, and d_1 where r >= 1/2. So kinks and jumps of a coefficient, where
the order is one or two whatever that of the kernels, have their own factor. The quarter is taken only where d_1 is
large; else, or where a quarter is too few, the rest is d_1 / 3, that of the order two, and on a disc with a velocity
d_1, since waves that its angles are too few for have no order. Where half of the particles make something infinite,
nothing is known of the error: it is infinite. Fields are compared where the fewer particles are, by splines between the
others; their distance is the larger of the greatest difference over the greatest |u|, and of int |difference| over
int |u|, which sees what is beside a peak at an end.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from fracparticles.errors import InvalidInput, NonFiniteSolution
from fracparticles.problems.problem import Problem

__all__ = [
    "SPACE_ERROR",
    "Estimates",
    "Solve",
    "among",
    "axes_of",
    "halved",
    "space_errors",
    "with_space_error",
]

SPACE_ERROR = 0.03
"""Of the greatest |u|, an error that is said."""

_HALVINGS = 2
_LEAST, _UNKNOWN = 1 / 32, 1 / 3  # the factor: at least, and where d_2 is not known
_FEWEST = {"interval": 16, "square": 8, "disc": 8, None: 8}
# Of fewer rings, half have about as many angles, and do not see what a velocity makes of those.
_LEAST_RINGS = 24

Estimates = dict[str, tuple[list[float], str]]
Solve = Callable[[Problem, Any], list[np.ndarray]]
Known = Callable[[Problem, Any, list[np.ndarray]], list[list[np.ndarray]]]


def _nothing(problem: Problem, initial: Any, fields: list[np.ndarray]) -> list[list[np.ndarray]]:
    return [[] for _ in fields]


def space_errors(
    problem: Problem,
    initial: Any,
    fields: list[np.ndarray],
    solve: Solve,
    known: Known = _nothing,
) -> list[float] | None:
    """Return the error at each output time; None if there are too few particles, or a function is for these alone.

    Even then an error that is known, and large, is returned.

    Parameters
    ----------
    problem : Problem
    initial : callable, array or None
        The initial data: a function, values at the particles, or nothing.
    fields : list of arrays
        u at each output time.
    solve : callable
        From a problem and its initial data to such a list.
    known : callable
        From these and such a list to the errors at the particles that may be known beforehand, see `frozen`.
    """
    apart: list[np.ndarray] = []
    errors = _quietly(known, problem, initial, fields)
    least = np.array([
        max((_distance(problem, u, u - e) for e in each), default=0.0)
        for u, each in zip(fields, errors, strict=True)
    ])  # fmt: skip
    carried = problem.domain == "disc" and bool(problem.transport)
    for _ in range(0 if carried and _count(problem) < _LEAST_RINGS else _HALVINGS):
        try:
            fewer = halved(problem)
            if not (initial is None or callable(initial)):
                initial = among(problem, fewer, initial)
            coarse = _quietly(solve, fewer, initial)
        except InvalidInput:  # too few particles, or a function that knows its own alone
            break
        except NonFiniteSolution:
            apart.append(np.full(len(fields), np.inf))
            break
        coarse_errors = _quietly(known, fewer, initial, coarse)
        apart.append(np.array([
            min(_distance(fewer, among(problem, fewer, a), b) for a, b in ((u, v), (u - e, v - f)))
            for u, e, v, f in zip(
                fields, _smoothest(errors), coarse, _smoothest(coarse_errors), strict=True
            )
        ]))  # fmt: skip
        if apart[0].max() <= SPACE_ERROR:
            break
        problem, fields, errors = fewer, coarse, coarse_errors
    if not apart:  # what is known is a part of the error alone: said where it is large
        return list(least) if least.max() > SPACE_ERROR else None
    factor = np.full(len(fields), 1.0 if carried else _UNKNOWN)
    if len(apart) > 1:
        factor = _still_to_come(*apart)
    return list(least + apart[0] * factor)


def _smoothest(errors: list[list[np.ndarray]]) -> list[Any]:
    return [each[0] if each else 0.0 for each in errors]


def _quietly(call: Callable[..., list[Any]], *given: Any) -> list[Any]:
    """Call without warnings: the run itself has given them, and some are of places that are no particles."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        return call(*given)


def _still_to_come(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """r / (1 - r), r = d_1 / d_2, of each output time; 1 where a quarter says nothing."""
    known = np.isfinite(second) & (first < 0.5 * second)
    factor = first / np.where(known, second - first, 1.0)
    return np.where(known, np.maximum(factor, _LEAST), 1.0)


def with_space_error(found: Estimates, *given: Any) -> Estimates:
    """Return the estimates with that of `space_errors`, if there is one."""
    errors = space_errors(*given)
    if errors is None:
        return found
    meaning = "estimated relative error, from the waves of the data, and half and a quarter of the particles"
    return found | {"space_error": (errors, meaning)}


def _distance(problem: Problem, u: np.ndarray, v: np.ndarray) -> float:
    volumes = problem.bounded_domain.volumes if problem.is_bounded else 1.0
    off, size = np.abs(u - v), np.abs(u)
    greatest = float(size.max()) or 1.0
    whole = float((volumes * (size / greatest)).sum()) or 1.0
    return max(float(off.max()) / greatest, float((volumes * (off / greatest)).sum()) / whole)


def halved(problem: Problem) -> Problem:
    """The problem on half as many particles along each axis; raises `InvalidInput` if these are too few."""
    half, least = _count(problem) // 2, _FEWEST[problem.domain]
    if half < least:
        raise InvalidInput("particles", half, f"at least {least}", "Take more.")
    if problem.is_bounded:
        return problem.model_copy(update={"particles": half})
    spacing = problem.half_width / half
    try:
        return problem.model_copy(update={"spacing": spacing})
    except InvalidInput as error:
        if error.field != "far_terms":
            raise
    return problem.model_copy(update={"spacing": spacing, "far_terms": None})


def _count(problem: Problem) -> int:
    """Particles across an interval or a square, rings of a disc; on a lattice from the middle to an end."""
    if problem.is_bounded:
        return problem.bounded_domain.volumes.shape[0]
    return problem.case.x.size // 2


def axes_of(problem: Problem) -> list[tuple[np.ndarray, bool]]:
    """For each axis the variable in which its particles are equally spaced, from 0 to 1, and whether it is an angle."""
    if not problem.is_bounded:
        return [(np.linspace(0.0, 1.0, problem.case.x.size), False)] * problem.dim
    angle = [False, problem.domain == "disc"]
    shape = problem.bounded_domain.volumes.shape
    return [
        ((np.arange(n) + 0.5 * (not turns)) / n, turns)
        for n, turns in zip(shape, angle, strict=False)
    ]


def among(problem: Problem, fewer: Problem, u: np.ndarray) -> np.ndarray:
    """Return a field of the problem where the fewer particles are, by splines along each axis."""
    for axis, ((s, turns), (at, _)) in enumerate(
        zip(axes_of(problem), axes_of(fewer), strict=True)
    ):
        if turns:
            s, u = np.append(s, 1.0), np.concatenate([u, u.take([0], axis)], axis)
        u = CubicSpline(s, u, axis, "periodic" if turns else "not-a-knot")(at)
    return u
