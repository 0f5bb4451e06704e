"""The tails of a run on the whole space, see `whole_space`: by powers, before and after, and their images.

Beyond the lattice u falls like powers, each with its dependence on the direction, see `multipoles`,

    u ~ sum_j sum_H b_jH H(-grad) |x|^(-n-gamma_j),    gamma_j of alpha, 2 alpha, .., 2 + alpha, ..,

which meet the data at some points near the ends. The tail of the result follows from the data: H(-grad) |x|^(-n-gamma)
comes from (-i)^l H(k) |k|^gamma / kappa in u^, and near k = 0, with the finite parts m_Hq of the moments,

    u^(k, 0) = sum_H (-i)^l H(k) (sum_q m_Hq |k|^(2q) + sum_j b_jH |k|^gamma_j / kappa_j),

which exp(-D t |k|^alpha) multiplies term by term.

1 / kappa has poles at the even gamma, where it magnifies the round-off of the b_j. Of the gamma_j that are nearly even
only alpha itself is kept, where all are, as alpha nears 2: what is left out vanishes with the distance.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from math import factorial

import numpy as np

from fracparticles.special.images import (
    image_series,
    outside_integrals,
    power_transform,
    square_basis,
)
from fracparticles.time.exponents import SAME, powers, sums, tail_exponents
from fracparticles.time.multipoles import HARMONICS, Harmonic, Monomial

__all__ = ["Tails"]

_FOR_BLAS = 8192  # products of two numbers, below which it takes one thread
_DEPTHS = (1.0, 0.75, 0.5, 0.875, 0.625, 0.375)  # where the tail meets the data, in half-widths
_MOMENTS = {1: 5, 2: 3, 3: 2}  # the highest, by dimension

Terms = list[tuple[Harmonic, float]]


class Tails:
    """The tails of the data and of the result, and their images; the period is the unit of length.

    The images are polynomials, whose coefficients are linear in a few numbers: the b of the data's own tail, and the
    moments of the data, see `multipoles`.

    Parameters
    ----------
    inside : tuple of slices
        The lattice in the circle, an axis each; the powers start at the middle of the circle.
    circle : tuple of int
        The shape of the circle.
    alpha : float
        Fractional order.
    time : float
        D t over the alpha-th power of the period.
    terms, tail
        See `whole_space.evolve`.
    moved : sequence of float
        The result is wanted at the points of the lattice and so many spacings on, along each axis.
    """

    def __init__(
        self,
        inside: tuple[slice, ...],
        circle: tuple[int, ...],
        alpha: float,
        time: float,
        terms: int,
        tail: Sequence[float] | None,
        moved: Sequence[float],
    ) -> None:
        dim, length = len(circle), circle[0]
        fundamental = tail_exponents(alpha, terms)
        before = fundamental if tail is None else powers(tail, dim)
        greatest = max([*fundamental, *before], default=0.0)
        after = sums([0.0, 2.0, *before], alpha, greatest)
        self._dim, self._moved = dim, moved
        self._x = (np.arange(length) - length // 2) * (1.0 / length)
        self._before, self._after = _terms(before, dim), _terms(after, dim)
        self._samples, self._fit = self._meeting(inside, before.size)
        beyond = np.ones(circle, dtype=bool)
        beyond[inside] = False
        self._beyond = np.flatnonzero(beyond)
        self._powers = self._columns(self._beyond, self._before)
        self._moments = [
            (harmonic, q)
            for harmonic in HARMONICS[dim]
            for q in range((_MOMENTS[dim] - harmonic.degree) // 2 + 1)
        ]
        own, count = len(self._before), len(self._moments)
        known = np.hstack([self._beyond_the_circle(), np.eye(count)])
        self._result = self._flow(known, before, alpha, time)
        self._bases = [self._basis(0.0)] * dim, [self._basis(by / length) for by in moved]
        self._series = (
            self._images(self._before, np.eye(own, own + count)),
            self._images(self._after, self._result),
        )

    def _meeting(self, inside: tuple[slice, ...], count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the flat indices of some points near the faces, and what makes the b of the values there."""
        middle = self._x.size // 2
        away = np.array([m for m in product((-1, 0, 1), repeat=self._dim) if any(m)])
        low, high = np.array([(middle - one.start, one.stop - 1 - middle) for one in inside]).T
        reach = np.where(away < 0, -low, np.where(away > 0, high, 0))
        depths = np.array(_DEPTHS[:count]).reshape(-1, 1, 1)
        index = (depths * reach).astype(int).reshape(-1, self._dim) + middle
        samples = np.ravel_multi_index(tuple(index.T), (self._x.size,) * self._dim)
        columns = self._columns(samples, self._before).T
        scale = np.abs(columns).max(axis=0, initial=0.0)
        return samples, np.linalg.pinv(columns / scale) / scale[:, None]

    def _columns(self, points: np.ndarray, terms: Terms) -> np.ndarray:
        """Return each H(-grad) |x|^(-n-gamma) at points given by flat indices, shape (terms, points)."""
        x = self._x[np.array(np.unravel_index(points, (self._x.size,) * self._dim))]
        # What is odd in a coordinate vanishes where the circle closes, half way between x = -1/2 and its image at 1/2.
        return _values(terms, x, np.where(x == -0.5, 0.0, x))

    def _beyond_the_circle(self) -> np.ndarray:
        """What the moments lack there of each term of the tail, shape (moments, terms)."""
        degrees = [
            # What is odd vanishes, where its finite part may have no meaning.
            [m.degree + 2 * q - self._dim - g - h.degree if m.parity == h.parity else 0.0
             for h, g in self._before] for m, q in self._moments
        ]  # fmt: skip

        def products(x: np.ndarray) -> np.ndarray:
            moments = np.array([h.moment_at(q, x) for h, q in self._moments])
            return moments[:, None] * _values(self._before, x, x)

        return outside_integrals(products, np.array(degrees), self._dim)

    def _flow(
        self, known: np.ndarray, before: np.ndarray, alpha: float, time: float
    ) -> np.ndarray:
        """Return the matrix from the numbers to the b of the result: exp(-t |k|^alpha) times the expansion at k = 0."""
        own = len(self._before)
        scaled = 1.0 / power_transform(np.array([g for _, g in self._before]), self._dim)
        found = np.zeros((len(self._after), known.shape[1]))
        for row, (harmonic, exponent) in enumerate(self._after):
            for m, (other, q) in enumerate(self._moments):
                if other is harmonic:
                    found[row] += harmonic.share(q) * _power(2.0 * q, exponent, alpha, time) * known[m]
            for at, (other, gamma) in enumerate(self._before):
                if other is harmonic:
                    found[row, at] += scaled[at] * _power(gamma, exponent, alpha, time)
            found[row] *= power_transform(exponent, self._dim)
        return found

    def _basis(self, by: float) -> tuple[np.ndarray, np.ndarray]:
        """The polynomials of the images along an axis, the even ones and x times these."""
        x = self._x + by
        even = square_basis(x, self._dim)
        return even, np.where(self._x == -0.5, 0.0, x) * even

    def _images(self, terms: Terms, amplitudes: np.ndarray) -> dict[Monomial, np.ndarray]:
        """Return the series of the images, linear in the numbers, by the coordinates in which it is odd."""
        found: dict[Monomial, np.ndarray] = {}
        series = image_series(np.array([gamma for _, gamma in terms]), self._dim)
        for (harmonic, _), one, amplitude in zip(terms, series, amplitudes, strict=True):
            part = np.multiply.outer(amplitude, harmonic.of_series(one))
            found[harmonic.parity] = found.get(harmonic.parity, 0.0) + part
        return found

    def complete(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Continue the data, shape (data, L, .., L), and add their images, in place.

        Return the images of the result, and the numbers that they depend on.
        """
        flat = u.reshape(len(u), self._x.size**self._dim)
        tail = flat[:, self._samples] @ self._fit.T
        flat[:, self._beyond] = np.einsum("nk,kx->nx", tail, self._powers)
        numbers = np.hstack([tail, self._moments_of(u)])
        u += self._sum(numbers, self._series[0], self._bases[0])
        return self._sum(numbers, self._series[1], self._bases[1]), numbers

    def _moments_of(self, u: np.ndarray) -> np.ndarray:
        """Return int H(x) |x|^(2q) u over the circle, shape (data, moments)."""
        odd = np.where(self._x == -0.5, 0.0, self._x)
        powers = np.array(
            [(odd if e % 2 else 1.0) * self._x ** (e - e % 2) for e in range(_MOMENTS[self._dim] + 1)]
        ) * (1.0 / self._x.size)
        for _ in range(self._dim):  # the last axis becomes the first after the data
            u = np.einsum("n...x,ex->ne...", u, powers)
        return np.array(
            [
                sum(c * u[(slice(None), *at)] for at, c in harmonic.moment(q).items())
                for harmonic, q in self._moments
            ]
        ).T

    def result_at(self, index: np.ndarray, numbers: np.ndarray) -> np.ndarray:
        """Return the tail of the result at some points, shape (data, points)."""
        points = np.ravel_multi_index(tuple(index.T), (self._x.size,) * self._dim)
        return np.asarray(numbers @ self._result.T @ self._columns(points, self._after))

    def _sum(
        self,
        numbers: np.ndarray,
        series: dict[Monomial, np.ndarray],
        bases: Sequence[tuple[np.ndarray, np.ndarray]],
    ) -> np.ndarray:
        """Return the images on the circle, shape (data, L, .., L): the polynomials are summed along one axis after
        the other."""
        parts = {
            parity: np.tensordot(numbers, one, axes=(1, 0)) for parity, one in series.items()
        }
        for basis in bases:
            summed: dict[Monomial, np.ndarray] = {}
            for (odd, *rest), one in parts.items():
                along = _along(one, basis[odd])
                key = tuple(rest)
                summed[key] = summed[key] + along if key in summed else along
            parts = summed
        return parts.get((), np.zeros((len(numbers), *(self._x.size,) * self._dim)))


def _terms(exponents: np.ndarray, dim: int) -> Terms:
    """Which H goes with which gamma: up to the order of the last dipole."""
    last = max(exponents, default=0.0) + 1.0
    return [(h, float(g)) for h in HARMONICS[dim] for g in exponents if g + h.degree <= last + SAME]


def _values(terms: Terms, x: np.ndarray, odd: np.ndarray) -> np.ndarray:
    """Return each H(-grad) |x|^(-n-gamma), shape (terms, points), see `Harmonic.tail`."""
    values = np.empty((len(terms), x.shape[1]))
    for row, (harmonic, gamma) in zip(values, terms, strict=True):
        row[:] = harmonic.tail(x, odd, gamma)
    return values


def _power(start: float, exponent: float, alpha: float, time: float) -> float:
    """What exp(-t |k|^alpha) |k|^start has of |k|^exponent."""
    j = round((exponent - start) / alpha)
    if j < 0 or abs(start + j * alpha - exponent) >= SAME:
        return 0.0
    return float((-time) ** j / factorial(j))


def _along(series: np.ndarray, basis: np.ndarray) -> np.ndarray:
    """Sum over the first axis after the data, whose place on the lattice becomes the last.

    Only small sums are left to BLAS, which rounds otherwise for another number of threads.
    """
    if series.ndim == 2 and series.size * basis.shape[1] <= _FOR_BLAS:
        return np.asarray(series @ basis)
    return np.einsum("nk...,kx->n...x", series, basis)
