"""The time integration of a problem: the method, the steps from output time to output time, and their cost."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np

from fracparticles.errors import InvalidInput
from fracparticles.problems.problem import Problem
from fracparticles.problems.sudden import sudden_changes
from fracparticles.time.krylov import KrylovStep
from fracparticles.time.stabilised import StabilisedStep, spectral_radius
from fracparticles.time.steps import STAGES, Absolute, EighthOrderStep, Steps
from fracparticles.time.sudden import instant

__all__ = ["Integration", "advanced", "integrate", "size_of_start", "size_to_come"]

_FINEST = 1e-9  # the least rtol of RKC2; below, the estimate of its error is round-off
_LOOKS = 17  # times at which a source that starts from u = 0 is evaluated
_FAINT = 1e-12  # share of what a source makes, below which u is not followed to its own digits
_REAL_AXIS = 5.5  # the greatest |lambda| dt at which a step of DOP853 is stable


@dataclass(frozen=True)
class Integration:
    """The result of a time integration.

    Attributes
    ----------
    u : list of arrays, shape (N,)
        u at each output time.
    method : str
        "exponential", "rkc2" or "dop853"; on an interval "radau", too.
    accepted, evaluations : int
        Steps taken, and evaluations of the right-hand side.
    rejected : int or None
        Steps thrown away, if that is known.
    stiffness : float
        The time of the run times an estimate of the largest |lambda|.
    """

    u: list[np.ndarray]
    method: str
    accepted: int
    rejected: int | None
    evaluations: int
    stiffness: float


class RightHandSide(Protocol):
    """R(t, u), flat like u; it counts its evaluations."""

    evaluations: int
    shape: tuple[int, ...]

    def __call__(self, t: float, u: np.ndarray) -> np.ndarray:
        """Return du/dt."""


def integrate(
    problem: Problem,
    rates: RightHandSide,
    u0: np.ndarray,
    held: Callable[[float], float] = lambda t: 0.0,
) -> Integration:
    """Integrate u' = R(t, u) to the output times.

    Parameters
    ----------
    problem : Problem
    rates : RightHandSide
        R(t, u).
    u0 : array, shape (N,)
        u at t_initial.
    held : callable
        Returns the size, at a time, of a field that is added to u: the tolerance is relative to it as well.

    Raises
    ------
    InvalidInput
        If the integrator asked for does not exist for this problem.
    NonFiniteSolution
        If the solution grows without bound; says when.
    """
    linear = problem.is_linear and problem.is_autonomous
    if problem.integrator == "exponential" and not linear:
        what = (
            "auto, rkc2 or dop853 for a source that depends on u, or coefficients that depend on t"
        )
        raise InvalidInput("integrator", problem.integrator, what, "Take auto.")
    if problem.integrator == "rkc2" and problem.rtol < _FINEST:
        finest = f"at least {_FINEST:g} for rkc2, whose estimate of the error is round-off below"
        raise InvalidInput("rtol", problem.rtol, finest, "Take another integrator.")
    # The error is to be small where the solution is, not in the mean over a lattice that it hardly fills.
    shares = np.sqrt(_filled(u0))
    rtol = problem.rtol * shares
    least = 0.0 if held(problem.t_initial) else size_of_start(problem, rates, u0)
    later = size_to_come(problem, rates, u0)
    atol: Absolute = lambda t, u: rtol * (max(float(np.abs(u).max()), held(t), later) or least)  # noqa: E731
    if problem.atol:
        atol = problem.atol * shares
    start, span = problem.t_initial, problem.span
    method: str = problem.integrator
    largest = 0.0
    if method == "auto":
        method = "exponential"
        if not linear:
            r = rates(start, u0)
            largest = spectral_radius(rates, start, u0, r)[0]
            method = _cheaper(problem, span * largest)
    steps: Steps
    if method == "exponential":
        steps = KrylovStep(lambda u: rates(start, u), u0.size, rtol, atol, span)
    elif method == "rkc2":
        steps = StabilisedStep(rates, rtol, atol)
    else:
        steps = EighthOrderStep(rates, rtol, atol)
    outputs = advanced(problem, steps, u0, sudden_changes(problem, u0.reshape(rates.shape)))
    u = outputs[-1]
    if not steps.largest and not largest:
        largest = spectral_radius(rates, problem.t_final, u, rates(problem.t_final, u))[0]
    return Integration(
        outputs, method, steps.accepted, steps.rejected, rates.evaluations,
        span * max(steps.largest, largest),
    )  # fmt: skip


def advanced(
    problem: Problem, steps: Steps, u0: np.ndarray, sudden: list[float]
) -> list[np.ndarray]:
    """Return u at each output time. Steps end at each sudden change, and find their length anew after it.

    No step is taken within a jump: a faded solution would be followed into it beyond the last digit of the time.
    """
    times, outputs, u = problem.output_times, [], u0
    changes, at_once = set(sudden), instant(problem.t_initial, problem.span)
    for before, after in pairwise(sorted({problem.t_initial, *sudden, *times})):
        if before in changes:
            steps.forget()
        if not (before in changes and after in changes and after - before <= at_once):
            u = steps.advance(u, after - before, before)
        if after in times:
            outputs.append(np.array(u))
    return outputs


def size_of_start(problem: Problem, rates: RightHandSide, u0: np.ndarray) -> float:
    """Return the greatest |u| at t_initial; if that is zero, the size that the source may give it."""
    size = float(np.abs(u0).max()) or _made(problem, rates, u0)
    return size if 0.0 < size < np.inf else 1.0


def size_to_come(problem: Problem, rates: RightHandSide, u0: np.ndarray) -> float:
    """Return a size that is negligible beside what the source makes from u = 0.

    A smaller solution, at the start or after it has faded, is not followed to its own digits. If it were, steps could
    not follow a source that begins then.
    """
    if problem.reaction is None:
        return 0.0
    size = _FAINT * _made(problem, rates, np.zeros_like(u0))
    return size if size < np.inf else 0.0


def _made(problem: Problem, rates: RightHandSide, u0: np.ndarray) -> float:
    times = problem.t_initial + problem.span * np.linspace(0.0, 1.0, _LOOKS)
    return problem.span * max(float(np.abs(rates(t, u0)).max()) for t in times)


def _filled(u: np.ndarray) -> float:
    """Return the share of the lattice that |u| fills, (sum |u|)^2 / (N sum u^2)."""
    size = np.abs(u).max()
    if not size > 0.0:
        return 1.0
    part = np.abs(u / size)
    return float(part.sum() ** 2 / (u.size * (part * part).sum()))


def _cheaper(problem: Problem, stiffness: float) -> str:
    """Return the explicit method with fewer evaluations. Stability limits that of order 8, accuracy that of order 2.

    RKC2 takes n = tol^(-1/2) steps of sqrt(1.54 T rho / n) stages. It is not stable for waves that travel.
    """
    if problem.transport or problem.rtol < _FINEST:
        return "dop853"
    n = problem.rtol**-0.5
    stabilised = n * (2.0 + np.sqrt(1.0 + 1.54 * stiffness / n))
    return "rkc2" if stabilised < STAGES * stiffness / _REAL_AXIS else "dop853"
