"""What a lattice does not hold: waves shorter than two spacings, estimated from the spectrum of the data.

u^ is known up to K = pi / h along each axis, from the sums over the others; at 2 K, which looks like a constant, it is
the square of that at K if it falls like an exponential, and less if it falls like a Gaussian.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.fft import rfft

__all__ = ["unresolved", "unresolved_of"]

_NEAR = 0.8  # of K: at K itself the two aliases of data centred between two points cancel
_LEAST = 1e-280  # a square that has not lost its digits
_TINY = float(np.finfo(float).tiny)


def unresolved(u: np.ndarray) -> float:
    """Return what the data, shape (data, N, .., N), may have at the wavenumber 2 K, K = pi / h, over their greatest."""
    others = [tuple(k for k in range(1, u.ndim) if k != axis) for axis in range(1, u.ndim)]
    return _at_twice(np.array([rfft(u.sum(axis=axes)) for axes in others]))


def unresolved_of(spectrum: np.ndarray, dim: int, enough: float) -> float:
    """Return the same from u^, shape (.., N, .., N // 2 + 1), or an upper bound that is not above `enough`."""
    half = slice(spectrum.shape[-1])
    places: list[tuple[Any, ...]] = [(*(0,) * k, half, *(0,) * (dim - 1 - k)) for k in range(dim)]
    lines = np.array([spectrum[(..., *place)] for place in places])
    if lines.ndim > 2:
        return _at_twice(lines.reshape(dim, -1, lines.shape[-1]))
    # Of one datum. The root of a sum of squares is not below the greatest: one pass.
    short, whole = lines[:, _first(lines) :], abs(lines.item(0)) ** 2
    sums = 2.0 * np.vdot(short, short).real
    if _LEAST < whole < np.inf and sums <= enough * whole:
        return float(sums / whole)
    return _at_twice(lines[:, None])


def _at_twice(lines: np.ndarray) -> float:
    """From the spectra along each axis, shape (n, data, N // 2 + 1)."""
    size = np.abs(lines)
    last = np.maximum.reduce(size[..., _first(size) :], axis=-1)
    greatest = np.maximum.reduce(size, axis=-1)
    shares = last / np.maximum(greatest, _TINY)
    shares *= shares
    return min(1.0, 2.0 * float(np.maximum.reduce(np.add.reduce(shares), initial=0.0)))


def _first(lines: np.ndarray) -> int:
    """The first of some waves near K."""
    return int(_NEAR * (lines.shape[-1] - 1))
