"""Run DVM on arrays. Its particles move, so that nothing can be prepared."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fracparticles.errors import NonFiniteSolution
from fracparticles.moving import dvm
from fracparticles.moving.lagrangian import Observer
from fracparticles.run.case import Case

if TYPE_CHECKING:
    from fracparticles.moving.dvm import ParticleRun

__all__ = ["advect", "advect_to_outputs", "named"]


def advect(case: Case, u0: np.ndarray, observe: Observer | None = None) -> ParticleRun:
    """Run DVM, whose particles move, and return them.

    Parameters
    ----------
    case : Case
        A case of the scheme "DVM".
    u0 : array, shape `case.shape`
        Initial strengths.
    observe : callable, optional
        See `lagrangian.advance`.

    Raises
    ------
    NonFiniteSolution
        If the run blows up; `FieldNotPositive` if the cause is a field that is not positive.
    """
    return advect_to_outputs(case, u0, observe)[-1]


def advect_to_outputs(
    case: Case, u0: np.ndarray, observe: Observer | None = None
) -> list[ParticleRun]:
    """Return the particles at each output time; parameters and errors as for `advect`."""
    try:
        return dvm.run_to_outputs(
            case.x,
            u0,
            spacing=case.particle_spacing,
            alpha=case.alpha,
            order=case.order,
            overlap=case.resolved_overlap,
            diffusivity=case.diffusivity,
            start=case.t_initial,
            legs=case.legs,
            summation=case.summation,
            exterior=case.exterior,
            observe=observe,
            **case.redistribution,
        )
    except NonFiniteSolution as error:
        raise named(case, error) from None


def named(case: Case, error: NonFiniteSolution) -> NonFiniteSolution:
    """Return the error with the scheme in front of its message."""
    return type(error)(f"{case.scheme} (order {case.order}): {error}")
