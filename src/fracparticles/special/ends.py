"""The fundamental solution on the line at the ends of the range of alpha, where it is elementary."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from fracparticles import arguments as check

__all__ = ["cauchy", "heat_kernel"]


def heat_kernel(x: Any, t: float) -> Any:
    """Return G(x, t) = exp(-x^2 / (4 t)) / sqrt(4 pi t), alpha = 2; t > 0. Raises `InvalidInput` for bad input."""
    x, t = check.real_array("x", x), check.scale("t", t)
    with np.errstate(over="ignore"):  # x^2 may be infinite: G is zero there
        return check.like(x, np.exp(-x * x / (4.0 * t)) / math.sqrt(4.0 * math.pi * t))


def cauchy(x: Any, t: float) -> Any:
    """Return G(x, t) = t / (pi (x^2 + t^2)), alpha = 1; t > 0. Raises `InvalidInput` for bad input."""
    x, t = check.real_array("x", x), check.scale("t", t)
    with np.errstate(over="ignore"):
        return check.like(x, t / (math.pi * (x * x + t * t)))
