"""Derivatives by polynomials through the nearest seven points: of order 6."""

from __future__ import annotations

import numpy as np

from fracparticles.arguments import FloatArray

__all__ = ["differences_through_centre", "one_sided_differences"]

_POINTS = 7


def one_sided_differences(count: int) -> FloatArray:
    """Return d/di of f_i between the values at i = 0 .. count - 1, shape (count, count); one-sided at the ends."""
    d = np.zeros((count, count))
    for i in range(count):
        first = min(max(i - _POINTS // 2, 0), count - _POINTS)
        at = np.arange(first, first + _POINTS)
        d[i, at] = _weights((at - i).astype(float))
    return d


def differences_through_centre(r: FloatArray) -> FloatArray:
    """Return d/dr at the first three radii, for fields that are even and for those that are odd, shape (2, 3, len(r)).

    Along a diameter a smooth field goes on through the centre: a wave cos(l theta) of it has f(-r) = (-1)^l f(r).
    """
    most = _POINTS // 2
    line = np.concatenate([-r[most - 1 :: -1], r])  # from the other side of the centre
    d = np.zeros((2, most, r.size))
    for i in range(most):
        weights = _weights(line[i : i + _POINTS] - r[i])
        opposite, near = weights[: most - i], weights[most - i :]
        d[:, i, : near.size] = near
        d[0, i, : opposite.size] += opposite[::-1]
        d[1, i, : opposite.size] -= opposite[::-1]
    return d


def _weights(offsets: FloatArray) -> FloatArray:
    """Those of the values at these offsets in f'(0)."""
    unit = float(np.abs(offsets).max())
    powers = np.vander(offsets / unit, increasing=True).T  # f' is the second coefficient
    return np.asarray(np.linalg.solve(powers, np.eye(offsets.size)[1])) / unit
