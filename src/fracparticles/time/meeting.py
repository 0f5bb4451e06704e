"""The fit of the tail of a run on the whole space to its data, at some points of the lattice."""

from __future__ import annotations

from itertools import product

import numpy as np

from fracparticles.special.images import outside_integrals
from fracparticles.time.multipoles import HARMONICS, Harmonic, Terms, values_of

__all__ = ["Meeting"]

# Distances from the middle, in half-widths: one of `_DEPTHS` for each gamma, or all of `_OUTER` by least squares.
_DEPTHS = (1.0, 0.75, 0.5, 0.875, 0.625, 0.375)
_OUTER = np.linspace(1.0, 0.8, 8)
_BETWEEN = np.array([0.9375, 0.8125])  # where the tail may miss the data


class Meeting:
    """The tail at some points towards the faces, the edges and the corners of the lattice.

    Parameters
    ----------
    terms : list
        The H and the gamma of the tail.
    x, odd : arrays
        The coordinate along the circle, and the one that takes its place in functions that are odd in it.
    inside : tuple of slices
        The lattice in the circle, one slice for each axis.
    outer : bool
        Whether the tail is fitted to the outer fifth of the lattice, with misfits relative to the slowest power.
        Otherwise it is fitted at as many depths as there are gamma.
    """

    def __init__(
        self, terms: Terms, x: np.ndarray, odd: np.ndarray, inside: tuple[slice, ...], outer: bool
    ) -> None:
        self._terms, self._dim = terms, len(inside)
        middle, count = x.size // 2, len({gamma for _, gamma in terms})
        depths = _OUTER if outer else np.array(_DEPTHS[:count])
        sides = (-1.0, -0.5, 0.0, 0.5, 1.0) if outer and self._dim > 1 else (-1.0, 0.0, 1.0)
        away = np.array([m for m in product(sides, repeat=self._dim) if max(map(abs, m)) == 1.0])
        low, high = np.array([(middle - at.start, at.stop - 1 - middle) for at in inside]).T
        reach = np.where(away < 0.0, low, high) * away
        corner = np.array([[at.start] for at in inside])

        def at(depths: np.ndarray) -> np.ndarray:
            return (depths.reshape(-1, 1, 1) * reach).astype(int).reshape(-1, self._dim) + middle

        places, between = at(depths), at(_BETWEEN)
        self._samples, self._others = places.T - corner, between.T - corner
        self._columns_between = values_of(terms, x[between.T], odd[between.T]).T
        self._nearest = float(min(*low, *high)) / x.size
        self._columns = values_of(terms, x[places.T], odd[places.T]).T
        self._weight = np.ones((len(places), 1))
        if outer and terms:
            self._weight = 1.0 / self._columns[:, :1]
        self._fit = _least_squares(self._columns, self._weight)

    def fitted(self, u: np.ndarray) -> np.ndarray:
        """Return the amplitudes of the terms, shape (data, terms), from data of shape (data, N, .., N)."""
        return np.asarray(u[(slice(None), *self._samples)] @ self._fit.T)

    def misfit(self, u: np.ndarray) -> np.ndarray:
        """Return the greatest distance of the tail from data of shape (data, N, .., N) between the depths, for each."""
        off = u[(slice(None), *self._others)] - self.fitted(u) @ self._columns_between.T
        return np.asarray(np.abs(off).max(axis=1))

    def left_open(self, u: np.ndarray) -> tuple[float, float]:
        """Return the uncertainty of int u and of int x u beyond the lattice; the period is the unit of length.

        It is the change of both integrals by the term of the last gamma: the terms that are left out may change them as
        much. Without terms the run takes u to be zero beyond the lattice. The uncertainty is then the integral of a u
        that goes on like |x|^(-n-1) up to twice the distance.
        """
        found, reach = u[tuple(self._samples)], 2.0 * self._nearest
        if not self._terms:
            beyond = float(np.abs(found).mean()) * self._dim * reach**self._dim
            return beyond, beyond * reach
        change = self._fit @ found
        last = max(gamma for _, gamma in self._terms)
        fewer = np.array([gamma < last for _, gamma in self._terms])
        change[fewer] -= _least_squares(self._columns[:, fewer], self._weight) @ found
        most = [0.0, 0.0]
        for harmonic in HARMONICS[self._dim]:
            if harmonic.degree < len(most):
                lacking = abs(float(self._beyond(harmonic) @ change))
                most[harmonic.degree] = max(most[harmonic.degree], lacking)
        return most[0], most[1]

    def _beyond(self, moment: Harmonic) -> np.ndarray:
        """Return int H u beyond the lattice for each term, with the H of a moment.

        Beyond a sphere only the terms of the same H have one. Beyond a square the others of its parity have one, too:
        those of l = 4 an integral, those of l = 3 a first moment.
        """
        found = np.zeros(len(self._terms))
        own = [row for row, (h, _) in enumerate(self._terms) if h.parity == moment.parity]
        terms = [self._terms[row] for row in own]
        if terms:
            degrees = moment.degree - self._dim - np.array([h.degree + g for h, g in terms])
            found[own] = outside_integrals(
                lambda x: moment.moment_at(0, x) * values_of(terms, x, x), degrees, self._dim
            )
            found[own] *= (2.0 * self._nearest) ** (self._dim + degrees)
        return found


def _least_squares(columns: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Return the matrix from values to amplitudes of the columns, for the least sum of (weight x misfit)^2."""
    weighted = columns * weight
    scale = np.abs(weighted).max(axis=0, initial=0.0)
    scale[scale == 0.0] = 1.0  # a term that vanishes at all of the points has amplitude zero
    return np.asarray(np.linalg.pinv(weighted / scale) / scale[:, None] * weight.T)
