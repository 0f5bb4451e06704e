"""Two blobs, one far narrower than the other and far away from it, with the exact solutions of three equations.

The first is u_t = -(-Laplacian)^(alpha/2) u from two fundamental solutions of mass 1/2, G(x, w^alpha) of width w. The
others have more terms:

- with a velocity -x, u_t = (x u)_x + .., the blobs stay stable densities. They are older by (1 - exp(-alpha t)) / alpha
  and narrower by exp(-t), and come together.
- With decay and competition, u_t = .. - u + kappa u (exp(-t) B - u), the solution is exp(-t) B, B that of the first
  equation. This equation is not linear, so that the blobs cannot be computed one by one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fracparticles.special import green

__all__ = ["Blobs"]

_KAPPA = 10.0  # kappa


@dataclass(frozen=True)
class Blobs:
    """The blobs: one at 0, the other at `distance`.

    Attributes
    ----------
    alpha : float
    widths : sequence of float
        The widths of both at the start.
    distance : float
        The place of the second.
    """

    alpha: float
    widths: Sequence[float] = (0.01, 1.0)
    distance: float = 50.0

    @property
    def window(self) -> tuple[float, float]:
        """The interval that figures show."""
        return -0.4 * self.distance, 1.6 * self.distance

    @property
    def grown(self) -> float:
        """The time at which the first is 2^(1/alpha) times as wide as at the start."""
        return float(self.widths[0] ** self.alpha)

    def __call__(self, x: np.ndarray, t: float, who: Sequence[int] = (0, 1)) -> np.ndarray:
        """Return the solution of the first equation from both blobs, or from those in `who`."""
        ages = [width**self.alpha + t for width in self.widths]
        parts = (0.5 * green(x - k * self.distance, ages[k], self.alpha) for k in who)
        return np.asarray(sum(parts))

    def drawn_together(self, x: np.ndarray, t: float) -> np.ndarray:
        """Return the solution with the velocity -x."""
        past, shrunk = -np.expm1(-self.alpha * t) / self.alpha, np.exp(-self.alpha * t)
        ages = [width**self.alpha * shrunk + past for width in self.widths]
        places = (x, x - self.distance * np.exp(-t))
        first, second = (green(at, age, self.alpha) for at, age in zip(places, ages, strict=True))
        return np.asarray(0.5 * first + 0.5 * second)

    def competing(self, x: np.ndarray, t: float) -> np.ndarray:
        """Return the solution with decay and competition."""
        return np.asarray(np.exp(-t) * self(x, t))

    def competition(self, x: np.ndarray, t: float, u: np.ndarray) -> np.ndarray:
        """Return f = -u + kappa u (exp(-t) B - u)."""
        return np.asarray(u * (_KAPPA * (self.competing(x, t) - u) - 1.0))
