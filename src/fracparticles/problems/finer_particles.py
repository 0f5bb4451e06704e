"""The error of diffusion alone on the particles of a bounded domain, from runs on three times as many.

A kink between the particles has its error from the first moment on. Half of the particles cannot tell it, see `frozen`.
Three times as many along each axis have a third of the error, so that two thirds of it are known. Without a velocity
and a source, and with a steady D, a step may have any length: see `steady_diffusion`.

On three times as many particles a function is given by its mean over each cell, less a twenty-fourth of the second
differences. So the total is that of the function, and where the function is smooth these are its values up to h^4. With
values alone, a jump in the middle third between two of the fewer particles would lie where those place it. What the
means leave out at early times is added, see `within_cells`.

Of an array this is not known. Data like |x|^p with an infinite bend look the same at a third of the spacing, 3^-p as
large, and a shape a third as wide spreads in 3^-alpha of the time. So with d(t) the distance from the run on three
times as many, the error at t is

    sum_k 3^(-k p) d(3^(k alpha) t),

over times up to h^alpha / D; the terms beyond fall by thirds. Of these the last twelve count. Before h^alpha the first
term is too small, because three times as many particles still leave out most of the tip of a root: it was a seventh of
the error.

If a run on three times as many takes more than a second, and the data are rough, n' < n particles are given the same
data. At the same t / h^alpha the error of n particles is (n' / n)^p times theirs. If that time is too long for the
domain, their error is taken at an earlier time, t l^alpha, and falls with the spacing for the rest: as
(n' / n)^(1 + p) l. A jump lies differently between n' particles than between n. So it may lie anywhere there, as in an
array: see `interpolants`. If the data are not rough, nothing is known then: fewer particles may not see how smooth they
are.

A D that depends only on time is 1 in its own time. If D depends on place and time, or values outside on time, the sum
is that of the frozen problem, see `steady_diffusion`, up to the time h^alpha / D. So long the solution depends on the
mean of D about a kink or a jump. Later the time is not scaled, l = 1, and the sum has one term.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from fracparticles import arguments as check
from fracparticles.errors import InvalidInput, NonFiniteSolution
from fracparticles.problems.fewer_particles import Solve, among, axes_of
from fracparticles.problems.interpolants import holds_no_short_waves, interpolants, power
from fracparticles.problems.problem import Problem
from fracparticles.problems.steady_diffusion import (
    diffused,
    doubling,
    frozen,
    in_own_time,
    is_steady,
)
from fracparticles.problems.within_cells import WithinCells

__all__ = ["errors_of_diffusion", "values_of"]

# Particles along an axis, or rings, of which three times as many take a second.
_MOST = {"interval": 300, "square": 32, "disc": 24}
# Rings likewise, where D varies in space: all their modes are in one matrix.
_MOST_IN_ONE = 16
_WRAPPED = 12  # particles by which an angle is continued beyond a turn
_PARTS = 8  # parts of a cell along each axis, in whose middles a function is evaluated
_TERMS = 12  # terms of the sum: towards h^alpha they grow, at first by 3^(alpha - p) each

Terms = list[tuple[float, float]]
"""Times at which a distance is taken, and the factor of each."""


def errors_of_diffusion(
    problem: Problem, initial: Any, fields: list[np.ndarray], solve: Solve
) -> list[list[np.ndarray]]:
    """Return at each output time the errors at the particles, one for each form of the data; none if none is known.

    Parameters
    ----------
    problem : Problem
        A problem on a bounded domain.
    initial : callable or array
        The initial data: a function, or values at the particles, see `interpolants`.
    fields : list of arrays
        u at each output time; the errors are scaled to its size.
    solve : callable
        Returns such a list for a problem and its initial data.
    """
    nothing: list[list[np.ndarray]] = [[] for _ in fields]
    count = fields[0].shape[0]
    few = count // -(-count // _most(problem))
    errors = list(nothing)
    try:
        alone = in_own_time(problem)
        some, many = (alone.model_copy(update={"particles": n}) for n in (few, 3 * few))
        p = _power(problem, values_of(problem, initial))
        if few < count and p is None:
            return nothing
        values = values_of(some, initial) if callable(initial) else among(problem, some, initial)
        given, left_out = [], None
        if callable(initial):
            exact = values_of(many, initial)
            given = [_with_means(many, initial, exact)]
            left_out = WithinCells(many, initial, exact, given[0])
        if few < count or not callable(initial):
            given += _interpolated(some, many, values)
        for run in _runs(some, few / count, p, callable(initial)):
            times = tuple(sorted({t for every in run.terms for t, _ in every}))
            update = {"times": times, "t_final": times[-1]}
            finest = run.problem.model_copy(update=update | {"particles": many.particles})
            made = diffused(run.problem.model_copy(update=update), values, solve)
            finer = [diffused(finest, one, solve) for one in given]
            if left_out is not None:
                each = zip(finer[0], times, strict=True)
                finer[0] = [
                    w + _asked(partial(left_out.after, finest, t), initial) for w, t in each
                ]
            finer = [[among(many, some, w) for w in every] for every in finer]
            sizes = [1.0 if problem.adds else 1.0 / (_greatest(v) or 1.0) for v in made]
            for output, every in zip(run.outputs, run.terms, strict=True):
                terms = [(times.index(t), share) for t, share in every]
                size = 1.0 if problem.adds else _greatest(fields[output])
                errors[output] = [
                    size
                    * _placed(
                        some,
                        problem,
                        sum(share * sizes[n] * (made[n] - w[n]) for n, share in terms),
                    )
                    for w in finer
                ]
    except (InvalidInput, NonFiniteSolution):  # a function that is valid only at its own particles
        return nothing
    return errors


class _Run(NamedTuple):
    """A problem, the output times for which it is solved, and for each of them the terms of the sum."""

    problem: Problem
    outputs: list[int]
    terms: list[Terms]


def _runs(some: Problem, ratio: float, p: float | None, placed: bool) -> Iterator[_Run]:
    """Yield the runs that tell the error at all output times, see the module."""
    start, times = some.t_initial, some.output_times
    if p is None or is_steady(some):
        terms = [_terms(some, t, ratio, p, placed) for t in times]
        yield _Run(some, list(range(len(times))), terms)
        return
    early = 0
    while early < len(times) and times[early] - start < _longest(frozen(some, times[early])):
        early += 1
    for _, *piece in doubling((start, *times[:early])) if early else ():
        outputs, still = [times.index(t) for t in piece], frozen(some, piece[-1])
        yield _Run(still, outputs, [_terms(still, t, ratio, p, placed) for t in piece])
    if early < len(times):
        yield _Run(some, list(range(early, len(times))), [[(t, ratio)] for t in times[early:]])


def _longest(some: Problem) -> float:
    """Return h^alpha / D of a D that does not depend on time."""
    h = float(some.bounded_domain.volumes.max()) ** (1.0 / some.dim)
    greatest = float(np.max(some.diffusion(some.places | {"t": np.array(some.t_initial)})))
    return h**some.alpha / greatest


def _terms(some: Problem, t: float, ratio: float, p: float | None, placed: bool) -> Terms:
    """Return the times at which the distance is taken for an output time, and the factor of each, see the module."""
    if p is None:
        return [(t, ratio)]
    alpha, start = some.alpha, some.t_initial
    most = (_longest(some) / (t - start)) ** (1.0 / alpha)
    wider = float(np.clip(most, 1.0, 1.0 / ratio))
    first = ratio ** (1.0 + p) * wider
    last = 0 if placed or most < wider else int(np.log(most / wider) / np.log(3.0))
    return [
        (start + (t - start) * (wider * 3.0**k) ** alpha, first * 3.0 ** (-k * p))
        for k in range(max(0, last + 1 - _TERMS), last + 1)
    ]


def _with_means(problem: Problem, initial: Any, values: np.ndarray) -> np.ndarray:
    """Return the mean of a function over each cell, less 1/24 of the second differences; at an end its value."""
    axes = axes_of(problem)
    parts = (np.arange(_PARTS) + 0.5) / _PARTS - 0.5
    places = []
    for n, (_, turns) in zip(values.shape, axes, strict=True):
        at = (np.arange(n)[:, None] + parts).ravel()
        places.append(at if turns else np.clip(at, 0.0, n - 1.0))
    points = [
        _splined(problem, np.broadcast_to(x, values.shape), places) for x in problem.places.values()
    ]
    missed = _asked(lambda: check.sampled("initial", initial, *points), initial)
    for axis, n in enumerate(values.shape):
        cells = (*values.shape[:axis], n, _PARTS, *missed.shape[axis + 1 :])
        missed = missed.reshape(cells).mean(axis + 1)
    missed -= values
    for axis, (_, turns) in enumerate(axes):
        beside = np.roll(values, 1, axis) + np.roll(values, -1, axis)
        missed -= (beside - 2.0 * values) / 24.0
        if not turns:
            np.moveaxis(missed, axis, 0)[[0, -1]] = 0.0
    return np.asarray(values + missed)


def _splined(problem: Problem, values: np.ndarray, places: list[np.ndarray]) -> np.ndarray:
    values, places = _unwound(problem, values, places)
    for axis, at in enumerate(places):
        values = CubicSpline(np.arange(values.shape[axis]), values, axis)(at)
    return values


def _most(problem: Problem) -> int:
    in_one = problem.domain == "disc" and problem.diffusion.depends_on - {"t"}
    return _MOST_IN_ONE if in_one else _MOST[str(problem.domain)]


def values_of(problem: Problem, initial: Any) -> np.ndarray:
    """Return the initial data at the particles; raises `InvalidInput` if a function is not valid at these."""
    return _asked(lambda: problem.bounded_domain.values("initial", initial), initial)


def _asked(values: Callable[[], Any], initial: Any) -> np.ndarray:
    try:
        return np.asarray(values())
    except Exception as error:  # a function that is valid only elsewhere may raise anything
        what = "a function of the place"
        raise InvalidInput(
            "initial", initial, what, "Evaluate it where it is asked for."
        ) from error


def _power(problem: Problem, values: np.ndarray) -> float | None:
    turning = _smooth_angles(problem, values)
    return power(values, [axis for axis in range(values.ndim) if axis not in turning])


def _smooth_angles(problem: Problem, values: np.ndarray) -> list[int]:
    return [
        axis
        for axis, (_, turns) in enumerate(axes_of(problem))
        if turns and holds_no_short_waves(values, axis)
    ]


def _interpolated(some: Problem, many: Problem, values: np.ndarray) -> list[np.ndarray]:
    """Return what data with these values at some particles may be at many, see `interpolants`."""
    places = [
        np.round(at * n - 0.5 * (not turns), 9)  # at a particle, without round-off
        for n, (_, turns), (at, _) in zip(values.shape, axes_of(some), axes_of(many), strict=True)
    ]
    for axis in _smooth_angles(some, values):
        n, m = values.shape[axis], places[axis].size
        values = m / n * np.fft.irfft(np.fft.rfft(values, axis=axis), m, axis)
        places[axis] = np.arange(float(m))
    values, places = _unwound(some, values, places)
    return interpolants(values, *places)


def _unwound(
    problem: Problem, values: np.ndarray, places: list[np.ndarray]
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return values continued beyond a turn along each angle, and places among them, in spacings behind the first."""
    places = list(places)
    for axis, (_, turns) in enumerate(axes_of(problem)):
        if turns:
            values = np.pad(values, [(0, 0)] * axis + [(_WRAPPED, _WRAPPED)], "wrap")
            places[axis] = places[axis] + _WRAPPED
    return values, places


def _placed(some: Problem, problem: Problem, error: np.ndarray) -> np.ndarray:
    same = some.particles == problem.bounded_domain.volumes.shape[0]
    return error if same else among(some, problem, error)


def _greatest(u: np.ndarray) -> float:
    return float(np.abs(u).max())
