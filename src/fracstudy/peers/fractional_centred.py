"""Fractional centred differences.

    -(-Laplacian)^(alpha/2) u(x_i) = -h^(-alpha) sum_j g_{i-j} u_j + O(h^2),
    g_m = (-1)^m Gamma(alpha + 1) / (Gamma(alpha/2 - m + 1) Gamma(alpha/2 + m + 1)).

Ortigueira, Int. J. Math. Math. Sci. 2006, 48391, defined the differences; Celik & Duman, J. Comput. Phys. 231 (2012)
1743, showed the second order and used them for fractional diffusion. The symbol is (2 sin(theta/2))^alpha.
"""

from __future__ import annotations

import numpy as np
from scipy.special import gamma

from fracstudy.peers.lattice import lattice_peer

__all__ = ["PEER", "squares", "symbol", "weights"]


def weights(alpha: float, count: int) -> np.ndarray:
    """Return a_m = -g_m by g_m = g_{m-1} (m - 1 - alpha/2) / (m + alpha/2)."""
    m = np.arange(1.0, count)
    ratios = (m - 1.0 - 0.5 * alpha) / (m + 0.5 * alpha)
    return -gamma(alpha + 1.0) / gamma(0.5 * alpha + 1.0) ** 2 * np.cumprod([1.0, *ratios])


def symbol(theta: np.ndarray, alpha: float) -> np.ndarray:
    """Return -(2 sin(theta/2))^alpha, 0 <= theta <= pi."""
    return -((2.0 * np.sin(0.5 * theta)) ** alpha)


def squares(theta: np.ndarray) -> np.ndarray:
    """Return 4 sin^2(theta/2), the part of one coordinate in the symbol of the five-point Laplacian."""
    return 4.0 * np.sin(0.5 * theta) ** 2


PEER = lattice_peer(
    weights,
    symbol,
    squares,
    name="fractional-centred",
    label="fractional centred",
    reference=(
        "Ortigueira (2006); Celik & Duman (2012), J. Comput. Phys. 231, 1743; in the plane Hao, Zhang & Du (2021), "
        "J. Comput. Phys. 424, 109851"
    ),
    place=3,
    colour="#666666",
    marker="^",
)
