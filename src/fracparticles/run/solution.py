"""The result of a run, and its error against the fundamental solution."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fracparticles.moving.dvm import ParticleRun
from fracparticles.run.case import Case
from fracparticles.run.reliability import Estimates
from fracparticles.run.times import Outputs
from fracparticles.special.stable import central_mass, green

__all__ = ["Solution", "relative_l1_deviation", "relative_l1_error"]


@dataclass(frozen=True)
class Solution:
    """The result of a run.

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
        For DVM, the particles themselves and the history of their redistributions.
    estimates : dict
        The estimates of the accuracy from the strengths, see `reliability`.
    outputs : Outputs, optional
        For a case with `times`, the strengths at each of them.
    """

    case: Case
    x: np.ndarray
    u0: np.ndarray
    u: np.ndarray
    operator_applications: int
    initial: str
    particles: ParticleRun | None = None
    estimates: Estimates = field(default_factory=dict)
    outputs: Outputs | None = None


def relative_l1_error(case: Case, u: np.ndarray) -> float:
    """Return `relative_l1_deviation` of the strengths of a case within `case.error_radius`: Eqs. (48), (59)."""
    whole: dict[str, Any] = {
        "time": case.diffusivity * case.t_final,
        "alpha": case.alpha,
        "dim": case.dim,
    }
    return relative_l1_deviation(u, case.radius, case.volumes, case.error_radius, **whole)


def relative_l1_deviation(
    u: np.ndarray,
    radius: np.ndarray,
    volumes: np.ndarray | float,
    within: float,
    *,
    time: float,
    alpha: float,
    dim: int,
) -> float:
    """Return the error against the fundamental solution G over |x| <= `within`, as in Eqs. (48), (59).

    It is sum_i V_i |u_i - G(x_i, t)| / int |G(x, t)| dx, with the integral in closed form.

    Parameters
    ----------
    u, radius : array
        u_i and |x_i|, of one shape.
    volumes : float or array
        V_i, one for all or one for each.
    within : float
        The radius.
    time, alpha, dim : float, float, int
        D t, 1 + beta and the space dimension.
    """
    inside = radius <= within * (1.0 + 1e-12)
    deviation = np.abs(u[inside] - green(radius[inside], time, alpha, dim))
    whole = central_mass(within, time, alpha, dim)
    if np.ndim(volumes) == 0:
        return float(volumes * deviation.sum() / whole)
    return float((np.asarray(volumes)[inside] * deviation).sum() / whole)
