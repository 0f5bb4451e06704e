"""The sinc scheme: the exact symbol on the lattice, -|theta|^alpha for |theta| <= pi.

    a_m = -(1 / pi) int_0^pi theta^alpha cos(m theta) dtheta
        = -pi^alpha / (1 + alpha) 1F2((1+alpha)/2; 1/2, (3+alpha)/2; -(pi m / 2)^2),

exact for what the lattice resolves (the cardinal function of Whittaker; Stenger, "Numerical Methods Based on Sinc
and Analytic Functions", 1993). On the whole line its error falls faster than any power of h for smooth u. For
alpha = 2 the weights are 2 (-1)^(m+1) / m^2, those of the sinc second derivative.
"""

from __future__ import annotations

import numpy as np
from scipy.special import gamma, roots_jacobi

from fracstudy.peers.lattice import lattice_peer

__all__ = ["PEER", "symbol", "weights"]

# From here the asymptotic series falls below round-off, with terms of the size (2 j)! / (pi m)^(2 j).
_FAR = 16
_TERMS = 16
_NODES = 64  # of the quadrature below: exact to round-off for up to 8 waves in the interval


def weights(alpha: float, count: int) -> np.ndarray:
    """Return a_m by Gauss-Jacobi quadrature for m < 16, beyond by the end-point contributions.

    -pi a_m ~ -Gamma(1+alpha) sin(pi alpha/2) m^(-1-alpha) + (-1)^m sum_j (-1)^j f^(2j+1)(pi) / m^(2j+2) with
    f = theta^alpha, by integration by parts.
    """
    nodes, quadrature = roots_jacobi(_NODES, 0.0, alpha)
    theta = 0.5 * np.pi * (1.0 + nodes)
    near = np.cos(np.outer(np.arange(min(count, _FAR)), theta)) @ quadrature
    near *= (0.5 * np.pi) ** (1.0 + alpha)
    m = np.arange(_FAR, max(count, _FAR), dtype=float)
    derivative = alpha * np.pi ** (alpha - 1.0)  # of order 2 j + 1
    alternating = np.zeros_like(m)
    for j in range(_TERMS):
        alternating += (-1) ** j * derivative / m ** (2 * j + 2)
        derivative *= (alpha - 2 * j - 1) * (alpha - 2 * j - 2) / np.pi**2
    tail = gamma(1.0 + alpha) * np.sin(0.5 * np.pi * alpha) * m ** (-1.0 - alpha)
    far = (1.0 - 2.0 * (m % 2.0)) * alternating - tail
    return -np.concatenate([near, far]) / np.pi


def symbol(theta: np.ndarray, alpha: float) -> np.ndarray:
    """Return -theta^alpha, 0 <= theta <= pi."""
    return -(theta**alpha)


PEER = lattice_peer(
    weights,
    symbol,
    np.square,
    name="sinc-lattice",
    label="sinc lattice",
    reference=(
        "Stenger (1993), Numerical Methods Based on Sinc and Analytic Functions; in the plane Antil, Dondl & Striet "
        "(2020), arXiv:2010.06509; Zhou & Zhang (2023), arXiv:2311.07814"
    ),
    place=4,
    colour="#B22222",
    marker="o",
)
