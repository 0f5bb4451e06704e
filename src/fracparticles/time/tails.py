"""The tails of a run on the whole space, see `whole_space`: as powers before and after the run, and their images.

Beyond the lattice u falls like powers of |x|. Each depends on the direction in its own way, see `multipoles`:

    u ~ sum_j sum_H b_jH H(-grad) |x|^(-n-gamma_j),    gamma_j of alpha, 2 alpha, .., 2 + alpha, ..,

The b_jH are fitted to the data at some points near the ends. The tail of the result follows from the data: the
transform of H(-grad) |x|^(-n-gamma) is (-i)^l H(k) |k|^gamma / kappa, and near k = 0, with the finite parts m_Hq of the
moments,

    u^(k, 0) = sum_H (-i)^l H(k) (sum_q m_Hq |k|^(2q) + sum_j b_jH |k|^gamma_j / kappa_j),

The run multiplies each term by exp(-D t |k|^alpha).

1 / kappa has poles at the even gamma, and near them it magnifies the round-off of the b_j. Of the gamma_j that are
nearly even only alpha itself is kept; as alpha nears 2, all of them are. The amplitude of a term that is left out is
proportional to the distance of its gamma_j from the even number.
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
from fracparticles.time.exponents import SAME
from fracparticles.time.meeting import Meeting
from fracparticles.time.multipoles import HARMONICS, Monomial, Terms, monomial, terms_of, values_of

__all__ = ["Tails"]

_FOR_BLAS = 8192  # multiplications of a product of matrices: up to so many, BLAS uses one thread
_MOMENTS = {1: 5, 2: 4, 3: 2}  # the degree of the highest moment, by dimension


class Tails:
    """The tails of the data and of the result, and their images; the period is the unit of length.

    The images are polynomials. Their coefficients are linear in a few `numbers`: the b of the tail of the data, and the
    moments of the data, see `multipoles`.

    Parameters
    ----------
    inside : tuple of slices
        The lattice in the circle, one slice for each axis; the powers start at the middle of the circle.
    shown : tuple of slices
        The points of the circle at which the result is wanted, one slice for each axis.
    length : int
        The points of the circle along each axis.
    alpha : float
        Fractional order.
    time : float
        D t over the alpha-th power of the period.
    before, after : arrays
        The gamma of the data and of the result.
    moved : sequence of float, optional
        The displacement of the places where the result is wanted, in spacings along each axis.
    outer : bool
        See `Meeting`.
    """

    def __init__(
        self,
        inside: tuple[slice, ...],
        shown: tuple[slice, ...],
        length: int,
        alpha: float,
        time: float,
        before: np.ndarray,
        after: np.ndarray,
        moved: Sequence[float] | None = None,
        outer: bool = False,
    ) -> None:
        dim = len(inside)
        self._dim, self._length, self._inside = dim, length, inside
        self._x = (np.arange(length) - length // 2) * (1.0 / length)
        # An odd function of a coordinate vanishes where the circle closes, at x = -1/2, which is also x = 1/2.
        self._odd = np.where(self._x == -0.5, 0.0, self._x)
        self._before, self._after = terms_of(before, dim), terms_of(after, dim)
        self.meeting = Meeting(self._before, self._x, self._odd, inside, outer)
        self._powers = self._quadrant()
        self._moments = [
            (harmonic, q)
            for harmonic in HARMONICS[dim]
            for q in range((_MOMENTS[dim] - harmonic.degree) // 2 + 1)
        ]
        each = _MOMENTS[dim] + 1
        self._monomials = np.array([monomial(self._x, self._odd, e) for e in range(each)])
        self._monomials *= 1.0 / length
        self._of_monomials = np.zeros((each,) * dim + (len(self._moments),))
        for m, (harmonic, q) in enumerate(self._moments):
            for at, c in harmonic.moment(q).items():
                self._of_monomials[(*at, m)] = c
        self._of_monomials = self._of_monomials.reshape(-1, len(self._moments))
        own, count = len(self._before), len(self._moments)
        known = np.hstack([self._beyond_the_circle(), np.eye(count)])
        self._result = self._flow(known, alpha, time)
        whole = self._basis(slice(None), 0.0)
        self._bases = [whole] * dim
        self._shown = [
            self._basis(where, by / length) if by else _part(whole, where)
            for where, by in zip(shown, moved or (0.0,) * dim, strict=True)
        ]
        self._series = (
            self._images(self._before, np.eye(own, own + count)),
            self._images(self._after, self._result),
        )

    def _quadrant(self) -> dict[Monomial, tuple[list[int], np.ndarray]]:
        """Return the H(-grad) |x|^(-n-gamma) where no coordinate is negative, by the coordinates in which H is odd.

        Each value holds the rows of the terms and an array of shape (terms, L // 2 + 1, ..), finite at the origin too.
        """
        half = np.abs(self._x[self._length // 2 :: -1]), np.abs(self._odd[self._length // 2 :: -1])
        x, odd = (np.array(np.meshgrid(*(one,) * self._dim, indexing="ij")) for one in half)
        x.reshape(self._dim, -1)[:, 0] = 1.0
        rows: dict[Monomial, list[int]] = {}
        for row, (harmonic, _) in enumerate(self._before):
            rows.setdefault(harmonic.parity, []).append(row)
        return {
            parity: (own, values_of([self._before[row] for row in own], x, odd))
            for parity, own in rows.items()
        }

    def _beyond_the_circle(self) -> np.ndarray:
        """The part of each moment that each term of the tail has beyond the circle, shape (moments, terms)."""
        degrees = [
            # The integral of an odd function vanishes, also where its finite part has no meaning: any degree but -n.
            [m.degree + 2 * q - self._dim - g - h.degree if m.parity == h.parity else 0.0
             for h, g in self._before] for m, q in self._moments
        ]  # fmt: skip

        def products(x: np.ndarray) -> np.ndarray:
            moments = np.array([h.moment_at(q, x) for h, q in self._moments])
            return moments[:, None] * values_of(self._before, x, x)

        return outside_integrals(products, np.array(degrees), self._dim)

    def _flow(self, known: np.ndarray, alpha: float, time: float) -> np.ndarray:
        """Return the matrix from the numbers to the b of the result, from exp(-t |k|^alpha) times u^ near k = 0."""
        scaled = 1.0 / power_transform(np.array([g for _, g in self._before]), self._dim)
        found = np.zeros((len(self._after), known.shape[1]))
        for row, (harmonic, exponent) in enumerate(self._after):
            for m, (other, q) in enumerate(self._moments):
                if other is harmonic:
                    share = harmonic.share(q) * _power(2.0 * q, exponent, alpha, time)
                    found[row] += share * known[m]
            for at, (other, gamma) in enumerate(self._before):
                if other is harmonic:
                    found[row, at] += scaled[at] * _power(gamma, exponent, alpha, time)
            found[row] *= power_transform(np.array(exponent), self._dim)
        return found

    def _basis(self, where: slice, by: float) -> tuple[np.ndarray, np.ndarray]:
        """The polynomials of the images along an axis: the even ones, and x times the even ones."""
        even = square_basis(self._x[where] + by, self._dim)
        return even, (self._odd[where] + by) * even

    def _images(self, terms: Terms, amplitudes: np.ndarray) -> dict[Monomial, np.ndarray]:
        """Return the series of the images, linear in the numbers, by the coordinates in which it is odd."""
        found: dict[Monomial, np.ndarray] = {}
        series = image_series(np.array([gamma for _, gamma in terms]), self._dim)
        for (harmonic, _), one, amplitude in zip(terms, series, amplitudes, strict=True):
            part = np.multiply.outer(amplitude, harmonic.of_series(one))
            found[harmonic.parity] = found.get(harmonic.parity, 0.0) + part
        return found

    def complete(
        self, u: np.ndarray, tail: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Continue data of shape (data, N, .., N) on the circle.

        Return three arrays: the continued data with their images added, the images of the result where it is shown, and
        the numbers on which both depend. If the b of the data are given as `tail`, in the units of `result` with
        wider = 1, nothing is fitted.
        """
        scale = float(self._length) ** -self._falls(self._before)
        tail = self.meeting.fitted(u) if tail is None else tail * scale
        whole = self._continued(tail)
        whole[(slice(None), *self._inside)] = u
        numbers = np.hstack([tail, self._moments_of(whole)])
        whole += self._sum(numbers, self._series[0], self._bases)
        return whole, self._sum(numbers, self._series[1], self._shown), numbers

    def _continued(self, tail: np.ndarray) -> np.ndarray:
        """Return the tail on the circle: one quadrant is computed, and the others follow from the parity of each H."""
        whole = np.empty((len(tail), *(self._length,) * self._dim))
        if not self._powers:
            whole[...] = 0.0
        parts = {
            parity: np.einsum("nk,k...->n...", tail[:, rows], columns)
            for parity, (rows, columns) in self._powers.items()
        }
        middle = self._length // 2
        ahead, behind = slice(0, self._length - middle), slice(middle, 0, -1)
        for sides in product((False, True), repeat=self._dim):  # behind the middle, along each axis
            whole_part = tuple(slice(0, middle) if back else slice(middle, None) for back in sides)
            of_quadrant = tuple(behind if back else ahead for back in sides)
            there = whole[(slice(None), *whole_part)]
            for k, (parity, one) in enumerate(parts.items()):  # the first is even in all of them
                flipped = sum(odd for odd, back in zip(parity, sides, strict=True) if back) % 2
                add = np.subtract if flipped else np.add
                part = one[(slice(None), *of_quadrant)]
                np.copyto(there, part) if k == 0 else add(there, part, out=there)
        return whole

    def _moments_of(self, u: np.ndarray) -> np.ndarray:
        """Return int H(x) |x|^(2q) u over the circle, shape (data, moments)."""
        for _ in range(self._dim):  # the last axis becomes the first after the data
            u = np.einsum("n...x,ex->ne...", u, self._monomials)
        return u.reshape(len(u), len(self._of_monomials)) @ self._of_monomials

    def result(self, numbers: np.ndarray, wider: int) -> np.ndarray:
        """Return the b of the result, shape (data, terms), for lengths in units of `wider` spacings."""
        return numbers @ self._result.T * (self._length / wider) ** self._falls(self._after)

    def _falls(self, terms: Terms) -> np.ndarray:
        """The powers of |x| by which the terms fall."""
        return np.array([self._dim + gamma + harmonic.degree for harmonic, gamma in terms])

    def result_at(self, index: np.ndarray, numbers: np.ndarray) -> np.ndarray:
        """Return the tail of the result at some points of the circle, shape (data, points)."""
        columns = values_of(self._after, self._x[index.T], self._odd[index.T])
        return np.asarray(numbers @ self._result.T @ columns)

    def _sum(
        self,
        numbers: np.ndarray,
        series: dict[Monomial, np.ndarray],
        bases: Sequence[tuple[np.ndarray, np.ndarray]],
    ) -> np.ndarray:
        """Return the images: the polynomials are summed along one axis after the other."""
        parts = {
            parity: (numbers @ one.reshape(len(one), -1)).reshape(len(numbers), *one.shape[1:])
            for parity, one in series.items()
        }
        for basis in bases:
            summed: dict[Monomial, np.ndarray] = {}
            for (odd, *rest), one in parts.items():
                along, key = _along(one, basis[odd]), tuple(rest)
                summed[key] = summed[key] + along if key in summed else along
            parts = summed
        shape = tuple(even.shape[1] for even, _ in bases)
        return parts.get((), np.zeros((len(numbers), *shape)))


def _part(basis: tuple[np.ndarray, np.ndarray], where: slice) -> tuple[np.ndarray, np.ndarray]:
    """The polynomials at some of the points, in contiguous arrays: sums over strided arrays are rounded differently."""
    even, odd = basis
    return np.ascontiguousarray(even[:, where]), np.ascontiguousarray(odd[:, where])


def _power(start: float, exponent: float, alpha: float, time: float) -> float:
    """The coefficient of |k|^exponent in the series of exp(-t |k|^alpha) |k|^start."""
    j = round((exponent - start) / alpha)
    if j < 0 or abs(start + j * alpha - exponent) >= SAME:
        return 0.0
    return float((-time) ** j / factorial(j))


def _along(series: np.ndarray, basis: np.ndarray) -> np.ndarray:
    """Sum over the first axis after the data; the places along the lattice become the last axis.

    Only small sums are left to BLAS: the rounding of large ones depends on the number of threads.
    """
    if series.ndim == 2 and series.size * basis.shape[1] <= _FOR_BLAS:
        return np.asarray(series @ basis)
    return np.einsum("nk...,kx->n...x", series, basis)
