"""The two measures of error of the paper, over the particles i; the approximation may be complex.

    L2  = sqrt(sum_i |f_i - <f>_i|^2) / sqrt(sum_i |f_i|^2),             (39)
    R^2 = 1 - sum_i |f_i - <f>_i|^2 / sum_i (f_i - f-bar)^2,             (40)

f-bar being the mean of the analytical values. (40) is printed with plain squares; of complex deviations the paper's
digits have the absolute ones.
"""

from __future__ import annotations

import numpy as np

__all__ = ["r2_score", "relative_l2"]


def relative_l2(exact: np.ndarray, ours: np.ndarray) -> float:
    """(39)."""
    return float(np.linalg.norm(exact - ours) / np.linalg.norm(exact))


def r2_score(exact: np.ndarray, ours: np.ndarray) -> float:
    """(40)."""
    return float(1.0 - np.sum(np.abs(exact - ours) ** 2) / np.sum((exact - exact.mean()) ** 2))
