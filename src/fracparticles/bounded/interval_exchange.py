"""The exchange between particles of an interval: the bare kernel with the weights of `adaptive.weights`."""

from __future__ import annotations

import numpy as np
from scipy.linalg import toeplitz

from fracparticles.adaptive.maps import GradedParticles
from fracparticles.adaptive.weights import near_weights
from fracparticles.arguments import FloatArray
from fracparticles.special import tail_constant

__all__ = ["exchange_matrix", "loss_rates", "rate_matrix"]


def exchange_matrix(particles: GradedParticles, alpha: float, near: int) -> FloatArray:
    """Return K_ij = C omega_|i-j| |x_i - x_j|^(-1-alpha), shape (N, N), symmetric; the diagonal is zero.

    Raises
    ------
    InvalidInput
        If alpha or `near` is outside its range.
    """
    row = np.ones(len(particles.x))
    omega = near_weights(alpha, near)[: row.size - 1]
    row[1 : 1 + omega.size] = omega
    distances = particles.distances
    np.fill_diagonal(distances, np.inf)
    return np.asarray(tail_constant(alpha) * toeplitz(row) * distances ** (-1.0 - alpha))


def rate_matrix(exchange: FloatArray, volumes: FloatArray, loss: FloatArray | None) -> FloatArray:
    """Return A of du/dt = A u: A_ij = K_ij V_j, A_ii = -sum_j K_ij V_j - kappa_i."""
    rates = exchange * volumes
    np.fill_diagonal(rates, -rates.sum(axis=1) - (0.0 if loss is None else loss))
    return rates


def loss_rates(particles: GradedParticles, alpha: float) -> FloatArray:
    """Return kappa_i = C int_outside |x_i - y|^(-1-alpha) dy = (C / alpha) sum_ends d^(-alpha), shape (N,)."""
    losses = particles.left**-alpha + particles.right**-alpha
    return np.asarray(tail_constant(alpha) / alpha * losses)
