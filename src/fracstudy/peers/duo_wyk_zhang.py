"""The weighted trapezoidal method of Duo, van Wyk & Zhang, J. Comput. Phys. 355 (2018) 233.

    -(-Laplacian)^(alpha/2) u(x) = C int_0^inf phi(xi) xi^(gamma-1-alpha) dxi,
    phi = (u(x-xi) - 2 u(x) + u(x+xi)) / xi^gamma,

with a splitting parameter alpha < gamma <= 2. The trapezoidal rule on phi and the exact integral of the weight in each
interval give, with nu = gamma - alpha and kappa = 2 for gamma = 2, else 1,

    a_1 = C / (2 nu) (2^nu + kappa - 1),    a_k = C / (2 nu) ((k+1)^nu - (k-1)^nu) / k^gamma,  k >= 2.

Beyond the distance K h, where u(x +- xi) = 0, the integral of -2 u(x) is exact, so that the last weight counts half:

    a_0 = -2 (sum_{k<K} a_k + C / (2 nu) (K^nu - (K-1)^nu) / K^gamma + C / (alpha K^alpha)).

The optimal gamma is 1 + alpha/2: second order for smooth u.
"""

from __future__ import annotations

import numpy as np

from fracparticles.special.tails import tail_constant
from fracstudy.peers.lattice import lattice_peer

__all__ = ["PEER", "weights"]


def weights(alpha: float, count: int) -> np.ndarray:
    """Return a_m for gamma = 1 + alpha/2, where kappa = 1; K = count."""
    gamma = 1.0 + 0.5 * alpha
    nu = gamma - alpha
    factor = tail_constant(alpha) / (2.0 * nu)
    k = np.arange(2.0, count)
    # (k+1)^nu - (k-1)^nu = 2 (k^2 - 1)^(nu/2) sinh(nu artanh(1/k)), without its cancellation.
    differences = 2.0 * (k * k - 1.0) ** (0.5 * nu) * np.sinh(nu * np.arctanh(1.0 / k))
    a = factor * np.array([0.0, 2.0**nu, *(differences / k**gamma)])[:count]
    last = float(count)
    half = factor * last ** (nu - gamma) * -np.expm1(nu * np.log1p(-1.0 / last))
    a[0] = -2.0 * (a[:0:-1].sum() + half + tail_constant(alpha) / alpha * last**-alpha)
    return a


PEER = lattice_peer(
    weights,
    name="duo-wyk-zhang",
    label="Duo-van Wyk-Zhang",
    reference="Duo, van Wyk & Zhang (2018), J. Comput. Phys. 355, 233",
    place=2,
    colour="#A0522D",
    marker="v",
)
