r"""Scattered particles spread over a lattice, and lattice values interpolated to scattered points:

    Q_l = sum_j q_j phi(l - c_j),     y_i = sum_l phi(c_i - l) Y_l,

c the positions in lattice spacings and phi the Kaiser-Bessel window of W = 14 spacings,

    phi(r) = I_0(b (1 - (2 r / W)^2)^(1/2)) / I_0(b),     |r| <= W/2,
    phi^(k) = W sinh(s) / (s I_0(b)),     s^2 = b^2 - (k W / 2)^2,     |k| <= pi.

Spreading followed by a transform of the lattice gives phi^(k) q^(k), up to aliases phi^(2 pi - k) q^(k). Where a
Gaussian exp(-(12 k / pi)^2 / 4) follows, as it does in `scattered`, these are below 2e-13 of the whole for b = 2.2 W.
J. Keiner, S. Kunis & D. Potts, ACM Trans. Math. Softw. 36 (2009) 19, has the window and its aliases.

Between two lattice points phi is a polynomial of degree 15, to 3e-15. The windows m and W - 1 - m mirror each other:
one even and one odd polynomial serve both.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from scipy.special import i0e

from fracparticles._compiled import njit
from fracparticles.moving.polynomials import fitted, horner

__all__ = ["WIDTH", "interpolate", "spread", "window", "window_transform", "window_weights"]

WIDTH = 14  # W
_SHAPE = 2.2 * WIDTH  # b
_BLOCK = 16  # particles worked on together


def window(r: np.ndarray) -> np.ndarray:
    """Return phi(r) for |r| <= W/2."""
    root = _SHAPE * np.sqrt(np.maximum(1.0 - (2.0 * r / WIDTH) ** 2, 0.0))
    return np.asarray(np.exp(root - _SHAPE) * i0e(root) / i0e(_SHAPE))


def window_transform(k: np.ndarray) -> np.ndarray:
    """Return phi^(k) for |k| <= pi, k in radians a spacing."""
    s = np.sqrt(_SHAPE**2 - (0.5 * WIDTH * k) ** 2)
    return np.asarray(0.5 * WIDTH * np.exp(s - _SHAPE) * -np.expm1(-2.0 * s) / (s * i0e(_SHAPE)))


def window_weights(cell: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return for each position c the first of its W lattice points, and phi at all of them.

    Parameters
    ----------
    cell : array, shape (N,)
        Positions, in spacings.

    Returns
    -------
    first : array of int, shape (N,)
    weights : array, shape (N, W)
    """
    first, weights = np.empty(cell.size, dtype=np.int64), np.empty((cell.size, WIDTH))
    _weights(cell, *_polynomials(), first, weights)
    return first, weights


@cache
def _polynomials() -> tuple[np.ndarray, np.ndarray]:
    """The polynomials of phi((y + 1) / 2 + m - W/2), m < W/2."""
    left = np.arange(WIDTH // 2) - WIDTH / 2
    return fitted(lambda y: window(0.5 * (y[:, None] + 1.0) + left))


@njit(error_model="numpy", fastmath={"contract"})
def _weights(cell, even, odd, first, weights):
    y, symmetric, skew = np.zeros(_BLOCK), np.empty(_BLOCK), np.empty(_BLOCK)
    for start in range(0, cell.size, _BLOCK):
        count = min(_BLOCK, cell.size - start)
        for j in range(count):
            left = math.ceil(cell[start + j] - 0.5 * WIDTH)
            first[start + j] = int(left)
            y[j] = 2.0 * (left - cell[start + j] + 0.5 * WIDTH) - 1.0
        for m in range(WIDTH // 2):
            # All of the block, so that the compiler takes several at a time.
            for j in range(_BLOCK):
                square = y[j] * y[j]
                symmetric[j] = horner(even[m], square)
                skew[j] = y[j] * horner(odd[m], square)
            for j in range(count):
                weights[start + j, m] = symmetric[j] + skew[j]
                weights[start + j, WIDTH - 1 - m] = symmetric[j] - skew[j]


@njit(error_model="numpy", fastmath={"contract"})
def spread(first, weights, q, out):
    """Write Q_l into `out`; its lattice points are those that the weights name."""
    out[:] = 0.0
    for j in range(q.size):
        here, phi, strength = out[first[j] : first[j] + WIDTH], weights[j], q[j]
        for m in range(WIDTH):
            here[m] += strength * phi[m]


@njit(error_model="numpy", fastmath={"contract", "reassoc"})
def interpolate(first, weights, values, out):
    """Write y_i into each row of `out`, of the lattice values Y in that row of `values`."""
    for i in range(out.shape[1]):
        phi = weights[i]
        for row in range(out.shape[0]):
            here = values[row, first[i] : first[i] + WIDTH]
            total = 0.0
            for m in range(WIDTH):
                total += phi[m] * here[m]
            out[row, i] = total
