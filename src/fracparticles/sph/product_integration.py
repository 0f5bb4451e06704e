r"""Product integration: the fractional integral of the broken line through given values, exactly.

    I^q g(x_i) = 1/Gamma(q) int_a^{x_i} (x_i - x')^(q-1) g(x') dx' = s^q / Gamma(q+2) sum_{j <= i} w_{i,j} g_j,
    w_{i,i} = 1,    w_{i,j} = (m+1)^(q+1) - 2 m^(q+1) + (m-1)^(q+1),  m = i - j,
    w_{i,0} = (i-1)^(q+1) - (i - q - 1) i^q;

Diethelm, Ford, Freed, "Detailed error analysis for a fractional Adams method", Numer. Algorithms 36 (2004). The only
error is that of the broken line, O(s^2), since nothing is smoothed. I^0 g is g.
"""

from __future__ import annotations

import numpy as np
from scipy.special import gamma

from fracparticles._compiled import njit

__all__ = ["fractional_integral"]


def fractional_integral(g: np.ndarray, spacing: float, order: np.ndarray) -> np.ndarray:
    """I^q g at each particle, from the values g and the orders q > -1 there, all of shape (N,); `spacing` is s."""
    sums = np.empty(g.size)
    _weighted(np.ascontiguousarray(g), np.ascontiguousarray(order), sums)
    return np.asarray(spacing**order / gamma(order + 2.0) * sums)


@njit()
def _weighted(g, order, sums):
    sums[0] = g[0] if order[0] == 0.0 else 0.0
    for i in range(1, g.size):
        q = order[i]
        before, at = 0.0, 1.0  # (m-1)^(q+1) and m^(q+1)
        total = g[i]
        for m in range(1, i):
            after = (m + 1.0) ** (q + 1.0)
            total += (after - 2.0 * at + before) * g[i - m]
            before, at = at, after
        sums[i] = total + (before - (i - q - 1.0) * float(i) ** q) * g[0]
