"""Linear operators on the lattice, as the integrators see them: du/dt = A u.

Every operator has `size`, `apply(u)` and the fused `update(u, a, b, c, v)`, which writes
a (A u) + b u + c v into v in one pass over memory: stepping and Chebyshev recurrences are made of it.

The sums keep work arrays. An operator locks them while it uses them, so that threads may share it: they take turns.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from threading import Lock
from typing import Protocol

import numpy as np

from fracparticles._compiled import njit
from fracparticles.lattice.banded import BandedConvolution

__all__ = [
    "BoxFarField",
    "ConvolutionOperator",
    "FarField",
    "FluxDivergenceOperator",
    "LatticeOperator",
    "Operator",
    "TwoPassOperator",
]

Convolution = Callable[[np.ndarray], np.ndarray]


class Operator(Protocol):
    """What an integrator needs."""

    size: int

    def update(self, u: np.ndarray, a: float, b: float, c: float, v: np.ndarray) -> None:
        """Write a (A u) + b u + c v into v; u and v are different arrays."""

    def apply(self, u: np.ndarray) -> np.ndarray:
        """Return A u as a new array."""


@dataclass(frozen=True)
class FarField:
    """The sum over the exterior, sum_p (u_{n-p} right_i^p + u_{-n+p} left_i^p): some strengths near the ends, extended.

    A truncated problem has no far field: its operators take None instead.

    Attributes
    ----------
    depth : array of int, shape (terms,)
        p: how far from the ends.
    right, left : array, shape (terms, points)
        What each of these strengths adds to the sums.
    """

    depth: np.ndarray
    right: np.ndarray
    left: np.ndarray

    def add(self, u: np.ndarray, y: np.ndarray) -> None:
        """Add the contribution of the exterior to the sums y."""
        _add_far_field(self.depth, self.right, self.left, u, y)


class _Far(Protocol):
    def add(self, u: np.ndarray, y: np.ndarray) -> None:
        """Add the contribution of the exterior to the sums y."""


@dataclass(frozen=True)
class BoxFarField:
    """The sums over the exterior of a square or a cube, sum_k a_k S_k with a = fit u_boundary.

    Attributes
    ----------
    boundary : array of int, shape (B,)
        The outermost particles.
    fit : array, shape (K, B)
        From their strengths to the amplitudes of the K modes.
    sums : array, shape (weights, K, points)
        S_k for each weight.
    """

    boundary: np.ndarray
    fit: np.ndarray
    sums: np.ndarray

    def add(self, u: np.ndarray, y: np.ndarray) -> None:
        """Add the contribution of the exterior to the sums y of every weight."""
        amplitudes = self.fit @ u[self.boundary]
        for sums, total in zip(self.sums, y.reshape(self.sums.shape[0], -1), strict=True):
            _add_modes(amplitudes, sums, total)


class LatticeOperator(ABC):
    """The operator of a scheme, with what is known of its spectrum."""

    size: int
    dim: int = 1
    symmetric: bool = False  # the matrix of A
    # The least and the greatest of what the bounded lattice adds to the diagonal of the infinite one, with zero.
    least_excess: float = 0.0
    greatest_excess: float = 0.0

    def __init__(self) -> None:
        self._lock = Lock()

    def update(self, u: np.ndarray, a: float, b: float, c: float, v: np.ndarray) -> None:
        """Write a (A u) + b u + c v into v; u and v are different arrays."""
        with self._lock:
            self._update(u, a, b, c, v)

    @abstractmethod
    def _update(self, u: np.ndarray, a: float, b: float, c: float, v: np.ndarray) -> None:
        """Do so with the work arrays to itself."""

    def apply(self, u: np.ndarray) -> np.ndarray:
        """Return A u as a new array."""
        out = np.zeros(self.size)
        self.update(np.ascontiguousarray(u, dtype=float), 1.0, 0.0, 0.0, out)
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
        far_field: _Far | None,
        infinite_diagonal: float | None = None,
        dim: int = 1,
    ) -> None:
        super().__init__()
        self.size, self.dim, self.symmetric = diagonal.size, dim, far_field is None
        if infinite_diagonal is not None:
            self.least_excess = min(0.0, float(diagonal.min()) - infinite_diagonal)
            self.greatest_excess = max(0.0, float(diagonal.max()) - infinite_diagonal)
        self.convolve, self._diagonal, self._far = convolve, diagonal, far_field

    def _update(self, u: np.ndarray, a: float, b: float, c: float, v: np.ndarray) -> None:
        y = self.convolve(u)
        if self._far is not None:
            self._far.add(u, y)
        _add_diagonal(y, self._diagonal, u, a, b, c, v)


class TwoPassOperator(LatticeOperator):
    """A u = S q + d q with q = (w * u + far field): a slow kernel first, a Gaussian one second.

    Parameters
    ----------
    convolve : callable
        First pass: the sum with the slowly decaying kernel, on the lattice or a little beyond it.
    stencil : BandedConvolution
        Second pass S.
    diagonal : array, shape (N,)
        d_i; what the second pass adds of particle i's own value.
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

    def _update(self, u: np.ndarray, a: float, b: float, c: float, v: np.ndarray) -> None:
        q = self.convolve(u)
        if self._far is not None:
            self._far.add(u, q)
        self._stencil.update(q, self._diagonal, u, a, b, c, v)


