"""Gauss quadrature: Legendre's rule, and Jacobi's on (0, 1)."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from fracparticles.arguments import FloatArray

__all__ = ["gauss_jacobi", "gauss_legendre"]


def gauss_legendre(
    count: int, low: float = -1.0, high: float = 1.0
) -> tuple[FloatArray, FloatArray]:
    """Return nodes and weights on (low, high), shape (count,) each, exact for polynomials of degree 2 count - 1."""
    x, w = _legendre(count)
    return 0.5 * (low + high) + 0.5 * (high - low) * x, 0.5 * (high - low) * w


@lru_cache(maxsize=64)
def _legendre(count: int) -> tuple[FloatArray, FloatArray]:
    return np.polynomial.legendre.leggauss(count)


def gauss_jacobi(count: int, power: float) -> tuple[FloatArray, FloatArray]:
    """Return nodes v and weights w of int_0^1 v^power f(v) dv = sum w f(v), exact for f of degree 2 count - 1.

    The monic polynomials p_k orthogonal to one another under that integral follow from (DLMF 18.9.2, shifted to (0, 1))

        p_{k+1} = (v - a_k) p_k - b_k p_{k-1},   a_k = (1 + q^2 / ((2k+q) (2k+q+2))) / 2,
        b_k = (k (k+q) / (2k+q))^2 / ((2k+q)^2 - 1),   q = power.

    The nodes are eigenvalues of the Jacobi matrix (Golub & Welsch 1969). numpy computes them: scipy's rule imports
    scipy's linear algebra, which takes longer than a whole run.

    Parameters
    ----------
    count : int
        Number of nodes.
    power : float
        Greater than 0.
    """
    k = np.arange(float(count))
    diagonal = 0.5 * (1.0 + power**2 / ((2.0 * k + power) * (2.0 * k + power + 2.0)))
    middle = 2.0 * k[1:] + power
    beside = k[1:] * (k[1:] + power) / middle / np.sqrt(middle**2 - 1.0)
    # eigh reads the lower half of the matrix only.
    nodes, vectors = np.linalg.eigh(np.diag(diagonal) + np.diag(beside, -1))
    return nodes, vectors[0] ** 2 / (1.0 + power)
