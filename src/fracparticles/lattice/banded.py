"""Lattice sums whose weights vanish, to round-off, a few smoothing lengths away: Gaussian kernels."""

from __future__ import annotations

import numpy as np

from fracparticles._compiled import njit
from fracparticles.kernels.families import gaussian_reach

__all__ = ["BandedConvolution"]

_NEGLIGIBLE = 2.0**-56  # share of the largest weight: an eighth of a rounding error
_BLOCK = 512  # rows that are summed at a time: the sums stay in the first-level cache


class BandedConvolution:
    """y_i = sum_{|m| <= M} w_m v_{i-m} over the lattice points present, with w_{-m} = parity * w_m.

    Parameters
    ----------
    weights : array, shape (M + 1,)
        w_m for m = 0 .. M; those at the end that are negligible beside the largest are dropped.
    parity : {1, -1}
        Whether w is even or odd.
    """

    def __init__(self, weights: np.ndarray, parity: int) -> None:
        significant = np.flatnonzero(np.abs(weights) > _NEGLIGIBLE * np.abs(weights).max())
        half_band = int(significant[-1]) if significant.size else 0
        # A zero weight is added if M is odd, since the sum takes two weights at a time.
        self._weights = np.zeros(half_band + half_band % 2 + 1)
        self._weights[: half_band + 1] = weights[: half_band + 1]
        self._parity = float(parity)

    @staticmethod
    def reach(overlap: float, order: int, family: str | None = None) -> int:
        """Return the half band M beyond which a Gaussian kernel of this order and overlap is zero."""
        return int(np.ceil(gaussian_reach(order, family) * overlap))

    def __call__(self, v: np.ndarray, out: np.ndarray) -> np.ndarray:
        """Write y for the points in the middle of v, as many as `out` has, into `out`; return it."""
        _sums(v, self._weights, self._parity, out)
        return out

    def along(self, v: np.ndarray, axis: int, count: int) -> np.ndarray:
        """Return the sums over the lines of v along one axis, for the `count` points in the middle of each."""
        before, after = v.shape[:axis], v.shape[axis + 1 :]
        out = np.empty((*before, count, *after))
        lines = v.reshape(int(np.prod(before)), v.shape[axis], int(np.prod(after)))
        _sums_along(lines, self._weights, self._parity, out.reshape(lines.shape[0], count, -1))
        return out

    def combine(
        self,
        q: np.ndarray,
        diagonal: np.ndarray,
        u: np.ndarray,
        out: np.ndarray,
        scale: float,
        shift: float,
        keep: float,
    ) -> None:
        """Write scale (y + d q) + shift u + keep out into `out`, where y is the sum over q: one pass over memory."""
        _combine(q, self._weights, self._parity, diagonal, u, out, scale, shift, keep)


@njit()
def _sums(v, weights, parity, out):
    skip = (v.size - out.size) // 2
    window = np.empty(_BLOCK + 2 * (weights.size - 1))
    for start in range(0, out.size, _BLOCK):
        total = out[start : start + _BLOCK]
        _sum_block(v, weights, parity, start + skip, window, total)


@njit()
def _sums_along(v, weights, parity, out):
    if v.shape[2] == 1:
        for line in range(v.shape[0]):
            _sums(v[line, :, 0], weights, parity, out[line, :, 0])
        return
    skip = (v.shape[1] - out.shape[1]) // 2
    for plane in range(v.shape[0]):
        for start in range(0, v.shape[2], _BLOCK):
            lines, sums = v[plane, :, start : start + _BLOCK], out[plane, :, start : start + _BLOCK]
            for i in range(out.shape[1]):
                row = sums[i]
                row[:] = weights[0] * lines[i + skip]
                for m in range(1, weights.size):
                    left, right = i + skip - m, i + skip + m
                    if left >= 0 and right < v.shape[1]:
                        below, above = lines[left], lines[right]
                        for k in range(row.size):
                            row[k] += weights[m] * (below[k] + parity * above[k])
                    elif left >= 0:
                        row += weights[m] * lines[left]
                    elif right < v.shape[1]:
                        row += weights[m] * parity * lines[right]


@njit()
def _combine(q, weights, parity, diagonal, u, out, scale, shift, keep):
    skip = (q.size - out.size) // 2
    window = np.empty(_BLOCK + 2 * (weights.size - 1))
    block = np.empty(_BLOCK)
    for start in range(0, out.size, _BLOCK):
        rows = min(_BLOCK, out.size - start)
        y = block[:rows]
        _sum_block(q, weights, parity, start + skip, window, y)
        middle = q[start + skip : start + skip + rows]
        part = slice(start, start + rows)
        d, given, new = diagonal[part], u[part], out[part]
        for i in range(rows):
            new[i] = scale * (y[i] + d[i] * middle[i]) + shift * given[i] + keep * new[i]


@njit()
def _sum_block(v, weights, parity, start, window, out):
    """out_i = w_0 v_j + sum_m w_m (v_{j-m} + parity v_{j+m}), j = start + i."""
    rows, half = out.size, weights.size - 1
    first = start - half
    low, high = max(first, 0), min(start + rows + half, v.size)
    # The window is v around the block, and zero beyond the ends of v.
    window[: low - first] = 0.0
    window[low - first : high - first] = v[low:high]
    window[high - first :] = 0.0
    # Slices, not offsets: the compiler knows that their indices are not negative, and vectorises the loops.
    middle = window[half : half + rows]
    for i in range(rows):
        out[i] = weights[0] * middle[i]
    for m in range(1, half, 2):  # two at a time: half the traffic of the sum
        w_near, w_far = weights[m], weights[m + 1]
        left, right = window[half - m :], window[half + m :]
        far_left, far_right = window[half - m - 1 :], window[half + m + 1 :]
        for i in range(rows):
            near = left[i] + parity * right[i]
            far = far_left[i] + parity * far_right[i]
            out[i] += w_near * near + w_far * far
