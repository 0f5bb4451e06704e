"""Periodic data by one pair of Fourier transforms: u^(k, t) = f(k) u^(k, 0), f = exp(-D t |k|^alpha) or a given one.

In units of the spacing f is a function of theta = k h, -pi < theta <= pi, and of tau = D t / h^alpha. Where the result
holds no waves shorter than 2 m spacings, every m-th point determines it, and only these points are transformed back.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import reduce

import numpy as np
from scipy.fft import irfft, irfftn, rfft, rfftn

from fracparticles.arguments import finite_array, function, of_shape
from fracparticles.time.short_waves import ShortWaves

__all__ = ["Amplification", "Circle", "Look", "unseen"]

Amplification = Callable[[np.ndarray], np.ndarray]
Look = Callable[[np.ndarray], object]
"""It is called with u^ of the data before the run."""


def unseen(spectrum: np.ndarray) -> None:
    """Do nothing: u^ of the data is not looked at."""


class Circle:
    """A run on L^n points that is periodic.

    Parameters
    ----------
    points : int
        L.
    dim : int
        n.
    alpha : float
        Fractional order.
    scaled_time : float
        tau.
    amplification : callable, optional
        f(theta) for theta in [0, pi]; in two and three dimensions the last axis of its argument holds the vector. Left
        out, it is exp(-tau |theta|^alpha).
    every : int
        m: the result is at every m-th point; L / m is even.
    moved : sequence of float, optional
        The displacement of the points of the result, in spacings along each axis.
    """

    def __init__(
        self,
        points: int,
        dim: int,
        alpha: float,
        scaled_time: float,
        amplification: Amplification | None = None,
        every: int = 1,
        moved: Sequence[float] | None = None,
    ) -> None:
        self._axes, self._every, self._points = tuple(range(-dim, 0)), every, points
        self._shape = (points // every,) * dim
        tau = scaled_time * float(every) ** -alpha
        self._amplification = _amplification(points // every, dim, alpha, tau, amplification)
        if moved is not None and any(moved):
            steps = [by / every for by in moved]
            self._amplification = self._amplification * _displacement(points // every, steps)

    def __call__(self, u: np.ndarray, look: Look = unseen) -> np.ndarray:
        """Return the result from u, shape (.., L, .., L); show u^, the last axis as of a real transform, to `look`."""
        spectrum = np.asarray(rfft(u) if len(self._axes) == 1 else rfftn(u, axes=self._of(u)))
        look(spectrum)
        if self._every > 1:
            spectrum = self._long_waves(spectrum)
        # Not in place: `look` may have kept the spectrum of the data.
        spectrum = spectrum * self._amplification
        if len(self._axes) == 1:
            return np.asarray(irfft(spectrum, self._shape[0]))
        return np.asarray(irfftn(spectrum, self._shape, axes=self._of(spectrum)))

    def waves(self, spectrum: np.ndarray) -> ShortWaves:
        """Return estimates, from u^, about waves too short for the circle."""
        return ShortWaves(spectrum, len(self._axes), self._points)

    def _of(self, u: np.ndarray) -> tuple[int, ...] | None:
        """The axes of space; None if u has no others, since scipy then need not sort them out."""
        return None if u.ndim == len(self._axes) else self._axes

    def _long_waves(self, spectrum: np.ndarray) -> np.ndarray:
        half = self._shape[0] // 2
        spectrum = spectrum[..., : half + 1] * float(self._every) ** -len(self._axes)
        for axis in self._axes[:-1]:
            lines = np.moveaxis(spectrum, axis, 0)
            spectrum = np.moveaxis(np.concatenate([lines[:half], lines[-half:]]), 0, axis)
        return spectrum


def _amplification(
    points: int, dim: int, alpha: float, tau: float, given: Amplification | None
) -> np.ndarray:
    """Return f at theta = 2 pi m / L, the last axis as of a real transform."""
    last = np.arange(points // 2 + 1) * (2.0 * np.pi / points)
    if given is not None:
        waves = last if dim == 1 else _waves(last, points, dim)
        values = function("amplification", given)(waves)
        values = finite_array("amplification", values, complex_too=True)
        shape = last.shape if dim == 1 else waves.shape[:-1]
        return of_shape("amplification", values, shape, "a number for each wave")
    if dim == 1:
        last **= alpha
        last *= -tau
        return np.exp(last, out=last)
    # |theta| is the same on either side of zero: one side of each axis is computed, and the other is its mirror.
    along = last * last
    square = reduce(lambda before, axis: before[..., None] + axis, [along] * dim)
    square **= 0.5 * alpha
    square *= -tau
    decay = np.exp(square, out=square)
    for axis in range(dim - 1):
        ahead, behind = [slice(None)] * dim, [slice(None)] * dim
        ahead[axis], behind[axis] = slice((points + 1) // 2), slice(points // 2, 0, -1)
        decay = np.concatenate([decay[tuple(ahead)], decay[tuple(behind)]], axis)
    return decay


def _waves(last: np.ndarray, points: int, dim: int) -> np.ndarray:
    """Return the vectors theta, shape (L, .., L // 2 + 1, n)."""
    every = np.fft.fftfreq(points, 1.0 / points) * (2.0 * np.pi / points)
    axes = np.meshgrid(*[every] * (dim - 1), last, indexing="ij", sparse=True)
    return np.stack(np.broadcast_arrays(*axes), axis=-1)


def _displacement(points: int, moved: Sequence[float]) -> np.ndarray:
    """Return exp(i theta s), s in spacings."""
    every = np.fft.fftfreq(points, 1.0 / points) * (2.0 * np.pi / points)
    waves = [every] * (len(moved) - 1) + [np.abs(every[: points // 2 + 1])]
    phases = [np.exp(1j * s * theta) for theta, s in zip(waves, moved, strict=True)]
    return np.asarray(reduce(np.multiply.outer, phases))
