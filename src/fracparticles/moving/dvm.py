r"""Diffusion velocity method (DVM), Eqs. (42)-(45):

    dx_i/dt = v_i = Q(x_i) / u(x_i),     U_i = V_i u_i constant,
    u(x) = sum_j U_j eta_eps(x - x_j),                                                  (45), eta of (8), (9)
    Q(x) = -(D / eps^beta) sum_j U_j F_eps(x - x_j),                                    (19), F of (20), (21)

the diffusion written as an advection by the flux per unit of the field. The particles carry their strengths along,
so the total is constant. They spread, and are redistributed onto the lattice when they are too far apart
(`moving.remeshing`). For the fundamental solution the velocity is exactly x / (alpha t).

Stability: in a uniform field a displacement wave xi exp(i k x) of the particles changes at the rate
-D |k|^alpha eta^(k eps) xi, aliases neglected, which is DD's symbol. So the midpoint rule is stable for
D dt / h^alpha <= a with DD's a, although the strengths never change. At the ends of a truncated set, where the
particles run outward unchecked, the step is limited further, by the effect of remeshing wide gaps on the field.

A run warns of what it can detect: a step beyond that limit, particles too far apart for the smoothing length
(`moving.reliability`), remeshings that change the field, a few steps that are too long, strength lost to a threshold or
at the ends of the lattice, and tails that do not continue the field inside.

An open exterior continues the set by its far field (`moving.tail`). The end particles then follow the paths of the
solution, and remeshing is needed only because all spacings grow.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fracparticles.arguments import (
    choice,
    finite_array,
    positive_real,
    real_array,
    scale,
    vector,
)
from fracparticles.errors import AccuracyWarning, InvalidInput, NonFiniteSolution
from fracparticles.moving.diffusion_velocity import EXTERIORS, DiffusionVelocity
from fracparticles.moving.lagrangian import (
    REMESH_ABOVE,
    REMESHING,
    THRESHOLD,
    History,
    Observer,
    Remeshing,
    advance,
    strengths_of,
)
from fracparticles.moving.reliability import (
    END,
    Changes,
    Particles,
    looked_at,
    ripple,
    warn_of_misfit,
    warn_of_remeshing,
    warn_of_ripple,
    warn_of_round_off,
    warn_of_smoothing,
    warn_of_step,
    warn_of_volumes,
)

__all__ = [
    "EXTERIORS",
    "LATTICES",
    "REMESH_ABOVE_OPEN",
    "DiffusionVelocity",
    "ParticleRun",
    "largest_gap",
    "run",
    "run_to_outputs",
]

LATTICES = ("initial", "extended")
# The spacing above which an open exterior remeshes, in h. All spacings grow alike, to rho h say, and remeshing leaves a
# ripple of wavelength h / (1 - 1 / rho) on the field, until diffusion takes it away: with M4' at order II it is fifteen
# times the error of the run for rho = 1.2, five times for 1.1, and less than the error for 1.05.
REMESH_ABOVE_OPEN = 1.05
GONE = 0.05  # of the total strength: what a threshold, or the ends of a truncated lattice, may leave out
_MISFIT = 0.125  # of the total strength: what the tails of an open exterior may hold wrongly; runs err by a third of it
# Of the peak: what remeshings may change. The error of a run is from a third of it to all of it.
_REMESHED = 0.1
_FEW_STEPS = 8  # up to so many, the same run with half the step tells their error; beyond, other errors are larger
_OF_STEPS = 0.05  # of the peak: above, a warning is given


@dataclass(frozen=True)
class ParticleRun:
    """The particles at the end of a run.

    Attributes
    ----------
    x, strength : array, shape (N,)
        Positions and strengths U_i.
    history : History
    velocity : DiffusionVelocity
    """

    x: np.ndarray
    strength: np.ndarray
    history: History
    velocity: DiffusionVelocity

    def field(self, z: np.ndarray) -> np.ndarray:
        """Return the field u(z) = sum_j U_j eta_eps(z - x_j), Eq. (7)."""
        return self.velocity.field(self.x, self.strength, real_array("z", z))


def largest_gap(exterior: str) -> float:
    """Return the spacing above which a run remeshes unless told otherwise, in h."""
    return REMESH_ABOVE_OPEN if exterior == "open" else REMESH_ABOVE


def run(
    x: np.ndarray,
    u: np.ndarray,
    *,
    spacing: float,
    alpha: float,
    dt: float,
    steps: int,
    **parameters: Any,
) -> ParticleRun:
    """Advance the field u by `steps` midpoint steps: `run_to_outputs` with a single leg, and its errors and warnings.

    Warns
    -----
    AccuracyWarning
        Also if the kernels smooth the data.
    """
    (end,) = run_to_outputs(x, u, spacing=spacing, alpha=alpha, legs=[(dt, steps)], **parameters)
    x, u = real_array("x", x), finite_array("u", u)
    places, which = np.unique(x, return_inverse=True)  # particles in one place make one field
    held = end.velocity.field(x, strengths_of(u, spacing), places)
    warn_of_smoothing(held, np.bincount(which, u))
    return end


def run_to_outputs(
    x: np.ndarray,
    u: np.ndarray,
    *,
    spacing: float,
    alpha: float,
    legs: Sequence[tuple[float, int]],
    order: int = 2,
    overlap: float = 2.0,
    diffusivity: float = 1.0,
    start: float = 0.0,
    remeshing: str = REMESHING,
    remesh_above: float | None = None,
    lattice: str = "initial",
    threshold: float = THRESHOLD,
    summation: str = "fft",
    exterior: str = "truncated",
    observe: Observer | None = None,
) -> list[ParticleRun]:
    """Advance the field u, given at particles of volume h, by midpoint steps; return the particles after each leg.

    Parameters
    ----------
    x, u : array, shape (N,)
        Positions, and the field there: the strengths are U_i = h u_i.
    spacing : float
        h.
    legs : sequence of (float, int)
        A time step, and how many of them.
    overlap : float
        epsilon / h.
    remeshing : {"M4'", "Lambda3", "Lambda6,4", "none"}
        The paper's M4', and Lambda3, leave an error of some 1e-3 however small h is. Lambda6,4 leaves that of the
        kernels.
    lattice : {"initial", "extended"}
        The paper's "initial" confines remeshing to the initial lattice: what has left it is lost. "extended" goes as
        far as the particles need, which conserves the total. An open exterior has no end and takes "initial" only.
    exterior : {"truncated", "open"}
        Nothing beyond the end particles, or their far field, see `moving.tail`.
    remesh_above : float, optional
        Spacing above which to remesh, in h; 1.5 if left out, 1.05 for an open exterior.
    threshold, start, observe
        See `moving.lagrangian`.

    Raises
    ------
    InvalidInput
        If the arguments cannot be worked with.
    NonFiniteSolution
        If the run cannot go on.

    Warns
    -----
    StabilityWarning
        If the step is larger than `DiffusionVelocity.largest_stable_step`.
    AccuracyWarning
        If the particles are not `spacing` apart, or too far apart for the smoothing length; if remeshings change the
        field; if the steps are at most eight, and half the step changes it; if much of the strength has been left out;
        or if the far field of an open exterior does not fit the field inside.
    """
    spacing, overlap = scale("spacing", spacing), positive_real("overlap", overlap)
    x = real_array("x", x)
    velocity = DiffusionVelocity(alpha, order, overlap * spacing, diffusivity, summation, exterior)
    initial = x, strengths_of(vector("u", u, x.size), spacing)
    watch = _Watch(velocity, initial)
    redistribution = _redistribution(
        velocity, x, spacing, remeshing, remesh_above, lattice, exterior, watch
    )
    longest = max(positive_real("dt", dt) for dt, _ in legs)
    warn_of_step(longest, velocity.largest_stable_step, stacklevel=3)
    warn_of_round_off(x, sum(steps for _, steps in legs), velocity.epsilon)
    runs = list(
        _after_each(legs, initial, velocity, start, redistribution, threshold, observe=observe)
    )
    warn_of_volumes(*initial, spacing, stacklevel=3)
    watch.warn(runs[-1])
    if sum(steps for _, steps in legs) <= _FEW_STEPS:
        again = None if redistribution is None else replace(redistribution, noticed=None)
        finer = _after_each(legs, initial, velocity, start, again, threshold, parts=2)
        _warn_of_steps(_error_of_steps(runs[-1], finer, watch.at))
    _warn_of_loss(runs[-1].history, exterior)
    if velocity.tail is not None:
        misfit = velocity.tail.misfit(runs[-1].x, runs[-1].strength)
        warn_of_misfit(misfit, _MISFIT, stacklevel=3)
    return runs


def _after_each(
    legs: Sequence[tuple[float, int]],
    particles: Particles,
    velocity: DiffusionVelocity,
    start: float,
    redistribution: Remeshing | None,
    threshold: float,
    observe: Observer | None = None,
    parts: int = 1,
) -> Iterator[ParticleRun]:
    """Yield the particles after each leg; each step is cut into so many parts."""
    (x, strength), history = particles, None
    for dt, steps in legs:
        x, strength, own = advance(
            x,
            strength,
            velocity,
            dt=dt / parts,
            steps=steps * parts,
            start=start,
            remeshing=redistribution,
            threshold=threshold,
            observe=observe,
        )
        history = own if history is None else history.followed_by(own)
        yield ParticleRun(x, strength, history, velocity)
        start += dt * steps


def _redistribution(
    velocity: DiffusionVelocity,
    x: np.ndarray,
    spacing: float,
    remeshing: str,
    remesh_above: float | None,
    lattice: str,
    exterior: str,
    watch: _Watch,
) -> Remeshing | None:
    """Return how the particles are remeshed, None if they are not."""
    choice("lattice", lattice, LATTICES)
    if exterior == "open" and lattice != "initial":
        raise InvalidInput("lattice", lattice, "'initial' for exterior='open'", "Leave it out.")
    if remeshing == "none":
        return None
    ends = (float(x.min()), float(x.max())) if lattice == "initial" else None
    continued = None if velocity.tail is None else velocity.tail.continued
    above = largest_gap(exterior) if remesh_above is None else remesh_above
    return Remeshing(remeshing, spacing, above, ends, continued, watch.remeshed)


class _Watch:
    """What remeshings show of a run: the ripple of the particles before each, and how it changes the field.

    Attributes
    ----------
    at : array
        The places at which the field is looked at, all of them well inside.
    """

    def __init__(self, velocity: DiffusionVelocity, initial: Particles) -> None:
        x, strength = initial
        inner = np.abs(x - 0.5 * (x.min() + x.max())) <= 0.5 * np.ptp(x) - END * velocity.epsilon
        if not inner.any():
            inner[:] = True
        self.at = x[inner][looked_at(strength[inner])]
        self._velocity, self._initial, self._ripples = velocity, initial, list[float]()
        self._changes = Changes(
            lambda particles: velocity.field(particles[0], particles[1], self.at)
        )

    def remeshed(self, before: Particles, after: Particles) -> None:
        """Take note of a remeshing."""
        self._note_ripple(before)  # they are farthest apart
        self._changes.add(before, after)

    def warn(self, end: ParticleRun) -> None:
        """Warn of a ripple, and of what remeshings have changed."""
        for particles in (self._initial, (end.x, end.strength)):
            self._note_ripple(particles)
        remedy = "Take a larger overlap, or remesh sooner."
        warn_of_ripple(max(self._ripples), self._velocity.epsilon, remedy, stacklevel=4)
        warn_of_remeshing(self._changes.largest, _REMESHED, stacklevel=4)

    def _note_ripple(self, particles: Particles) -> None:
        x, strength = particles[:2]
        self._ripples.append(ripple(x, strength, self._velocity.epsilon, self._velocity.transform))


def _error_of_steps(run: ParticleRun, finer: Iterator[ParticleRun], at: np.ndarray) -> float:
    """Return the error of the steps over the peak, at some places; infinite if half the step does not get to the end.

    The midpoint rule is of second order: with half the step a quarter of its error is left.
    """
    try:
        *_, end = finer
    except NonFiniteSolution:
        return np.inf
    field = run.field(at)
    peak = float(np.abs(field).max())
    return 4.0 / 3.0 * float(np.abs(field - end.field(at)).max()) / peak if peak else 0.0


def _warn_of_steps(left: float) -> None:
    if left > _OF_STEPS:
        says = f"of about {left:.2g} of the peak, as half the step says"
        if left == np.inf:
            says = "that is not known: with half the step the run does not get to the end"
        warnings.warn(
            f"the time steps are so long that they leave an error {says}. Take a smaller step.",
            AccuracyWarning,
            stacklevel=4,
        )


def _warn_of_loss(history: History, exterior: str) -> None:
    weak, lost = (
        abs(part / history.total_initial)
        for part in (history.eliminated_strength, history.lost_strength)
    )
    if weak > GONE:
        warnings.warn(
            f"the particles left out for their small strengths held {weak:.2g} of the total. Take a smaller threshold.",
            AccuracyWarning,
            stacklevel=4,
        )
    if lost > GONE and exterior == "truncated":
        warnings.warn(
            f"remeshing onto the initial lattice has left out {lost:.2g} of the total strength, which now lies beyond "
            "its ends. Take a wider lattice, exterior='open' or lattice='extended'.",
            AccuracyWarning,
            stacklevel=4,
        )
