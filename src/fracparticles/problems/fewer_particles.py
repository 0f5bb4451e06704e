"""The error that the particles leave: a known part, and the rest from the problem on half and a quarter of them.

The known part is the error from the initial data alone, see `frozen` and `finer_particles`. An array may stand for
several data between the particles: then the largest of their errors counts. Before two solutions are compared, the
error of the smoothest of these data is taken off each, if that brings the two closer together. So are the initial data,
if they are a function: at early times u has their kinks and jumps, which no spline follows between the particles.

Let d_1 be the distance between u and the solution on half of the particles along each axis, and d_2 that between half
and a quarter. Each halving of the spacing leaves r = d_1 / d_2 of the distance before. The distances that are still to
come add up to the rest of the error,

    d_1 (r + r^2 + ..) = d_1 r / (1 - r).

For the order p this is d_1 / (2^p - 1). It is taken as d_1 / 32 at least, and as d_1 where r >= 1/2. So kinks and jumps
of a coefficient, where the order is one or two for any kernel, have their own factor. The quarter is solved only if d_1
is large. If not, or if a quarter is too few, the rest is d_1 / 3, as for the order two. On a disc with a velocity it is
d_1, since waves for which the angles are too few have no order. If the solution on half of the particles becomes
infinite, the error is infinite: nothing is known of it.

Fields are compared at the fewer particles, by splines between the others. Their distance is the larger of two: the
greatest |difference| over the greatest |u|, and int |difference| over int |u|. The second sees errors beside a peak at
an end.
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
    "distance",
    "halved",
    "quietly",
    "space_errors",
    "with_error",
    "with_space_error",
]

SPACE_ERROR = 0.03
"""The error over the greatest |u| from which there is a warning."""

_HALVINGS = 2  # runs, each on half of the particles of the one before along each axis
_LEAST, _UNKNOWN = 1 / 32, 1 / 3  # the factor of d_1: the least, and the one if d_2 is not known
# The fewest particles across a domain, rings of a disc, or, on a lattice, from the middle to an end.
_FEWEST = {"interval": 16, "square": 8, "disc": 8, None: 8}
# Half of fewer rings have about as many angles, and do not see the error by the angles.
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
    """Return the relative error at each output time; None if the particles are too few, or a function needs them all.

    The known part is returned even then, if it is large.

    Parameters
    ----------
    problem : Problem
    initial : callable, array or None
        The initial data: a function, values at the particles, or nothing.
    fields : list of arrays
        u at each output time.
    solve : callable
        Returns such a list for a problem and its initial data.
    known : callable
        Returns the known errors at the particles for a problem, its initial data and such a list, see `frozen`.
    """
    apart: list[np.ndarray] = []
    start = _at_start(problem, initial)
    errors = quietly(known, problem, initial, fields)
    least = np.array([
        max((distance(problem, u, u - e) for e in each), default=0.0)
        for u, each in zip(fields, errors, strict=True)
    ])  # fmt: skip
    carried = problem.domain == "disc" and bool(problem.transport)
    for _ in range(0 if carried and _count(problem) < _LEAST_RINGS else _HALVINGS):
        try:
            fewer = halved(problem)
            if not (initial is None or callable(initial)):
                initial = among(problem, fewer, initial)
            coarse = quietly(solve, fewer, initial)
        except InvalidInput:  # too few particles, or a function that is valid only at its own
            break
        except NonFiniteSolution:
            apart.append(np.full(len(fields), np.inf))
            break
        coarse_errors = quietly(known, fewer, initial, coarse)
        coarse_start = _at_start(fewer, initial)
        apart.append(np.array([
            min(
                distance(fewer, among(problem, fewer, u - e - a) + b, v - f)
                for e, f in ((0.0, 0.0), (e, f))
                for a, b in ((0.0, 0.0), (start, coarse_start))
            )
            for u, e, v, f in zip(
                fields, _smoothest(errors), coarse, _smoothest(coarse_errors), strict=True
            )
        ]))  # fmt: skip
        if apart[0].max() <= SPACE_ERROR:
            break
        problem, fields, errors, start = fewer, coarse, coarse_errors, coarse_start
    if not apart:  # the known part is not the whole error: it counts only if it is large
        return list(least) if least.max() > SPACE_ERROR else None
    factor = np.full(len(fields), 1.0 if carried else _UNKNOWN)
    if len(apart) > 1:
        factor = _still_to_come(*apart)
    return list(least + apart[0] * factor)


def _at_start(problem: Problem, initial: Any) -> Any:
    """Return the data at the particles of a bounded domain, if they are a function; zero otherwise."""
    if not (problem.is_bounded and callable(initial)):
        return 0.0
    return np.array(problem.bounded_domain.values("initial", initial))


def _smoothest(errors: list[list[np.ndarray]]) -> list[Any]:
    return [each[0] if each else 0.0 for each in errors]


def quietly(call: Callable[..., list[Any]], *given: Any) -> list[Any]:
    """Call without warnings: the run itself has given them, and some concern places without a particle."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        return call(*given)


