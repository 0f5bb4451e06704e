"""Kernels by linear interpolation in a table, as the paper evaluates F and G in two dimensions (Sec. 5).

    K(r) ~ K(r_k) + (r - r_k) (K(r_{k+1}) - K(r_k)) / step,   r_k = k step <= r < r_{k+1}.

The error is at most step^2 max|K''| / 8. The tables only serve to show the effect of interpolation: the exact kernels
are fast enough.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from fracparticles.arguments import positive_real
from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import KERNELS, kernel
from fracparticles.kernels.rules import distances

__all__ = ["KernelValues", "tabulated"]

_MOST_POINTS = 2**25  # of a table: 256 MB, and as much again to make it

# kernel(name, r, alpha, dim=..., order=...)
KernelValues = Callable[..., Any]


def tabulated(step: float, family: str | None = None) -> KernelValues:
    """Return a function with the parameters of `kernels.families.kernel` that interpolates in a table of this step.

    Parameters
    ----------
    step : float
        Step of the table, in units of the smoothing length.
    family : str, optional
        Kernel family, see `kernels.families.kernel`.

    Raises
    ------
    InvalidInput
        If the step is not a positive number. The returned function raises it as `kernel` does, and also if the
        distances require a table of more than 2^25 points.
    """
    step = positive_real("kernel_table", step)

    def values(name: str, r: Any, alpha: float, dim: int = 1, order: int = 2) -> np.ndarray:
        r = distances(r, dim)
        size = np.abs(r)
        largest = float(size.max(initial=0.0))
        if not largest < _MOST_POINTS * step:
            least = f"at least {largest / _MOST_POINTS:.3g}"
            allowed = f"{least} for distances up to {largest:.4g} smoothing lengths"
            remedy = "Take a larger step, or a narrower domain."
            raise InvalidInput("kernel_table", step, allowed, remedy)
        points = step * np.arange(int(largest / step) + 2)
        table = np.asarray(kernel(name, points, alpha, dim=dim, order=order, family=family))
        interpolated = np.interp(size, points, table)
        return np.copysign(1.0, r) * interpolated if KERNELS[name].parity == "odd" else interpolated

    return values
