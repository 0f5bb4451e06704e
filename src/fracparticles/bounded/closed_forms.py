r"""The powers (1 - |x|^2)_+^p. Their fractional Laplacian is known inside and outside the unit ball, n = 1, 2:

    (-Laplacian)^s u = 2^alpha Gamma(s + n/2) Gamma(p + 1) / (Gamma(n/2) Gamma(p + 1 - s))
                       2F1(s + n/2, s - p; n/2; r^2),

s = alpha/2, r < 1 (B. Dyda, Fract. Calc. Appl. Anal. 15 (2012) 536, Theorem 1). Outside it is an integral
over the ball,

    -c pi^(n/2) Gamma(p + 1) / Gamma(p + 1 + n/2) r^(-n-alpha) 2F1(s + n/2, 1 + s; p + 1 + n/2; 1 / r^2).
"""

from __future__ import annotations

from math import gamma, pi

import numpy as np
from scipy.special import hyp2f1

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.special.tails import plane_constant, tail_constant

__all__ = ["power_in_ball", "riesz_of_power"]


def power_in_ball(squared: FloatArray, power: float) -> FloatArray:
    """Return (1 - r^2)_+^p for the squares r^2, of their shape."""
    return np.asarray(np.maximum(1.0 - squared, 0.0) ** power)


def riesz_of_power(squared: FloatArray, alpha: float, power: float, dim: int) -> FloatArray:
    """Return (-Laplacian)^(alpha/2) (1 - r^2)_+^p at points inside or outside the unit ball.

    Parameters
    ----------
    squared : array
        r^2 of points not on the sphere; the result has the same shape.
    alpha : float
        Fractional order, 1 < alpha < 2.
    power : float
        The power p.
    dim : {1, 2}

    Raises
    ------
    InvalidInput
        If alpha is not between 1 and 2, the dimension not 1 or 2, or p not above alpha/2 - 1.
    """
    alpha, dim = check.fractional_order(alpha), check.whole_number("dim", dim, 1, 2)
    s, half = 0.5 * alpha, 0.5 * dim
    p = check.real_between("power", power, s - 1.0, 100.0, inside=True)
    size = 2.0**alpha * gamma(s + half) * gamma(p + 1.0) / gamma(half) / gamma(p + 1.0 - s)
    inside = size * hyp2f1(s + half, s - p, half, np.minimum(squared, 1.0))
    c = tail_constant(alpha) if dim == 1 else plane_constant(alpha)
    c *= pi**half * gamma(p + 1.0) / gamma(p + 1.0 + half)
    far = np.maximum(squared, 1.0)
    outside = -c * far ** (-half - s) * hyp2f1(s + half, 1.0 + s, p + 1.0 + half, 1.0 / far)
    return np.asarray(np.where(np.asarray(squared) < 1.0, inside, outside))
