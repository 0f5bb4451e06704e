r"""Initial profiles with the solution of the diffusion equation f_t = f_xx (1), and where its markers go.

Each has `value(x, t)`, `cumulative(x, t)` = int_-inf^x f dx', its inverse `quantile(g, t)`, and the `total`.
A marker carried by the exact velocity V = -f_x / f (3) keeps the part of the total that lies to its left: it is at
quantile(g, t) with g constant, at any time.

- `Square`: f_0 = 1 for |x| <= 1 (12);  f = (erf((x+1) / 2 sqrt(t)) - erf((x-1) / 2 sqrt(t))) / 2.
- `Gaussian`: f_0 = exp(-x^2) (25);  f = exp(-x^2 / (1 + 4 t)) / sqrt(1 + 4 t).
- `Ramp`: f = x exp(-x^2) on [0, x_0], for the loading of Figs. 1-4; it has no t.

Every x, g is an array of any shape, t a number of zero or more. A quantile is within round-off of the one of g, for any
0 < g < total. The differences in f of `Square` cancel for large t and beyond the square. For s = 2 sqrt(t) > 20 they
are integrals over the square by a Gauss rule, and to the left of the square

    int_-inf^x f dx' = s/2 (i(-(x + 1) / s) - i((1 - x) / s)),     i(u) = exp(-u^2) (1/sqrt(pi) - u erfcx(u)).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from scipy.special import erf, erfc, erfcinv, erfcx, erfinv

from fracparticles import arguments as check
from fracparticles.special.quadrature import gauss_legendre

__all__ = ["Gaussian", "Profile", "Ramp", "Square", "inside"]

_WIDE = 20.0  # s, against the square's half-width of 1
# Exact for exp((x - y)^2 / s^2) with y / s below 1/20.
_NODES, _WEIGHTS = gauss_legendre(12)
_FAR = 0.5  # beyond the square, in s: f is a difference of erfc there, which are small themselves
_ERFINV = 1e-4  # of the total: erfinv keeps twelve digits of it


class Profile(Protocol):
    """What loading needs to know."""

    @property
    def total(self) -> float:
        """The integral of f, sigma."""

    def quantile(self, g: Any) -> np.ndarray:
        """Return x with int_-inf^x f dx' = g at the start, 0 < g < total."""


@dataclass(frozen=True)
class Square:
    """The square profile (12)."""

    total = 2.0  # no field: a square of another total is another profile

    def value(self, x: Any, t: float = 0.0) -> np.ndarray:
        """Return f(x, t)."""
        x, t = check.places("x", x), check.not_negative("t", t)
        if t == 0.0:
            return np.where(np.abs(x) <= 1.0, 1.0, 0.0)
        s = 2.0 * math.sqrt(t)
        if s > _WIDE:
            return _over_square(lambda z: np.exp(-z * z), x, s) * 2.0 / (s * math.sqrt(math.pi))
        near, far = (np.abs(x) - 1.0) / s, (np.abs(x) + 1.0) / s
        middle = 0.5 * (erf((x + 1.0) / s) - erf((x - 1.0) / s))
        return np.where(near > _FAR, 0.5 * (erfc(near) - erfc(far)), middle)

    def slope(self, x: Any, t: float) -> np.ndarray:
        """Return f_x(x, t) for t > 0."""
        x, s = check.places("x", x), 2.0 * math.sqrt(check.scale("t", t))
        if s > _WIDE:
            slope = _over_square(lambda z: -2.0 * z * np.exp(-z * z), x, s)
            return slope * 2.0 / (s * s * math.sqrt(math.pi))
        return (np.exp(-(((x + 1.0) / s) ** 2)) - np.exp(-(((x - 1.0) / s) ** 2))) / (
            s * math.sqrt(math.pi)
        )

    def cumulative(self, x: Any, t: float = 0.0) -> np.ndarray:
        """Return int_-inf^x f dx'."""
        x, t = check.places("x", x), check.not_negative("t", t)
        return np.clip(x + 1.0, 0.0, 2.0) if t == 0.0 else self._cumulative(x, 2.0 * math.sqrt(t))

    def _cumulative(self, x: np.ndarray, s: float) -> np.ndarray:
        if s > _WIDE:
            return _over_square(lambda z: erfc(-z), x, s)
        outside = self._outside(np.maximum(np.abs(x) - 1.0, 0.0), s)
        inner = np.clip(x, -1.0, 1.0)

        def antiderivative(y: np.ndarray) -> np.ndarray:  # of erf(y / s)
            return y * erf(y / s) + s / math.sqrt(math.pi) * np.exp(-((y / s) ** 2))

        inside = 1.0 + 0.5 * (antiderivative(inner + 1.0) - antiderivative(inner - 1.0))
        return np.where(np.abs(x) <= 1.0, inside, np.where(x < 0.0, outside, 2.0 - outside))

    def _outside(self, y: np.ndarray, s: float) -> np.ndarray:
        """int f dx' over what is farther than y from the square on one side, to a relative error of round-off."""

        def integral(u: np.ndarray) -> np.ndarray:
            return np.exp(-u * u) * (1.0 / math.sqrt(math.pi) - u * erfcx(u))

        y = np.minimum(y, 30.0 * s)  # f is zero beyond
        return 0.5 * s * (integral(y / s) - integral((y + 2.0) / s))

    def quantile(self, g: Any, t: float = 0.0) -> np.ndarray:
        """Return x with cumulative(x, t) = g, by bisection; accurate to round-off in g."""
        g, t = inside(g, self.total), check.not_negative("t", t)
        if t == 0.0:
            return g - 1.0
        # The half with x <= 0, where no digits are lost, gives the other by symmetry.
        mirrored, s = np.minimum(g, 2.0 - g), 2.0 * math.sqrt(t)
        zero = np.zeros_like(g)
        left = zero - (1.0 + 27.5 * s)
        x = bisected(lambda x: self._cumulative(x, s) < mirrored, left, zero, 64)
        return np.where(g <= 1.0, 1.0, -1.0) * x


