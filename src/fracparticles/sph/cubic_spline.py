r"""The cubic spline kernel W, Eq. (22), its gradient and its integral (Fig. 2).

With q = x/h and z = |q|, and C_d = 1/h in one dimension,

    h W        = 2/3 - z^2 + z^3/2                        0 <= z < 1,     (22)
               = (2 - z)^3 / 6                            1 <= z < 2,     0 beyond;
    h^2 W'     = sgn(q) (-2 z + 3 z^2/2),                 -sgn(q) (2 - z)^2 / 2,    0;
    W~(x)      = int_{-inf}^{x} W = 1/2 + sgn(q) (2 z/3 - z^3/3 + z^4/8),
                 1/2 + sgn(q) (1/2 - (2 - z)^4 / 24),     1/2 + sgn(q)/2.

The support ends at |x| = 2 h: there W and W' vanish, and W~ is 0 or 1.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fracparticles._compiled import njit
from fracparticles.arguments import elementwise, real_array, scale

__all__ = ["SUPPORT", "spline", "spline_gradient", "spline_integral"]

SUPPORT = 2.0  # radius of the support in units of h, the paper's kappa


def spline(x: Any, h: float) -> np.ndarray | float:
    """W(x, h), Eq. (22); any shape of `x`, smoothing length `h`.

    Raises `InvalidInput` if `x` is not real or `h` not from 1e-100 to 1e100; so do the other two.
    """
    return elementwise(_all, real_array("x", x), scale("h", h), 0)


def spline_gradient(x: Any, h: float) -> np.ndarray | float:
    """dW/dx(x, h), odd in x."""
    return elementwise(_all, real_array("x", x), scale("h", h), 1)


def spline_integral(x: Any, h: float) -> np.ndarray | float:
    """W~(x, h), the integral of W from minus infinity to x."""
    return elementwise(_all, real_array("x", x), scale("h", h), 2)


@njit()
def w(q):
    """h W at x = h q."""
    z = abs(q)
    if z < 1.0:
        return 2.0 / 3.0 - z * z + 0.5 * z**3
    if z < 2.0:
        return (2.0 - z) ** 3 / 6.0
    return 0.0


@njit()
def dw(q):
    """h^2 dW/dx at x = h q."""
    z = abs(q)
    if z < 1.0:
        slope = -2.0 * z + 1.5 * z * z
    elif z < 2.0:
        slope = -0.5 * (2.0 - z) ** 2
    else:
        slope = 0.0
    return slope if q >= 0.0 else -slope


@njit()
def iw(q):
    """W~ at x = h q."""
    z = abs(q)
    if z < 1.0:
        half = 2.0 * z / 3.0 - z**3 / 3.0 + 0.125 * z**4
    elif z < 2.0:
        half = 0.5 - (2.0 - z) ** 4 / 24.0
    else:
        half = 0.5
    return 0.5 + half if q > 0.0 else 0.5 - half


@njit()
def _all(x, h, which, out):
    for i in range(x.size):
        q = x[i] / h
        if which == 0:
            out[i] = w(q) / h
        elif which == 1:
            out[i] = dw(q) / (h * h)
        else:
            out[i] = iw(q)
