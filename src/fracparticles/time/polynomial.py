"""The step polynomials of the explicit Runge-Kutta schemes, Eq. (52), and their stability interval."""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial

import numpy as np

__all__ = ["STEP_POLYNOMIALS", "StepPolynomial"]


@dataclass(frozen=True)
class StepPolynomial:
    """p(z) = sum_{k=0}^{s} z^k / k!, z = lambda dt: one step of an s-stage, order-s scheme, s <= 4.

    Attributes
    ----------
    name : str
        The integrator.
    stages : int
        Number of stages s, which is also the order of accuracy.
    stability_interval : float
        |p(z)| <= 1 for -stability_interval <= z <= 0: 2 for RK1 and RK2 (Eq. 53), 2.7853 for RK4.
    """

    name: str
    stages: int
    stability_interval: float

    def __call__(self, z: np.ndarray) -> np.ndarray:
        """Return p(z)."""
        return 1.0 + self.increment(z)

    def increment(self, z: np.ndarray) -> np.ndarray:
        """Return p(z) - 1 without cancellation."""
        z = np.asarray(z, dtype=float)
        value = np.zeros_like(z)
        for k in range(self.stages, 0, -1):
            value = z * (1.0 / factorial(k) + value)
        return value

    def log_power(self, z: np.ndarray, steps: int) -> tuple[np.ndarray, np.ndarray]:
        """Return sign and logarithm of |p(z)|^steps, accurate also where p is close to 1."""
        increment = self.increment(z)
        with np.errstate(divide="ignore"):
            near = np.log1p(np.maximum(increment, -1.0))
            far = np.log(np.abs(1.0 + increment))
        logarithm = np.where(increment > -0.5, near, far)
        sign = np.where((increment < -1.0) & (steps % 2 == 1), -1.0, 1.0)
        return sign, steps * logarithm

    def sensitivity(self, z: np.ndarray, steps: int) -> np.ndarray:
        """Return |steps z p'(z) / p(z)|, by which p^steps magnifies a relative error of z; 0 where p(z) = 0."""
        z = np.asarray(z, dtype=float)
        value = self(z)
        # p' is p without its last term.
        slope = value - z**self.stages / factorial(self.stages)
        return np.abs(steps * z * slope / np.where(value == 0.0, np.inf, value))


# 2.785293563405282 is the real root of z^3 - 4 z^2 + 12 z - 24 = 0, where p(-z) = 1 for RK4.
STEP_POLYNOMIALS = {
    "euler": StepPolynomial("euler", 1, 2.0),
    "rk2": StepPolynomial("rk2", 2, 2.0),
    "rk4": StepPolynomial("rk4", 4, 2.785293563405282),
}
