"""What a lattice does not hold: waves shorter than two spacings, estimated from the spectrum of the data.

u^ is known up to K = pi / h along each axis. Beyond, it is taken to fall on as it does from 0.4 K to 0.8 K,

    |u^(K + k)| = a (a / b)^(5 k / 2 K),   a, b the greatest |u^| from 0.8 K to K, and from 0.4 K to K / 2,

which is so for an exponential; that of a Gaussian falls faster. It is the rate that counts, and not what is left at K
of u^(0): of a spike on a wide hill the hill has all of that. The waves 2 K - k and 2 K + k look like the wave k. On the
lattice the data are right at the start: what is wrong later is the difference of the amplitudes, f(k) - f(2 K - k).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

__all__ = ["ShortWaves"]

_BANDS = (0.8, 1.0), (0.4, 0.5)  # of K: at one wave the aliases of some data cancel
_NODES = (np.arange(8.0)[:, None] + 0.5) / 8.0  # k / K
_GONE = 8.0  # exp(-8)
_TINY = float(np.finfo(float).tiny)


@dataclass(frozen=True)
class ShortWaves:
    """How u^ falls along each axis, for each of the data and for each wave along the other axes.

    Attributes
    ----------
    length : int
        The points L along each axis.
    high, middle : tuple of arrays, shape (data, waves)
        a and b, an axis each.
    """

    length: int
    high: tuple[np.ndarray, ...]
    middle: tuple[np.ndarray, ...]

    @classmethod
    def of(cls, spectrum: np.ndarray, dim: int, length: int) -> ShortWaves:
        """From u^, shape (.., L, .., L // 2 + 1), as of a real transform."""
        data, own = spectrum.shape[:-dim], spectrum.shape[-dim:]
        each = spectrum.reshape(math.prod(data), *own)
        half = length // 2
        high, middle = (
            tuple(
                _greatest(each, axis, int(low * half), int(top * half), both=axis < dim)
                for axis in range(1, dim + 1)
            )
            for low, top in _BANDS
        )
        return cls(length, high, middle)

    def _axes(self) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """For each axis a, and r = a / b, at most 1."""
        for a, b in zip(self.high, self.middle, strict=True):
            yield a, np.minimum(1.0, a / (b + _TINY))

    @property
    def of_the_integral(self) -> np.ndarray:
        """What the waves 2 K may add to the integral, shape (data,)."""
        return np.asarray(sum(2.0 * a[:, 0] * r[:, 0] ** 2.5 for a, r in self._axes()))

    def at_most(self, alpha: float, tau: float) -> np.ndarray:
        """Return a bound of `of_a_peak` as if u^ did not fall beyond K.

        Of an axis 2 H_0 int_0^1 exp(-c s^alpha) ds < 2 H_0 min(1, c^(-1/alpha)), with s = k / K, c = tau pi^alpha, and
        H_0 the sum of a over the waves along the other axes.
        """
        dim, c = len(self.high), tau * math.pi**alpha
        total = np.add.reduce(self.high[0], 1)
        for a in self.high[1:]:
            total += np.add.reduce(a, 1)
        # The weight of a wave, with that of conjugates; on the line there are none.
        weight = 2.0 if dim == 1 else 4.0 * float(self.length) ** (1 - dim)
        return np.asarray(weight * min(1.0, c ** (-1.0 / alpha)) * total)

    def nearly(self, alpha: float, tau: float) -> np.ndarray:
        """Return a closer bound: H_q = sum a r^q, r = a / b, has a logarithm convex in q, so H_q <= H_0 R^q with

            R = (H_5 / H_0)^(1/5),   2 H_0 max_s R^(5 (1 - s) / 2) exp(-c s^alpha),

        the greatest where c alpha s^(alpha - 1) = -5/2 log R, or s = 1.
        """
        dim, c = len(self.high), tau * math.pi**alpha
        wrong = np.zeros(len(self.high[0]))
        for axis, (a, r) in enumerate(self._axes()):
            h = np.add.reduce(a, 1)
            steep = -0.5 * np.log(np.add.reduce(a * r**5, 1) / (h + _TINY) + _TINY)  # -5/2 log R
            s = np.minimum(1.0, steep / (c * alpha)) ** (1.0 / (alpha - 1.0))
            conjugates = 2.0 if axis == dim - 1 else 4.0
            wrong += conjugates * h * np.exp(-steep * (1.0 - s) - c * s**alpha)
        return np.asarray(wrong * float(self.length) ** (1 - dim))

    def of_a_peak(self, alpha: float, tau: float) -> np.ndarray:
        """Return how far off a peak may be after the scaled time tau, shape (data,): if all waves are in phase."""
        wrong = np.zeros(len(self.high[0]))
        for axis, (a, r) in enumerate(self._axes()):
            square, weight = self._across(axis)
            parts, change = _change(alpha, tau, square)
            aliases = a * _aliases(r, parts[..., None])
            wrong += np.einsum("pdw,pw->d", aliases, weight * change)
        return wrong

    def _across(self, axis: int) -> tuple[np.ndarray, np.ndarray]:
        """The squares of the waves along the other axes, and their weights, shape (waves,)."""
        dim = len(self.high)
        if dim == 1:
            return np.zeros(1), np.ones(1)
        every = np.square(2.0 * np.pi * np.fft.fftfreq(self.length))
        half = every[: self.length // 2 + 1]
        twice = np.where((half > 0.0) & (half < np.pi**2), 2.0, 1.0)  # and their conjugates
        square: np.ndarray = np.zeros(())
        weight: np.ndarray = np.ones(())
        for other in (k for k in range(dim) if k != axis):
            last = other == dim - 1
            square = np.add.outer(square, half if last else every)
            own = twice if last else np.ones(self.length)
            weight = np.multiply.outer(weight, own / self.length)
        return square.ravel(), weight.ravel()


def _change(alpha: float, tau: float, square: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return k / K, shape (nodes, 1), and f(k) - f(2 K - k) there times the width of a node, shape (nodes, waves)."""
    # Beyond this nothing is left.
    reach = min(1.0, (_GONE / tau) ** (1.0 / alpha) / math.pi)
    parts = reach * _NODES
    both = np.square(math.pi * np.concatenate([parts, 2.0 - parts])) + square
    f = np.exp(-tau * both ** (0.5 * alpha))
    return parts, reach / len(_NODES) * (f[: len(_NODES)] - f[len(_NODES) :])


def _aliases(r: np.ndarray, parts: np.ndarray) -> np.ndarray:
    """Return |u^(2 K - k)| + |u^(2 K + k)| over a, by k / K."""
    return np.asarray(r ** (2.5 - 2.5 * parts) + r ** (2.5 + 2.5 * parts))


def _greatest(each: np.ndarray, axis: int, first: int, last: int, both: bool) -> np.ndarray:
    """The greatest |u^| of the waves first .. last of an axis, and of those on the other side of zero if `both`.

    Shape (data, waves along the other axes).
    """
    before, length = (slice(None),) * axis, each.shape[axis]
    band = np.maximum.reduce(np.abs(each[(*before, slice(first, last + 1))]), axis=axis)
    if both:
        other = each[(*before, slice(length - last, length - max(first, 1) + 1))]
        band = np.maximum(band, np.abs(other).max(axis=axis, initial=0.0))
    return band.reshape(len(each), math.prod(band.shape[1:]))
