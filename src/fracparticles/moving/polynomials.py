"""A smooth function as a polynomial of degree 15, in an even and an odd part: fast for many arguments at once."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.polynomial import chebyshev

from fracparticles._compiled import njit

__all__ = ["fitted", "horner"]

_DEGREE = 15
_NODES = np.cos(math.pi * (np.arange(64) + 0.5) / 64)


def fitted(function: Callable[[np.ndarray], np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return the coefficients of the even and the odd part, function(y) ~ E(y^2) + y O(y^2) for |y| <= 1.

    Parameters
    ----------
    function : callable
        Of an array of shape (M,); it returns one of shape (M, K), K functions, or (M,).

    Returns
    -------
    even, odd : array, shape (K, 8) or (8,)
    """
    series = chebyshev.chebfit(_NODES, function(_NODES), _DEGREE)
    powers = np.apply_along_axis(chebyshev.cheb2poly, 0, series).T
    return np.ascontiguousarray(powers[..., ::2]), np.ascontiguousarray(powers[..., 1::2])


@njit(inline="always")
def horner(c, z):
    """Return sum_k c_k z^k, k = 0 .. 7."""
    high = ((c[7] * z + c[6]) * z + c[5]) * z + c[4]
    return (((high * z + c[3]) * z + c[2]) * z + c[1]) * z + c[0]
