r"""Burgers' equation f_t + f f_x = mu f_xx, Sec. 4, as a conservation equation (2):

    V = f / 2 - mu f_x / f,

and its solution from a point source of total M > 0 at t = 0, by the Cole-Hopf transform f = -2 mu phi_x / phi:

    phi(x, t) = 1 - (1 - exp(-R)) erfc(-x / s) / 2,     s = 2 sqrt(mu t),     R = M / (2 mu).

For large R it is a triangle with a shock, f = x / t up to x = sqrt(2 M t); for small R a Gaussian. Beyond R = 300
exp(R) and phi leave the range of numbers. With z = x / s >= 0 and erfcx(z) = exp(z^2) erfc(z) it is

    phi exp(z^2) = (erfcx(z) + exp(z^2 - R) erfc(-z)) / 2

that is computed. The shock is R ulp wide at best: the relative error is about that.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import erfc, erfcinv, erfcx, ndtri_exp

from fracparticles import arguments as check
from fracparticles.errors import InvalidInput
from fracparticles.markers.profiles import inside
from fracparticles.markers.solver import Flux

__all__ = ["PointSource", "burgers"]

_LARGE = 300.0  # R: exp(R) erfc(-sqrt(R)) and its like are numbers up to 700
_SHARPEST = 1e8


def burgers(mu: float) -> Flux:
    """Return the flux V F = F^2 / 2 - mu F_x.

    Raises `InvalidInput` if mu is not positive.
    """
    mu = check.scale("mu", mu)

    def flux(x: np.ndarray, fields: np.ndarray) -> np.ndarray:
        return 0.5 * fields[0] ** 2 - mu * fields[1]

    return flux


@dataclass(frozen=True)
class PointSource:
    """The solution from a point source.

    Raises `InvalidInput` if a value is outside its range; so do the methods; they take any shape.

    Attributes
    ----------
    mu, total : float
        Positive, with R = M / (2 mu) up to 1e8.
    """

    mu: float
    total: float

    def __post_init__(self) -> None:
        check.fields(self, mu=check.scale, total=check.scale)
        if not self.reynolds <= _SHARPEST:
            least = f"at least total / {2.0 * _SHARPEST:g}"
            allowed = f"{least}: the shock is not resolved by the digits of x"
            remedy = "Take a larger mu, or the limit f = x / t up to x = sqrt(2 M t)."
            raise InvalidInput("mu", self.mu, allowed, remedy)

    @property
    def reynolds(self) -> float:
        """R = M / (2 mu)."""
        return self.total / (2.0 * self.mu)

    def value(self, x: Any, t: float) -> np.ndarray:
        """Return f(x, t), t > 0."""
        z, s = self._scaled(x, t)
        r = self.reynolds
        factor = 2.0 * self.mu * -math.expm1(-r)
        with np.errstate(over="ignore", invalid="ignore"):
            slope = -math.expm1(-r) * np.exp(-z * z) / (s * math.sqrt(math.pi))
            plain = 2.0 * self.mu * slope / self._phi(np.minimum(z, 0.0) if r > _LARGE else z)
            if r <= _LARGE:
                return plain
            right = np.maximum(z, 0.0)
            scaled = 0.5 * (erfcx(right) + np.exp(right * right - r) * erfc(-right))
            return np.where(z < 0.0, plain, factor / (s * math.sqrt(math.pi)) / scaled)

    def cumulative(self, x: Any, t: float) -> np.ndarray:
        """Return int_-inf^x f dx' = -2 mu log phi."""
        z, _ = self._scaled(x, t)
        r = self.reynolds
        if r <= _LARGE:
            # log1p where phi is near 1: the logarithm would lose the digits of the small part.
            missing = 0.5 * math.expm1(-r) * erfc(-z)
            with np.errstate(divide="ignore"):
                near, far = np.log1p(missing), np.log(self._phi(z))
            return -2.0 * self.mu * np.where(missing > -0.5, near, far)
        right = np.maximum(z, 0.0)
        least = np.minimum(right * right, r)
        with np.errstate(under="ignore"):
            terms = erfcx(right) * np.exp(least - right * right) + np.exp(least - r) * erfc(-right)
            left = np.log1p(0.5 * math.expm1(-r) * erfc(-np.minimum(z, 0.0)))
        return -2.0 * self.mu * np.where(z < 0.0, left, np.log(0.5 * terms) - least)

    def quantile(self, g: Any, t: float) -> np.ndarray:
        """Return x with cumulative(x, t) = g, 0 < g < M: where a marker with that part to its left is."""
        g = inside(g, self.total)
        width, r = self._width(t), self.reynolds
        # erfc(-z) / 2 and erfc(z) / 2: the smaller of the two tells z without loss of digits.
        left = np.expm1(-g / (2.0 * self.mu)) / math.expm1(-r)
        if r <= _LARGE:
            rest = np.expm1((self.total - g) / (2.0 * self.mu)) / math.expm1(r)
            z = np.where(left < rest, -erfcinv(2.0 * left), erfcinv(2.0 * rest))
        else:
            beyond = np.log(-np.expm1(-(self.total - g) / (2.0 * self.mu)))
            right = -ndtri_exp(beyond - g / (2.0 * self.mu)) / math.sqrt(2.0)
            z = np.where(left < 0.5, -erfcinv(2.0 * np.minimum(left, 0.5)), right)
        return check.finite_result("g", width * z)

    def _scaled(self, x: Any, t: float) -> tuple[np.ndarray, float]:
        s = self._width(t)
        return check.places("x", x) / s, s

    def _width(self, t: float) -> float:
        return 2.0 * math.sqrt(self.mu * check.scale("t", t))

    def _phi(self, z: np.ndarray) -> np.ndarray:
        # A sum of two positive terms: nothing cancels where phi is small.
        return 0.5 * (erfc(z) + math.exp(-self.reynolds) * erfc(-z))
