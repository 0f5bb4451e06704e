"""Particle strength exchange with the bare kernel of the fractional Laplacian, on particles of unequal volume.

    du_i/dt = sum_j K_ij V_j (u_j - u_i) - kappa_i u_i,   K_ij = C omega_|i-j| |x_i - x_j|^(-1-alpha),

C int (u(y) - u(x)) |x - y|^(-1-alpha) dy as a sum over particles that a smooth map places, with the weights omega of
`weights` and C of `special.tail_constant`. K is symmetric: without losses sum V u is conserved for any volumes. No
smoothing length is needed.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from scipy.linalg import toeplitz

from fracparticles.adaptive.weights import near_weights
from fracparticles.arguments import FloatArray
from fracparticles.special import tail_constant

__all__ = ["Placed", "exchange_matrix", "rate_matrix"]


class Placed(Protocol):
    """Particles that a smooth map places."""

    @property
    def volumes(self) -> FloatArray:
        """V_i, shape (N,)."""

    @property
    def distances(self) -> FloatArray:
        """|x_i - x_j|, shape (N, N), to relative round-off, as a new array."""


def exchange_matrix(particles: Placed, alpha: float, near: int) -> FloatArray:
    """Return K, shape (N, N), symmetric; the diagonal is zero.

    Parameters
    ----------
    particles : Placed
    alpha : float
        Fractional order, 1 < alpha < 2.
    near : int
        q of `near_weights`, 0 to 6.

    Raises
    ------
    InvalidInput
        If alpha or `near` is outside its range.
    """
    row = np.ones(len(particles.volumes))
    omega = near_weights(alpha, near)[: row.size - 1]
    row[1 : 1 + omega.size] = omega
    distances = particles.distances
    np.fill_diagonal(distances, np.inf)
    return np.asarray(tail_constant(alpha) * toeplitz(row) * distances ** (-1.0 - alpha))


def rate_matrix(exchange: FloatArray, volumes: FloatArray, loss: FloatArray | None) -> FloatArray:
    """Return A of du/dt = A u: A_ij = K_ij V_j, A_ii = -sum_j K_ij V_j - kappa_i; None for no loss."""
    rates = exchange * volumes
    np.fill_diagonal(rates, -rates.sum(axis=1) - (0.0 if loss is None else loss))
    return rates
