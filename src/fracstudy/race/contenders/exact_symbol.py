"""The exact symbol on a periodic box: one pair of transforms. The only errors are by the period and the lattice.

u^_k(t) = exp(-t |k|^alpha) u^_k(0)
"""

from __future__ import annotations

import numpy as np
from scipy.fft import fftfreq, irfftn, rfftfreq, rfftn

from fracstudy.race.contender import Contender, Ready, Trials, lattices, sweep
from fracstudy.race.problem import Problem, lattice


class ExactSymbol(Contender):
    """Fourier's method."""

    name = label = "exact symbol, periodic"
    reference = "u^(k, t) = exp(-t |k|^alpha) u^(k, 0)"
    place, dims = 1, (1, 2, 3)
    colour, marker = "#000000", "*"

    def trials(self, problem: Problem) -> Trials:
        """Yield lattices."""
        yield from sweep(lattices(problem), variant="")

    def prepare(self, problem: Problem, variant: str, points: int, half_width: float) -> Ready:
        """Return the multiplier made ready."""
        dim, h = problem.dim, 2.0 * half_width / points
        axes, shape = tuple(range(-dim, 0)), (points,) * dim
        waves = [fftfreq(points, h)] * (dim - 1) + [rfftfreq(points, h)]
        square = sum(k * k for k in np.meshgrid(*waves, indexing="ij", sparse=True))
        decay = np.exp(
            -problem.time * (2.0 * np.pi) ** problem.alpha * square ** (0.5 * problem.alpha)
        )

        def solve(u0: np.ndarray) -> np.ndarray:
            return irfftn(rfftn(u0, axes=axes) * decay, shape, axes=axes)

        return Ready(lattice(points, half_width, dim), h**dim, solve, batched=True)
