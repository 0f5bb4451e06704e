"""The inverse of an exchange, to relative round-off, and with it its slow modes.

A_ij = K_ij V_j, A_ii = -sum_j K_ij V_j - kappa_i has rates up to d^(-alpha), d being the distance of two neighbours.
At the end of an interval this is 1e30 and more, and the rates that matter, of order one, would be lost in round-off.
The elimination of Grassmann, Taksar & Heyman (Oper. Res. 33 (1985) 1107) keeps them: it takes no difference of nearly
equal rates, since each diagonal is the sum of what the particle still exchanges. With the outside as one more
particle, which exchanges V_i kappa_i with particle i and is held at zero,

    L_ij = V_i K_ij V_j (exchanges),  d_k = sum_(j > k) L_kj,  L_ij <- L_ij + L_ik L_kj / d_k,   i, j > k,

leaves -V A = U^T diag(d) U, U_kj = -L_kj / d_k, and

    -(V^(1/2) A V^(-1/2))^(-1) = Y Y^T,   Y = V^(1/2) U^(-1) d^(-1/2):

the largest eigenvalues of Y Y^T are one over the slowest rates. The closest particles are taken first. If there are
no losses, the last particle is held at zero instead, and the constant, whose rate is zero, is projected out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh, solve_triangular

from fracparticles.arguments import FloatArray
from fracparticles.errors import InvalidInput

__all__ = ["InverseExchange"]

_BLOCK = 32  # rows eliminated together
_TOLD_APART = 1e-8  # of the largest eigenvalue: smaller ones have few digits


@dataclass(frozen=True)
class InverseExchange:
    """-A^(-1) of an exchange, and its modes.

    Attributes
    ----------
    volumes : array, shape (N,)
        V_i.
    factor : array, shape (N, N)
        Y, up to a permutation of its columns; of a conservative exchange its last column is zero.
    conservative : bool
        Whether sum V u is conserved: -A^(-1) is then the inverse on fields of mean zero.
    """

    volumes: FloatArray
    factor: FloatArray
    conservative: bool

    @classmethod
    def of(
        cls,
        exchange: FloatArray,
        volumes: FloatArray,
        outside: FloatArray | None,
        order: np.ndarray,
    ) -> InverseExchange:
        """Return the inverse of an exchange.

        Parameters
        ----------
        exchange : array, shape (N, N)
            K, symmetric.
        volumes : array, shape (N,)
            V.
        outside : array, shape (N,), or None
            kappa; None if nothing is exchanged with the outside.
        order : array of int, shape (N,)
            The particles in the order of their elimination, the closest first.

        Raises
        ------
        InvalidInput
            If K, which a diffusivity that varies may have changed, makes something grow.
        """
        n, v = len(volumes), volumes[order]
        coupling = np.zeros((n, n + 1))
        coupling[:, :n] = exchange[np.ix_(order, order)] * np.outer(v, v)
        if outside is not None:
            coupling[:, n] = v * outside[order]
        pivots = _eliminate(coupling)
        last = n if outside is not None else n - 1
        pivots = pivots[:last]
        if not pivots.min() > 0.0:
            shown = "a jump between neighbours, some of which would give away what they do not have"
            what = "one that the particles resolve"
            raise InvalidInput("diffusivity", shown, what, "Take more particles, or smooth it.")
        upper = -np.triu(coupling[:last, :last], 1) / pivots[:, None]
        scaled = solve_triangular(upper, np.diag(pivots**-0.5), unit_diagonal=True)
        factor = np.zeros((n, n))
        factor[:last, :last] = scaled
        if outside is None:  # take the mean off each column
            factor -= v @ factor / v.sum()
        result = np.empty_like(factor)
        result[order] = factor * np.sqrt(v)[:, None]
        return cls(volumes, result, outside is None)

    def apply(self, load: FloatArray) -> FloatArray:
        """Return w of A w = -b from V b, both of shape (N, ..): of mean zero if the exchange is conservative."""
        root = np.sqrt(self.volumes).reshape(-1, *([1] * (load.ndim - 1)))
        return np.asarray(self.factor @ (self.factor.T @ (load / root)) / root)

    def modes(self, count: int | None = None) -> tuple[FloatArray, FloatArray]:
        """Return the slowest rates in ascending order, and orthonormal vectors V^(1/2) u in columns.

        Without a `count` all of them. For rates above 1e15 times the first only this bound is known.
        """
        n = len(self.volumes)
        known = 1 if self.conservative else 0
        count = n if count is None else count
        inverse = self.factor @ self.factor.T
        values, vectors = eigh(inverse, subset_by_index=[n - max(count - known, 1), n - 1])
        values, vectors = values[::-1], vectors[:, ::-1]
        known_too = values > _TOLD_APART * values[0]
        # One more product with what is positive: the digits of what is small, close to the ends.
        vectors[:, known_too] = inverse @ vectors[:, known_too] / values[known_too]
        rates = 1.0 / np.maximum(values, 1e-16 * values[0])
        if self.conservative:
            constant = np.sqrt(self.volumes / self.volumes.sum())
            vectors = vectors - np.outer(constant, constant @ vectors)
            rates = np.concatenate([[0.0], rates])
            vectors = np.concatenate([constant[:, None], vectors], axis=1)
        return rates[:count], vectors[:, :count]


def _eliminate(coupling: FloatArray) -> FloatArray:
    """Eliminate in place, by blocks; row k keeps its L_kj, j > k, of when it was eliminated. Return d_k."""
    n = len(coupling)
    pivots = np.empty(n)
    for start in range(0, n, _BLOCK):
        end = min(start + _BLOCK, n)
        rows = coupling[start:end]
        for k in range(end - start):
            pivots[start + k] = rows[k, start + k + 1 :].sum()
            if k + 1 < end - start:
                share = rows[k, start + k + 1 : end] / pivots[start + k]
                rows[k + 1 :, start + k + 1 :] += np.outer(share, rows[k, start + k + 1 :])
        if end < n:
            share = rows[:, end:n] / pivots[start:end, None]
            coupling[end:, end:] += share.T @ rows[:, end:]
    return pivots
