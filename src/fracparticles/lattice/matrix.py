"""Lattice sums over few particles by a matrix product."""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from fracparticles._compiled import njit

__all__ = ["MatrixConvolution"]


class MatrixConvolution:
    """The sum of `FourierConvolution` as a product with the Toeplitz matrix w_{i-j}. Same parameters, same result."""

    def __init__(self, weights: np.ndarray, size: int, parity: int = 1, pad: int = 0) -> None:
        self.size, self.pad = size, pad
        # w from -(N - 1 + pad) to N - 1 + pad; row i of the matrix is a window of it, from w_i downwards.
        both = np.concatenate([parity * weights[:0:-1], weights])
        self._matrix = np.ascontiguousarray(sliding_window_view(both, size)[:, ::-1])
        self._sums = np.empty(size + 2 * pad)

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """Return y, shape (N + 2 pad,): a buffer that the next call overwrites."""
        _product(self._matrix, u, self._sums)
        return self._sums


# Compiled, since numpy's own call would warn of overflows, which the solver reports itself.
@njit()
def _product(matrix, u, y):
    np.dot(matrix, u, y)
