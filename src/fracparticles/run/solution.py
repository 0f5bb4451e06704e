"""What a run computes, and its error against the fundamental solution."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fracparticles.moving.dvm import ParticleRun
from fracparticles.run.case import Case
from fracparticles.run.reliability import Estimates
from fracparticles.special.stable import central_mass, green

__all__ = ["Solution", "relative_l1_error"]


@dataclass(frozen=True)
class Solution:
    """What a run computes.

    Attributes
    ----------
    case : Case
    x : array, shape (N,)
        Positions along an axis.
    u0, u : array, shape (N,) * dim
        Initial and final strengths on the lattice; for DVM the final field (7) there.
    operator_applications : int
        How often the operator was applied, or the velocity evaluated.
    initial : str
        Where the initial data came from.
    particles : ParticleRun, optional
        For DVM, the particles themselves and what happened to them.
    estimates : dict
        What the strengths say of the accuracy, see `reliability`.
    """

    case: Case
    x: np.ndarray
    u0: np.ndarray
    u: np.ndarray
    operator_applications: int
    initial: str
    particles: ParticleRun | None = None
    estimates: Estimates = field(default_factory=dict)


def relative_l1_error(case: Case, u: np.ndarray) -> float:
    """Return the error against the fundamental solution, Eqs. (48), (59), over |x| <= `case.error_radius`.

    sum_i V_i |u_i - G(x_i, t_f)| / int |G(x, t_f)| dx, the integral in closed form.
    """
    radius = np.abs(case.x) if case.dim == 1 else case.radius
    inside = radius <= case.error_radius * (1.0 + 1e-12)
    time = case.diffusivity * case.t_final
    exact = green(radius[inside], time, case.alpha, case.dim)
    deviation = case.integral(np.abs(u[inside] - exact), inside)
    return float(deviation / central_mass(case.error_radius, time, case.alpha, case.dim))
