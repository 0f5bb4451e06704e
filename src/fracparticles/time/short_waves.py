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
    high, fall : tuple of arrays, shape (data, waves)
        a and min(1, a / b), an axis each.
    """

    length: int
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
            along = each if axis == dim else np.moveaxis(each, axis, -1)
            high, middle = (
                _greatest(along, int(low * half), int(top * half), both=axis < dim)
                for low, top in _BANDS
            )
            found.append((high, np.minimum(1.0, high / (middle + _TINY))))
        return cls(length, *zip(*found, strict=True))

    @property
    def of_the_integral(self) -> np.ndarray:
        """What the waves 2 K may add to the integral, shape (data,)."""
        return np.asarray(
            sum(2.0 * self._beyond(axis, 1.0)[:, 0] for axis in range(len(self.high)))
        )

    def _beyond(self, axis: int, part: np.ndarray | float) -> np.ndarray:
        """|u^(K + k)| for k / K, shape (data, waves), after that of the part."""
        return np.asarray(self.high[axis] * self.fall[axis] ** (2.5 * np.asarray(part)))

    def at_most(self, alpha: float, tau: float) -> np.ndarray:
        """Return a bound of `of_a_peak`, shape (data,); on the line it is that itself.

        As if the other axes had no waves: f(k) - f(2 K - k) falls with theirs. With H_q = sum a (a / b)^q over them
        log H_q is convex in q, so that H_q <= H_0 (H_5 / H_0)^(q / 5).
        """
        parts, change = _change(alpha, tau, np.zeros(1))
        dim, wrong = len(self.high), np.zeros(len(self.high[0]))
        for axis, (high, fall) in enumerate(zip(self.high, self.fall, strict=True)):
            weight = 1.0 if axis == dim - 1 else 2.0  # of conjugates
            h = np.add.reduce(high, 1)
            r = fall[:, 0]
            if dim > 1:
                r = (np.add.reduce(high * fall**5, 1) / (h + _TINY)) ** 0.2
            wrong += weight * h * (_aliases(r[:, None], parts[:, 0]) @ change[:, 0])
        return np.asarray(wrong * float(self.length) ** (1 - dim))

    def of_a_peak(self, alpha: float, tau: float) -> np.ndarray:
        """Return how far off a peak may be after the scaled time tau, shape (data,): if all waves are in phase."""
        wrong = np.zeros(len(self.high[0]))
        for axis, (high, fall) in enumerate(zip(self.high, self.fall, strict=True)):
            square, weight = self._across(axis)
            parts, change = _change(alpha, tau, square)
            aliases = high * _aliases(fall, parts[..., None])
            wrong += np.einsum("pdw,pw->d", aliases, weight * change)
        return wrong

    def _across(self, axis: int) -> tuple[np.ndarray, np.ndarray]:
        """The squares of the waves along the other axes, and their weights, shape (waves,)."""
        dim = len(self.high)
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


def _aliases(fall: np.ndarray, parts: np.ndarray) -> np.ndarray:
    """Return |u^(2 K - k)| + |u^(2 K + k)| over a, by k / K."""
    return np.asarray(fall ** (2.5 - 2.5 * parts) + fall ** (2.5 + 2.5 * parts))


def _greatest(along: np.ndarray, first: int, last: int, both: bool) -> np.ndarray:
    """The greatest |u^| of the waves first .. last of the last axis, and of those on the other side of zero if `both`.

    Shape (data, waves along the other axes).
    """
    band = np.maximum.reduce(np.abs(along[..., first : last + 1]), axis=-1)
    if both:
        other = along[..., along.shape[-1] - last : along.shape[-1] - max(first, 1) + 1]
        band = np.maximum(band, np.abs(other).max(axis=-1, initial=0.0))
    return band.reshape(len(along), math.prod(band.shape[1:]))
