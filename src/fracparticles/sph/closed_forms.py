r"""Closed forms of the Appendix, for the left-handed operators on [0, x], x >= 0, and their four functions.

A function has its `value`, its `derivative`, and by order alpha

    `rl(x, alpha)`       RL D^alpha f, (A5)-(A8); alpha < 0 gives the integral I^-alpha f (last lines of the Appendix),
    `caputo(x, alpha)`   C D^alpha f,  (A1)-(A4).

alpha is a number or an array like x: (A1)-(A4) and the integrals hold for a variable order of Type I, (A5)-(A8) with
alpha > 0 do not. Three departures from the print:

* 2^(alpha-1) sqrt(pi) / [Gamma(1-alpha/2) Gamma(3/2-alpha/2)] of (A5) is written 1 / Gamma(2-alpha), that of (A6)
  1 / Gamma(1-alpha), by the duplication formula.
* (A3), (A7) are written with 1F1, which stays real for beta < 0 where the print has (beta)^alpha.
* The factor (beta+x)^n ((beta+x)/beta)^-n of (A8) is beta^n; as printed it is 0 times infinity at x = -beta.

`mirrored(b)` gives f(b - x) as a sum of such functions, for the right-handed operators on [x, b].
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np
from scipy.special import gamma, hyp1f1

from fracparticles.special.arguments import positive_integer, positive_real
from fracparticles.sph.one_f_two import one_f_two

__all__ = ["FUNCTIONS", "Cosine", "Exponential", "Function", "ShiftedPower", "Sine"]

Order = float | np.ndarray


class Function(ABC):
    """A function with its closed forms."""

    @abstractmethod
    def value(self, x: np.ndarray) -> np.ndarray:
        """f(x)."""

    @abstractmethod
    def caputo(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """C D^alpha f, 0 < alpha < 1."""

    @abstractmethod
    def rl(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """RL D^alpha f, -1 < alpha < 1; infinite at x = 0 for alpha > 0 and f(0) != 0."""

    @abstractmethod
    def mirrored(self, b: float) -> list[tuple[float, Function]]:
        """The terms of f(b - x), each a factor and a function."""


@dataclass(frozen=True)
class Sine(Function):
    """sin(beta x), beta > 0."""

    beta: float

    def __post_init__(self) -> None:
        positive_real("beta", self.beta)

    def value(self, x: np.ndarray) -> np.ndarray:
        """sin(beta x)."""
        return np.sin(self.beta * x)

    def caputo(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A1): beta x^(1-alpha) / Gamma(2-alpha) 1F2[1; 1-alpha/2, 3/2-alpha/2; -(beta x)^2/4]."""
        factor = self.beta * x ** (1.0 - alpha) / gamma(2.0 - alpha)
        return factor * one_f_two(2.0 - alpha, self.beta * x)

    def rl(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A5): the same as (A1), for sin 0 = 0."""
        return self.caputo(x, alpha)

    def mirrored(self, b: float) -> list[tuple[float, Function]]:
        """sin(beta b) cos(beta x) - cos(beta b) sin(beta x)."""
        return [(sin(self.beta * b), Cosine(self.beta)), (-cos(self.beta * b), self)]


@dataclass(frozen=True)
class Cosine(Function):
    """cos(beta x), beta > 0."""

    beta: float

    def __post_init__(self) -> None:
        positive_real("beta", self.beta)

    def value(self, x: np.ndarray) -> np.ndarray:
        """cos(beta x)."""
        return np.cos(self.beta * x)

    def caputo(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A2): -beta^2 x^(2-alpha) / Gamma(3-alpha) 1F2[1; 3/2-alpha/2, 2-alpha/2; -(beta x)^2/4]."""
        factor = -(self.beta**2) * x ** (2.0 - alpha) / gamma(3.0 - alpha)
        return factor * one_f_two(3.0 - alpha, self.beta * x)

    def rl(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A6): x^-alpha / Gamma(1-alpha) 1F2[1; 1/2-alpha/2, 1-alpha/2; -(beta x)^2/4]."""
        return _power(x, -alpha) / gamma(1.0 - alpha) * one_f_two(1.0 - alpha, self.beta * x)

    def mirrored(self, b: float) -> list[tuple[float, Function]]:
        """cos(beta b) cos(beta x) + sin(beta b) sin(beta x)."""
        return [(cos(self.beta * b), self), (sin(self.beta * b), Sine(self.beta))]


@dataclass(frozen=True)
class Exponential(Function):
    """exp(beta x), any beta."""

    beta: float

    def value(self, x: np.ndarray) -> np.ndarray:
        """exp(beta x)."""
        return np.exp(self.beta * x)

    def caputo(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A3): beta x^(1-alpha) / Gamma(2-alpha) 1F1[1; 2-alpha; beta x]."""
        factor = self.beta * x ** (1.0 - alpha) / gamma(2.0 - alpha)
        return factor * hyp1f1(1.0, 2.0 - alpha, self.beta * x)

    def rl(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A7): x^-alpha / Gamma(1-alpha) 1F1[1; 1-alpha; beta x]."""
        return _power(x, -alpha) / gamma(1.0 - alpha) * hyp1f1(1.0, 1.0 - alpha, self.beta * x)

    def mirrored(self, b: float) -> list[tuple[float, Function]]:
        """exp(beta b) exp(-beta x)."""
        return [(float(np.exp(self.beta * b)), Exponential(-self.beta))]


@dataclass(frozen=True)
class ShiftedPower(Function):
    """(x + beta)^n, n = 1, 2, ..., beta != 0."""

    beta: float
    n: int

    def __post_init__(self) -> None:
        positive_integer("n", self.n)
        positive_real("|beta|", abs(self.beta))

    def value(self, x: np.ndarray) -> np.ndarray:
        """(x + beta)^n."""
        return (x + self.beta) ** self.n

    def caputo(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A4): n beta^(n-1) x^(1-alpha) / Gamma(2-alpha) 2F1[1, 1-n; 2-alpha; -x/beta]."""
        factor = self.n * self.beta ** (self.n - 1) * x ** (1.0 - alpha) / gamma(2.0 - alpha)
        return factor * _two_f_one(self.n - 1, 2.0 - alpha, -x / self.beta)

    def rl(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A8): beta^n x^-alpha / Gamma(1-alpha) 2F1[1, -n; 1-alpha; -x/beta]."""
        factor = self.beta**self.n * _power(x, -alpha) / gamma(1.0 - alpha)
        return factor * _two_f_one(self.n, 1.0 - alpha, -x / self.beta)

    def rl_as_printed(self, x: np.ndarray, alpha: Order) -> np.ndarray:
        """(A8) with its printed factor (beta+x)^n ((beta+x)/beta)^-n for beta^n."""
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = (self.beta + x) / self.beta
            factor = (self.beta + x) ** self.n * ratio**-self.n
            factor = factor * _power(x, -alpha) / gamma(1.0 - alpha)
            return factor * _two_f_one(self.n, 1.0 - alpha, -x / self.beta)

    def mirrored(self, b: float) -> list[tuple[float, Function]]:
        """(-1)^n (x - b - beta)^n."""
        return [((-1.0) ** self.n, ShiftedPower(-b - self.beta, self.n))]


FUNCTIONS: dict[str, Function] = {
    "sin": Sine(pi),
    "cos": Cosine(pi),
    "exp": Exponential(1.0),
    "cubic": ShiftedPower(-1.0, 3),
}
"""The paper's four: sin(pi x), cos(pi x), exp(x), (x - 1)^3."""


def _power(x: np.ndarray, exponent: Order) -> np.ndarray:
    with np.errstate(divide="ignore"):
        return np.asarray(x, dtype=float) ** exponent


def _two_f_one(n: int, c: Order, z: np.ndarray) -> np.ndarray:
    """2F1[1, -n; c; z], a polynomial of degree n, by Horner's rule."""
    total = np.ones(np.broadcast_shapes(np.shape(z), np.shape(c)))
    for k in range(n - 1, -1, -1):
        total = 1.0 + (k - n) / (c + k) * z * total
    return total
