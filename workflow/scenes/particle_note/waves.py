"""What the scenes of the note share: the function that sums are tried on, and how orders of accuracy are drawn."""

from __future__ import annotations

from typing import Any

import numpy as np

from fracparticles.pse import Kernel, derivative, lattice

__all__ = ["LINES", "second_derivative_error", "wave"]

# A line for each accuracy r.
LINES: dict[int, dict[str, Any]] = {
    2: {"color": "#0072B2", "linestyle": "-"},
    4: {"color": "#D55E00", "linestyle": "--"},
    6: {"color": "#009E73", "linestyle": "-."},
    8: {"color": "#CC79A7", "linestyle": ":"},
}


def wave(x: np.ndarray, kappa: float = 1.0, order: int = 0) -> np.ndarray:
    """The derivative of cos(kappa x) of that order; its maximum is kappa^order."""
    return kappa**order * np.cos(kappa * x + 0.5 * np.pi * order)


def second_derivative_error(kernel: Kernel, h: float, overlap: float) -> float:
    """The largest error of (21) for cos x at particles of the lattice."""
    epsilon = overlap * h
    x = h * np.round(np.linspace(0.0, 2.0 * np.pi, 17) / h)
    margin = kernel.reach * epsilon
    particles = lattice(-margin, 2.0 * np.pi + margin, h)
    found = derivative(x, wave(x), particles, wave(particles), h, epsilon, kernel, 2)
    return float(np.abs(found - wave(x, order=2)).max())
