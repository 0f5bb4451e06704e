"""A run on the whole space by one pair of Fourier transforms, with tails that are continued in closed form.

The solution of u_t = -D (-Laplacian)^(alpha/2) u is u^(k, t) = f(k) u^(k, 0) with f = exp(-D t |k|^alpha). On a lattice
transforms give the sum over all periodic images of u, not u. Beyond the lattice u falls like powers, see `tails`. They
meet the data at some points near the ends, and continue them on a longer lattice. The images of the data are added
before the transforms, and the images of the result are taken off after them (`special.images`). Two errors are left:
that of the expansion after its last term, and that of a lattice sum, which falls as fast as u^ does.

A method on the lattice has another f, which follows from the symbol of its scheme or difference formula.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike
from scipy.fft import next_fast_len

from fracparticles import arguments as check
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.time.circle import Amplification, Circle, Look, unseen
from fracparticles.time.continued import Continued
from fracparticles.time.exponents import MOST_TERMS, later_exponents, powers, tail_exponents
from fracparticles.time.labels import check_labels
from fracparticles.time.short_waves import ShortWaves

__all__ = ["WholeSpace", "evolve", "tail_exponents"]

# Share of the maximum: there is a warning if the tail misses the solution by more, or if the lattice lacks more waves.
_NOTICED = 1e-3
FEWEST = 8  # points along an axis: the tail meets the data at six depths
_OUTGROWN = 0.9  # the least half-width of the lattice, over (D t)^(1/alpha)
# Added to a peak, which may be zero.
_TINY = float(np.finfo(float).tiny)
_TIMES = 1e-300, 1e300  # scaled: before, nothing changes; after, all has outgrown the lattice
_STRETCH = {1: 3.0, 2: 2.0, 3: 1.5}  # by dimension: the longer lattice over the given one


def evolve(
    u: ArrayLike,
    spacing: float,
    alpha: float,
    time: float,
    *,
    dim: int | None = None,
    diffusivity: float = 1.0,
    terms: int = 2,
    tail: Sequence[float] | None = None,
    stretch: float | None = None,
) -> np.ndarray:
    """Return the solution of u_t = -D (-Laplacian)^(alpha/2) u on the whole space after a time.

    Parameters
    ----------
    u : array, shape (..., N, .., N)
        Values on a uniform lattice, the same number along each axis; further axes before these are different data.
        The coordinates of labelled data must be the spacing apart.
    spacing : float
        The spacing h of the lattice.
    alpha : float
        Fractional order, 1 < alpha < 2.
    time : float
        The time of the run, in units of length^alpha / D; for zero the solution is the data.
    dim : {1, 2, 3}, optional
        How many of the axes are space; all of them if left out.
    diffusivity : float
        The diffusivity D.
    terms : int
        How many powers continue u beyond the lattice, 0 to 6; with 0 it is periodic.
    tail : sequence of float, optional
        The powers p, q, .. of |x|^(-p), |x|^(-q) by which the data fall: for 1/(1 + x^2) on the line (2, 4). Empty for
        data that are zero beyond the lattice. If left out, the powers of the fundamental solution.
    stretch : float, optional
        The length of the lattice of the transforms over that of the given one, at least 1. A doubling takes one or two
        digits off the error near the ends. If left out, 3, 2 and 1.5 in one, two and three dimensions, and 1 without
        terms.

    Returns
    -------
    array
        The solution, of the shape of u.

    Raises
    ------
    InvalidInput
        If an argument is outside its range, or the solution outgrows the lattice, see `WholeSpace`.

    Warns
    -----
    AccuracyWarning
        If the powers that continue the solution may leave an error of a thousandth of its maximum; or if waves that the
        lattice does not hold may be a thousandth of it. If the powers miss the data or the solution by so much, one
        power fewer and two more tell their error, as twice what they change. That takes three times as long. With
        powers of your own, only how far they miss the solution at the faces of the lattice is known.

    Examples
    --------
    >>> x = np.linspace(-20.0, 20.0, 401)
    >>> u = evolve(np.exp(-x * x), x[1] - x[0], alpha=1.5, time=1.0, tail=())
    """
    given, u = u, check.finite_array("u", u)
    dim = _dimension_of(u) if dim is None else check.dimension(dim)
    alpha, h = check.fractional_order(alpha), check.scale("spacing", spacing)
    span = check.time_to_go(time) * check.scale("diffusivity", diffusivity)
    check_labels(given, dim, h)
    points = u.shape[-1] if u.ndim else 0
    if u.shape[-dim:] != (points,) * dim:
        _refuse_shape(u.shape, f"as many points along each of its last {dim} axes, those of space")
    scaled_time = min(max(span * h**-alpha, _TIMES[0]), _TIMES[1])
    run = WholeSpace(points, dim, alpha, scaled_time, terms=terms, tail=tail, stretch=stretch)
    if not span:
        return u.copy()
    result, miss, lacking = run.solve_and_judge(u)
    how = f"powers that miss it at the ends by {miss:.2g} of its maximum"
    if terms and tail is None and max(miss, run.misfit(u, result)) > _NOTICED:
        others = (
            WholeSpace(points, dim, alpha, scaled_time, terms=other, stretch=stretch)
            for other in _others(terms)
        )
        miss = max(_distance(result, one.solve(u), dim) for one in others)
        how = f"powers, and fewer or more of them change it by {miss:.2g} of its maximum"
    if miss > _NOTICED:
        warnings.warn(
            f"beyond the lattice the solution is continued by {how}; there the error may be as large. Take a wider "
            "lattice.",
            AccuracyWarning,
            stacklevel=2,
        )
    if lacking > _NOTICED:
        warnings.warn(
            f"the lattice does not resolve the data: {lacking:.2g} of the solution may be of waves shorter than two "
            "spacings, which look like others. Take a smaller spacing, if the data are samples of something finer.",
            AccuracyWarning,
            stacklevel=2,
        )
    return result


class WholeSpace:
    """A run on N^n points made ready, in units of the spacing.

    Parameters
    ----------
    points : int
        The number N of points along each axis.
    dim : int
        The number n of space dimensions.
    alpha : float
        Fractional order.
    scaled_time : float
        tau = D t / h^alpha.
    amplification : callable, optional
        f(theta) for theta in [0, pi], in more dimensions of an array whose last axis is the vector; left out,
        exp(-tau |theta|^alpha).
    terms, tail, stretch
        See `evolve`.

    Raises
    ------
    InvalidInput
        If one is outside its range, there are fewer than 8 points, or the solution outgrows the lattice. The half-width
        of the lattice must be at least 0.9 tau^(1/alpha) spacings; at less, half of a point mass would lie beyond it.
    """

    def __init__(
        self,
        points: int,
        dim: int,
        alpha: float,
        scaled_time: float,
        *,
        amplification: Amplification | None = None,
        terms: int = 2,
        tail: Sequence[float] | None = None,
        stretch: float | None = None,
    ) -> None:
        points, dim = check.whole_number("points", points, FEWEST), check.dimension(dim)
        alpha = check.fractional_order(alpha)
        scaled_time = check.positive_real("scaled_time", scaled_time)
        terms = check.whole_number("terms", terms, 0, MOST_TERMS)
        _refuse_outgrown(points, scaled_time ** (1.0 / alpha))
        longer = _STRETCH[dim] if terms else 1.0
        if stretch is not None:
            longer = check.real_between("stretch", stretch, 1.0)
        if (longer * points) ** dim > check.MOST:
            most = f"for {points} points an axis a lattice of at most {check.MOST} in all"
            raise InvalidInput("stretch", longer, most, "Take fewer points, or a smaller stretch.")
        length = points if longer == 1.0 else next_fast_len(int(longer * points), real=True)
        self._points, self._dim, self._length = points, dim, length
        self._start = length // 2 - points // 2  # the place of the lattice in the circle
        self._inside: tuple[Any, ...] | None = None  # the lattice in a longer circle
        if length != points:
            self._inside = (..., *(slice(self._start, self._start + points),) * dim)
        middle, steps = points // 2, [points**k for k in reversed(range(dim))]
        middles = [
            middle * (sum(steps) - step) + at * step for at in (0, points - 1) for step in steps
        ]
        self._ends = np.array(middles)  # places of the middles of the faces, of N^n points in a row
        self._alpha, self._tau = alpha, scaled_time
        self._changed = min(1.0, scaled_time * math.pi**alpha)  # share of the shortest waves
        self._circle: Circle | Continued
        if terms:
            fundamental = tail_exponents(alpha, terms)
            before = fundamental if tail is None else powers(tail, dim)
            greatest = max([*fundamental, *before], default=0.0)
            after = later_exponents(before, alpha, greatest)
            self._circle = Continued(
                points, length, dim, alpha, scaled_time, before, after, amplification=amplification
            )
        else:
            self._circle = Circle(length, dim, alpha, scaled_time, amplification)

    def __repr__(self) -> str:
        """Return the arguments that it was made with."""
        return f"WholeSpace({self._points}, {self._dim}, {self._alpha:.6g}, {self._tau:.6g})"

    def solve(self, u: np.ndarray) -> np.ndarray:
        """Return the solution from u, both of shape (..., N, .., N).

        Raises
        ------
        InvalidInput
            If u has another shape.
        """
        return self._run(u)[0]

    def solve_and_judge(self, u: np.ndarray) -> tuple[np.ndarray, float, float]:
        """Return the solution, and two doubts about it.

        Returns
        -------
        u : array, shape (..., N, .., N)
        miss : float
            How far the tail is from u at the faces of the lattice, over the maximum of u. It counts less if the time is
            short.
        lacking : float
            The size that waves which the lattice does not hold may have, over the maximum of u, see `short_waves`. A
            value below a thousandth may be an upper bound.

        For several data, both are those of the worst.

        Raises
        ------
        InvalidInput
            If u has another shape, or sums of it overflow.
        """
        seen: list[np.ndarray] = []
        with np.errstate(over="ignore", invalid="ignore"):
            result, numbers = self._run(u, seen.append)
            each = result.reshape(-1, self._points**self._dim)
            peaks = np.maximum.reduce(np.abs(each), 1).tolist()
            if not all(map(math.isfinite, peaks)):
                check.finite_result("u", each)
            miss = self._changed * self._miss(each, numbers, peaks)
            return result, miss, self._lacking(self._circle.waves(seen[0]), peaks)

    def misfit(self, u: np.ndarray, result: np.ndarray) -> float:
        """Return how far the tail of the data is from them, between the places where it meets them.

        Over the maximum of the result, for the worst of several data; zero without a tail.
        """
        if not isinstance(self._circle, Continued):
            return 0.0
        off = self._circle.tails.meeting.misfit(u.reshape(-1, *(self._points,) * self._dim))
        return _worst(off.tolist(), _greatest(result, self._dim))

    def _run(self, u: np.ndarray, look: Look = unseen) -> tuple[np.ndarray, np.ndarray | None]:
        """Return the solution, and the numbers of its tail if it has one; show u^ of the data to `look`."""
        points, dim = self._points, self._dim
        shape = (points,) * dim
        # Data of another type become float64: a transform has the digits of its data.
        if type(u) is not np.ndarray or u.dtype != np.float64:
            u = check.finite_array("u", u)
        if u.ndim < dim or u.shape[u.ndim - dim :] != shape:
            allowed = f"the shape {shape}, after what counts the data"
            raise InvalidInput("u", u.shape, allowed, "Give a value at each lattice point.")
        if isinstance(self._circle, Continued):
            result, numbers = self._circle(u.reshape(_count(u, dim), *shape), look=look)
            return result.reshape(u.shape), numbers
        if self._inside is None:
            return self._circle(u, look), None
        longer = np.zeros((*u.shape[: u.ndim - dim], *(self._length,) * dim))
        longer[self._inside] = u
        return self._circle(longer, look)[self._inside], None

    def _lacking(self, waves: ShortWaves, peaks: list[float]) -> float:
        """Return the size that the waves which the lattice does not hold may have, over the greatest value."""
        worst = _worst(waves.at_most(self._alpha, self._tau), peaks)
        if worst >= _NOTICED:
            worst = _worst(waves.of_a_peak(self._alpha, self._tau), peaks)
        return min(1.0, worst)

    def _miss(self, each: np.ndarray, numbers: np.ndarray | None, peaks: list[float]) -> float:
        """Return how far the tail is from the result in the middles of the faces, over its maximum."""
        miss = each.take(self._ends, 1)
        if isinstance(self._circle, Continued) and numbers is not None:
            faces = np.transpose(np.unravel_index(self._ends, (self._points,) * self._dim))
            miss -= self._circle.tails.result_at(faces + self._start, numbers)
        return _worst([max(map(abs, one)) for one in miss.tolist()], peaks)


def _worst(wrong: list[float], peaks: list[float]) -> float:
    """Return the error over the peak, for the data of which it is greatest."""
    return max((w / (peak + _TINY) for w, peak in zip(wrong, peaks, strict=True)), default=0.0)


def _others(terms: int) -> set[int]:
    """Return two other numbers of terms: one fewer, and two more or two fewer."""
    more = terms + 2 if terms + 2 <= MOST_TERMS else terms - 2
    return {max(1, terms - 1), more} - {terms}


def _distance(u: np.ndarray, other: np.ndarray, dim: int) -> float:
    """Return twice the greatest difference over the greatest value, of the data for which it is greatest."""
    return 2.0 * _worst(_greatest(u - other, dim), _greatest(u, dim))


def _greatest(u: np.ndarray, dim: int) -> list[float]:
    """Return the greatest |u| of each of the data."""
    return list(np.abs(u).max(axis=tuple(range(-dim, 0))).ravel().tolist())


def _dimension_of(u: np.ndarray) -> int:
    """Return how many axes space has if `dim` is not given: all."""
    if not (1 <= u.ndim <= 3 and len(set(u.shape)) == 1):
        _refuse_shape(u.shape, "as many points along each of one to three axes")
    return u.ndim


def _refuse_shape(shape: tuple[int, ...], allowed: str) -> NoReturn:
    remedy = "If its last axis alone is space, and the others count data, give dim=1."
    raise InvalidInput("u", f"array of shape {shape}", allowed, remedy)


def _refuse_outgrown(points: int, spread: float) -> None:
    if 0.5 * points < _OUTGROWN * spread:
        least = f"one of half-width {_OUTGROWN:g} (D t)^(1/alpha) = {_OUTGROWN * spread:.4g} spacings at least"
        remedy = "Take a wider one, a shorter time, or fp.evolve_long, which widens it."
        raise InvalidInput("lattice", 0.5 * points, least, remedy)


def _count(u: np.ndarray, dim: int) -> int:
    """Return how many data there are in an array of shape (.., N, .., N)."""
    return math.prod(u.shape[: u.ndim - dim])
