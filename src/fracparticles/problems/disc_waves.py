"""Waves that a velocity makes on a disc of few particles.

Some may grow, but no faster than u is pressed together, see `bounded.disc_transport`: at max(-div a) / 2, less the
lowest rate of the diffusion. Where div a = 0 none does. Nor does any of u_t = D A u - div(a u): int |u| falls, or
stays, while int u^2 grows. So an eigenvalue with a positive real part is the particles' own, of a layer that is pressed
together to less than the distance of rings.

Others are too short for the angles. A velocity takes each wave along the rings for its neighbours, and those beyond the
shortest for others. In the modes a high wave may be slow, so that its rate does not tell.
"""

from __future__ import annotations

import warnings

import numpy as np

from fracparticles.arguments import FloatArray
from fracparticles.bounded.disc import Disc
from fracparticles.bounded.modes import size_of
from fracparticles.errors import NonFiniteSolution, StabilityWarning
from fracparticles.problems.domain_rates import DomainRates
from fracparticles.problems.problem import Problem

__all__ = ["high_waves", "warn_of_growth"]

_MOST = 300  # particles whose eigenvalues take no longer than a run; of more those of fewer tell, by `space_error`
_GROWTH = np.log(10.0)  # of a wave over the run, before there is a warning
_ROUND_OFF = -np.log(np.finfo(float).eps)  # what makes of the last digit the first


def warn_of_growth(problem: Problem, rates: DomainRates) -> None:
    """Look for waves that grow on a disc of few particles, by the velocity at three times, if they can.

    Raises
    ------
    NonFiniteSolution
        If they grow so much that they are all that is left of u.

    Warns
    -----
    StabilityWarning
        If they grow tenfold.
    """
    if problem.domain != "disc" or not problem.transport or rates.domain.volumes.size > _MOST:
        return
    varies = any("t" in one.depends_on for one in (problem.diffusion, *problem.transport))
    shares = (0.0, 0.5, 1.0) if varies else (0.0,)
    times = [problem.t_initial + share * problem.span for share in shares]
    least = rates.slowest()
    found = max(
        (rates.growth(t) for t in times if (rates.pressed(t) - least) * problem.span > _GROWTH),
        default=0.0,
    )
    if found * problem.span <= _GROWTH:
        return
    text = (
        f"waves that the particles do not resolve grow by exp({found * problem.span:.3g}) on the disc, because the "
        "velocity presses u together faster than it spreads. Take more rings, a smaller velocity, a larger diffusivity "
        "or alpha, or an earlier end."
    )
    if found * problem.span > _ROUND_OFF:
        raise NonFiniteSolution(text)
    warnings.warn(text, StabilityWarning, stacklevel=4)


def high_waves(disc: Disc, v: FloatArray) -> float:
    """Return the norm of v in the upper half of the waves along the rings."""
    return size_of(disc.all_modes().into(v)[disc.angular // 4 + 1 :].reshape(-1))
