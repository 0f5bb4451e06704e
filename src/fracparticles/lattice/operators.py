"""Linear operators on the lattice, as the integrators see them: du/dt = A u.

Every operator has `size`, `apply(u)` and the fused `combine(u, out, scale, shift, keep)`, which writes scale A u +
shift u + keep out into `out` in one pass over memory. Stepping and Chebyshev recurrences use it.

The sums keep work arrays. An operator locks them while it uses them, so threads may share it and take turns.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from threading import Lock
from typing import Protocol

import numpy as np

from fracparticles._compiled import njit
from fracparticles.lattice.banded import BandedConvolution
from fracparticles.lattice.direct import matrix_product

__all__ = [
    "ConvolutionOperator",
    "FarField",
    "FluxDivergenceOperator",
    "LatticeOperator",
    "MatrixOperator",
    "Operator",
    "TwoPassOperator",
]

Convolution = Callable[[np.ndarray], np.ndarray]


class Operator(Protocol):
    """The methods of an operator that an integrator needs."""

    size: int

    def combine(
        self, u: np.ndarray, out: np.ndarray, scale: float, shift: float = 0.0, keep: float = 0.0
    ) -> None:
        """Write scale A u + shift u + keep out into `out`; u and out are different arrays."""

    def apply(self, u: np.ndarray) -> np.ndarray:
        """Return A u as a new array."""


class FarField(Protocol):
    """The sums over the region beyond the lattice, see `exterior`. A truncated problem has None instead."""

    def add(self, u: np.ndarray, y: np.ndarray) -> None:
        """Add the contribution of the exterior to the sums y, or to A u."""


class LatticeOperator(ABC):
    """The operator of a scheme, with what is known of its spectrum."""

    size: int
    dim: int = 1
    symmetric: bool = False  # the matrix of A
    # The least and the greatest number that the bounded lattice adds to the diagonal of the infinite one, or zero.
    diagonal_shift: tuple[float, float] = (0.0, 0.0)
    watch: Callable[[], None] | None = None  # called after each application

    def __init__(self) -> None:
        self._lock = Lock()

    def combine(
        self, u: np.ndarray, out: np.ndarray, scale: float, shift: float = 0.0, keep: float = 0.0
    ) -> None:
        """Write scale A u + shift u + keep out into `out`; u and out are different arrays."""
        with self._lock:
            self._combine(u, out, scale, shift, keep)
        if self.watch is not None:
            self.watch()

    @abstractmethod
    def _combine(
        self, u: np.ndarray, out: np.ndarray, scale: float, shift: float, keep: float
    ) -> None:
        """Do what `combine` does; the lock on the work arrays is held."""

    def apply(self, u: np.ndarray) -> np.ndarray:
        """Return A u as a new array."""
        out = np.zeros(self.size)
        self.combine(np.ascontiguousarray(u, dtype=float), out, 1.0)
        return out


class ConvolutionOperator(LatticeOperator):
    """(A u)_i = sum_j w_{i-j} u_j + d_i u_i + far field.

    Parameters
    ----------
    convolve : callable
        The sum over the particles, see `sums`.
    diagonal : array, shape (N,)
        d_i; for a particle strength exchange minus the sum of the weights.
    far_field : FarField or None
        The contribution of the exterior.
    infinite_diagonal : float, optional
        d_i of a particle in the middle of an infinite lattice, if the bounded one differs from it.
    dim : {1, 2, 3}
        Space dimension of the lattice.
    """

    def __init__(
        self,
        convolve: Convolution,
        diagonal: np.ndarray,
        far_field: FarField | None,
        infinite_diagonal: float | None = None,
        dim: int = 1,
    ) -> None:
        super().__init__()
        self.size, self.dim, self.symmetric = diagonal.size, dim, far_field is None
        if infinite_diagonal is not None:
            least = min(0.0, float(diagonal.min()) - infinite_diagonal)
            greatest = max(0.0, float(diagonal.max()) - infinite_diagonal)
            self.diagonal_shift = least, greatest
        self.convolve, self._diagonal, self._far = convolve, diagonal, far_field

    def _combine(
        self, u: np.ndarray, out: np.ndarray, scale: float, shift: float, keep: float
    ) -> None:
        y = self.convolve(u)
        if self._far is not None:
            self._far.add(u, y)
        _combine_with_diagonal(y, self._diagonal, u, out, scale, shift, keep)


class MatrixOperator(LatticeOperator):
    """A dense matrix, shape (N, N). Its products always sum in the same order; BLAS on many threads does not."""

    def __init__(self, matrix: np.ndarray) -> None:
        super().__init__()
        self.size, self._columns = len(matrix), np.ascontiguousarray(matrix.T)
        self._product = np.empty(self.size)

    def _combine(
        self, u: np.ndarray, out: np.ndarray, scale: float, shift: float, keep: float
    ) -> None:
        matrix_product(self._columns, u, self._product)
        _combine(self._product, u, out, scale, shift, keep)


class TwoPassOperator(LatticeOperator):
    """A u = S q + d q with q = (w * u + far field): a slow kernel first, a Gaussian one second.

    Parameters
    ----------
    convolve : callable
        First pass: the sum with the slowly decaying kernel, on the lattice or a little beyond it.
    stencil : BandedConvolution
        Second pass S.
    diagonal : array, shape (N,)
        d_i, the factor of q_i in the second pass.
    far_field : FarField or None
        The contribution of the exterior to q.
    """

    def __init__(
        self,
        convolve: Convolution,
        stencil: BandedConvolution,
        diagonal: np.ndarray,
        far_field: FarField | None,
    ) -> None:
        super().__init__()
        self.size = diagonal.size
        self.convolve, self._stencil = convolve, stencil
        self._diagonal, self._far = diagonal, far_field

    def _combine(
        self, u: np.ndarray, out: np.ndarray, scale: float, shift: float, keep: float
    ) -> None:
        q = self.convolve(u)
        if self._far is not None:
            self._far.add(u, q)
        self._stencil.combine(q, self._diagonal, u, out, scale, shift, keep)


class FluxDivergenceOperator(LatticeOperator):
    """A u = sum_d (S_d q_d + c_d q_d) + far field with the flux q_d = w_d * u, on a square or cubic lattice.

    Parameters
    ----------
    convolve : callable
        The flux: from the strengths, shape (N, .., N), to the `dim` components on the lattice or a little beyond.
    divergence : callable
        S: from the components of the flux to one value a particle, shape (N, .., N).
    diagonal : array, shape (dim, N, .., N), or None
        c_d; None if it is zero.
    far_field : FarField or None
        The contribution of the exterior to A u.
    shape : tuple of int
        The lattice.
    """

    def __init__(
        self,
        convolve: Convolution,
        divergence: Convolution,
        diagonal: np.ndarray | None,
        far_field: FarField | None,
        shape: tuple[int, ...],
    ) -> None:
        super().__init__()
        self.size, self.dim = int(np.prod(shape)), len(shape)
        self._shape = shape
        self.convolve, self._divergence = convolve, divergence
        self._diagonal, self._far = diagonal, far_field

    def _combine(
        self, u: np.ndarray, out: np.ndarray, scale: float, shift: float, keep: float
    ) -> None:
        q = self.convolve(u.reshape(self._shape))
        y = self._divergence(q)
        if self._diagonal is not None:
            for part, component in zip(self._diagonal, q, strict=True):
                _add_product(part.reshape(-1), component.reshape(-1), y.reshape(-1))
        if self._far is not None:
            self._far.add(u, y.reshape(-1))
        _combine(y.reshape(-1), u, out, scale, shift, keep)


@njit()
def _combine(y, u, out, scale, shift, keep):
    for i in range(out.size):
        out[i] = scale * y[i] + shift * u[i] + keep * out[i]


@njit()
def _combine_with_diagonal(y, diagonal, u, out, scale, shift, keep):
    for i in range(out.size):
        out[i] = scale * (y[i] + diagonal[i] * u[i]) + shift * u[i] + keep * out[i]


@njit()
def _add_product(diagonal, q, y):
    for i in range(y.size):
        y[i] += diagonal[i] * q[i]
