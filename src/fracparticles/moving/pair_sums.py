"""Sums over scattered particles pair by pair: over all pairs, or those that a kernel reaches; see `scattered`."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence

import numpy as np

from fracparticles._compiled import njit
from fracparticles.errors import InvalidInput
from fracparticles.moving.scattered_base import ScatteredKernel, ScatteredSum

__all__ = ["NaiveScatteredSum", "NeighbourSum"]

_PAIRS = 2**14  # pairs evaluated together: they stay in the second-level cache


class _PairSum(ScatteredSum):
    """The sum over the pairs that `_partners` gives, a block of rows at a time."""

    def _add_to(self, out, x, q, z):
        z = x if z is None else z
        x, q, first, last = self._partners(x, q, z)
        count = last - first
        ends = np.cumsum(count)
        row = 0
        while row < z.size:
            done = ends[row] - count[row]
            stop = max(row + 1, int(np.searchsorted(ends, done + _PAIRS, side="right")))
            distance = np.empty(ends[stop - 1] - done)
            _distances(x, z[row:stop], first[row:stop], last[row:stop], self._epsilon, distance)
            for k, y in zip(self._kernels, out, strict=True):
                values = np.ascontiguousarray(k.profile(distance))
                _add_up(values, q, first[row:stop], last[row:stop], y[row:stop])
            row = stop
        out /= self._epsilon

    @abstractmethod
    def _partners(
        self, x: np.ndarray, q: np.ndarray, z: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return x and q in an order in which the partners of z_i are x[first_i:last_i], first and last."""


class NaiveScatteredSum(_PairSum):
    """The sums over all pairs, O(N M)."""

    def _partners(self, x, q, z):
        return x, q, np.zeros(z.size, dtype=np.int64), np.full(z.size, x.size)


class NeighbourSum(_PairSum):
    """The sums over the pairs that are no farther apart than the widest kernel reaches.

    Raises `InvalidInput` if a kernel has no finite reach.
    """

    def __init__(self, kernels: Sequence[ScatteredKernel], epsilon: float) -> None:
        super().__init__(kernels, epsilon)
        self._reach = max(k.reach for k in self._kernels) * self._epsilon
        if not math.isfinite(self._reach):
            allowed = "a finite number for a sum over neighbours"
            raise InvalidInput("reach", math.inf, allowed, "Take another sum.")

    def _partners(self, x, q, z):
        order = np.argsort(x, kind="stable")
        x, q = x[order], q[order]
        first = np.searchsorted(x, z - self._reach, side="left")
        return x, q, first, np.searchsorted(x, z + self._reach, side="right")


@njit()
def _distances(x, z, first, last, epsilon, out):
    pair = 0
    for i in range(z.size):
        for j in range(first[i], last[i]):
            out[pair] = (z[i] - x[j]) / epsilon
            pair += 1


@njit()
def _add_up(values, q, first, last, out):
    pair = 0
    for i in range(out.size):
        total = 0.0
        for j in range(first[i], last[i]):
            total += values[pair] * q[j]
            pair += 1
        out[i] = total