class FluxDivergenceOperator(LatticeOperator):
    """A u = sum_d (S_d q_d + c_d q_d) with the flux q = (w_d * u + far field)_d, on a square or cubic lattice.

    Parameters
    ----------
    convolve : callable
        The flux: from the strengths, shape (N, .., N), to the `dim` components on the lattice or a little beyond.
    divergence : callable
        S: from the components of the flux to one value a particle, shape (N, .., N).
    diagonal : array, shape (dim, N, .., N), or None
        c_d; None if it is zero.
    far_field : BoxFarField or None
        The contribution of the exterior to q.
    shape : tuple of int
        The lattice.
    """

    def __init__(
        self,
        convolve: Convolution,
        divergence: Convolution,
        diagonal: np.ndarray | None,
        far_field: BoxFarField | None,
        shape: tuple[int, ...],
    ) -> None:
        super().__init__()
        self.size, self.dim = int(np.prod(shape)), len(shape)
        self._shape = shape
        self.convolve, self._divergence = convolve, divergence
        self._diagonal, self._far = diagonal, far_field

    def _update(self, u: np.ndarray, a: float, b: float, c: float, v: np.ndarray) -> None:
        q = self.convolve(u.reshape(self._shape))
        if self._far is not None:
            self._far.add(u, q)
        y = self._divergence(q)
        if self._diagonal is not None:
            for part, component in zip(self._diagonal, q, strict=True):
                _add_product(part.reshape(-1), component.reshape(-1), y.reshape(-1))
        _combine(y.reshape(-1), u, a, b, c, v)


@njit()
def _add_diagonal(y, diagonal, u, a, b, c, v):
    for i in range(v.size):
        v[i] = a * (y[i] + diagonal[i] * u[i]) + b * u[i] + c * v[i]


@njit()
def _add_far_field(depth, right, left, u, y):
    for k in range(depth.size):
        last, first = u[u.size - 1 - depth[k]], u[depth[k]]
        from_right, from_left = right[k], left[k]
        for i in range(y.size):
            y[i] += last * from_right[i] + first * from_left[i]


@njit()
def _combine(y, u, a, b, c, v):
    for i in range(v.size):
        v[i] = a * y[i] + b * u[i] + c * v[i]


@njit()
def _add_product(diagonal, q, y):
    for i in range(y.size):
        y[i] += diagonal[i] * q[i]


@njit()
def _add_modes(amplitudes, sums, y):
    for k in range(amplitudes.size):
        amplitude, mode = amplitudes[k], sums[k]
        for i in range(y.size):
            y[i] += amplitude * mode[i]
