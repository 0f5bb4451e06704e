"""A run on the whole space by one pair of Fourier transforms, with tails that are continued in closed form.

The solution of u_t = -D (-Laplacian)^(alpha/2) u is u^(k, t) = f(k) u^(k, 0) with f = exp(-D t |k|^alpha). On a lattice
transforms give the sum over all periodic images of u, not u. Beyond the lattice u falls like powers,

    u ~ sum_j (a_j - p_j.grad) |x|^(-n-gamma_j),    gamma_j of alpha, 2 alpha, .., 2 + alpha, ..,

which meet the data at some points near the ends. They continue the data on a longer lattice; the images of the data are
added before the transforms, and those of the result taken off after them (`special.images`). The tail of the result
follows from the data: |x|^(-n-gamma) comes from |k|^gamma / kappa in u^, and near k = 0, with the mass M, the first
moment M1 and the finite part Q of the second,

    u^(k, 0) = M - i k.M1 - Q |k|^2 / 2 n + sum_j (a_j - i k.p_j) |k|^gamma_j / kappa_j,

which exp(-D t |k|^alpha) multiplies term by term. What is left is the error of the expansion after its last term, and
that of a lattice sum, which falls as fast as u^ does.

A method of the lattice has its own f: the symbol of a scheme, or of a difference formula, over the time.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from itertools import product
from math import factorial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.fft import irfft, irfftn, next_fast_len, rfft, rfftn

from fracparticles.arguments import fractional_order, positive_real, real_array
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.special.images import (
    image_series,
    outside_integral,
    power_transform,
    square_basis,
)

__all__ = ["WholeSpace", "evolve", "later_powers", "tail_exponents"]

Amplification = Callable[[np.ndarray], np.ndarray]

_MOST_TERMS = 6
_NOTICED = 1e-3  # of the maximum: a tail that misses the solution by more
_FEWEST = 8  # points an axis: the tail meets the data at six depths
_OUTGROWN = 0.9
_SAME = 1e-9  # exponents nearer than this are one
_STRETCH = {1: 3.0, 2: 2.0, 3: 1.5}  # the longer lattice over the given one
_DEPTHS = (1.0, 0.75, 0.5, 0.875, 0.625, 0.375)  # where the tail meets the data, in half-widths


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
    spacing : float
        h.
    alpha : float
        Fractional order, 1 < alpha < 2.
    time : float
        The time to go, in units of length^alpha / D.
    dim : {1, 2, 3}, optional
        How many of the axes are space; all of them if left out.
    diffusivity : float
        D.
    terms : int
        How many powers continue u beyond the lattice, 0 to 6; with 0 it is periodic.
    tail : sequence of float, optional
        The powers p, q, .. of |x|^(-p), |x|^(-q) by which the data fall: for 1/(1 + x^2) on the line (2, 4). Empty for
        data that are zero beyond the lattice. Left out: those of the fundamental solution.
    stretch : float, optional
        How much longer the lattice of the transforms is, at least 1: a doubling takes one or two digits off the error
        near the ends. Left out: 3, 2 and 1.5 in one, two and three dimensions, and 1 without terms.

    Returns
    -------
    array
        Of the shape of u.

    Raises
    ------
    InvalidInput
        If an argument is outside its range, or the solution outgrows the lattice, see `WholeSpace`.

    Warns
    -----
    AccuracyWarning
        If the powers that continue the solution miss it at the faces of the lattice by a thousandth of its maximum.

    Examples
    --------
    >>> x = np.linspace(-20.0, 20.0, 401)
    >>> u = evolve(np.exp(-x * x), x[1] - x[0], alpha=1.5, time=1.0, tail=())
    """
    u = real_array("u", u)
    dim = u.ndim if dim is None else dim
    scaled_time = positive_real("time", time) * positive_real("diffusivity", diffusivity)
    scaled_time *= positive_real("spacing", spacing) ** -fractional_order(alpha)
    points = u.shape[-1] if u.ndim else 0
    run = WholeSpace(points, dim, alpha, scaled_time, terms=terms, tail=tail, stretch=stretch)
    result, miss = run.solve_and_compare(u)
    if miss > _NOTICED:
        warnings.warn(
            f"beyond the lattice the solution is continued by powers that miss it at the ends by {miss:.2g} of its "
            "maximum; there the error may be as large. Take a wider lattice.",
            AccuracyWarning,
            stacklevel=2,
        )
    return result


