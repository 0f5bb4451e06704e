"""An estimate of the error of a run whose exact solution is not known.

The equation can be solved without particles: by the exact symbol, with one pair of transforms on the whole space
(`time.whole_space`). Its spacing is halved and its lattice widened until both together change this solution by less
than a third of the error that is estimated. It is then the reference. Three steps lead from it to the run, each with
one more assumption:

    spacing   the symbol of the scheme on the infinite lattice instead of the exact one: spacing, order, overlap
    domain    the scheme on its bounded lattice, with its assumption beyond: half-width and exterior
    time      the steps of the integrator instead of the exponential

Each part is the distance of two neighbours, and the total is the distance of the run from the reference, all relative
and in the 1-norm. Parts of opposite sign may cancel, so that the total is at most their sum. `reference` is the last
change of the reference, and `data` the error that measured data leave open between their points and beyond them.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from fracparticles.data.interpolated import Measured
from fracparticles.errors import AccuracyWarning, FracparticlesWarning, InvalidInput
from fracparticles.run.case import FUNDAMENTAL, Case, a_case
from fracparticles.run.initial import Initial, resolved
from fracparticles.run.prepared import scheme_amplification
from fracparticles.run.solution import Solution
from fracparticles.run.solver import compute
from fracparticles.special.stable import green
from fracparticles.time.whole_space import WholeSpace

__all__ = ["ErrorEstimate", "estimate_error", "estimate_of", "estimates_of"]

Data = Callable[..., np.ndarray]

_CLEAR = 0.3  # share of the total: the last change of the reference must be smaller
_MOST_POINTS = 5_000_000  # of the reference
_UNSETTLED = 0.5  # share of the total: a larger last change is warned of
_TERMS = {1: 4, 2: 4, 3: 2}  # of the tail that continues the reference, by dimension
# The width of the narrow reference over that of the lattice: its ends must not count in the error of the spacing.
_ROOM = {1: 4.0, 2: 2.0, 3: 1.0}
_EIGHTHS = 8  # it divides the half-width: tails are then fitted at the same places at any spacing
_FAR = 1e4  # distance, in half-widths, at which the power is found by which data fall
_FALLEN = 1e-13  # share of the greatest value: data that are smaller far out have ended
_ROUND_OFF = 1e-11  # a total below it is round-off
_DEGREE = 7  # of the spline through bare arrays


@dataclass(frozen=True)
class ErrorEstimate:
    """The estimated relative error of a run at its final time, in the 1-norm, and its parts.

    Attributes
    ----------
    total : float
        The estimate.
    spacing, domain, time : float
        The errors by the spacing of the lattice, its ends, and the time steps; see the module.
    data : float
        The error that measured data leave open; it is part of the total.
    reference : float
        The uncertainty of the estimate itself.
    within : float
        The error is taken over |x| <= within.
    """

    total: float
    spacing: float
    domain: float
    time: float
    data: float
    reference: float
    within: float

    @property
    def parts(self) -> dict[str, float]:
        """The parts by name, the largest first."""
        named = {name: float(getattr(self, name)) for name in ("spacing", "domain", "time", "data")}
        return dict(sorted(named.items(), key=lambda item: -item[1]))

    @property
    def remedy(self) -> str:
        """The change of the case or of the data that would lower the largest part."""
        return {
            "spacing": "a smaller spacing, or a higher order",
            "domain": "a wider lattice",
            "time": "a smaller dt, or integrator='exponential'",
            "data": "more points, or farther out",
        }[next(iter(self.parts))]

    def __str__(self) -> str:
        parts = ", ".join(f"{name} {value:.1e}" for name, value in self.parts.items() if value)
        return f"estimated error {self.total:.1e} ({parts or 'none'})"


def estimate_error(
    case: Case, initial: Initial | None = None, *, within: float | None = None
) -> ErrorEstimate:
    """Return an estimate of the relative error of a run at t_final, made as the module says.

    It costs the run itself and some transforms. For several output times the estimate is that of the last one; for
    another time, call ``estimate_error(case.until(time), initial)``.

    Parameters
    ----------
    case : Case
    initial : as for `solve`
        Functions and tables are evaluated between the particles and beyond the lattice. Bare arrays are continued by a
        spline between the particles and by |x|^(-n-alpha) beyond; the estimate then holds for such data.
    within : float, optional
        The error is taken over |x| <= within. Left out, it is taken over the whole lattice, but for a run from the
        fundamental solution and on graded particles within the radius of Eqs. (47), (59).

    Raises
    ------
    InvalidInput
        As `solve`.
    """
    source = resolved(a_case(case), initial)
    return estimate_of(compute(case, source), source, within)


def estimate_of(
    solution: Solution,
    source: Initial,
    within: float | None = None,
    most: int = _MOST_POINTS,
    enough: float = _ROUND_OFF,
) -> ErrorEstimate:
    """Return the estimate for a run that is done, from these initial data.

    The reference has at most `most` points, and is not improved once it changes by less than `enough`, however small
    the error.
    """
    case, data = solution.case, _function(solution, source)
    if within is None:
        standard = case.is_graded or (isinstance(source, str) and source == FUNDAMENTAL)
        within = case.error_radius if standard else case.reach
    distance = _Distance(case, within)
    truth = _Truth(case, data, distance, most)
    known, change = truth.beside(solution.u, enough)
    total = distance(solution.u, known)
    time = domain = 0.0
    exact_in_time = solution.u
    if case.kind.moving:
        finer = _quietly(_changed(case, dt=0.5 * case.time_step), source)
        time = 4.0 / 3.0 * distance(solution.u, finer)
    elif case.steps and not case.kind.self_timed:
        plain = _changed(case, integrator="exponential", dt=None, evaluation=None)
        exact_in_time = _quietly(plain, source)
        time = distance(solution.u, exact_in_time)
    if case.is_graded or case.kind.moving:
        spacing = max(0.0, total - time)
    else:
        infinite = truth.of_the_scheme()
        spacing, domain = distance(infinite, known), distance(exact_in_time, infinite)
    measured = source.error if isinstance(source, Measured) else 0.0
    if change > _UNSETTLED * min(total, 1.0) and total > _ROUND_OFF:
        warnings.warn(
            f"the estimate of the error, {max(total, change):.1g}, is uncertain: its reference still changes by "
            f"{change:.1g}. The data vary over far shorter lengths than the spacing, or fall too slowly.",
            AccuracyWarning,
            stacklevel=3,
        )
    whole = max(total, change) + measured
    return ErrorEstimate(whole, spacing, domain, time, measured, change, within)


def estimates_of(solution: Solution, source: Initial) -> list[ErrorEstimate]:
    """Return the estimate for each output time of a run that is done, or for its final one."""
    if solution.outputs is None:
        return [estimate_of(solution, source)]
    pairs = zip(solution.outputs.times, solution.outputs.u, strict=True)
    return [
        estimate_of(replace(solution, case=solution.case.until(time), u=u, outputs=None), source)
        for time, u in pairs
    ]


class _Distance:
    """sum V |u - v| / sum V |v| over the particles within a radius."""

    def __init__(self, case: Case, within: float) -> None:
        self._inside = case.radius <= within * (1.0 + 1e-12)
        if not self._inside.any():
            raise InvalidInput(
                "within", within, "a radius that holds particles", "Take a larger one."
            )
        self._volumes = np.broadcast_to(case.volumes, case.shape)[self._inside]
        self.radius = float(case.radius[self._inside].max())

    def __call__(self, u: np.ndarray, v: np.ndarray) -> float:
        size = float((self._volumes * np.abs(v[self._inside])).sum())
        apart = float((self._volumes * np.abs((u - v)[self._inside])).sum())
        return apart / size if size > 0.0 else apart


class _Truth:
    """The reference: the exact symbol on lattices that hold that of the case, finer ones and wider ones.

    The errors by spacing and by width add up, so that no lattice need be both fine and wide. If R(f, w) is the solution
    with the spacing h / f and the half-width w h, the reference is R(1, w) + R(f, w0) - R(1, w0).
    """

    def __init__(self, case: Case, data: Data, distance: _Distance, most: int) -> None:
        self._case, self._data, self._distance = case, data, distance
        spread = (case.diffusivity * case.span) ** (1.0 / case.alpha)
        half = max(0.0 if case.is_graded else case.reach, 2.0 * distance.radius, 4.0 * spread)
        self._h = case.particle_spacing
        eighth = np.ceil(_ROOM[case.dim] * half / self._h / _EIGHTHS)
        self._least = _EIGHTHS * int(eighth)  # w0
        self._fine, self._wide = 2, 2 * self._least
        self._most = max(most, 8 * case.particles)
        self._tail = _tail(data, case)
        self._reached = lru_cache(maxsize=4)(self._at_particles)

    def beside(self, u: np.ndarray, enough: float) -> tuple[np.ndarray, float]:
        """Return the reference at the particles, and its last change: `enough`, or small beside its distance from u."""
        best = self._combined(self._fine, self._wide)
        changes: dict[str, float] = {}
        growing = {"width", "fineness"}
        while growing:
            clear = 0.5 * max(enough, _CLEAR * min(1.0, self._distance(u, best)))
            # The one that was not tried goes first, then the one that changed more.
            name = max(growing, key=lambda name: (changes.get(name, np.inf), name))
            if changes.get(name, np.inf) <= clear:
                break
            grown = self._scaled(name, 2.0)
            if self._points(*grown) > self._most:
                growing.remove(name)
                if name not in changes:  # its last doubling changed as much, or more
                    changes[name] = self._distance(self._combined(*self._scaled(name, 0.5)), best)
                continue
            better = self._combined(*grown)
            changes[name] = self._distance(best, better)
            (self._fine, self._wide), best = grown, better
        return best, sum(changes.values())

    def of_the_scheme(self) -> np.ndarray:
        """Return the solution of the scheme on its infinite lattice, exact in time, at the particles."""
        case = self._case
        _, u = self._solution(1, self._wide, scheme_amplification(case, exact=True))
        along = slice(self._wide - case.n, self._wide + case.n + 1)
        return u[(along,) * case.dim]

    def _scaled(self, name: str, factor: float) -> tuple[int, int]:
        if name == "fineness":
            return int(self._fine * factor), self._wide
        return self._fine, int(self._wide * factor)

    def _points(self, fine: int, wide: int) -> int:
        return int((2 * max(fine * self._least, wide) + 1) ** self._case.dim)

    def _combined(self, fine: int, wide: int) -> np.ndarray:
        least = self._least
        return self._reached(1, wide) + self._reached(fine, least) - self._reached(1, least)

    def _at_particles(self, fine: int, wide: int) -> np.ndarray:
        x, u = self._solution(fine, wide, None)
        if self._case.is_graded:
            from scipy.interpolate import make_interp_spline

            inside = np.clip(self._case.x, x[0], x[-1])
            return np.asarray(make_interp_spline(x, u, k=_DEGREE)(inside))
        along = slice((wide - self._case.n) * fine, (wide + self._case.n) * fine + 1, fine)
        return np.ascontiguousarray(u[(along,) * self._case.dim])

    def _solution(
        self, fine: int, wide: int, amplification: Callable[[np.ndarray], np.ndarray] | None
    ) -> tuple[np.ndarray, np.ndarray]:
        case, m = self._case, fine * wide
        x = np.arange(-m, m + 1) * (self._h / fine)
        u = self._data(*np.meshgrid(*(x,) * case.dim, indexing="ij", sparse=True))
        run = WholeSpace(
            x.size,
            case.dim,
            case.alpha,
            case.diffusivity * case.span * (self._h / fine) ** -case.alpha,
            amplification=amplification,
            terms=_TERMS[case.dim],
            tail=self._tail,
            stretch=1.0,
        )
        return x, run.solve(np.broadcast_to(u, (x.size,) * case.dim))


# --- the data as a function of the place ------------------------------------------------------------------


def _function(solution: Solution, source: Initial) -> Data:
    case = solution.case
    if isinstance(source, str) and source == FUNDAMENTAL:
        time = case.diffusivity * case.t_initial
        return lambda *x: np.asarray(green(_radius(x), time, case.alpha, case.dim))
    if not callable(source):
        return _continued(solution)

    def given(*x: np.ndarray) -> np.ndarray:
        """The values of the caller's function, which is called for single numbers if it takes no arrays."""
        shape = np.broadcast_shapes(*(one.shape for one in x))
        try:
            values = np.asarray(source(*x), dtype=float)
        except (TypeError, ValueError):
            values = np.asarray(np.vectorize(source, otypes=[float])(*x))
        return np.broadcast_to(values, shape)

    return given


