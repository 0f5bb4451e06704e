"""The finite difference-quadrature of Huang & Oberman, SIAM J. Numer. Anal. 52 (2014) 3056: quadratic interpolation.

    -(-Laplacian)^(alpha/2) u(x) = int_0^inf (u(x-y) - 2 u(x) + u(x+y)) nu(y) dy,   nu(y) = C y^(-1-alpha).

Over y < h the second difference is replaced by (y/h)^2 times its value at h, over every panel [j-1, j+1] h, j even, by
its quadratic interpolant. With G''' = nu, G(t) = C t^(2-alpha) / ((2-alpha) (alpha-1) alpha) in units of h,

    a_1 = C / (2-alpha) - G''(1) - (G'(3) + 3 G'(1)) / 2 + G(3) - G(1),
    a_j = 2 (G'(j+1) + G'(j-1) - G(j+1) + G(j-1)),                       j = 2, 4, 6, ..
    a_j = -(G'(j+2) + 6 G'(j) + G'(j-2)) / 2 + G(j+2) - G(j-2),          j = 3, 5, 7, ..
    a_0 = -2 sum_j a_j = -2 (C / (2-alpha) + C / alpha),

the last because the rule is exact for constants. All weights but a_0 are positive. The published error is
O(h^(3-alpha)). For smooth u it is smaller, O(h^(4-alpha)): the second difference is even in y, the rule is exact for
its term y^2, and its term y^4 leaves h^4 nu(h) h near y = h and less beyond.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial.polynomial import polyval
from scipy.special import gamma, poch

from fracparticles.special.tails import tail_constant
from fracstudy.peers.lattice import lattice_peer

__all__ = ["PEER", "weights"]

# From here the differences of G, which lose j^3 ulp, are summed as a Taylor series in 1/j.
_FAR = 8
_TERMS = 14


def weights(alpha: float, count: int) -> np.ndarray:
    """Return a_m."""
    c = tail_constant(alpha)

    def g(t: np.ndarray | float) -> np.ndarray | float:
        return c * t ** (2.0 - alpha) / ((2.0 - alpha) * (alpha - 1.0) * alpha)

    def g1(t: np.ndarray | float) -> np.ndarray | float:
        return c * t ** (1.0 - alpha) / ((alpha - 1.0) * alpha)

    second = -c / alpha  # G''(1)
    a = np.empty(max(count, _FAR))
    a[0] = -2.0 * (c / (2.0 - alpha) + c / alpha)
    a[1] = c / (2.0 - alpha) - second - 0.5 * (g1(3.0) + 3.0 * g1(1.0)) + g(3.0) - g(1.0)
    even, odd = np.arange(2.0, _FAR, 2.0), np.arange(3.0, _FAR, 2.0)
    a[2:_FAR:2] = 2.0 * (g1(even + 1.0) + g1(even - 1.0) - g(even + 1.0) + g(even - 1.0))
    a[3:_FAR:2] = -0.5 * (g1(odd + 2.0) + 6.0 * g1(odd) + g1(odd - 2.0))
    a[3:_FAR:2] += g(odd + 2.0) - g(odd - 2.0)
    j = np.arange(float(_FAR), a.size)
    a[_FAR:] = _far_weights(alpha, c, j)
    return a[:count]


def _far_weights(alpha: float, c: float, j: np.ndarray) -> np.ndarray:
    """Return sum_p b_p nu^(2p-2)(j): b_p = 8 p / (2p+1)! for j even, 4^p (3 - 2p) / (2p+1)! for j odd.

    The leading terms are Simpson's 4/3 nu and 2/3 nu.
    """
    p = np.arange(1.0, _TERMS + 1.0)
    series = c * poch(1.0 + alpha, 2.0 * p - 2.0) / gamma(2.0 * p + 2.0)
    square = 1.0 / (j * j)
    even = polyval(square, series * 8.0 * p)
    odd = polyval(square, series * 4.0**p * (3.0 - 2.0 * p))
    return np.where(j % 2.0 == 1.0, odd, even) * j ** (-1.0 - alpha)


PEER = lattice_peer(
    weights,
    name="huang-oberman",
    label="Huang-Oberman",
    reference="Huang & Oberman (2014), SIAM J. Numer. Anal. 52, 3056",
    place=1,
    colour="#8A6D3B",
    marker="s",
)
