"""What a lattice does not hold: waves shorter than two spacings, estimated from the spectrum of the data.

u^ is known up to K = pi / h along each axis. Beyond K it is assumed to fall at the rate at which it falls from 0.4 K
to 0.8 K,

    |u^(K + k)| = a r^(5 k / 2 K),   r = a / b,   a, b the greatest |u^| from 0.8 K to K, and from 0.4 K to K / 2,

This holds for an exponential, and u^ of a Gaussian falls faster. The estimate uses the rate, and not the ratio of u^ at
K to u^(0): of a spike on a wide hill, u^(0) is all of the hill. On the lattice the waves 2 K - k and 2 K + k look like
the wave k. The data are right there at the start. What is wrong later is the difference of the factors by which the
waves decay, f(k) - f(2 K - k).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import reduce

import numpy as np

__all__ = ["ShortWaves"]

_NODES = 8  # of the integral over the waves from 0 to K
_GONE = 8.0  # an exponent: exp(-8) of a wave counts as nothing
_TINY = float(np.finfo(float).tiny)


class ShortWaves:
    """How u^ falls along each axis, for each of the data and for each wave along the other axes.

    Parameters
    ----------
    spectrum : array, shape (.., L, .., L // 2 + 1)
        u^, as of a real transform.
    dim : int
        How many of its axes are space.
    length : int
        L.
    """

    def __init__(self, spectrum: np.ndarray, dim: int, length: int) -> None:
        data, own = spectrum.shape[: spectrum.ndim - dim], spectrum.shape[spectrum.ndim - dim :]
        self._each, self._dim, self._length = spectrum.reshape(math.prod(data), *own), dim, length

    def _rates(self) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """For each axis a and r, shape (data, waves); r is at most 1."""
        for a, b in zip(self._greatest(0.8, 1.0), self._greatest(0.4, 0.5), strict=True):
            yield a, np.minimum(1.0, a / (b + _TINY))

    def _greatest(self, low: float, top: float) -> list[np.ndarray]:
        """The greatest |u^| from low K to top K, on both sides of zero: at one wave the aliases of some data cancel."""
        length, half = self._length, self._length // 2
        first, last = int(low * half), int(top * half)
        sides = slice(first, last + 1), slice(length - last, length + 1 - max(first, 1))
        greatest = []
        for axis in range(1, self._dim + 1):
            bands = [
                np.maximum.reduce(np.abs(self._each[(*(slice(None),) * axis, side)]), axis)
                for side in (sides if axis < self._dim else sides[:1])
            ]
            band = reduce(np.maximum, bands)
            greatest.append(band.reshape(len(band), math.prod(band.shape[1:])))
        return greatest

    @property
    def of_the_integral(self) -> np.ndarray:
        """What the waves 2 K may add to the integral, shape (data,)."""
        return np.asarray(sum(2.0 * a[:, 0] * r[:, 0] ** 2.5 for a, r in self._rates()))

    def at_most(self, alpha: float, tau: float) -> list[float]:
        """Return a bound of `of_a_peak`, as if u^ did not fall beyond K, nor along the other axes.

        Of an axis 2 H_0 int_0^1 exp(-kappa c s^alpha) ds <= 2 H_0 min(1, (kappa c)^(-1/alpha)), c = tau pi^alpha. In
        H_0, along one of the other axes, sum_q exp(-kappa^2 tau q^alpha) / L <= 1/L + (kappa^2 tau)^(-1/alpha) / pi.
        """
        kappa = _slowed(self._dim, alpha)
        weight = 2.0 * min(1.0, (kappa * tau) ** (-1.0 / alpha) / math.pi)
        if self._dim > 1:
            across = 1.0 / self._length + (kappa * kappa * tau) ** (-1.0 / alpha) / math.pi
            weight *= min(1.0, across) ** (self._dim - 1)
        first = int(0.8 * (self._length // 2))
        band = slice(first, self._length - first + 1)  # on both sides of zero, where there are two
        greatest = []
        for axis in range(1, self._dim + 1):
            size = np.abs(self._each[(*(slice(None),) * axis, band)])
            flat = size.reshape(len(size), math.prod(size.shape[1:]))
            greatest.append(np.maximum.reduce(flat, 1).tolist())
        return [weight * sum(a) for a in zip(*greatest, strict=True)]

    def of_a_peak(self, alpha: float, tau: float) -> list[float]:
        """Return how far off a peak of each of the data may be after the scaled time tau: if all waves are in phase.

        For a wave of s K along an axis and of q along the others, with c = tau pi^alpha, kappa = 2^(alpha/2 - 1),

            f(s K, q) <= exp(-kappa tau q^alpha) exp(-kappa c s^alpha),
            1 - f((2 - s) K, q) / f(s K, q) <= 1 - exp(-c ((2 - s)^alpha - s^alpha)).

        On the line q = 0 and kappa = 1: both are equal. H_p, the sum of a r^p exp(-kappa tau q^alpha) over q, has a
        logarithm that is convex in p: H_p <= H_0 R^p with R = (H_5 / H_0)^(1/5). An integral over s is left.
        """
        dim = self._dim
        kappa = _slowed(dim, alpha)
        nodes = _nodes(alpha, tau * math.pi**alpha, kappa)
        wrong = [0.0] * len(self._each)
        across = {last: self._across(last, alpha, kappa * tau) for last in {True, dim == 1}}
        for axis, (a, r) in enumerate(self._rates()):
            square, weights = r * r, across[axis == dim - 1]
            h_0, h_5 = a @ weights, (a * r * square * square) @ weights
            for one, (h0, h5) in enumerate(zip(h_0.tolist(), h_5.tolist(), strict=True)):
                if h5 > 0.0:
                    wrong[one] += h0 * _integral(0.5 * math.log(h5 / h0), nodes)
        return wrong

    def _across(self, last: bool, alpha: float, tau: float) -> np.ndarray:
        """Return exp(-tau q^alpha) times the weight of a wave along the axes but one, the `last` or another."""
        dim, length = self._dim, self._length
        if dim == 1:
            return np.ones(1)
        every = np.square(2.0 * np.pi * np.fft.fftfreq(length))
        half = every[: length // 2 + 1]
        square = reduce(np.add.outer, [every] * (dim - 2) + [every if last else half])
        weights = np.exp(-tau * square ** (0.5 * alpha))
        weights *= float(length) ** (1 - dim)
        if not last:
            weights[..., 1 : (length + 1) // 2] *= 2.0  # and their conjugates
        return np.asarray(weights.ravel())


def _slowed(dim: int, alpha: float) -> float:
    """Return kappa: (x + y)^(alpha / 2) >= kappa (x^(alpha / 2) + y^(alpha / 2)), by concavity."""
    return 1.0 if dim == 1 else 2.0 ** (0.5 * alpha - 1.0)


def _nodes(alpha: float, c: float, kappa: float) -> list[tuple[float, float]]:
    """Return s, and what is wrong of a wave there, see `of_a_peak`, times the width of a node."""
    reach = min(1.0, (_GONE / (kappa * c)) ** (1.0 / alpha))  # beyond nothing is left
    nodes = []
    for s in (reach * (j + 0.5) / _NODES for j in range(_NODES)):
        left, change = s**alpha, (2.0 - s) ** alpha - s**alpha
        nodes.append((s, -reach / _NODES * math.exp(-kappa * c * left) * math.expm1(-c * change)))
    return nodes


def _integral(steep: float, nodes: list[tuple[float, float]]) -> float:
    """Return the integral of (|u^(2 K - k)| + |u^(2 K + k)|) / a with R^(5/2) = exp(steep)."""
    return sum(w * (math.exp(steep * (1.0 - s)) + math.exp(steep * (1.0 + s))) for s, w in nodes)
