"""Lattice sums whose weights vanish, to round-off, a few smoothing lengths away: Gaussian kernels."""

from __future__ import annotations

import numba as nb
import numpy as np

__all__ = ["BandedConvolution"]

# exp(-r^2) falls below the round-off of a unit sum, 1e-18, at r = 6.44; the order-IV kernels may hold
# exp(-r^2 / 2), which does so at r = 9.1.
_REACH = {2: 6.5, 4: 9.2}
_BLOCK = 512  # rows at a time, so that the sums stay in the first-level cache


class BandedConvolution:
    """y_i = sum_{|m| <= M} w_m v_{i-m} over the lattice points present, with w_{-m} = parity * w_m.

    Parameters
    ----------
    weights : array, shape (M + 1,)
        w_m for m = 0 .. M.
    parity : {1, -1}
        Whether w is even or odd.
    """

    def __init__(self, weights: np.ndarray, parity: int) -> None:
        self.half_band = weights.size - 1
        # Stored for the correlation sum_k taps_k v_{i - M + k}.
        self._taps = np.concatenate([weights[:0:-1], parity * weights])
        self._taps[self.half_band] = weights[0]

    @staticmethod
    def reach(overlap: float, order: int) -> int:
        """Return the half band M beyond which a Gaussian kernel of this order and overlap is nil."""
        return int(np.ceil(_REACH[order] * overlap))

    def __call__(self, v: np.ndarray, out: np.ndarray) -> np.ndarray:
        """Write y for the points in the middle of v, as many as `out` has, into `out`; return it."""
        _correlate(v, self._taps, (v.size - out.size) // 2, out)
        return out


@nb.njit(cache=True, nogil=True)
def _correlate(v, taps, skip, out):
    half = taps.size // 2
    for start in range(0, out.size, _BLOCK):
        stop = min(start + _BLOCK, out.size)
        out[start:stop] = 0.0
        for k in range(taps.size):
            shift = skip + k - half
            tap = taps[k]
            for row in range(max(start, -shift), min(stop, v.size - shift)):
                out[row] += tap * v[row + shift]
