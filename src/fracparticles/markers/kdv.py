r"""The Korteweg-de Vries equation f_t + 3 (f^2)_x + f_xxx = 0, Sec. 2.1:

    V = 3 f + f_xx / f,

and its soliton of speed c on a background b,

    f = b + c/2 sech^2(sqrt(c) / 2 (x - (c + 6 b) t)).

With b = 0 all markers move at V = c. With b > 0 they stream through it: V = c + 6 b - b (c + 3 b) / f.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from fracparticles import arguments as check

__all__ = ["Soliton", "kdv"]


def kdv(x: np.ndarray, fields: np.ndarray) -> np.ndarray:
    """V F = 3 F^2 + F_xx, for a `MarkerVelocity` with two derivatives."""
    return 3.0 * fields[0] ** 2 + fields[2]


@dataclass(frozen=True)
class Soliton:
    """A soliton.

    Raises `InvalidInput` if a value is outside its range; so do the methods; they take any shape.

    Attributes
    ----------
    c, background : float
        c > 0 and b >= 0: markers need f > 0.
    """

    c: float
    background: float = 0.0

    def __post_init__(self) -> None:
        check.fields(self, c=check.scale, background=check.not_negative)

    @property
    def speed(self) -> float:
        """c + 6 b."""
        return self.c + 6.0 * self.background

    def value(self, x: Any, t: float = 0.0) -> np.ndarray:
        """Return f(x, t)."""
        x = check.places("x", x)
        z = 0.5 * math.sqrt(self.c) * (x - self.speed * check.place("t", t))
        with np.errstate(over="ignore"):  # f - b is zero there
            return self.background + 0.5 * self.c / np.cosh(z) ** 2

    def velocity(self, f: Any) -> np.ndarray:
        """Return the exact V where the solution is f, which is above zero."""
        if self.background == 0.0:
            return self.speed - 0.0 * check.within("f", f, 0.0)
        f = check.within("f", f, 0.0, inside=True)
        with np.errstate(over="ignore"):
            part = self.background * (self.c + 3.0 * self.background) / f
        return check.finite_result("f", self.speed - part)
