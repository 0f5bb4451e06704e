"""The tails of a run on the whole space, see `whole_space`: by powers, before and after, and their images.

Beyond the lattice u falls like powers,

    u ~ sum_j (a_j - p_j.grad) |x|^(-n-gamma_j),    gamma_j of alpha, 2 alpha, .., 2 + alpha, ..,

which meet the data at some points near the ends. The tail of the result follows from the data: |x|^(-n-gamma) comes
from |k|^gamma / kappa in u^, and near k = 0, with the mass M, the first moment M1 and the finite part Q of the second,

    u^(k, 0) = M - i k.M1 - Q |k|^2 / 2 n + sum_j (a_j - i k.p_j) |k|^gamma_j / kappa_j,

which exp(-D t |k|^alpha) multiplies term by term.

1 / kappa has poles at the even gamma, where it magnifies the round-off of the a_j. Of the gamma_j that are nearly even
only alpha itself is kept, where all are, as alpha nears 2: what is left out vanishes with the distance, see `_NEARLY`.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from math import factorial
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.errors import InvalidInput
from fracparticles.special.images import (
    image_series,
    outside_integral,
    power_transform,
    square_basis,
)

__all__ = ["MOST_TERMS", "Tails", "later_powers", "powers", "tail_exponents"]

MOST_TERMS = 6
_FOR_BLAS = 8192  # products of two numbers, below which it takes one thread
_SAME = 1e-9  # exponents nearer than this are one
# Measured: six terms in space leave 1e-10 / distance of the maximum, and more near two, where all are nearly even and
# nearly one. The amplitude of a term that is left out is proportional to the distance.
_NEARLY = 1e-2
_STEEPEST = 30.0  # power of a tail: of steeper ones nothing is left
_DEPTHS = (1.0, 0.75, 0.5, 0.875, 0.625, 0.375)  # where the tail meets the data, in half-widths


def tail_exponents(alpha: float, terms: int) -> np.ndarray:
    """Return the first gamma_j of the tail |x|^(-n-gamma_j) of the fundamental solution and what is moved or widened.

    They are j alpha + 2 m with j >= 1, ascending, but for those that are even, which belong to no tail, or within 0.01
    of it; alpha itself may be as near as 1e-9. Of two that are nearly one there is the lower.
    """
    found: list[float] = []
    for e in sorted(j * alpha + 2.0 * m for j in range(1, 2 * terms + 2) for m in range(terms + 1)):
        new = not found or e - found[-1] >= _NEARLY
        if new and _from_even(e) >= (_SAME if e == alpha else _NEARLY):
            found.append(e)
    return np.array(found[:terms])


def powers(tail: Sequence[float], dim: int) -> np.ndarray:
    """Return the gamma of the powers p = n + gamma by which somebody's data fall.

    Raises
    ------
    InvalidInput
        If there are more than six, or one is not above n, is n plus an even integer, or above 30.
    """
    exponents = check.vector("tail", tail, least=0) - dim
    good = (exponents > 0.0) & (exponents + dim <= _STEEPEST)
    if (
        exponents.size > MOST_TERMS
        or not good.all()
        or min(map(_from_even, exponents), default=1.0) < _SAME
    ):
        allowed = f"at most {MOST_TERMS} powers from {dim} to {_STEEPEST:g}, none of them {dim} plus an even integer"
        remedy = "Leave it out, or take a wide lattice with terms=0."
        raise InvalidInput("tail", tail, allowed, remedy)
    return exponents


def _from_even(exponent: float) -> float:
    """Return the distance to the nearest even integer."""
    return abs(exponent - 2.0 * round(0.5 * exponent))


class Tails:
    """The tails of the data and of the result, and their images; the period is the unit of length.

    The images are polynomials, whose coefficients are linear in a few numbers: the (a, p) of the data's own tail, and
    the means of u, of x_d u and of |x|^2 u.

    Parameters
    ----------
    inside : tuple of slices
        The lattice in the circle, after what counts the data.
    circle : tuple of int
        The shape of the circle.
    alpha : float
        Fractional order.
    time : float
        D t over the alpha-th power of the period.
    terms, tail
        See `whole_space.evolve`.
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
        before = fundamental if tail is None else powers(tail, dim)
        after = _sums([0.0, 2.0, *before], alpha, max([*fundamental, *before], default=0.0))
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
        self._before, self._after = (
            image_series(exponents, dim).reshape(exponents.size, len(self._basis) ** dim).T
            @ numbers
            for exponents, numbers in ((before, own), (after, self._result))
        )

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
        flat = u.reshape(len(u), self._x.size**self._dim)
        numbers = np.empty((len(u), self._fit.shape[0] + self._dim + 2))
        numbers[:, : -self._dim - 2] = flat[:, self._samples] @ self._fit.T
        flat[:, self._beyond] = _along(numbers[:, : -self._dim - 2], self._powers)
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
        amplitudes = self._result.reshape(columns.shape[1], numbers.shape[1])
        return np.asarray(numbers @ (columns @ amplitudes).T)

    def _sum(self, numbers: np.ndarray, series: np.ndarray) -> np.ndarray:
        """Return sum_j (a_j - p_j.grad) S_j on the lattice, shape (data, L, .., L).

        The polynomials are summed along one axis after the other; the sum and the derivatives of the axes that are
        done are one array.
        """
        shape = (len(numbers), *(len(self._basis),) * self._dim)
        total, *slopes = (part.T.reshape(shape) for part in series @ numbers.T)
        for d in range(self._dim):
            total = _along(total, self._basis) - _along(slopes[d], self._slope)
            slopes[d + 1 :] = [_along(slope, self._basis) for slope in slopes[d + 1 :]]
        return total


def _along(series: np.ndarray, basis: np.ndarray) -> np.ndarray:
    """Sum over the first axis after the data, whose place on the lattice becomes the last.

    Only small sums are left to BLAS, which rounds otherwise for another number of threads.
    """
    if series.ndim == 2 and series.size * basis.shape[1] <= _FOR_BLAS:
        return np.asarray(series @ basis)
    return np.einsum("nk...,kx->n...x", series, basis)


def later_powers(tail: Sequence[float], dim: int, alpha: float, terms: int) -> tuple[float, ...]:
    """Return the first powers by which a solution falls whose data fell like these, see `whole_space.evolve`."""
    own = powers(tail, dim)
    every = _sums([0.0, 2.0, *own], alpha, max([*tail_exponents(alpha, terms), *own]))
    return tuple((dim + every[:MOST_TERMS]).tolist())


def _sums(starts: Sequence[float], alpha: float, greatest: float) -> np.ndarray:
    """Return the exponents start + j alpha up to the greatest that belong to a tail, ascending, each once."""
    most = int(greatest / alpha) + 1
    found: list[float] = []
    for exponent in sorted(start + j * alpha for start in starts for j in range(most + 1)):
        new = not found or exponent - found[-1] > _SAME
        if new and exponent <= greatest + _SAME and _from_even(exponent) >= _SAME:
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