def tail_exponents(alpha: float, terms: int) -> np.ndarray:
    """Return the first gamma_j of the tail |x|^(-n-gamma_j) of the fundamental solution and what is moved or widened.

    They are j alpha + 2 m with j >= 1, ascending; even integers belong to no tail.
    """
    every = sorted(j * alpha + 2.0 * m for j in range(1, terms + 2) for m in range(terms + 1))
    return np.array([e for e in every if not _is_even(e)][:terms])


def _is_even(exponent: float) -> bool:
    return abs(0.5 * exponent - round(0.5 * exponent)) < _SAME


class WholeSpace:
    """A run on N^n points made ready, in units of the spacing.

    Parameters
    ----------
    points : int
        N.
    dim : int
        n.
    alpha : float
        Fractional order.
    scaled_time : float
        tau = D t / h^alpha.
    amplification : callable, optional
        f(theta) for theta in [0, pi], in more dimensions of an array whose last axis is the vector; left out,
        exp(-tau |theta|^alpha).
    terms, tail, stretch
        See `evolve`.
    shown : int, optional
        How many points an axis the result has, about the same middle; those of the data if left out.

    Raises
    ------
    InvalidInput
        If one is outside its range, there are fewer than 8 points, or the solution outgrows the lattice: its half-width
        must be 0.9 tau^(1/alpha) at least, in spacings; of a point mass half would then lie beyond.
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
        shown: int | None = None,
    ) -> None:
        fractional_order(alpha)
        positive_real("scaled_time", scaled_time)
        if points < _FEWEST:
            raise InvalidInput("points", points, f"at least {_FEWEST}", "Give more points an axis.")
        spread = scaled_time ** (1.0 / alpha)
        if 0.5 * points < _OUTGROWN * spread:
            least = f"one of half-width {_OUTGROWN:g} (D t)^(1/alpha) = {_OUTGROWN * spread:.4g} spacings at least"
            raise InvalidInput(
                "lattice", 0.5 * points, least, "Take a wider one, or a shorter time."
            )
        if dim not in (1, 2, 3):
            raise InvalidInput("dim", dim, "1, 2 or 3", "Say how many axes are space.")
        if terms not in range(_MOST_TERMS + 1):
            allowed = f"an integer from 0 to {_MOST_TERMS}"
            raise InvalidInput("terms", terms, allowed, "Take one of these.")
        longer = (_STRETCH[dim] if terms else 1.0) if stretch is None else stretch
        if not longer >= 1.0:
            raise InvalidInput("stretch", stretch, "at least 1", "Leave it out.")
        circle = points if longer == 1.0 else next_fast_len(int(longer * points), real=True)
        start = circle // 2 - points // 2
        self._shape, self._circle = (points,) * dim, (circle,) * dim
        self._axes = tuple(range(-dim, 0))
        self._start = start
        self._inside: tuple[Any, ...] = (..., *(slice(start, start + points),) * dim)
        self._shown = self._inside
        if shown is not None:
            first = circle // 2 - shown // 2
            self._shown = (..., *(slice(first, first + shown),) * dim)
        self._amplification = _on_circle(circle, dim, alpha, scaled_time, amplification)
        self._tails = None
        if terms:
            time = scaled_time * float(circle) ** -alpha
            self._tails = _Tails(self._inside, self._circle, alpha, time, terms, tail)

    def solve(self, u: np.ndarray) -> np.ndarray:
        """Return the solution from u, both of shape (..., N, .., N).

        Raises
        ------
        InvalidInput
            If u has another shape.
        """
        return self._run(u)[0]

    def solve_and_compare(self, u: np.ndarray) -> tuple[np.ndarray, float]:
        """Return the solution, and how far its tail is from it at the faces of the lattice, over its maximum.

        Of several data, the worst.
        """
        result, numbers = self._run(u)
        each = result.reshape(-1, *self._shape)
        size = np.abs(each.reshape(len(each), -1)).max(axis=1, keepdims=True)
        found = each[(slice(None), *self._faces(0).T)]
        tail: np.ndarray | float = 0.0
        if self._tails is not None:
            tail = self._tails.result_at(self._faces(self._start), numbers)
        return result, float(np.max(np.abs(found - tail) / np.where(size > 0.0, size, 1.0)))

    def _faces(self, start: int) -> np.ndarray:
        """The indices of the middles of the faces, shape (2 n, n); of the lattice, or in a circle where it starts."""
        dim, points = len(self._axes), self._shape[0]
        faces = np.full((2, dim, dim), points // 2)
        faces[0][np.diag_indices(dim)], faces[1][np.diag_indices(dim)] = 0, points - 1
        return faces.reshape(-1, dim) + start

    def _run(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        dim = len(self._axes)
        if u.ndim < dim or u.shape[u.ndim - dim :] != self._shape:
            allowed = f"the shape {self._shape}, after what counts the data"
            raise InvalidInput("u", u.shape, allowed, "Give a value at each lattice point.")
        if self._tails is None and self._shape == self._circle:
            return self._periodic(u), np.zeros(0)
        longer = np.zeros((*u.shape[: u.ndim - dim], *self._circle))
        longer[self._inside] = u
        if self._tails is None:
            return self._periodic(longer)[self._inside], np.zeros(0)
        images, numbers = self._tails.complete(longer.reshape(-1, *self._circle))
        return (self._periodic(longer) - images.reshape(longer.shape))[self._shown], numbers

    def _periodic(self, u: np.ndarray) -> np.ndarray:
        if len(self._axes) == 1:
            return np.asarray(irfft(rfft(u) * self._amplification, u.shape[-1]))
        spectrum = rfftn(u, axes=self._axes)
        spectrum *= self._amplification
        return np.asarray(irfftn(spectrum, self._circle, axes=self._axes))


def _on_circle(
    points: int,
    dim: int,
    alpha: float,
    scaled_time: float,
    amplification: Amplification | None,
) -> np.ndarray:
    """Return f at the waves of the circle, theta = 2 pi m / N, the last axis as of a real transform."""
    last = np.arange(points // 2 + 1) * (2.0 * np.pi / points)
    if dim == 1:
        return np.exp(-scaled_time * last**alpha) if amplification is None else amplification(last)
    every = np.fft.fftfreq(points, 1.0 / points) * (2.0 * np.pi / points)
    axes = np.meshgrid(*[every] * (dim - 1), last, indexing="ij", sparse=True)
    if amplification is None:
        square = sum(axis * axis for axis in axes)
        return np.exp(-scaled_time * np.power(square, 0.5 * alpha, out=square), out=square)
    return amplification(np.stack(np.broadcast_arrays(*axes), axis=-1))


class _Tails:
    """The tails of the data and of the result, and their images; the period is the unit of length.

    The images are polynomials, whose coefficients are linear in a few numbers: the (a, p) of the data's own tail, and
    the means of u, of x_d u and of |x|^2 u.
    """

    def __init__(
        self,
        inside: tuple[Any, ...],
        circle: tuple[int, ...],
        alpha: float,
        time: float,
        terms: int,
        tail: Sequence[float] | None,
    ) -> None:
        dim, length = len(circle), circle[0]
        fundamental = tail_exponents(alpha, terms)
        before = fundamental if tail is None else _powers(tail, dim)
        after = _sums([0.0, 2.0, *before], alpha, max([*fundamental, *before]))
        self._dim = dim
        self._x = (np.arange(length) - length // 2) * (1.0 / length)
        # What is odd in a coordinate vanishes where the circle closes, half way between x = -1/2 and its image at 1/2.
        self._odd = np.where(self._x == -0.5, 0.0, self._x)
        self._basis, self._slope = square_basis(self._x, dim)
        self._slope[:, self._x == -0.5] = 0.0
        self._samples, self._fit = self._meeting(inside[-1], before)
        beyond = np.ones(circle, dtype=bool)
        beyond[inside] = False
        self._beyond = np.flatnonzero(beyond)
        self._powers = self._columns(self._beyond, before).T
        count = (1 + dim) * before.size
        own = np.zeros((1 + dim, before.size, count + dim + 2))  # (a, p) of the data
        own[..., :count] = np.eye(count).reshape(1 + dim, before.size, count)
        known = np.zeros((1 + dim, 2 + before.size, own.shape[2]))  # M or M1; Q; (a, p)
        known[np.arange(1 + dim), 0, count + np.arange(1 + dim)] = 1.0
        known[0, 1, -1] = 1.0
        known[:, 2:] = own
        for at, g in enumerate(before):  # what M, M1 and Q lack beyond the lattice
            outside = outside_integral(g, dim)
            known[0, 0] += outside * own[0, at]
            known[1:, 0] += (dim + g) / dim * outside * own[1:, at]
            known[0, 1] += outside_integral(g - 2.0, dim) * own[0, at]
        self._exponents = after
        self._result = _flow(before, after, alpha, time, dim) @ known
        shape = -1, len(self._basis) ** dim
        self._before = image_series(before, dim).reshape(shape).T @ own
        self._after = image_series(after, dim).reshape(shape).T @ self._result

    def _meeting(self, inside: slice, exponents: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the flat indices of some points near the faces, and what makes (a, p) of the values there."""
        middle = self._x.size // 2
        depths = [int(depth * (inside.stop - middle - 1)) for depth in _DEPTHS[: exponents.size]]
        away = np.array([m for m in product((-1, 0, 1), repeat=self._dim) if any(m)])
        index = (np.array(depths, dtype=int)[:, None, None] * away).reshape(-1, self._dim) + middle
        samples = np.ravel_multi_index(tuple(index.T), (self._x.size,) * self._dim)
        columns = self._columns(samples, exponents)
        scale = columns.max(axis=0, initial=0.0)
        return samples, np.linalg.pinv(columns / scale) / scale[:, None]

    def _columns(self, points: np.ndarray, exponents: np.ndarray) -> np.ndarray:
        """Return each |x|^(-n-gamma), then of each axis each -d/dx |x|^(-n-gamma), at points given by flat indices."""
        index = np.array(np.unravel_index(points, (self._x.size,) * self._dim))
        square = (self._x[index] ** 2).sum(axis=0)[:, None]
        power = square ** (-0.5 * (self._dim + exponents))
        slope = (self._dim + exponents) * power / square
        return np.hstack([power, *(line[:, None] * slope for line in self._odd[index])])

    def complete(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Continue the data, shape (data, L, .., L), and add their images, in place.

        Return the images of the result, and the numbers that they depend on.
        """
        flat = u.reshape(len(u), -1)
        numbers = np.empty((len(u), self._fit.shape[0] + self._dim + 2))
        numbers[:, : -self._dim - 2] = flat[:, self._samples] @ self._fit.T
        flat[:, self._beyond] = numbers[:, : -self._dim - 2] @ self._powers
        axes = range(1, self._dim + 1)
        lines = [u.mean(axis=tuple(a for a in axes if a != d)) for d in axes]  # along each axis
        numbers[:, -2 - self._dim] = lines[0].mean(axis=1)
        for d, line in enumerate(lines):
            numbers[:, -1 - self._dim + d] = line @ self._odd / self._x.size
        numbers[:, -1] = sum(lines) @ self._x**2 / self._x.size
        u += self._sum(numbers, self._before)
        return self._sum(numbers, self._after), numbers

    def result_at(self, index: np.ndarray, numbers: np.ndarray) -> np.ndarray:
        """Return the tail of the result at some points, shape (data, points)."""
        points = np.ravel_multi_index(tuple(index.T), (self._x.size,) * self._dim)
        columns = self._columns(points, self._exponents)
        return np.asarray(numbers @ (columns @ self._result.reshape(columns.shape[1], -1)).T)

    def _sum(self, numbers: np.ndarray, series: np.ndarray) -> np.ndarray:
        """Return sum_j (a_j - p_j.grad) S_j on the lattice, shape (data, L, .., L)."""
        parts = series @ numbers.T  # of the sum and of each derivative, for each of the data
        total = self._on_lattice(parts[0].T, -1)
        for d in range(self._dim):
            total -= self._on_lattice(parts[1 + d].T, d)
        return total

    def _on_lattice(self, series: np.ndarray, sloping: int) -> np.ndarray:
        """The polynomials on the lattice, along one axis their derivative."""
        bases = [self._slope if axis == sloping else self._basis for axis in range(self._dim)]
        if self._dim == 1:
            return series @ bases[0]
        series = series.reshape(-1, *[len(basis) for basis in bases])
        for basis in bases:  # each axis moves to the end in its turn
            series = np.tensordot(series, basis, axes=(1, 0))
        return series


def _powers(tail: Sequence[float], dim: int) -> np.ndarray:
    exponents = np.array([positive_real("tail", p) - dim for p in tail])
    if (exponents <= 0.0).any() or any(map(_is_even, exponents)):
        allowed = f"powers above {dim} that are not {dim} plus an even integer"
        remedy = "Leave it out, or take a wide lattice with terms=0."
        raise InvalidInput("tail", tuple(tail), allowed, remedy)
    return exponents


def later_powers(tail: Sequence[float], dim: int, alpha: float, terms: int) -> tuple[float, ...]:
    """Return the first powers by which a solution falls whose data fell like these, see `evolve`."""
    own = _powers(tail, dim)
    every = _sums([0.0, 2.0, *own], alpha, max([*tail_exponents(alpha, terms), *own]))
    return tuple((dim + every[:_MOST_TERMS]).tolist())


def _sums(starts: Sequence[float], alpha: float, greatest: float) -> np.ndarray:
    """Return the exponents start + j alpha up to the greatest that belong to a tail, ascending, each once."""
    most = int(greatest / alpha) + 1
    found: list[float] = []
    for exponent in sorted(start + j * alpha for start in starts for j in range(most + 1)):
        new = not found or exponent - found[-1] > _SAME
        if new and exponent <= greatest + _SAME and not _is_even(exponent):
            found.append(exponent)
    return np.array(found)


def _flow(before: np.ndarray, after: np.ndarray, alpha: float, time: float, dim: int) -> np.ndarray:
    """Return the matrix from (M, Q, a_j) to the a_j of the result: exp(-t |k|^alpha) times the expansion at k = 0."""
    columns = [(0.0, 1.0), (2.0, -0.5 / dim)]
    columns += zip(before.tolist(), (1.0 / power_transform(before, dim)).tolist(), strict=True)
    flow = np.zeros((after.size, len(columns)))
    for row, exponent in enumerate(after.tolist()):
        for column, (start, factor) in enumerate(columns):
            j = round((exponent - start) / alpha)
            if j >= 0 and abs(start + j * alpha - exponent) < _SAME:
                flow[row, column] = factor * (-time) ** j / factorial(j)
    return flow * power_transform(after, dim)[:, None]