def _over_square(function: Any, x: np.ndarray, s: float) -> np.ndarray:
    """Half the integral of function((x - y) / s) over -1 < y < 1."""
    return np.asarray(0.5 * function((x[..., None] - _NODES) / s) @ _WEIGHTS)


def bisected(too_low: Any, low: np.ndarray, high: np.ndarray, halvings: int) -> np.ndarray:
    """Return the x between low and high where `too_low` turns false."""
    for _ in range(halvings):
        x = 0.5 * (low + high)
        below = too_low(x)
        low, high = np.where(below, x, low), np.where(below, high, x)
    return 0.5 * (low + high)


@dataclass(frozen=True)
class Gaussian:
    """The Gaussian exp(-x^2), (25)."""

    total = math.sqrt(math.pi)

    def value(self, x: Any, t: float = 0.0) -> np.ndarray:
        """Return f(x, t)."""
        width = 1.0 + 4.0 * check.not_negative("t", t)
        return np.exp(-np.square(check.places("x", x)) / width) / math.sqrt(width)

    def cumulative(self, x: Any, t: float = 0.0) -> np.ndarray:
        """Return int_-inf^x f dx'."""
        scaled = check.places("x", x) / math.sqrt(1.0 + 4.0 * check.not_negative("t", t))
        return 0.5 * self.total * erfc(-scaled)

    def quantile(self, g: Any, t: float = 0.0) -> np.ndarray:
        """Return x with cumulative(x, t) = g."""
        g = inside(g, self.total)
        # erfinv is blind to how far its argument is from -1 and 1.
        end = np.minimum(g, self.total - g) / self.total
        tail = np.where(2.0 * g < self.total, -1.0, 1.0) * erfcinv(2.0 * end)
        with np.errstate(divide="ignore"):
            z = np.where(end < _ERFINV, tail, erfinv(2.0 * g / self.total - 1.0))
        return check.finite_result("g", math.sqrt(1.0 + 4.0 * check.not_negative("t", t)) * z)


@dataclass(frozen=True)
class Ramp:
    """f = x exp(-x^2) on [0, x_0]; total sigma = (1 - exp(-x_0^2)) / 2.

    Raises `InvalidInput` if x_0 is not positive.

    Attributes
    ----------
    end : float
        x_0.
    """

    end: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "end", check.scale("x_0", self.end))

    @property
    def total(self) -> float:
        """The integral of f, sigma."""
        return -0.5 * math.expm1(-(self.end**2))

    def value(self, x: Any) -> np.ndarray:
        """Return f(x)."""
        x = check.places("x", x)
        return np.where((x >= 0.0) & (x <= self.end), x * np.exp(-x * x), 0.0)

    def quantile(self, g: Any) -> np.ndarray:
        """Return x with int_0^x f dx' = g: with g = sigma (j - 1/2) / N this is (11)."""
        return np.minimum(np.sqrt(-np.log1p(-2.0 * inside(g, self.total))), self.end)


def inside(g: Any, total: float) -> np.ndarray:
    """Return parts of the total, 0 < g < total, as an array: a marker needs something on each side.

    Raises `InvalidInput` if one is not inside.
    """
    return check.within("g", g, 0.0, total, inside=True)
