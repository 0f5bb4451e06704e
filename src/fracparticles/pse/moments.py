"""Moments of a kernel: over the line (16), over the points of a lattice (28), and of the Gaussian in closed form."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fracparticles.errors import InvalidInput
from fracparticles.pse.shapes import Kernel

__all__ = [
    "absolute_moment",
    "gaussian_moment",
    "lattice_moment",
    "moment",
    "nodes_and_weights",
]

FloatArray = NDArray[np.float64]
_BEYOND = 4.0

# On pieces of length 1, exact for the splines; for exp(-z^2) times a polynomial of degree 30 at round-off.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


def nodes_and_weights(kernel: Kernel) -> tuple[FloatArray, FloatArray]:
    """Return nodes and weights of a Gauss rule, piece by piece, on [-reach, reach] and a little more.

    Beyond its reach a Gaussian is below round-off, but z^k times it is not.
    """
    inside = [-kernel.reach, *kernel.breaks, kernel.reach]
    ends = [inside[0] - _BEYOND, *inside, inside[-1] + _BEYOND]
    edges = np.concatenate(
        [np.linspace(a, b, int(np.ceil(b - a)) + 1)[:-1] for a, b in pairwise(ends)] + [ends[-1:]]
    )
    half = 0.5 * np.diff(edges)[:, None]
    middle = 0.5 * (edges[1:] + edges[:-1])[:, None]
    return (middle + half * _NODES).ravel(), (half * _WEIGHTS).ravel()


def moment(kernel: Kernel, k: int) -> float:
    """M_k = int z^k eta(z) dz  (16), by a Gauss rule on each piece of the kernel."""
    z, w = nodes_and_weights(kernel)
    return float(w @ (z**k * kernel(z)))


def absolute_moment(kernel: Kernel, k: int) -> float:
    """int |z^k eta(z)| dz: what an error of M_k is to be held against."""
    z, w = nodes_and_weights(kernel)
    return float(w @ np.abs(z**k * kernel(z)))


def lattice_moment(
    kernel: Kernel, k: int, overlap: ArrayLike = 1.0, offset: float = 0.0
) -> FloatArray:
    """M^_k = (1/s) sum_i z_i^k eta(z_i), z_i = (i + offset) / s: what the particles of a lattice make of M_k.

    Parameters
    ----------
    kernel : Kernel
        eta.
    k : int
        Order of the moment.
    overlap : array_like
        s = eps / h, positive; s = 1 is (28).
    offset : float
        Distance of the point from the lattice, in h.

    Returns
    -------
    array, in the shape of `overlap`

    Raises
    ------
    InvalidInput
        If an overlap is not positive and finite.
    """
    s = np.asarray(overlap, dtype=float)
    if not (np.isfinite(s) & (s > 0.0)).all():
        raise InvalidInput("overlap", overlap, "positive and finite", "Give eps / h.")
    n = int(np.ceil((kernel.reach + _BEYOND) * s.max(initial=0.0))) + 1
    z = (np.arange(-n, n + 1) + offset) / s[..., None]
    return (z**k * kernel(z)).sum(axis=-1) / s


def gaussian_moment(k: int, dim: int = 1) -> Fraction:
    """int |z|^k pi^(-d/2) exp(-z^2) dz = (d/2) (d/2 + 1) ... (d/2 + k/2 - 1) for even k; 0 for odd k, as of z^k."""
    if k % 2:
        return Fraction(0)
    product = Fraction(1)
    for j in range(k // 2):
        product *= Fraction(dim, 2) + j
    return product
