"""The far field of the fractional Laplacian: its constants, and the error of leaving it out."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import gamma

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray

__all__ = ["exchange_truncation_error", "plane_constant", "tail_constant"]


def tail_constant(alpha: float) -> float:
    """Return C of (-Laplacian)^(alpha/2) u(x) = C int (u(x) - u(y)) |x - y|^(-1-alpha) dy on the line.

    C = 2^(alpha-1) alpha Gamma((1+alpha)/2) / (sqrt(pi) Gamma(1-alpha/2)) = Gamma(1+alpha) sin(pi alpha/2) / pi,
    1 < alpha < 2. Raises `InvalidInput` for another.
    """
    alpha = check.fractional_order(alpha)
    # sin(pi alpha/2) keeps all digits as alpha nears 2.
    return float(gamma(1.0 + alpha) * np.sin(0.5 * np.pi * (2.0 - alpha)) / np.pi)


def plane_constant(alpha: float) -> float:
    """Return c of (-Laplacian)^(alpha/2) u(x) = c int (u(x) - u(y)) |x - y|^(-2-alpha) dy, Eq. (4) for n = 2.

    c = alpha 2^(alpha-1) Gamma(1 + alpha/2) / (pi Gamma(1 - alpha/2)).
    """
    numerator = alpha * 2.0 ** (alpha - 1.0) * math.gamma(1.0 + 0.5 * alpha)
    return numerator / (math.pi * math.gamma(1.0 - 0.5 * alpha))


def exchange_truncation_error(half_width: ArrayLike, alpha: float, time: float) -> FloatArray:
    """Return the relative error that the truncation at |x| = D causes in KPSE and GPSE, time (2 C / alpha) D^(-alpha).

    A truncated exchange, (34) or (41), leaves out the integral over |y| > D of C (u(y) - u(x)) |y - x|^(-1-alpha), C =
    `tail_constant`. Near the origin this is mainly the loss -u(x) 2 C D^(-alpha) / alpha: each particle keeps the
    strength that it would have given to places beyond D. The next term is smaller by D^(-alpha).

    Parameters
    ----------
    half_width : array_like
        D, any shape.
    alpha : float
        1 < alpha < 2.
    time : float
        Time of the run, t_f - t_0, times the diffusivity.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """
    half_width = check.within("half_width", half_width, *check.SIZES)
    return (
        check.not_negative("time", time) * 2.0 * tail_constant(alpha) / alpha * half_width**-alpha
    )
