"""The interface of error-controlled steps, and scipy's steps of order 8 by Dormand & Prince, for problems not stiff."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np
from scipy.integrate import DOP853

from fracparticles.errors import NonFiniteSolution

__all__ = [
    "STAGES",
    "Absolute",
    "ControlledStep",
    "EighthOrderStep",
    "Pace",
    "Rate",
    "Steps",
    "absolute",
    "blown_up",
    "norm",
    "ordinary_unit",
]

Rate = Callable[[float, np.ndarray], np.ndarray]
"""R(t, u) of u' = R(t, u)."""

Absolute = float | Callable[[float, np.ndarray], float]
"""An absolute tolerance: a number, or a function of the time and of u."""

STAGES = 12  # evaluations that a step of order 8 takes
_LOOK = 2000  # steps between two looks at the pace
_MOST = 1e6  # steps to go, beyond which the end is out of reach
_LEAST = float(np.finfo(float).tiny)  # the least absolute tolerance, in the ordinary unit of u
# Sizes from 2^-500 to 2^500 are ordinary: their tolerances and their squares are numbers.
_ORDINARY = 500


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

    @property
    def accepted(self) -> int:
        """A property, so that a class may have it as an attribute or compute it."""

    @property
    def largest(self) -> float:
        """Likewise."""

    @property
    def rejected(self) -> int | None:
        """Likewise; the attribute of a class may be an int that is never None."""

    def advance(self, u: np.ndarray, span: float, start: float = 0.0) -> np.ndarray:
        """Return u, shape (N,), at the time `start + span`; raises `NonFiniteSolution` if it blows up."""

    def forget(self) -> None:
        """Let the next step find its length anew: the right-hand side has changed suddenly."""


class ControlledStep:
    """What steps of u' = R(t, u) with an estimated error have in common: their tolerances and counters, see `Steps`.

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

    def forget(self) -> None:
        """Let the next step find its length anew."""
        self._dt = None


class EighthOrderStep(ControlledStep):
    """Steps of order 8; the root mean square of their estimated error / (atol + rtol |u|) is at most 1."""

    def advance(self, u: np.ndarray, span: float, start: float = 0.0) -> np.ndarray:
        """Return u after the time `span`, of any shape.

        Raises
        ------
        NonFiniteSolution
            If u grows without bound, or reaches a value where the right-hand side is singular: then the steps shrink to
            nothing, or would never reach the end; says when.
        """
        first = None if self._dt is None else min(self._dt, span)
        unit = ordinary_unit(
            max(float(np.abs(u).max()), absolute(self._atol, start, u) / self._rtol)
        )

        def atol(t: float, u: np.ndarray) -> float:
            return max(absolute(self._atol, t, u) / unit, _LEAST)  # u may have faded to nothing

        # The time is counted from the start: beside a large one, no step of scipy's is short.
        with np.errstate(over="ignore", invalid="ignore"):
            solver = DOP853(
                lambda t, y: self._rate(start + t, unit * y.reshape(u.shape)).reshape(-1) / unit,
                0.0, u.reshape(-1) / unit, span,
                first_step=first, rtol=self._rtol, atol=atol(start, u),
            )  # fmt: skip
            began, taken, pace = solver.nfev, 0, Pace(start, span)
            while solver.status == "running":
                solver.atol = atol(start + solver.t, unit * solver.y)
                solver.step()
                taken += 1
                if solver.status == "failed" or not np.isfinite(solver.y).all():
                    raise blown_up(start + solver.t, unit * solver.y)
                pace.stepped(start + solver.t)
        self.accepted += taken
        self.rejected += round((solver.nfev - began) / STAGES) - taken
        self._dt = solver.h_abs
        return np.asarray(unit * solver.y).reshape(u.shape)


class Pace:
    """The pace of steps: they stop if they would never reach the end.

    A solution may be driven to a value where its source jumps or is infinite, like 1 / u at u = 0. It crosses this
    value again and again, in steps that are very short but never fail.
    """

    def __init__(self, start: float, span: float) -> None:
        self._end, self._before, self._taken, self._pace = start + span, start, 0, np.inf

    def stepped(self, t: float) -> None:
        """Note a step to the time t.

        Raises
        ------
        NonFiniteSolution
            If more than a million steps would follow, and the pace does not fall. Where it falls, as in a blow-up,
            steps end by themselves.
        """
        self._taken += 1
        if self._taken % _LOOK:
            return
        before, self._before = self._before, t
        last, self._pace = self._pace, t - before
        if (self._end - t) * _LOOK > _MOST * self._pace and self._pace > 0.5 * last:
            raise NonFiniteSolution(
                f"the time steps have shrunk to {self._pace / _LOOK:.2g} at t = {t:.6g}, and would not reach "
                f"t = {self._end:.6g}: the source may be singular where the solution has come to, or the problem too "
                "stiff for these steps. End before, mend the source, or take another integrator."
            )


def absolute(atol: Absolute, t: float, u: np.ndarray) -> float:
    """Return the absolute tolerance at a time when the solution is u."""
    return atol(t, u) if callable(atol) else atol


def ordinary_unit(size: float) -> float:
    """Return the power of two nearest to one in which a size is ordinary: 1 for nearly all.

    Steps are taken in this unit. Their tolerance is a small share of the size: of 1e-300 it would have no digits.
    """
    exponent = int(np.frexp(size)[1])
    return float(np.ldexp(1.0, exponent - min(max(exponent, -_ORDINARY), _ORDINARY)))


def blown_up(t: float, u: np.ndarray) -> NonFiniteSolution:
    """Return the error of a solution whose time step has shrunk to nothing."""
    return NonFiniteSolution(
        f"the solution grows without bound near t = {t:.6g}: the time step has shrunk to nothing, and the greatest |u| "
        f"is {np.abs(u).max():.3g}. If that is not large, the source is singular where u has come to. End before, or "
        "mend the source."
    )


def norm(u: np.ndarray) -> float:
    """Return the 2-norm, summed in one order whatever the number of threads, of numbers of any size."""
    largest = float(np.abs(u).max(initial=0.0))
    if not 0.0 < largest < np.inf:
        return largest
    part = u / largest
    return largest * float(np.sqrt(np.sum(part * part)))
