r"""Closed forms of the Appendix, for the left-handed operators on [0, x], x >= 0, and their four functions.

A function has its `value`, its `derivative`, and by order alpha

    `rl(x, alpha)`       RL D^alpha f, (A5)-(A8); alpha < 0 gives the integral I^-alpha f (last lines of the Appendix),
    `caputo(x, alpha)`   C D^alpha f,  (A1)-(A4).

alpha is a number or an array like x. (A1)-(A4) and the integrals hold for a variable order of Type I; (A5)-(A8) with
alpha > 0 do not. There are three departures from the print:

* 2^(alpha-1) sqrt(pi) / [Gamma(1-alpha/2) Gamma(3/2-alpha/2)] of (A5) is written 1 / Gamma(2-alpha), that of (A6)
  1 / Gamma(1-alpha), by the duplication formula.
* (A3), (A7) are written with 1F1, which stays real for beta < 0 where the print has (beta)^alpha.
* The factor (beta+x)^n ((beta+x)/beta)^-n of (A8) is beta^n; as printed it is 0 times infinity at x = -beta.

The terms of the polynomials in (A4), (A8) have both signs for beta < 0, and cancel for a large n. A recurrence from the
definition by parts takes their place,

    I^mu f = K_n / Gamma(1+mu),     K_0 = x^mu,     K_n = (n (x+beta) K_(n-1) + mu x^mu beta^n) / (n + mu).

Its error stays within n ulp of I^mu |f|.

`mirrored(b)` gives f(b - x) as a sum of such functions, for the right-handed operators on [x, b].
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import partial
from math import cos, pi, sin
from typing import Any

import numpy as np
from scipy.special import gamma, hyp1f1

from fracparticles import arguments as check
from fracparticles.sph.one_f_two import one_f_two

__all__ = ["FUNCTIONS", "Cosine", "Exponential", "Function", "ShiftedPower", "Sine"]

Order = float | np.ndarray

# The terms of (A4), (A8) lose no more than two digits for n up to _HORNER, for x / |beta| up to the first and |beta|
# between the other two numbers of _NEAR.
_HORNER = 4
_NEAR = 1e3, 1e-50, 1e50


class Function(ABC):
    """A function with its closed forms. x is an array of any shape, and x >= 0 for `caputo` and `rl`.

    Raises `InvalidInput` if x or alpha is outside its range, the shapes do not fit together, or the values overflow.
    """

    def value(self, x: Any) -> np.ndarray:
        """f(x)."""
        x = check.places("x", x)
        with np.errstate(over="ignore"):
            return check.finite_result("x", np.asarray(self._value(x)))

    def caputo(self, x: Any, alpha: Any) -> np.ndarray:
        """C D^alpha f, 0 < alpha < 1."""
        x, alpha = _arguments(x, alpha)
        check.within("alpha", alpha, 0.0, 1.0, inside=True)
        with np.errstate(over="ignore", invalid="ignore"):
            return check.finite_result("x", np.asarray(self._caputo(x, alpha)))

    def rl(self, x: Any, alpha: Any) -> np.ndarray:
        """RL D^alpha f, -1 < alpha < 1; infinite at x = 0 for alpha > 0 and f(0) != 0."""
        x, alpha = _arguments(x, alpha)
        with np.errstate(over="ignore", invalid="ignore"):
            values = np.asarray(self._rl(x, alpha))
        check.finite_result("x", np.where(x > 0.0, values, 0.0))
        return values

    @abstractmethod
    def _value(self, x: np.ndarray) -> np.ndarray: ...

    @abstractmethod
    def _caputo(self, x: np.ndarray, alpha: Order) -> np.ndarray: ...

    @abstractmethod
    def _rl(self, x: np.ndarray, alpha: Order) -> np.ndarray: ...

    @abstractmethod
    def mirrored(self, b: float) -> list[tuple[float, Function]]:
        """The terms of f(b - x), each a factor and a function."""


@dataclass(frozen=True)
class _Wave(Function):
    beta: float

    def __post_init__(self) -> None:
        check.fields(self, beta=check.scale)


class Sine(_Wave):
    """sin(beta x), beta > 0."""

    def _value(self, x: np.ndarray) -> np.ndarray:
        return np.sin(self.beta * x)

    def _caputo(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A1): beta x^(1-alpha) / Gamma(2-alpha) 1F2[1; 1-alpha/2, 3/2-alpha/2; -(beta x)^2/4]."""
        factor = self.beta * x ** (1.0 - alpha) / gamma(2.0 - alpha)
        return factor * one_f_two(2.0 - alpha, self.beta * x)

    def _rl(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A5): the same as (A1), because sin 0 = 0."""
        return self._caputo(x, alpha)

    def mirrored(self, b: float) -> list[tuple[float, Function]]:
        """sin(beta b) cos(beta x) - cos(beta b) sin(beta x)."""
        b = check.finite_real("b", b)
        return [(sin(self.beta * b), Cosine(self.beta)), (-cos(self.beta * b), self)]


class Cosine(_Wave):
    """cos(beta x), beta > 0."""

    def _value(self, x: np.ndarray) -> np.ndarray:
        return np.cos(self.beta * x)

    def _caputo(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A2): -beta^2 x^(2-alpha) / Gamma(3-alpha) 1F2[1; 3/2-alpha/2, 2-alpha/2; -(beta x)^2/4]."""
        factor = -(self.beta**2) * x ** (2.0 - alpha) / gamma(3.0 - alpha)
        return factor * one_f_two(3.0 - alpha, self.beta * x)

    def _rl(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A6): x^-alpha / Gamma(1-alpha) 1F2[1; 1/2-alpha/2, 1-alpha/2; -(beta x)^2/4]."""
        return _power(x, -alpha) / gamma(1.0 - alpha) * one_f_two(1.0 - alpha, self.beta * x)

    def mirrored(self, b: float) -> list[tuple[float, Function]]:
        """cos(beta b) cos(beta x) + sin(beta b) sin(beta x)."""
        b = check.finite_real("b", b)
        return [(cos(self.beta * b), self), (sin(self.beta * b), Sine(self.beta))]


@dataclass(frozen=True)
class Exponential(Function):
    """exp(beta x), any beta."""

    beta: float

    def __post_init__(self) -> None:
        check.fields(self, beta=check.place)

    def _value(self, x: np.ndarray) -> np.ndarray:
        return np.exp(self.beta * x)

    def _caputo(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A3): beta x^(1-alpha) / Gamma(2-alpha) 1F1[1; 2-alpha; beta x]."""
        factor = self.beta * x ** (1.0 - alpha) / gamma(2.0 - alpha)
        return factor * hyp1f1(1.0, 2.0 - alpha, self.beta * x)

    def _rl(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A7): x^-alpha / Gamma(1-alpha) 1F1[1; 1-alpha; beta x]."""
        return _power(x, -alpha) / gamma(1.0 - alpha) * hyp1f1(1.0, 1.0 - alpha, self.beta * x)

    def mirrored(self, b: float) -> list[tuple[float, Function]]:
        """exp(beta b) exp(-beta x)."""
        with np.errstate(over="ignore"):
            factor = float(check.finite_result("b", np.exp(self.beta * check.finite_real("b", b))))
        return [(factor, Exponential(-self.beta))]


@dataclass(frozen=True)
class ShiftedPower(Function):
    """(x + beta)^n, n = 1, 2, ..., 1000, beta != 0."""

    beta: float
    n: int

    def __post_init__(self) -> None:
        check.fields(self, beta=check.finite_real, n=partial(check.positive_integer, most=1000))
        check.scale("|beta|", abs(self.beta))

    def _value(self, x: np.ndarray) -> np.ndarray:
        return (x + self.beta) ** self.n

    def _caputo(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A4): n beta^(n-1) x^(1-alpha) / Gamma(2-alpha) 2F1[1, 1-n; 2-alpha; -x/beta]."""
        if not self._few_terms(x):
            return self.n * self._integral(x, 1.0 - alpha, self.n - 1)
        factor = self.n * self.beta ** (self.n - 1) * x ** (1.0 - alpha) / gamma(2.0 - alpha)
        return factor * _two_f_one(self.n - 1, 2.0 - alpha, -x / self.beta)

    def _rl(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A8): beta^n x^-alpha / Gamma(1-alpha) 2F1[1, -n; 1-alpha; -x/beta]."""
        if not self._few_terms(x):
            mu = np.maximum(-np.asarray(alpha), 0.0)
            derivative = np.where(alpha > 0.0, alpha, 0.0)
            boundary = np.float64(self.beta) ** self.n * _power(x, -derivative)
            return np.where(
                np.broadcast_to(alpha, np.broadcast_shapes(np.shape(x), np.shape(alpha))) > 0.0,
                boundary / gamma(1.0 - derivative) + self._caputo(x, derivative),
                self._integral(x, mu, self.n),
            )
        factor = self.beta**self.n * _power(x, -alpha) / gamma(1.0 - alpha)
        return factor * _two_f_one(self.n, 1.0 - alpha, -x / self.beta)

    def rl_as_printed(self, x: Any, alpha: Any) -> np.ndarray:
        """(A8) with its printed factor (beta+x)^n ((beta+x)/beta)^-n for beta^n."""
        x, alpha = _arguments(x, alpha)
        with np.errstate(all="ignore"):
            ratio = (self.beta + x) / self.beta
            factor = (self.beta + x) ** self.n * ratio**-self.n
            factor = factor * _power(x, -alpha) / gamma(1.0 - alpha)
            return factor * _two_f_one(self.n, 1.0 - alpha, -x / self.beta)

    def mirrored(self, b: float) -> list[tuple[float, Function]]:
        """(-1)^n (x - b - beta)^n."""
        b = check.finite_real("b", b)
        return [((-1.0) ** self.n, ShiftedPower(-b - self.beta, self.n))]

    def _few_terms(self, x: np.ndarray) -> bool:
        farthest, least, most = _NEAR
        size = abs(self.beta)
        near = np.max(x, initial=0.0) <= farthest * size and least <= size <= most
        return bool(self.n <= _HORNER and near)

    def _integral(self, x: np.ndarray, mu: Order, n: int) -> np.ndarray:
        """I^mu of (x + beta)^n by the recurrence for K_n, in units of the larger of |x + beta|^n and |beta|^n."""
        y = x + self.beta
        unit = np.maximum(np.abs(y), abs(self.beta))
        y, beta, first = y / unit, self.beta / unit, x**mu
        k, power = first, np.ones_like(beta)
        for m in range(1, n + 1):
            power = power * beta
            k = (m * y * k + mu * first * power) / (m + mu)
        return unit**n * k / gamma(1.0 + mu)


FUNCTIONS: dict[str, Function] = {
    "sin": Sine(pi),
    "cos": Cosine(pi),
    "exp": Exponential(1.0),
    "cubic": ShiftedPower(-1.0, 3),
}
"""The paper's four: sin(pi x), cos(pi x), exp(x), (x - 1)^3."""


def _arguments(x: Any, alpha: Any) -> tuple[np.ndarray, Order]:
    x = check.within("x", x, 0.0, check.SIZES[1])
    alpha = check.within("alpha", alpha, -1.0, 1.0, inside=True)
    check.together(x=x, alpha=alpha)
    return x, float(alpha) if alpha.ndim == 0 else alpha


def _power(x: np.ndarray, exponent: Order) -> np.ndarray:
    with np.errstate(divide="ignore"):
        return np.asarray(x, dtype=float) ** exponent


def _two_f_one(n: int, c: Order, z: np.ndarray) -> np.ndarray:
    """2F1[1, -n; c; z], a polynomial of degree n, by Horner's rule."""
    total = np.ones(np.broadcast_shapes(np.shape(z), np.shape(c)))
    for k in range(n - 1, -1, -1):
        total = 1.0 + (k - n) / (c + k) * z * total
    return total
