"""Weights of the nearest particles in a singular sum, which give it a high order.

For an even smooth f with f(0) = 0 the punctured trapezoidal rule with a singular weight errs by a series in the even
derivatives of f (the zeta function: Navot 1961; Sidi 2012; as corrected weights: Kapur & Rokhlin 1997)

    h sum_{m != 0} f(m h) |m h|^(-1-alpha)
        = int f(y) |y|^(-1-alpha) dy + 2 sum_{k = 2, 4, ..} zeta(1 + alpha - k) f_k h^(k - alpha),

f_k the coefficients of Taylor's series, k = 2 being the principal value's. The first q of these errors vanish if the
terms with m = -q .. q have the weights omega_m:

    sum_{m=1}^q (omega_m - 1) m^(k - 1 - alpha) = -zeta(1 + alpha - k),   k = 2, 4, .., 2 q,

which leaves h^(2 q + 2 - alpha). Odd terms of f cancel in the sum, whatever the weights. The kernel of particles that a
smooth map places, |phi(s) - phi(s + y)|^(-1-alpha), is |y|^(-1-alpha) times a smooth function: these weights hold for
every map, and depend on |i - j| alone, so that the exchange of two particles stays symmetric.
"""

from __future__ import annotations

import numpy as np
from scipy.special import zeta

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray

__all__ = ["MOST_NEAR", "near_weights", "order_of"]

MOST_NEAR = 6


def near_weights(alpha: float, near: int) -> FloatArray:
    """Return omega_1 .. omega_q, shape (near,); q = `near` from 0 to 6.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """
    alpha, near = check.fractional_order(alpha), check.whole_number("near", near, 0, MOST_NEAR)
    m, k = np.arange(1.0, near + 1.0), 2.0 * np.arange(1.0, near + 1.0)
    moments = m ** (k[:, None] - 1.0 - alpha)
    return 1.0 + np.linalg.solve(moments, -zeta(1.0 + alpha - k)) if near else m


def order_of(alpha: float, near: int) -> float:
    """Return the order 2 q + 2 - alpha in the spacing h of the mapped variable."""
    return 2.0 * near + 2.0 - alpha
