r"""1F2[1; b/2, (b+1)/2; -y^2/4], the hypergeometric function of (A1), (A2), (A5), (A6), for y >= 0.

It is the real part of 1F1(1; b; iy) = sum_k (iy)^k / (b)_k, and with a = b - 1

    1F1(1; 1+a; z) = Gamma(1+a) z^-a e^z - a e^z z^-a Gamma(a, z),      z = iy,

an oscillation that stays and a transient that dies out. The Taylor series magnifies round-off by e^y, and is used for
y <= 4 only. For greater y Legendre's continued fraction

    e^z z^-a Gamma(a, z) = 1/(z+1-a - 1(1-a)/(z+3-a - 2(2-a)/(z+5-a - ...)))

converges at z = iy like exp(-sqrt(8 k y)) after k terms.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.special import gamma

from fracparticles.arguments import together, within

__all__ = ["one_f_two"]

_NEAR = 4.0  # y up to which the series is used: there it magnifies round-off by e^4 = 55
_SERIES = 26  # terms of the series: 4^(2k) / (2k)! is below 1e-36 at k = 26
_FRACTION = 60  # terms of the fraction: exp(-sqrt(8 * 60 * 4)) = 1e-19


def one_f_two(b: Any, y: Any) -> np.ndarray:
    """1F2[1; b/2, (b+1)/2; -y^2/4] for 0 < b <= 3 and 0 <= y <= 1e100, of the broadcast shape.

    The error is about 1e-14 of 1 or, if larger, of the amplitude Gamma(b) y^(1-b) of the oscillation.

    Raises `InvalidInput` if b or y is outside its range, or their shapes do not fit together.
    """
    b = within("b", within("b", b, 0.0, inside=True), 0.0, 3.0)
    b, y = together(b=b, y=within("y", y, 0.0, 1e100))
    near = y <= _NEAR
    out = np.empty(b.shape)
    out[near] = _series(b[near], y[near])
    out[~near] = _fraction(b[~near], y[~near])
    return out


def _series(b: np.ndarray, y: np.ndarray) -> np.ndarray:
    total = np.ones_like(b)
    for k in range(_SERIES, -1, -1):
        total = 1.0 - y * y / ((b + 2 * k) * (b + 2 * k + 1)) * total
    return total


def _fraction(b: np.ndarray, y: np.ndarray) -> np.ndarray:
    a, z = b - 1.0, 1j * y
    tail = z + (2 * _FRACTION + 1) - a
    for k in range(_FRACTION, 0, -1):
        tail = z + (2 * k - 1) - a - k * (k - a) / tail
    oscillation = gamma(1.0 + a) * y**-a * np.cos(y - 0.5 * np.pi * a)
    return oscillation - (a / tail).real
