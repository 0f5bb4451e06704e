"""Runs of the diffusion velocity method from the fundamental solution on a lattice, and their errors."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.special import gamma

from fracparticles.moving import dvm
from fracparticles.schemes.stability import stability_limit
from fracparticles.special.stable import green
from fracstudy.probe import off

START, TIME, ALPHA = 0.5, 0.5, 1.5
WORD: tuple[str, float, str] = ("within 5 %, or a word", 0.05, "fundamental solution")
"""An error that must be spoken of: what is expected, its bound, where that is known from."""
FACTORS = (0.9, 0.99, 1.01, 1.1, 1.5)
"""Of the limit of a step."""


class Cloud:
    """Particles on a lattice of |x| <= `half_width`."""

    def __init__(self, half_width: float, spacing: float) -> None:
        self.h, self.half_width = spacing, half_width
        n = round(half_width / spacing)
        self.x = spacing * np.arange(-n, n + 1.0)

    def u(self, alpha: float = ALPHA) -> np.ndarray:
        """Return the strengths at the start."""
        return np.asarray(green(self.x, START, alpha))

    def run(self, u: np.ndarray | None = None, **options: Any) -> dvm.ParticleRun:
        """Run to `TIME` after the start, by steps of half the limit unless told otherwise."""
        alpha, order = options.get("alpha", ALPHA), options.get("order", 2)
        time, x = options.pop("time", TIME), options.pop("x", self.x)
        limit = stability_limit("DD", alpha - 1.0, order, options.get("overlap", 2.0))
        dt = options.pop("factor", 0.5) * limit * self.h**alpha
        steps = options.pop("steps", max(1, math.ceil(time / dt)))
        how = {"spacing": self.h, "alpha": alpha, "dt": time / steps, "start": START, **options}
        return dvm.run(x, self.u(alpha) if u is None else u, steps=steps, **how)

    def error(self, exact: Callable[..., Any] | None = None, **options: Any) -> float:
        """Return the error of the field in |x| < L/2, relative to its peak."""
        end, alpha = START + options.get("time", TIME), options.get("alpha", ALPHA)
        z = np.linspace(-0.5, 0.5, 101) * self.half_width
        return off(self.run(**options).field(z), exact(z, end) if exact else green(z, end, alpha))

    def smoothing(self, alpha: float = ALPHA) -> float:
        """epsilon^2 |u''(0)| / (4 u(0)) at the start: what a kernel of order II takes from the peak, the most ever."""
        curvature = gamma(3.0 / alpha) / gamma(1.0 / alpha) * START ** (-2.0 / alpha)
        return float(0.25 * (2.0 * self.h) ** 2 * curvature)


def missed(growth: Callable[..., tuple[float, float]], *arguments: Any) -> tuple[float, str]:
    """Return how far the growth of a wave in a step is from its prediction."""
    found, predicted = growth(*arguments)
    return abs(found - predicted), f"{found:.3f}, predicted {predicted:.3f}"
