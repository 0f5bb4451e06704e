"""The two measures of error of the paper, over the particles i; the approximation may be complex.

    L2  = sqrt(sum_i |f_i - <f>_i|^2) / sqrt(sum_i |f_i|^2),             (39)
    R^2 = 1 - sum_i |f_i - <f>_i|^2 / sum_i (f_i - f-bar)^2,             (40)

with f-bar the mean of the analytical values. (40) is printed with plain squares; for complex deviations the paper's
digits come from absolute squares.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fracparticles.arguments import finite_result, vector
from fracparticles.errors import InvalidInput

__all__ = ["r2_score", "relative_l2"]


def relative_l2(exact: Any, ours: Any) -> float:
    """(39), for two arrays of shape (N,), real or complex.

    Raises `InvalidInput` if they are not finite or do not fit together, or if the exact values are all zero.
    """
    exact, ours = _values(exact, ours)
    return float(np.linalg.norm(exact - ours) / np.linalg.norm(exact))


def r2_score(exact: Any, ours: Any) -> float:
    """(40), with the arguments and errors of `relative_l2`; the exact values must not all be equal."""
    exact, ours = _values(exact, ours)
    spread = np.sum((exact - exact.mean()) ** 2)
    if not spread > 0.0:
        raise _no_size(exact)
    return float(1.0 - np.sum(np.abs(exact - ours) ** 2) / spread)


def _values(exact: Any, ours: Any) -> tuple[np.ndarray, np.ndarray]:
    """Both arrays in units of a power of 2 about the largest exact value, so that their squares do not overflow."""
    exact = vector("exact", exact)
    ours = vector("ours", ours, exact.size, complex_too=True)
    greatest = np.abs(exact).max()
    if greatest == 0.0:
        raise _no_size(exact)
    unit = np.ldexp(1.0, np.frexp(greatest)[1] - 1)
    with np.errstate(over="ignore"):
        return exact / unit, finite_result("ours", ours / unit)


def _no_size(exact: np.ndarray) -> InvalidInput:
    return InvalidInput("exact", exact, "values with a size to compare with", "Change them.")
