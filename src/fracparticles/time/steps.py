"""The interface of error-controlled steps, and scipy's steps of order 8 by Dormand & Prince, for problems not stiff."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np
from scipy.integrate import DOP853

from fracparticles.errors import NonFiniteSolution

__all__ = ["STAGES", "Absolute", "EighthOrderStep", "Rate", "Steps", "absolute", "blown_up", "norm"]

Rate = Callable[[float, np.ndarray], np.ndarray]
"""R(t, u)."""

Absolute = float | Callable[[float, np.ndarray], float]
"""An absolute tolerance: a number, or a function of the time and of u."""

STAGES = 12  # evaluations that a step of order 8 takes


class Steps(Protocol):
    """Steps of u' = R(t, u).

    Attributes
    ----------
    accepted : int
        Steps taken.
    rejected : int or None
        Steps thrown away; None if they are not counted.
    largest : float
        The largest |lambda| that was estimated; 0 if none was.
    """

    accepted: int
    largest: float

    @property
    def rejected(self) -> int | None:
        """A property, so that the attribute of a class may be an int that is never None."""

    def advance(self, u: np.ndarray, span: float, start: float = 0.0) -> np.ndarray:
        """Return u, shape (N,), at the time `start + span`; raises `NonFiniteSolution` if it blows up."""

    def forget(self) -> None:
        """Let the next step find its length anew: the right-hand side has changed suddenly."""


class EighthOrderStep:
    """Steps of order 8; the root mean square of their estimated error / (atol + rtol |u|) is at most 1.

    Parameters
    ----------
    rate : callable
        R(t, u).
    rtol : float
    atol : float, or function of t and u
    """

    def __init__(self, rate: Rate, rtol: float, atol: Absolute) -> None:
        self._rate, self._rtol, self._atol = rate, rtol, atol
        self.accepted = self.rejected = 0
        self.largest = 0.0
        self._dt: float | None = None

    def advance(self, u: np.ndarray, span: float, start: float = 0.0) -> np.ndarray:
        """Return u after the time `span`, of any shape.

        Raises
        ------
        NonFiniteSolution
            If u grows without bound, so that the step shrinks to nothing; the message says when.
        """
        first = None if self._dt is None else min(self._dt, span)
        tolerances = {"rtol": self._rtol, "atol": absolute(self._atol, start, u)}
        with np.errstate(over="ignore", invalid="ignore"):
            solver = DOP853(
                lambda t, y: self._rate(t, y.reshape(u.shape)).reshape(-1),
                start, u.reshape(-1), start + span, first_step=first, **tolerances,
            )  # fmt: skip
            began, taken = solver.nfev, 0
            while solver.status == "running":
                solver.atol = absolute(self._atol, solver.t, solver.y)
                solver.step()
                taken += 1
                if solver.status == "failed" or not np.isfinite(solver.y).all():
                    raise blown_up(solver.t, solver.y)
        self.accepted += taken
        self.rejected += round((solver.nfev - began) / STAGES) - taken
        self._dt = solver.h_abs
        return np.asarray(solver.y).reshape(u.shape)

    def forget(self) -> None:
        """Let the next step find its length anew."""
        self._dt = None


def absolute(atol: Absolute, t: float, u: np.ndarray) -> float:
    """Return the absolute tolerance at a time when the solution is u."""
    return atol(t, u) if callable(atol) else atol


def blown_up(t: float, u: np.ndarray) -> NonFiniteSolution:
    """Return the error of a solution whose time step has shrunk to nothing."""
    return NonFiniteSolution(
        f"the solution grows without bound near t = {t:.6g}: the time step has shrunk to nothing, and the greatest |u| "
        f"is {np.abs(u).max():.3g}. End before, or mend the source."
    )


def norm(u: np.ndarray) -> float:
    """Return the 2-norm, summed in one order whatever the number of threads, of numbers of any size."""
    largest = float(np.abs(u).max(initial=0.0))
    if not 0.0 < largest < np.inf:
        return largest
    part = u / largest
    return largest * float(np.sqrt(np.sum(part * part)))
