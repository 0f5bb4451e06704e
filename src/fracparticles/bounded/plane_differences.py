"""Derivatives by polynomials through the nearest points: through seven, of order 6, if not said otherwise."""

from __future__ import annotations

import numpy as np

from fracparticles.arguments import FloatArray

__all__ = [
    "REACH",
    "differences_through_centre",
    "differences_with_beyond",
    "one_sided_differences",
]

_POINTS = 7  # points of a polynomial
REACH = _POINTS // 2  # points on either side, of differences that are not one-sided


def one_sided_differences(count: int, points: int = _POINTS) -> FloatArray:
    """Return d/di of f_i between the values at i = 0 .. count - 1, shape (count, count); one-sided at the ends."""
    d = np.zeros((count, count))
    for i in range(count):
        first = min(max(i - points // 2, 0), count - points)
        at = np.arange(first, first + points)
        d[i, at] = _weights((at - i).astype(float))
    return d


def differences_with_beyond(count: int) -> FloatArray:
    """Return d/di of f_i at i = 0 .. count - 1 from the values at i = -3 .. count + 2, shape (count, count + 6)."""
    return one_sided_differences(count + 2 * REACH)[REACH:-REACH]


def differences_through_centre(r: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return d/dr at the first three radii: from the values at all radii, shape (3, len(r)), and opposite, (3, 3).

    Along a diameter a smooth field goes on through the centre to the first radii on the other side.
    """
    most = REACH
    line = np.concatenate([-r[most - 1 :: -1], r])  # from the other side of the centre
    near, opposite = np.zeros((most, r.size)), np.zeros((most, most))
    for i in range(most):
        weights = _weights(line[i : i + _POINTS] - r[i])
        near[i, : _POINTS - most + i] = weights[most - i :]
        opposite[i, : most - i] = weights[: most - i][::-1]
    return near, opposite


def _weights(offsets: FloatArray) -> FloatArray:
    """Return the weights of the values at these offsets in f'(0)."""
    unit = float(np.abs(offsets).max())
    powers = np.vander(offsets / unit, increasing=True).T  # f' is the second coefficient
    return np.asarray(np.linalg.solve(powers, np.eye(offsets.size)[1])) / unit
