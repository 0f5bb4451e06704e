r"""Shape functions S1 to S8, Eqs. (9), (13)-(15); S_eps(x) = S(x / eps) / eps.

Every one is c P(|x|) exp(-g x^2), g = 0 or 1, with a polynomial P; S1 to S7 are zero for |x| > 1:

    S1 = 1/2                            S5 = mu (1 - |x|) exp(-x^2)
    S2 = 1 - |x|                        S6 = beta (1 - x^2)^2 exp(-x^2)
    S3 = 3/4 (1 - x^2)                  S7 = alpha (1 - x^2) exp(-x^2)
    S4 = 15/16 (1 - x^2)^2              S8 = (3/2 - x^2) exp(-x^2) / sqrt(pi),     any x

With J = sqrt(pi) erf(1), the constants that give int S dx = 1 are

    mu = 1 / (J - 1 + 1/e),     beta = 2 / (3/2 J - 1/e),     alpha = 1 / (J / 2 + 1/e).

Print: beta = 2 / (3/2 erf(1) - 1/e), without the sqrt(pi), and alpha = 1 / (1/e + sqrt(pi) erf(1/2)).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial

from fracparticles.arguments import choice, finite_array, real_array, whole_number, within
from fracparticles.errors import InvalidInput
from fracparticles.moving.scattered import ScatteredKernel
from fracparticles.special.quadrature import gauss_legendre

__all__ = ["SHAPES", "Shape", "shape_function"]

_REACH = 6.5  # exp(-x^2) is 4e-19 there
_HIGHEST = 24  # derivative
_FASTEST = 1e4  # k of a transform: it takes k / 2 nodes
_MOST_TERMS = 2**26
_J = math.sqrt(math.pi) * math.erf(1.0)
_1_E = math.exp(-1.0)
_SQRT_PI = math.sqrt(math.pi)


@dataclass(frozen=True)
class Shape:
    """A shape function.

    Attributes
    ----------
    name, title, equation : str
        S1 to S8, what the paper calls it, and where it defines it.
    constant, printed : float
        c with which int S dx = 1, and c as printed.
    polynomial : Polynomial
        P(|x|).
    gaussian : bool
        Whether exp(-x^2) is a factor.
    finite : bool
        Whether S is zero for |x| > 1.
    smoothness : int or None
        How many derivatives are bounded functions; None: all. The transform falls like k^-(smoothness + 1).
    """

    name: str
    title: str
    equation: str
    constant: float
    printed: float
    polynomial: Polynomial = field(hash=False)  # it has no hash
    gaussian: bool = False
    finite: bool = True
    smoothness: int | None = None

    @property
    def reach(self) -> float:
        """Where S is zero, or below round-off: |x| > reach."""
        return 1.0 if self.finite else _REACH

    @property
    def moment_order(self) -> int:
        """The lowest k > 0 with int S x^k dx not zero: 2 if S >= 0, 4 for S8."""
        return 2 if self.finite else 4

    def as_printed(self) -> Shape:
        """The shape function with the printed constant."""
        return replace(self, constant=self.printed)

    def __call__(self, x: Any, derivative: int = 0) -> np.ndarray:
        """Return the derivative of S of that order at x, any shape.

        At a jump the mean of both sides, for a derivative that is odd: S2'(0) = 0; at |x| = 1 the inner value.

        Raises `InvalidInput` if x is not real, or the derivative is not a bounded function, or above the 24th.
        """
        x = real_array("x", x)
        r = np.minimum(np.abs(x), 2.0 * self.reach)
        value = self._factor(derivative)(r)
        if self.gaussian:
            value = value * np.exp(-r * r)
        if derivative % 2:
            value = value * np.sign(x)
        return np.where(r <= self.reach, value, 0.0)

    def kernel(self, derivative: int = 0) -> ScatteredKernel:
        """The derivative as a kernel of `moving.scattered`."""
        return _kernel(self, whole_number("derivative", derivative, most=_HIGHEST))

    def transform(self, k: Any) -> np.ndarray:
        """Return int S(x) exp(-i k x) dx, real and even; absolute accuracy 1e-14.

        S8: (1 + k^2/4) exp(-k^2/4). The others by Gauss-Legendre quadrature on [0, 1], which is exact to round-off
        with the k / 2 + 24 nodes taken.

        Raises `InvalidInput` if a wavenumber k is not real and finite, or, except for S8, above 1e4 in size; or if
        there are too many k for memory.
        """
        k = finite_array("k, a wavenumber,", k)
        if not self.finite:
            k = np.clip(k, -_FASTEST, _FASTEST)  # zero beyond
            q = 0.25 * k * k
            return self.constant * _SQRT_PI * (1.0 + q) * np.exp(-q)
        within("k", k, -_FASTEST, _FASTEST)
        nodes = 24 + math.ceil(0.5 * float(np.abs(k).max(initial=0.0)))
        if k.size * nodes > _MOST_TERMS:
            shown = f"{k.size} wavenumbers"
            raise InvalidInput("k", shown, "fewer of this size", "Do it in parts.")
        x, w = gauss_legendre(nodes, 0.0, 1.0)
        return np.asarray(2.0 * np.cos(k[..., None] * x) @ (w * self(x)))

    def _factor(self, derivative: int) -> Polynomial:
        """Return c P_m with S^(m) = c P_m(|x|) exp(-g x^2) (times sgn x): P_(m+1) = P_m' - 2 g r P_m."""
        derivative = whole_number("derivative", derivative, most=_HIGHEST)
        if self.smoothness is not None and derivative > self.smoothness:
            most = f"from 0 to {self.smoothness} for {self.name}"
            allowed = f"{most}, whose next derivative is not a function"
            remedy = "Choose a smoother shape function: S8 has all derivatives."
            raise InvalidInput("derivative", derivative, allowed, remedy)
        p = self.polynomial
        for _ in range(derivative):
            p = p.deriv() - (2.0 * Polynomial([0.0, 1.0]) * p if self.gaussian else 0.0)
        return self.constant * p


