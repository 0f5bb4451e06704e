r"""Linear stability of markers at equal distances h and of equal weights, for the diffusion flux (7).

With x_j = j h + d_j, d_j = exp(i q j h) and F_x = 0 on the lattice, (7) gives d d_j/dt = sigma(q) d_j with

    sigma(q) = - sum_m S_eps''(m h) (1 - cos(q m h)) / sum_m S_eps(m h),

and for many markers per eps, by Poisson's formula,

    sigma(q) = -q^2 S^(eps q).

The exact rate is -q^2. Where the transform S^ of the shape function is negative the perturbation grows: markers
gather in clusters 2 pi / q apart. Where S^ > 0 an explicit step must obey dt < 2 / max(-sigma) (midpoint rule).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from fracparticles.arguments import finite_array, instance, real_between
from fracparticles.errors import InvalidInput
from fracparticles.markers.shapes import Shape
from fracparticles.moving.lagrangian import MIDPOINT_LIMIT

__all__ = ["Extremes", "extremes", "lattice_rate", "rate"]

_LARGEST = 1e100
_MOST_TERMS = 2**26


def rate(shape: Shape, k: Any) -> np.ndarray:
    """Return eps^2 sigma = -k^2 S^(k) at k = eps q, for many markers per eps.

    Raises `InvalidInput` if it is not a shape function, or k is not finite or too large for its transform.
    """
    transform = instance("shape", shape, Shape).transform(k)
    k = np.clip(finite_array("k", k), -_LARGEST, _LARGEST)
    return -k * k * transform


def lattice_rate(shape: Shape, k: Any, spacing: float) -> np.ndarray:
    """Return eps^2 sigma at k = eps q for markers `spacing` = h / eps apart.

    Where S'' jumps, at |x| = eps, a marker counts half: its neighbour is inside as often as outside.

    Raises `InvalidInput` if the shape function has no second derivative, k is not finite, or the spacing is below
    1e-6 or so small that the k and the neighbours together are too many.
    """
    shape = instance("shape", shape, Shape)
    h, k = real_between("spacing", spacing, 1e-6, 1e6), finite_array("k", k)
    if k.size * shape.reach / h > _MOST_TERMS:
        raise InvalidInput("spacing", h, f"at most {_MOST_TERMS} terms", "Give fewer k.")
    m = np.arange(1, math.floor(shape.reach / h * (1.0 + 1e-12)) + 1)
    curvature, value = shape(m * h, 2), shape(m * h)
    curvature = np.where(np.isclose(m * h, shape.reach), 0.5, 1.0) * curvature
    total = float(shape(0.0)) + 2.0 * value.sum()
    return -2.0 * (1.0 - np.cos(np.multiply.outer(k, m * h))) @ curvature / total


@dataclass(frozen=True)
class Extremes:
    """What the rates -k^2 S^(k) say of a shape function.

    Attributes
    ----------
    growth, k_growth : float
        The largest eps^2 sigma and its k; zero for a shape function without growth.
    first_zero : float
        Where S^ first turns negative; infinite if it does not.
    decay, k_decay : float
        The largest -eps^2 sigma and its k.
    """

    growth: float
    k_growth: float
    first_zero: float
    decay: float
    k_decay: float

    @property
    def eta(self) -> float:
        """The constant of dt < eta eps^2: 2 / decay."""
        return MIDPOINT_LIMIT / self.decay

    @property
    def wavelength(self) -> float:
        """Distance of the fastest-growing clusters, in units of eps."""
        return 2.0 * math.pi / self.k_growth if self.growth > 0.0 else math.inf


def extremes(shape: Shape, largest: float = 30.0) -> Extremes:
    """Return the extremes of the rate over 0 < k < `largest`, each refined by a parabola through three points.

    Raises `InvalidInput` if it is not a shape function, or `largest` not from 1 to 2000.
    """
    return _extremes(instance("shape", shape, Shape), real_between("largest", largest, 1.0, 2000.0))


@lru_cache(maxsize=64)
def _extremes(shape: Shape, largest: float) -> Extremes:
    k = np.linspace(0.0, largest, 6001)[1:]
    sigma, transform = rate(shape, k), shape.transform(k)
    # Round-off makes the transform of S8 vanish far out; only what is clearly negative counts.
    below = np.flatnonzero(transform < -1e-12)
    k_decay, decay = _peak(k, -sigma)
    if not below.size:
        return Extremes(0.0, 0.0, math.inf, decay, k_decay)
    i = below[0]
    zero = k[i - 1] + (k[i] - k[i - 1]) * transform[i - 1] / (transform[i - 1] - transform[i])
    k_growth, growth = _peak(k, sigma)
    return Extremes(growth, k_growth, float(zero), decay, k_decay)


def _peak(k: np.ndarray, y: np.ndarray) -> tuple[float, float]:
    i = int(np.argmax(y))
    if i in (0, k.size - 1):
        return float(k[i]), float(y[i])
    a, b, c = y[i - 1 : i + 2]
    shift = 0.5 * (a - c) / (a - 2.0 * b + c)
    return float(k[i] + shift * (k[1] - k[0])), float(b - 0.25 * (a - c) * shift)