def _still_to_come(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return r / (1 - r), r = d_1 / d_2, for each output time; 1 where the quarter tells nothing."""
    known = np.isfinite(second) & (first < 0.5 * second)
    factor = first / np.where(known, second - first, 1.0)
    return np.where(known, np.maximum(factor, _LEAST), 1.0)


def with_space_error(found: Estimates, *given: Any) -> Estimates:
    """Return the estimates, together with that of `space_errors` if there is one."""
    meaning = "estimated relative error, from the waves of the data, and half and a quarter of the particles"
    return with_error(found, "space_error", meaning, space_errors(*given))


def with_error(found: Estimates, name: str, meaning: str, errors: list[float] | None) -> Estimates:
    """Return the estimates, together with that of a name and a meaning if its errors are known."""
    return found if errors is None else found | {name: (errors, meaning)}


def distance(problem: Problem, u: np.ndarray, v: np.ndarray) -> float:
    """Return the distance of two fields, see the module, relative to the first."""
    volumes = problem.bounded_domain.volumes if problem.is_bounded else 1.0
    off, size = np.abs(u - v), np.abs(u)
    greatest = float(size.max()) or 1.0
    whole = float((volumes * (size / greatest)).sum()) or 1.0
    return max(float(off.max()) / greatest, float((volumes * (off / greatest)).sum()) / whole)


def halved(problem: Problem) -> Problem:
    """Return the problem on half as many particles along each axis; raises `InvalidInput` if these are too few."""
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
    """Return the particles across an interval or a square, rings of a disc, or, on a lattice, from the middle on."""
    if problem.is_bounded:
        return problem.bounded_domain.volumes.shape[0]
    return problem.case.x.size // 2


def axes_of(problem: Problem) -> list[tuple[np.ndarray, bool]]:
    """Return for each axis a variable from 0 to 1 in which its particles are equally spaced, and if it is an angle."""
    if not problem.is_bounded:
        return [(np.linspace(0.0, 1.0, problem.case.x.size), False)] * problem.dim
    angle = [False, problem.domain == "disc"]
    shape = problem.bounded_domain.volumes.shape
    return [
        ((np.arange(n) + 0.5 * (not turns)) / n, turns)
        for n, turns in zip(shape, angle, strict=False)
    ]


def among(problem: Problem, fewer: Problem, u: np.ndarray) -> np.ndarray:
    """Return a field of the problem at the fewer particles, by splines along each axis."""
    for axis, ((s, turns), (at, _)) in enumerate(
        zip(axes_of(problem), axes_of(fewer), strict=True)
    ):
        if turns:
            s, u = np.append(s, 1.0), np.concatenate([u, u.take([0], axis)], axis)
        u = CubicSpline(s, u, axis, "periodic" if turns else "not-a-knot")(at)
    return u
