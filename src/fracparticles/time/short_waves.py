"""What a lattice does not hold: waves shorter than two spacings, estimated from the spectrum of the data.

u^ is known up to K = pi / h along each axis. Beyond, it is taken to fall on as it does from 0.4 K to 0.8 K,

    |u^(K + k)| = a (a / b)^(5 k / 2 K),   a, b the greatest |u^| from 0.8 K to K, and from 0.4 K to K / 2,

which is so for an exponential; that of a Gaussian falls faster. It is the rate that counts, and not what is left at K
of u^(0): of a spike on a wide hill the hill has all of that. The waves 2 K - k and 2 K + k look like the wave k. On the
lattice the data are right at the start: what is wrong later is the difference of the amplitudes, f(k) - f(2 K - k).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

__all__ = ["ShortWaves"]

_BANDS = (0.8, 1.0), (0.4, 0.5)  # of K: at one wave the aliases of some data cancel
_NODES = (np.arange(8) + 0.5) / 8.0  # k / K
_GONE = 8.0  # exp(-8)
_TINY = float(np.finfo(float).tiny)


@dataclass(frozen=True)
class ShortWaves:
    """How u^ falls along each axis, for each of the data and for each wave along the other axes.

    Attributes
    ----------
    length : int
        The points L along each axis.
    greatest : array, shape (data,)
        The greatest |u^|.
    high, fall : tuple of arrays, shape (data, waves)
        a and min(1, a / b), an axis each.
    """

    length: int
    greatest: np.ndarray
    high: tuple[np.ndarray, ...]
    fall: tuple[np.ndarray, ...]

    @classmethod
    def of(cls, spectrum: np.ndarray, dim: int, length: int) -> ShortWaves:
        """From u^, shape (.., L, .., L // 2 + 1), as of a real transform."""
        data, own = spectrum.shape[: spectrum.ndim - dim], spectrum.shape[spectrum.ndim - dim :]
        each = spectrum.reshape(math.prod(data), *own)
        half = length // 2
        found = []
        for axis in range(1, dim + 1):
            along = np.moveaxis(each, axis, -1)
            bands = []
            for low, top in _BANDS:
                first, last = int(low * half), int(top * half)
                band = np.abs(along[..., first : last + 1]).max(axis=-1)
                if axis < dim:  # and the waves on the other side of zero
                    other = along[..., length - last : length - max(first, 1) + 1]
                    band = np.maximum(band, np.abs(other).max(axis=-1, initial=0.0))
                bands.append(band.reshape(len(each), math.prod(band.shape[1:])))
            high, middle = bands
            found.append((high, np.minimum(1.0, high / (middle + _TINY))))
        lowest = each[(slice(None), *(slice(1 + half // 8),) * dim)]
        greatest = np.abs(lowest).max(axis=tuple(range(1, dim + 1)), initial=0.0)
        return cls(length, greatest, *zip(*found, strict=True))

    @property
    def of_the_integral(self) -> float:
        """What the waves 2 K may be of it, of several data the most: over the greatest |u^|, at most 1."""
        shares = sum(2.0 * self._beyond(axis, 1.0)[:, 0] for axis in range(len(self.high)))
        return min(1.0, float((shares / (self.greatest + _TINY)).max(initial=0.0)))

    def _beyond(self, axis: int, part: float) -> np.ndarray:
        """|u^(K + k)| for k / K, shape (data, waves)."""
        return np.asarray(self.high[axis] * self.fall[axis] ** (2.5 * part))

    @property
    def most(self) -> np.ndarray:
        """More than `of_a_peak` at any time, shape (data,): as if u^ did not fall beyond K at all."""
        waves = float(self.length) ** (1 - len(self.high))  # the weight of one
        return np.asarray(sum(4.0 * waves * high.sum(axis=1) for high in self.high))

    def of_a_peak(self, alpha: float, tau: float) -> np.ndarray:
        """Return how far off a peak may be after the scaled time tau, shape (data,): if all waves are in phase."""
        dim = len(self.high)
        every = np.square(2.0 * np.pi * np.fft.fftfreq(self.length))
        half = every[: self.length // 2 + 1]
        twice = np.where((half > 0.0) & (half < np.pi**2), 2.0, 1.0)  # and their conjugates
        reach = min(
            1.0, (_GONE / tau) ** (1.0 / alpha) / np.pi
        )  # k / K up to which anything is left
        wrong = np.zeros(len(self.greatest))
        for axis in range(dim):
            square: np.ndarray = np.zeros(())
            weight: np.ndarray = np.ones(())
            for other in (k for k in range(dim) if k != axis):
                last = other == dim - 1
                square = np.add.outer(square, half if last else every)
                own = twice if last else np.ones(self.length)
                weight = np.multiply.outer(weight, own / self.length)
            square, weight = square.ravel(), weight.ravel()
            for part in reach * _NODES:
                now, then = (
                    np.exp(-tau * (square + (np.pi * k) ** 2) ** (0.5 * alpha))
                    for k in (part, 2.0 - part)
                )
                aliases = self._beyond(axis, 1.0 - part) + self._beyond(axis, 1.0 + part)
                wrong += reach / _NODES.size * (aliases @ (weight * (now - then)))
        return wrong
