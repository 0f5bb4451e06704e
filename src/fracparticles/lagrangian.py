r"""Particles of constant strength, carried by a velocity that follows from all of them:

    dx_i/dt = v(x_i),     U_i constant,                                                           (43)

in steps of the midpoint rule. It serves every conservation law u_t + (v u)_x = 0 whose velocity is a flux divided
by the field, v = Q / u, both of them sums over the particles (`sums.scattered`).

Rules
- Order does not matter. Particles that coincide are two strengths in one place: they stay together, since the
  velocity has one value there. Particles that overtake one another do so because dt is too large for the velocity
  gradient; the sums and remeshing remain what they are, and the history counts the steps after which it was so.
- Particles whose strength is at most `threshold` of the largest are left out at the start and after every
  remeshing, at threshold 0 those of no strength (or one that underflowed); the history keeps the total left out.
- A remeshing may be given ends: what it puts beyond them is left out too, and the history keeps that total apart.
- The field must have one sign at all particles, above the accuracy of the sums; else `FieldNotPositive`.
- A velocity or a position that is not finite, or a particle so far out that the sums cannot hold it, is an error
  too. All name the time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from fracparticles.errors import FracparticlesError, InvalidInput, NonFiniteSolution
from fracparticles.remeshing import REMESHINGS, eliminate, remesh
from fracparticles.special.arguments import positive_integer, positive_real, real_array

__all__ = ["FieldNotPositive", "History", "Remeshing", "advance", "quotient_velocity"]

Velocity = Callable[[np.ndarray, np.ndarray], np.ndarray]
Observer = Callable[[float, np.ndarray, np.ndarray], None]


class FieldNotPositive(NonFiniteSolution):
    """The field vanishes or changes sign at a particle, where a velocity Q / u has no meaning."""


@dataclass(frozen=True)
class Remeshing:
    """When and how to redistribute the particles onto the lattice x_p = p h.

    Attributes
    ----------
    name : {"M4'", "Lambda3"}
        See `remeshing`.
    spacing : float
        Lattice spacing h.
    above : float
        Remesh after a step that leaves two neighbours farther apart than `above` h.
    ends : tuple of two floats or None
        The first and last lattice point kept; None: the lattice goes on as far as the particles need.
    """

    name: str
    spacing: float
    above: float = 1.5
    ends: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        if self.name not in REMESHINGS:
            raise InvalidInput(
                "remeshing", self.name, f"one of {', '.join(REMESHINGS)}", "Choose one of these."
            )
        positive_real("spacing", self.spacing)
        if not positive_real("remesh_above", self.above) > 1.0:
            raise InvalidInput(
                "remesh_above", self.above, "a number above 1", "Give 1.5, for example."
            )
        if self.ends is not None and not self.ends[0] < self.ends[1]:
            raise InvalidInput("ends", self.ends, "two increasing numbers", "Mend their order.")


@dataclass
class History:
    """What happened on the way.

    Attributes
    ----------
    remeshing_times, spacings_before, spacings_where : list of float
        For each remeshing the time, the largest spacing before it and the middle of that gap.
    particles : list of int
        The number of particles at the start and after each remeshing.
    total_initial, total_final : float
        Total strength given, and at the end.
    eliminated_count, eliminated_strength
        Particles left out because of the threshold, and their total strength.
    lost_strength : float
        Total strength of what remeshing put beyond its ends.
    overtaking_steps : int
        Steps after which the particles were no longer in the order in which the step before had left them.
    largest_spacing : float
        The largest spacing after any step.
    velocity_evaluations : int
    """

    remeshing_times: list[float] = field(default_factory=list)
    spacings_before: list[float] = field(default_factory=list)
    spacings_where: list[float] = field(default_factory=list)
    particles: list[int] = field(default_factory=list)
    total_initial: float = 0.0
    total_final: float = 0.0
    eliminated_count: int = 0
    eliminated_strength: float = 0.0
    lost_strength: float = 0.0
    overtaking_steps: int = 0
    largest_spacing: float = 0.0
    velocity_evaluations: int = 0

    @property
    def remeshings(self) -> int:
        """How often the particles were redistributed."""
        return len(self.remeshing_times)


def quotient_velocity(
    flux: np.ndarray, u: np.ndarray, x: np.ndarray, accuracy: float = 0.0
) -> np.ndarray:
    """Return v = Q / u at the particles, Eq. (44).

    Parameters
    ----------
    flux, u, x : array, shape (N,)
        Q and u at the particles, and where they are.
    accuracy : float
        The error of u relative to its largest modulus.

    Raises
    ------
    FieldNotPositive
        Unless u has one sign and is larger than its error at all particles; names the worst place.
    NonFiniteSolution
        If the velocity is not finite.
    """
    top = int(np.argmax(np.abs(u)))
    signed = np.copysign(1.0, u[top]) * u
    worst = int(np.argmin(signed))
    if not signed[worst] > accuracy * signed[top]:
        raise FieldNotPositive(
            f"the field is {u[worst]:.3g} at the particle x = {x[worst]:.6g} and {u[top]:.3g} at its peak "
            f"x = {x[top]:.6g}: a velocity Q / u needs a field of one sign, larger than "
            f"{accuracy:.0e} of its peak. Leave out weak particles by a larger threshold, or mend the data."
        )
    with np.errstate(over="ignore"):
        velocity = flux / u
    if not np.isfinite(velocity).all():
        where = x[~np.isfinite(velocity)][0]
        raise NonFiniteSolution(f"the velocity Q / u is not finite at the particle x = {where:.6g}")
    return velocity


def advance(
    x: np.ndarray,
    strength: np.ndarray,
    velocity: Velocity,
    *,
    dt: float,
    steps: int,
    start: float = 0.0,
    remeshing: Remeshing | None = None,
    threshold: float = 0.0,
    observe: Observer | None = None,
) -> tuple[np.ndarray, np.ndarray, History]:
    """Advance the particles by `steps` midpoint steps: x* = x + dt/2 v(x), x <- x + dt v(x*).

    Parameters
    ----------
    x, strength : array, shape (N,)
        Positions and strengths U_i at time `start`.
    velocity : callable
        v(x, strength), shape (N,).
    dt, steps : float, int
    start : float
        Time at the start, for the history, the observer and messages.
    remeshing : Remeshing or None
    threshold : float
        See the rules of the module.
    observe : callable, optional
        observe(t, x, strength), called at the start and after every step (and its remeshing). It must not change
        the arrays; x is a new array at every step.

    Returns
    -------
    x, strength : array
    history : History

    Raises
    ------
    InvalidInput
        If the arguments cannot be worked with.
    NonFiniteSolution
        If the run cannot go on; `FieldNotPositive` if that is for the field. Both with the step and the time.
    """
    x, strength = _particles(x, strength)
    dt, steps = positive_real("dt", dt), positive_integer("steps", steps)
    history = History(total_initial=float(strength.sum()))
    x, strength = _keep(x, strength, threshold, history)
    history.particles.append(x.size)
    if observe is not None:
        observe(start, x, strength)
    for n in range(1, steps + 1):
        time = start + n * dt
        try:
            halfway = x + 0.5 * dt * velocity(x, strength)
            moved = x + dt * velocity(halfway, strength)
            _require_finite(moved, x)
            spacing, where = _largest_gap(moved, history)
            if remeshing is not None and spacing > remeshing.above * remeshing.spacing:
                history.remeshing_times.append(time)
                history.spacings_before.append(spacing)
                history.spacings_where.append(where)
                moved, strength = _redistribute(moved, strength, remeshing, history)
                moved, strength = _keep(moved, strength, threshold, history)
                history.particles.append(moved.size)
        except FracparticlesError as error:
            kind = FieldNotPositive if isinstance(error, FieldNotPositive) else NonFiniteSolution
            raise kind(
                f"step {n} of {steps}, from t = {time - dt:.6g} to {time:.6g}: {error}"
            ) from error
        x = moved
        if observe is not None:
            observe(time, x, strength)
    history.velocity_evaluations = 2 * steps
    history.total_final = float(strength.sum())
    return x, strength, history


def _particles(x: np.ndarray, strength: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    x, strength = np.array(real_array("x", x)), np.array(real_array("strength", strength))
    if x.ndim != 1 or x.shape != strength.shape:
        raise InvalidInput(
            "strength",
            f"array of shape {strength.shape}",
            f"one strength for each of the positions, of shape {x.shape}",
            "Give two arrays of one dimension and the same length.",
        )
    for name, values in (("x", x), ("strength", strength)):
        if not np.isfinite(values).all():
            index = int(np.flatnonzero(~np.isfinite(values))[0])
            raise InvalidInput(
                name, f"{values[index]} at index {index}", "finite numbers", "Mend the data."
            )
    return x, strength


def _keep(
    x: np.ndarray, strength: np.ndarray, threshold: float, history: History
) -> tuple[np.ndarray, np.ndarray]:
    kept = eliminate(x, strength, threshold)
    history.eliminated_count += kept.count
    history.eliminated_strength += kept.eliminated
    return kept.x, kept.strength


def _redistribute(
    x: np.ndarray, strength: np.ndarray, remeshing: Remeshing, history: History
) -> tuple[np.ndarray, np.ndarray]:
    x, strength = remesh(x, strength, remeshing.spacing, remeshing.name)
    if remeshing.ends is None:
        return x, strength
    slack = 0.25 * remeshing.spacing  # the ends are lattice points, up to round-off
    inside = (x > remeshing.ends[0] - slack) & (x < remeshing.ends[1] + slack)
    history.lost_strength += float(strength[~inside].sum())
    return x[inside], strength[inside]


def _require_finite(moved: np.ndarray, x: np.ndarray) -> None:
    finite = np.isfinite(moved)
    if not finite.all():
        raise NonFiniteSolution(f"the particle from x = {x[~finite][0]:.6g} went to infinity")


def _largest_gap(x: np.ndarray, history: History) -> tuple[float, float]:
    """Return the largest distance between neighbours and the middle of that gap."""
    if x.size < 2:
        return 0.0, float(x[0])
    gap = np.diff(x)
    if gap.min() < 0.0:
        history.overtaking_steps += 1
        x = np.sort(x)
        gap = np.diff(x)
    widest = int(np.argmax(gap))
    largest = float(gap[widest])
    history.largest_spacing = max(history.largest_spacing, largest)
    return largest, float(0.5 * (x[widest] + x[widest + 1]))
