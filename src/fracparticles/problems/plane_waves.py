"""Waves that a velocity makes on a disc or a square of few particles.

Some waves may grow, at most at the rate max(-div a) / 2 less the lowest rate of the diffusion, see
`bounded.disc_transport` and `bounded.square_transport`. Where div a = 0 no wave grows. No mode of the equation
u_t = D A u - div(a u) grows either: int |u| falls or stays, even while int u^2 grows. So an eigenvalue with a positive
real part belongs to the particles. Its wave is a layer that the velocity presses together to less than the distance of
particles. On an interval there is no such bound; `unresolved_share` and `space_error` tell of such layers there.

On a disc other waves are too short for the angles. A velocity couples each wave along the rings to its neighbours, and
takes those beyond the shortest for longer ones. In the modes a high wave may be slow, so that its rate does not tell.
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

_MOST = 300  # particles whose eigenvalues take no longer than a run; for more, runs on fewer tell, by `space_error`
_GROWTH = np.log(10.0)  # log of the growth of a wave over the run from which there is a warning
_ROUND_OFF = -np.log(np.finfo(float).eps)  # log of the growth that makes the last digit the first


def warn_of_growth(problem: Problem, rates: DomainRates) -> None:
    """Look for waves that grow on a disc or a square of few particles, with the velocity at three times.

    Raises
    ------
    NonFiniteSolution
        If they grow from round-off to the size of u.

    Warns
    -----
    StabilityWarning
        If they grow tenfold.
    """
    few = rates.domain.volumes.size <= _MOST
    if problem.domain not in ("disc", "square") or not problem.transport or not few:
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
        f"waves that the particles do not resolve grow by exp({found * problem.span:.3g}) on the {problem.domain}, "
        "because the velocity presses u together faster than it spreads. Take more particles, a smaller velocity, a "
        "larger diffusivity or alpha, or an earlier end."
    )
    if found * problem.span > _ROUND_OFF:
        raise NonFiniteSolution(text)
    warnings.warn(text, StabilityWarning, stacklevel=4)


def high_waves(disc: Disc, v: FloatArray) -> float:
    """Return the norm of v in the upper half of the waves along the rings."""
    return size_of(disc.all_modes().into(v)[disc.angles // 4 + 1 :].reshape(-1))
