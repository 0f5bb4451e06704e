"""Lattice sums by the papers' own double loop over all pairs of particles, O(N^2), on all cores."""

from __future__ import annotations

import numba as nb
import numpy as np

from fracparticles._compiled import njit

__all__ = ["NaiveConvolution"]


class NaiveConvolution:
    """The sum of `FourierConvolution`, term by term. Same parameters, same result up to round-off."""

    def __init__(self, weights: np.ndarray, size: int, parity: int = 1, pad: int = 0) -> None:
        self.size, self.pad = size, pad
        self._weights = np.ascontiguousarray(weights, dtype=float)
        self._parity = float(parity)
        self._out = np.empty(size + 2 * pad)

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """Return y, shape (N + 2 pad,): a buffer that the next call overwrites."""
        _sum_over_pairs(u, self._weights, self._parity, self.pad, self._out)
        return self._out


@njit(parallel=True)
def _sum_over_pairs(u, weights, parity, pad, out):
    for row in nb.prange(out.size):
        i = row - pad
        left = 0.0
        for j in range(min(max(i, 0), u.size)):
            left += weights[i - j] * u[j]
        right = 0.0
        for j in range(max(i + 1, 0), u.size):
            right += weights[j - i] * u[j]
        total = left + parity * right
        if 0 <= i < u.size:
            total += weights[0] * u[i]
        out[row] = total
