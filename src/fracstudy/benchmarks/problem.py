"""The problem that all contenders solve, and how they are judged."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from fracparticles.run.case import Case
from fracparticles.run.solution import relative_l1_deviation
from fracparticles.special import green, mean_radius

__all__ = ["Problem"]


@dataclass(frozen=True)
class Problem:
    """From the fundamental solution at `t_initial` to `t_final`, in `dim` dimensions, D = 1.

    Attributes
    ----------
    beta : float
        Fractional order, alpha = 1 + beta.
    dim : {1, 2, 3}
    t_initial, t_final : float
    """

    beta: float
    dim: int = 1
    t_initial: float = 0.5
    t_final: float = 1.5

    @property
    def alpha(self) -> float:
        """Fractional order alpha = 1 + beta."""
        return 1.0 + self.beta

    @property
    def time(self) -> float:
        """The time to go."""
        return self.t_final - self.t_initial

    @property
    def error_radius(self) -> float:
        """The error is taken over |x| <= 5 R_alpha (48) on the line, over |x| <= 5 (59) beyond."""
        return 5.0 * mean_radius(self.alpha) if self.dim == 1 else 5.0

    def half_width(self, truncation: float) -> float:
        """Return D = C t_f^(1/alpha) R_alpha, Eq. (46)."""
        return float(truncation * self.t_final ** (1.0 / self.alpha) * mean_radius(self.alpha))

    def case(self, **fields: Any) -> Case:
        """Return a case of the problem."""
        times = {"t_initial": self.t_initial, "t_final": self.t_final}
        return Case(beta=self.beta, dim=self.dim, **times, **fields)

    def initial(self, radius: np.ndarray) -> np.ndarray:
        """Return the fundamental solution at `t_initial`; radius is |x|."""
        return np.asarray(green(radius, self.t_initial, self.alpha, self.dim))

    def error(self, radius: np.ndarray, volumes: np.ndarray | float, u: np.ndarray) -> float:
        """Return the error of u at `t_final` within the error radius; |x_i|, V_i and u_i."""
        exact: Any = {"time": self.t_final, "alpha": self.alpha, "dim": self.dim}
        return relative_l1_deviation(u, radius, volumes, self.error_radius, **exact)
