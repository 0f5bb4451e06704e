r"""Burgers' equation f_t + f f_x = mu f_xx, Sec. 4, as a conservation equation (2):

    V = f / 2 - mu f_x / f,

and its solution from a point source of total M > 0 at t = 0, by the Cole-Hopf transform f = -2 mu phi_x / phi:

    phi(x, t) = 1 - (1 - exp(-R)) erfc(-x / s) / 2,     s = 2 sqrt(mu t),     R = M / (2 mu).

For large R it is a triangle with a shock, f = x / t up to x = sqrt(2 M t); for small R a Gaussian.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import erfc, erfcinv

from fracparticles.markers.solver import Flux
from fracparticles.special.arguments import positive_real

__all__ = ["PointSource", "burgers"]


def burgers(mu: float) -> Flux:
    """Return the flux V F = F^2 / 2 - mu F_x."""
    mu = positive_real("mu", mu)

    def flux(x: np.ndarray, fields: np.ndarray) -> np.ndarray:
        return 0.5 * fields[0] ** 2 - mu * fields[1]

    return flux


@dataclass(frozen=True)
class PointSource:
    """The solution from a point source.

    Attributes
    ----------
    mu, total : float
    """

    mu: float
    total: float

    def __post_init__(self) -> None:
        positive_real("mu", self.mu)
        positive_real("total", self.total)

    @property
    def reynolds(self) -> float:
        """R = M / (2 mu)."""
        return self.total / (2.0 * self.mu)

    def value(self, x: np.ndarray, t: float) -> np.ndarray:
        """Return f(x, t), t > 0."""
        s = self._width(t)
        z = np.asarray(x, dtype=float) / s
        slope = -math.expm1(-self.reynolds) * np.exp(-z * z) / (s * math.sqrt(math.pi))
        return 2.0 * self.mu * slope / self._phi(z)

    def cumulative(self, x: np.ndarray, t: float) -> np.ndarray:
        """Return int_-inf^x f dx' = -2 mu log phi."""
        return -2.0 * self.mu * np.log(self._phi(np.asarray(x, dtype=float) / self._width(t)))

    def quantile(self, g: np.ndarray, t: float) -> np.ndarray:
        """Return x with cumulative(x, t) = g, 0 < g < M: where a marker with that part to its left is."""
        g = np.asarray(g, dtype=float)
        # erfc(-z) / 2 and erfc(z) / 2: the smaller of the two tells z without loss of digits.
        left = np.expm1(-g / (2.0 * self.mu)) / math.expm1(-self.reynolds)
        rest = np.expm1((self.total - g) / (2.0 * self.mu)) / math.expm1(self.reynolds)
        z = np.where(left < rest, -erfcinv(2.0 * left), erfcinv(2.0 * rest))
        return self._width(t) * z

    def _width(self, t: float) -> float:
        return 2.0 * math.sqrt(self.mu * positive_real("t", t))

    def _phi(self, z: np.ndarray) -> np.ndarray:
        # A sum of two positive terms: nothing cancels where phi is small.
        return 0.5 * (erfc(z) + math.exp(-self.reynolds) * erfc(-z))
