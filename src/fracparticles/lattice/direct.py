"""Lattice sums without a transform: by a matrix product for few particles, and the papers' own double loop."""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from fracparticles._compiled import njit, prange

__all__ = ["MatrixConvolution", "NaiveConvolution", "matrix_product"]


class MatrixConvolution:
    """The sum of `FourierConvolution` as a product with the Toeplitz matrix w_{i-j}. Same parameters, same result."""

    def __init__(self, weights: np.ndarray, size: int, parity: int = 1, pad: int = 0) -> None:
        self.size, self.pad = size, pad
        # w_m for m from -(N - 1 + pad) to N - 1 + pad; row i of the matrix is a window of them, from w_i downwards.
        both = np.concatenate([parity * weights[:0:-1], weights])
        self._columns = np.ascontiguousarray(sliding_window_view(both, size)[:, ::-1].T)
        self._sums = np.empty(size + 2 * pad)

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """Return y, shape (N + 2 pad,): a buffer that the next call overwrites."""
        matrix_product(self._columns, u, self._sums)
        return self._sums


class NaiveConvolution:
    """The same sum over all pairs of particles, O(N^2), on all cores. Same parameters, same result to round-off."""

    def __init__(self, weights: np.ndarray, size: int, parity: int = 1, pad: int = 0) -> None:
        self.size, self.pad = size, pad
        self._weights = np.ascontiguousarray(weights, dtype=float)
        self._parity = float(parity)
        self._out = np.empty(size + 2 * pad)

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """Return y, shape (N + 2 pad,): a buffer that the next call overwrites."""
        _sum_over_pairs(u, self._weights, self._parity, self.pad, self._out)
        return self._out


# Four columns at a time: for few particles this is as fast as BLAS, which takes 40 ms to load. It is compiled, since
# numpy's own call would warn of overflows, which the solver reports itself.
@njit()
def matrix_product(columns, u, y):
    """y = sum_j u_j columns_j, always summed in the same order."""
    y[:] = 0.0
    fours = u.size - u.size % 4
    for j in range(0, fours, 4):
        u0, u1, u2, u3 = u[j], u[j + 1], u[j + 2], u[j + 3]
        w0, w1, w2, w3 = columns[j], columns[j + 1], columns[j + 2], columns[j + 3]
        for i in range(y.size):
            y[i] += u0 * w0[i] + u1 * w1[i] + u2 * w2[i] + u3 * w3[i]
    for j in range(fours, u.size):
        for i in range(y.size):
            y[i] += u[j] * columns[j, i]


@njit(parallel=True)
def _sum_over_pairs(u, weights, parity, pad, out):
    for row in prange(out.size):
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
