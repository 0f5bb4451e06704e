"""Run DVM on arrays: its particles move, so that nothing can be prepared."""

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
        Of scheme "DVM".
    u0 : array, shape `case.shape`
        Initial strengths.
    observe : callable, optional
        See `lagrangian.advance`.

    Raises
    ------
    NonFiniteSolution
        If the run blows up; `FieldNotPositive` if that is for the field.
    """
    return advect_to_outputs(case, u0, observe)[-1]


def advect_to_outputs(
    case: Case, u0: np.ndarray, observe: Observer | None = None
) -> list[ParticleRun]:
    """Return what `advect` does for each output time."""
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
    """Return the error with the scheme in front of what it says."""
    return type(error)(f"{case.scheme} (order {case.order}): {error}")
