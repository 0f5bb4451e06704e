r"""The Korteweg-de Vries equation f_t + 3 (f^2)_x + f_xxx = 0, Sec. 2.1:

    V = 3 f + f_xx / f,

and its soliton of speed c on a background b,

    f = b + c/2 sech^2(sqrt(c) / 2 (x - (c + 6 b) t)).

With b = 0 all markers move at V = c. With b > 0 they stream through it: V = c + 6 b - b (c + 3 b) / f.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fracparticles.errors import InvalidInput
from fracparticles.special.arguments import positive_real

__all__ = ["Soliton", "kdv"]


def kdv(x: np.ndarray, fields: np.ndarray) -> np.ndarray:
    """V F = 3 F^2 + F_xx, for a `MarkerVelocity` with two derivatives."""
    return 3.0 * fields[0] ** 2 + fields[2]


@dataclass(frozen=True)
class Soliton:
    """A soliton.

    Attributes
    ----------
    c, background : float
        c > 0 and b >= 0.
    """

    c: float
    background: float = 0.0

    def __post_init__(self) -> None:
        positive_real("c", self.c)
        if not self.background >= 0.0:
            raise InvalidInput(
                "background", self.background, "0 or more", "Markers need f > 0: raise it."
            )

    @property
    def speed(self) -> float:
        """c + 6 b."""
        return self.c + 6.0 * self.background

    def value(self, x: np.ndarray, t: float = 0.0) -> np.ndarray:
        """Return f(x, t)."""
        z = 0.5 * math.sqrt(self.c) * (np.asarray(x, dtype=float) - self.speed * t)
        return self.background + 0.5 * self.c / np.cosh(z) ** 2

    def velocity(self, f: np.ndarray) -> np.ndarray:
        """Return the exact V where the solution is f."""
        return self.speed - self.background * (self.c + 3.0 * self.background) / f
