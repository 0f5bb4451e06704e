"""Derivatives at the middles of N equal cells, by polynomials through the nearest seven points: of order 6."""

from __future__ import annotations

import numpy as np

from fracparticles.arguments import FloatArray

__all__ = ["one_sided_differences"]

_POINTS = 7


def one_sided_differences(count: int) -> FloatArray:
    """Return d/di of f_i between the values at i = 0 .. count - 1, shape (count, count); one-sided at the ends."""
    d = np.zeros((count, count))
    for i in range(count):
        first = min(max(i - _POINTS // 2, 0), count - _POINTS)
        at = np.arange(first, first + _POINTS)
        powers = np.vander(
            at - float(i), increasing=True
        ).T  # of a polynomial about i: f' is its second coefficient
        d[i, at] = np.linalg.solve(powers, np.eye(_POINTS)[1])
    return d
