r"""Product integration: the integral of a power times the broken line through given values, exactly.

    J^p g(x_i) = int_a^{x_i} (x_i - x')^p g(x') dx' = s^(p+1) / ((p+1)(p+2)) sum_{j <= i} w_{i,j} g_j,      p > -1,
    w_{i,i} = 1,    w_{i,j} = (m+1)^(p+2) - 2 m^(p+2) + (m-1)^(p+2),  m = i - j,
    w_{i,0} = (i-1)^(p+2) - (i - p - 2) i^(p+1);

Diethelm, Ford, Freed, "Detailed error analysis for a fractional Adams method", Numer. Algorithms 36 (2004). The error
is that of the broken line, O(s^2). Nothing is smoothed.
"""

from __future__ import annotations

import numpy as np

from fracparticles._compiled import njit

__all__ = ["product_integral"]


def product_integral(g: np.ndarray, spacing: float, power: np.ndarray) -> np.ndarray:
    """J^p g at each particle, from the values g and with the powers p > -1 there, all of shape (N,)."""
    sums = np.empty(g.size)
    _weighted(np.ascontiguousarray(g), np.ascontiguousarray(power), sums)
    return np.asarray(spacing ** (power + 1.0) / ((power + 1.0) * (power + 2.0)) * sums)


@njit()
def _weighted(g, power, sums):
    sums[0] = 0.0
    for i in range(1, g.size):
        p = power[i]
        before, at = 0.0, 1.0  # (m-1)^(p+2) and m^(p+2)
        total = g[i]
        for m in range(1, i):
            after = (m + 1.0) ** (p + 2.0)
            total += (after - 2.0 * at + before) * g[i - m]
            before, at = at, after
        sums[i] = total + (before - (i - p - 2.0) * float(i) ** (p + 1.0)) * g[0]