@lru_cache(maxsize=256)
def _kernel(shape: Shape, derivative: int) -> ScatteredKernel:
    p = shape._factor(derivative)
    coefficients, odd = p.convert(domain=[-1, 1], window=[-1, 1]).coef[::-1], derivative % 2

    def profile(x: np.ndarray) -> np.ndarray:
        # The sum over neighbours asks for |x| <= reach only, the one over all pairs for any x.
        r = np.abs(x)
        value = np.full_like(r, coefficients[0])
        for c in coefficients[1:]:
            value *= r
            value += c
        if shape.gaussian:
            value *= np.exp(-r * r)
        if odd:
            value *= np.sign(x)
        value[r > shape.reach] = 0.0
        return value

    return ScatteredKernel(profile, reach=shape.reach)


_HAT = Polynomial([1.0, -1.0])
_QUADRATIC = Polynomial([1.0, 0.0, -1.0])

SHAPES: Mapping[str, Shape] = MappingProxyType(
    {
        shape.name: shape
        for shape in (
            Shape("S1", "gate", "(9)", 0.5, 0.5, Polynomial([1.0]), smoothness=0),
            Shape("S2", "hat", "(9)", 1.0, 1.0, _HAT, smoothness=1),
            Shape("S3", "quadratic", "(9)", 0.75, 0.75, _QUADRATIC, smoothness=1),
            Shape("S4", "quartic", "(9), (13)", 15 / 16, 15 / 16, _QUADRATIC**2, smoothness=2),
            Shape(
                "S5", "hat/Gaussian", "(9)", 1.0 / (_J - 1.0 + _1_E), 1.0 / (_J + _1_E - 1.0), _HAT,
                gaussian=True, smoothness=1,
            ),
            Shape(
                "S6", "quartic/Gaussian", "(9)", 2.0 / (1.5 * _J - _1_E),
                2.0 / (1.5 * math.erf(1.0) - _1_E), _QUADRATIC**2, gaussian=True, smoothness=2,
            ),
            Shape(
                "S7", "quadratic/Gaussian", "(14)", 1.0 / (0.5 * _J + _1_E),
                1.0 / (_1_E + _SQRT_PI * math.erf(0.5)), _QUADRATIC, gaussian=True, smoothness=1,
            ),
            Shape(
                "S8", "super Gaussian", "(15)", 1.0 / _SQRT_PI, 1.0 / _SQRT_PI,
                Polynomial([1.5, 0.0, -1.0]), gaussian=True, finite=False,
            ),
        )
    }
)  # fmt: skip


def shape_function(name: str) -> Shape:
    """Return the shape function of that name, S1 to S8.

    Raises `InvalidInput` if it does not exist.
    """
    return SHAPES[choice("shape", name, tuple(SHAPES))]
