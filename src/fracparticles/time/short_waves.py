"""What a lattice does not hold: waves shorter than two spacings, estimated from the spectrum of the data.

u^ is known up to K = pi / h along each axis, from the sums over the others; at 2 K, which looks like a constant, it is
the square of that at K if it falls like an exponential, and less if it falls like a Gaussian.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.fft import rfft

__all__ = ["unresolved", "unresolved_of"]

_NEAR = 0.8  # of K: at K itself the two aliases of data centred between two points cancel
_TINY = float(np.finfo(float).tiny)


def unresolved(u: np.ndarray) -> float:
    """Return what the data, shape (data, N, .., N), may have at the wavenumber 2 K, K = pi / h, over their greatest."""
    others = [tuple(k for k in range(1, u.ndim) if k != axis) for axis in range(1, u.ndim)]
    return _at_twice([rfft(u.sum(axis=axes)) for axes in others])


def unresolved_of(spectrum: np.ndarray, dim: int) -> float:
    """Return the same from u^, shape (.., N, .., N // 2 + 1)."""
    half = slice(spectrum.shape[-1])
    places: list[tuple[Any, ...]] = [(*(0,) * k, half, *(0,) * (dim - 1 - k)) for k in range(dim)]
    return _at_twice([spectrum[(..., *place)] for place in places])


def _at_twice(lines: Sequence[np.ndarray]) -> float:
    """From the spectra along each axis, shape (.., N // 2 + 1)."""
    shares = []
    for line in lines:
        size = np.abs(line)
        last = np.maximum.reduce(size[..., int(_NEAR * (size.shape[-1] - 1)) :], axis=-1)
        shares.append(last / (np.maximum.reduce(size, axis=-1) + _TINY))
    total = sum(2.0 * share * share for share in shares)
    return min(1.0, float(np.max(total, initial=0.0) if np.ndim(total) else total))
