r"""Diffusion in its modes and transport beside it, by implicit steps: y' = -lambda y + P(t) y + N(y, t).

An explicit N (`exponential`) cannot follow waves that are carried as fast as they decay, where P has the size of
lambda. Radau IIA of order 5 (Hairer & Wanner, Solving ODEs II, Sec. IV.8), from scipy, solves for them with the matrix
-lambda + P. In the modes rates of 1e15 do no harm: each of them is known to its own digits.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.integrate import Radau

from fracparticles.arguments import FloatArray
from fracparticles.bounded.modes import Held, ModalSteps, Modes, Rest, size_of
from fracparticles.errors import InvalidInput, NonFiniteSolution
from fracparticles.time.steps import blown_up, ordinary_unit

__all__ = ["ImplicitSteps"]

Beside = Callable[[float, FloatArray], FloatArray]

_FINEST = 1e-12  # the least relative tolerance
_MOST = 20_000  # steps
_FIRST = 1e-3  # share of the time: what N makes in it from u = 0 is the size for the first step
# The least size of u to which steps are accurate, in its ordinary unit: smaller numbers underflow.
_NOTHING = 1e-290


class ImplicitSteps(ModalSteps):
    """Steps of u' = A u + N(t, u) with the derivative of both in the modes of A; rejected steps are not counted.

    Parameters
    ----------
    modes, rest, tolerance, held
        See `ModalSteps`.
    beside : callable
        P(t, u), shape (N, N): the part of the derivative of N that is implicit.
    """

    def __init__(
        self, modes: Modes, rest: Rest, beside: Beside, tolerance: float, held: Held | None = None
    ) -> None:
        super().__init__(modes, rest, max(tolerance, _FINEST), held)
        self._beside, self.largest = beside, float(modes.rates.max())

    def advance(self, u: FloatArray, span: float, start: float = 0.0) -> FloatArray:
        """Return u after the time `span`.

        Raises
        ------
        NonFiniteSolution
            If u becomes infinite, or the steps too short or too many; says when.
        """
        modes = self._modes
        y, diagonal = modes.into(u), np.diag(modes.rates)
        with np.errstate(over="ignore", invalid="ignore"):
            first = size_of(modes.into(self._rest(start, u))) * _FIRST * span
            unit = ordinary_unit(self._size(start, y) or first)
            y = y / unit

            # The time is counted from the start: beside a large one, no step of scipy's is short.
            def rate(t: float, y: FloatArray) -> FloatArray:
                beside = modes.into(self._rest(start + t, modes.back(unit * y))) / unit
                return np.asarray(-modes.rates * y + beside)

            def atol(t: float, y: FloatArray) -> float:
                size = max((self._size(start + t, unit * y) or first or 1.0) / unit, _NOTHING)
                return self._tolerance * size / np.sqrt(y.size)

            solver = Radau(
                rate, 0.0, y, span, rtol=self._tolerance, atol=atol(0.0, y),
                jac=lambda t, y: self._beside(start + t, modes.back(unit * y)) - diagonal,
                first_step=None if self._h is None else min(self._h, span),
            )  # fmt: skip
            for _ in range(_MOST):
                solver.atol = atol(solver.t, solver.y)
                try:
                    solver.step()
                except InvalidInput:
                    raise
                # Of scipy's solver of linear equations, which refuses infinite numbers.
                except ValueError as error:
                    raise blown_up(start + solver.t, modes.back(unit * solver.y)) from error
                if solver.status == "failed" or not np.isfinite(solver.y).all():
                    raise blown_up(start + solver.t, modes.back(unit * solver.y))
                self.accepted += 1
                if solver.status == "finished":
                    self._h = float(solver.h_abs)
                    return modes.back(unit * solver.y)
        raise NonFiniteSolution(
            f"the solution stops at t = {start + solver.t:g} after {_MOST} steps. End before, or mend the source "
            "or the velocity."
        )
