r"""Diffusion in its modes and transport beside it, by implicit steps: y' = -lambda y + P(t) y + N(y, t).

Waves that are carried as fast as they decay, P of the size of lambda, are no matter for an explicit N (`exponential`).
Radau IIA of order 5, scipy's (Hairer & Wanner, Solving ODEs II, Sec. IV.8), takes them with the matrix -lambda + P; in
the modes that is not afraid of rates of 1e15, each of which is known to its own digits.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.integrate import Radau

from fracparticles.arguments import FloatArray
from fracparticles.bounded.exponential import Modes, Rest
from fracparticles.errors import NonFiniteSolution
from fracparticles.time.steps import blown_up

__all__ = ["ImplicitSteps"]

_FINEST = 1e-12  # of a relative tolerance
_MOST = 20_000  # steps


class ImplicitSteps:
    """Steps of u' = A u + N(t, u) with the derivative of both in the modes of A.

    Parameters
    ----------
    modes : Modes
        Of -A.
    rest : callable
        N.
    beside : callable
        P(t, u), shape (N, N): what is to be taken implicitly of the derivative of N.
    tolerance, size : float
        Of each step, relative to the norm of u, or to `size` where u is smaller.

    Attributes
    ----------
    accepted, rejected : int
        Steps taken; those thrown away are not told, and are 0 here.
    largest : float
        The greatest rate.
    """

    def __init__(
        self,
        modes: Modes,
        rest: Rest,
        beside: Callable[[float, FloatArray], FloatArray],
        tolerance: float,
        size: float,
    ) -> None:
        self._modes, self._rest, self._beside = modes, rest, beside
        self._tolerance, self._size = max(tolerance, _FINEST), size
        self.accepted = self.rejected = 0
        self.largest = float(modes.rates.max())
        self._h: float | None = None

    def advance(self, u: FloatArray, span: float, start: float = 0.0) -> FloatArray:
        """Return u after the time `span`.

        Raises
        ------
        NonFiniteSolution
            If u becomes infinite, or the steps too short or too many; says when.
        """
        modes = self._modes
        y, diagonal = modes.into(u), np.diag(modes.rates)

        def rate(t: float, y: FloatArray) -> FloatArray:
            return np.asarray(-modes.rates * y + modes.into(self._rest(t, modes.back(y))))

        with np.errstate(over="ignore", invalid="ignore"):
            first = float(np.linalg.norm(self._rest(start, u))) * span
            size = max(float(np.linalg.norm(y)), self._size) or first or 1.0
            solver = Radau(
                rate, start, y, start + span, rtol=self._tolerance,
                atol=self._tolerance * size / np.sqrt(y.size),
                jac=lambda t, y: self._beside(t, modes.back(y)) - diagonal,
                first_step=None if self._h is None else min(self._h, span),
            )  # fmt: skip
            for _ in range(_MOST):
                solver.step()
                if solver.status == "failed" or not np.isfinite(solver.y).all():
                    raise blown_up(solver.t, modes.back(solver.y))
                self.accepted += 1
                if solver.status == "finished":
                    self._h = float(solver.h_abs)
                    return modes.back(solver.y)
        raise NonFiniteSolution(
            f"the solution stops at t = {solver.t:g} after {_MOST} steps. End before, or mend the source "
            "or the velocity."
        )

    def forget(self) -> None:
        """Let the next step find its length anew."""
        self._h = None