def _continued(solution: Solution) -> Data:
    """Return bare strengths as a function: a spline on the lattice, and |x|^(-n-alpha) beyond its boundary."""
    from scipy.interpolate import make_interp_spline

    case, end = solution.case, solution.case.reach

    def value(*x: np.ndarray) -> np.ndarray:
        lines = [np.unique(np.clip(one, -end, end)) for one in x]
        values = solution.u0
        for axis, line in enumerate(lines):
            values = make_interp_spline(case.x, values, k=_DEGREE, axis=axis)(line)
        farthest = np.abs(x[0])
        for one in x[1:]:
            farthest = np.maximum(farthest, np.abs(one))
        shrink = end / np.maximum(farthest, end)  # towards the centre, onto the boundary
        index = tuple(
            np.searchsorted(line, np.clip(one * shrink, -end, end) - 1e-9 * case.particle_spacing)
            for one, line in zip(x, lines, strict=True)
        )
        index = tuple(np.minimum(i, line.size - 1) for i, line in zip(index, lines, strict=True))
        return np.asarray(values[index] * shrink ** (case.dim + case.alpha))

    return value


def _radius(x: tuple[np.ndarray, ...]) -> np.ndarray:
    if len(x) == 1:
        return np.abs(x[0])
    return np.asarray(np.sqrt(sum(np.square(one) for one in x)))


