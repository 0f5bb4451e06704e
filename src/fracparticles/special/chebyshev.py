"""Piecewise polynomials on pieces of equal width: sampled once, evaluated by Horner's rule.

On piece i, w i <= x < w (i + 1), a function is replaced by its interpolant at `DEGREE` + 1
Chebyshev points, written in powers of the local coordinate t = 2 (x / w - i) - 1 in [-1, 1]. The
functions tabulated here are analytic around every piece, so that their Chebyshev coefficients fall
at least like 8^-k; powers of t are then as accurate as Chebyshev polynomials, and faster.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from fracparticles._compiled import njit

__all__ = ["DEGREE", "fit", "horner", "sample_points"]

DEGREE = 17  # of the polynomial on each piece: 8^-18 is below round-off

_POINTS = chebyshev.chebpts1(DEGREE + 1)
# Chebyshev coefficients from samples (discrete orthogonality at the points), then powers of t.
_TO_CHEBYSHEV = chebyshev.chebvander(_POINTS, DEGREE).T * (2.0 / (DEGREE + 1))
_TO_CHEBYSHEV[0] /= 2.0
_TO_POWERS = np.eye(DEGREE + 1)  # column k holds T_k = 2 t T_{k-1} - T_{k-2}
for _k in range(2, DEGREE + 1):
    _TO_POWERS[:, _k] = 2.0 * np.roll(_TO_POWERS[:, _k - 1], 1) - _TO_POWERS[:, _k - 2]


def sample_points(width: float, pieces: int) -> NDArray[np.float64]:
    """Return the Chebyshev points of every piece, shape (pieces, DEGREE + 1)."""
    return width * (np.arange(pieces)[:, None] + 0.5 * (1.0 + _POINTS))


def fit(samples: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the coefficients of the powers of t, lowest first, from samples at `sample_points`; both shaped alike."""
    return np.ascontiguousarray((samples @ _TO_CHEBYSHEV.T) @ _TO_POWERS.T)


@njit(inline="always")
def horner(pieces_x: float, coefficients: NDArray[np.float64]) -> float:
    """Evaluate at pieces_x = x / width, which must lie below the number of pieces."""
    piece = int(pieces_x)
    t = 2.0 * (pieces_x - piece) - 1.0
    value = coefficients[piece, DEGREE]
    for k in range(DEGREE - 1, -1, -1):
        value = value * t + coefficients[piece, k]
    return value
