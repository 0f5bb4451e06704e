r"""Initial profiles with the solution of the diffusion equation f_t = f_xx (1), and where its markers go.

Each has `value(x, t)`, `cumulative(x, t)` = int_-inf^x f dx', its inverse `quantile(g, t)`, and the `total`.
A marker carried by the exact velocity V = -f_x / f (3) keeps the part of the total that lies to its left: it is at
quantile(g, t) with g constant, at any time.

- `Square`: f_0 = 1 for |x| <= 1 (12);  f = (erf((x+1) / 2 sqrt(t)) - erf((x-1) / 2 sqrt(t))) / 2.
- `Gaussian`: f_0 = exp(-x^2) (25);  f = exp(-x^2 / (1 + 4 t)) / sqrt(1 + 4 t).
- `Ramp`: f = x exp(-x^2) on [0, x_0], for the loading of Figs. 1-4; it has no t.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.special import erf, erfinv

from fracparticles.errors import InvalidInput
from fracparticles.special.arguments import positive_real, real_array

__all__ = ["Gaussian", "Profile", "Ramp", "Square"]


class Profile(Protocol):
    """What loading needs to know."""

    @property
    def total(self) -> float:
        """The integral of f, sigma."""

    def quantile(self, g: np.ndarray) -> np.ndarray:
        """Return x with int_-inf^x f dx' = g at the start, 0 < g < total."""


@dataclass(frozen=True)
class Square:
    """The square profile (12)."""

    total: float = 2.0

    def value(self, x: np.ndarray, t: float = 0.0) -> np.ndarray:
        """Return f(x, t)."""
        x = np.asarray(x, dtype=float)
        if t == 0.0:
            return np.where(np.abs(x) <= 1.0, 1.0, 0.0)
        s = 2.0 * math.sqrt(positive_real("t", t))
        return 0.5 * (erf((x + 1.0) / s) - erf((x - 1.0) / s))

    def slope(self, x: np.ndarray, t: float) -> np.ndarray:
        """Return f_x(x, t) for t > 0."""
        x, s = np.asarray(x, dtype=float), 2.0 * math.sqrt(positive_real("t", t))
        return (np.exp(-(((x + 1.0) / s) ** 2)) - np.exp(-(((x - 1.0) / s) ** 2))) / (
            s * math.sqrt(math.pi)
        )

    def cumulative(self, x: np.ndarray, t: float = 0.0) -> np.ndarray:
        """Return int_-inf^x f dx'."""
        x = np.asarray(x, dtype=float)
        if t == 0.0:
            return np.clip(x + 1.0, 0.0, 2.0)
        s = 2.0 * math.sqrt(positive_real("t", t))

        def antiderivative(y: np.ndarray) -> np.ndarray:  # of erf(y / s)
            return y * erf(y / s) + s / math.sqrt(math.pi) * np.exp(-((y / s) ** 2))

        return 1.0 + 0.5 * (antiderivative(x + 1.0) - antiderivative(x - 1.0))

    def quantile(self, g: np.ndarray, t: float = 0.0) -> np.ndarray:
        """Return x with cumulative(x, t) = g, by bisection; accurate to round-off in g."""
        g = _inside(g, self.total)
        if t == 0.0:
            return g - 1.0
        # The half with x <= 0, where no digits are lost, gives the other by symmetry.
        mirrored = np.minimum(g, 2.0 - g)
        low = np.full_like(mirrored, -(1.0 + 16.0 * math.sqrt(t)))
        high = np.zeros_like(mirrored)
        for _ in range(64):
            middle = 0.5 * (low + high)
            left = self.cumulative(middle, t) < mirrored
            low, high = np.where(left, middle, low), np.where(left, high, middle)
        return np.where(g <= 1.0, 1.0, -1.0) * 0.5 * (low + high)


@dataclass(frozen=True)
class Gaussian:
    """The Gaussian exp(-x^2), (25)."""

    total: float = math.sqrt(math.pi)

    def value(self, x: np.ndarray, t: float = 0.0) -> np.ndarray:
        """Return f(x, t)."""
        width = 1.0 + 4.0 * t
        return np.exp(-np.square(np.asarray(x, dtype=float)) / width) / math.sqrt(width)

    def cumulative(self, x: np.ndarray, t: float = 0.0) -> np.ndarray:
        """Return int_-inf^x f dx'."""
        scaled = np.asarray(x, dtype=float) / math.sqrt(1.0 + 4.0 * t)
        return 0.5 * self.total * (1.0 + erf(scaled))

    def quantile(self, g: np.ndarray, t: float = 0.0) -> np.ndarray:
        """Return x with cumulative(x, t) = g."""
        g = _inside(g, self.total)
        return math.sqrt(1.0 + 4.0 * t) * erfinv(2.0 * g / self.total - 1.0)


@dataclass(frozen=True)
class Ramp:
    """f = x exp(-x^2) on [0, x_0]; total sigma = (1 - exp(-x_0^2)) / 2.

    Attributes
    ----------
    end : float
        x_0.
    """

    end: float

    def __post_init__(self) -> None:
        positive_real("x_0", self.end)

    @property
    def total(self) -> float:
        """The integral of f, sigma."""
        return -0.5 * math.expm1(-(self.end**2))

    def value(self, x: np.ndarray) -> np.ndarray:
        """Return f(x)."""
        x = np.asarray(x, dtype=float)
        return np.where((x >= 0.0) & (x <= self.end), x * np.exp(-x * x), 0.0)

    def quantile(self, g: np.ndarray) -> np.ndarray:
        """Return x with int_0^x f dx' = g: with g = sigma (j - 1/2) / N this is (11)."""
        return np.sqrt(-np.log1p(-2.0 * _inside(g, self.total)))


def _inside(g: np.ndarray, total: float) -> np.ndarray:
    g = real_array("g", g)
    if not ((g > 0.0) & (g < total)).all():
        raise InvalidInput(
            "g",
            g,
            f"parts of the total, 0 < g < {total:g}",
            "A marker needs something on each side.",
        )
    return g