def _tail(data: Data, case: Case) -> tuple[float, ...] | None:
    """Return the powers by which the data fall far out; None for those of the fundamental solution."""
    far = _FAR * case.reach * np.array([1.0, 2.0])
    others = [np.zeros(2)] * (case.dim - 1)
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            near, there = np.abs(data(far, *others)).ravel()[:2]
            peak = float(np.abs(data(*case.positions)).max())
        except Exception:  # a function that cannot be evaluated so far out
            return None
    if not np.isfinite([near, there]).all():
        return None
    if near <= _FALLEN * _FAR ** -(case.dim + 3.0) * peak or there == 0.0:
        return ()
    power = float(np.log2(near / there))
    if not case.dim + 0.05 < power < case.dim + 6.0 or abs(power - case.dim - case.alpha) < 1e-3:
        return None
    powers = [
        p for p in (round(power, 3), round(power, 3) + 2.0) if abs((p - case.dim) % 2.0) > 1e-2
    ]
    return tuple(powers)


# --- other runs ------------------------------------------------------------------------------------------


def _changed(case: Case, **changes: Any) -> Case:
    fields = case.until(case.t_final).model_dump(exclude_none=True) | changes
    return Case(**{name: value for name, value in fields.items() if value is not None})


def _quietly(case: Case, source: Initial) -> np.ndarray:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FracparticlesWarning)
        return compute(case, source).u
