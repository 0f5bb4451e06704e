r"""Particles of constant strength, carried by a velocity that follows from all of them:

    dx_i/dt = v(x_i),     U_i constant,                                                           (43)

in steps of the midpoint rule. It serves every conservation law u_t + (v u)_x = 0 whose velocity is a flux divided
by the field, v = Q / u, both of them sums over the particles (`moving.scattered`).

Rules
- The particles may be in any order. Particles that coincide are two strengths at one position: they stay together,
  since the velocity has one value there. If dt is too large for the velocity gradient, particles overtake one another.
  The sums and remeshing still work, and the history counts the steps that changed the order.
- Particles whose strength is at most `threshold` of the largest are left out at the start and after every remeshing.
  At threshold 0 these are the particles of strength zero. The history keeps the total that was left out.
- A remeshing may be given ends. What it puts beyond them is left out too, and the history keeps that total apart.
- The field must have one sign at all particles, above the accuracy of the sums; else `FieldNotPositive`.
- A velocity or a position that is not finite, or a particle so far out that the sums cannot hold it, is an error
  too. Every error names the time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.errors import FracparticlesError, InvalidInput, NonFiniteSolution
from fracparticles.moving.history import History
from fracparticles.moving.remeshing import REMESHINGS, eliminate, remesh, total_of

__all__ = [
    "MIDPOINT_LIMIT",
    "REMESHING",
    "REMESH_ABOVE",
    "THRESHOLD",
    "FieldNotPositive",
    "History",
    "Remeshing",
    "advance",
    "quotient_velocity",
]

MIDPOINT_LIMIT = 2.0  # |1 + z + z^2 / 2| <= 1 for real z = lambda dt in [-2, 0]
# The defaults: the remeshing kernel, the spacing in h above which it is used, and the share of the greatest strength
# up to which particles are left out.
REMESHING, REMESH_ABOVE, THRESHOLD = "M4'", 1.5, 0.0

Velocity = Callable[[np.ndarray, np.ndarray], np.ndarray]
Continued = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]
Noticed = Callable[[tuple[np.ndarray, ...], tuple[np.ndarray, ...]], None]
Observer = Callable[[float, np.ndarray, np.ndarray], None]

# The greatest strength must be this large, so that strengths of 1e-16 of it still have all their digits.
_SMALLEST = 1e-290


class FieldNotPositive(NonFiniteSolution):
    """The field vanishes or changes sign at a particle, where a velocity Q / u has no meaning."""


@dataclass(frozen=True)
class Remeshing:
    """When and how to redistribute the particles onto the lattice x_p = p h.

    Attributes
    ----------
    name : {"M4'", "Lambda3", "Lambda6,4"}
        See `moving.remeshing`.
    spacing : float
        Lattice spacing h.
    above : float
        Remesh after a step that leaves two neighbours farther apart than `above` h.
    ends : tuple of two floats or None
        The first and last lattice point kept; None: the lattice goes on as far as the particles need.
    continued : callable or None
        continued(x, strength) returns these particles and those of the far field beyond them. All are redistributed.
    noticed : callable or None
        noticed(before, after) is called with the positions and the strengths before and after each remeshing.
    """

    name: str
    spacing: float
    above: float = REMESH_ABOVE
    ends: tuple[float, float] | None = None
    continued: Continued | None = None
    noticed: Noticed | None = None

    def __post_init__(self) -> None:
        check.choice("remeshing", self.name, REMESHINGS)
        check.fields(self, spacing=check.scale, above=_above_one)
        if self.ends is not None:
            check.fields(self, ends=partial(check.pair, rising=True))
        if self.continued is not None:
            check.function("continued", self.continued)
        if self.noticed is not None:
            check.function("noticed", self.noticed)


def _above_one(_: str, value: Any) -> float:
    return check.real_between("remesh_above", value, 1.0, inside=True, remedy="Give 1.5.")


def strengths_of(u: np.ndarray, volume: float) -> np.ndarray:
    """Return the strengths U_i = V u_i of a field at particles of this volume, zeros included.

    Raises `InvalidInput` if they overflow, or are so small that they lose their digits.
    """
    with np.errstate(over="ignore"):
        strength: np.ndarray = check.finite_result("u", volume * u)
    if u.any() and not np.abs(strength).max() >= _SMALLEST:
        shown = f"a field of at most {np.abs(u).max():.3g}, of strengths of at most {np.abs(strength).max():.3g}"
        raise InvalidInput("u", shown, f"strengths of {_SMALLEST:g} and more", "Change the units.")
    return strength


def quotient_velocity(flux: Any, u: Any, x: Any, accuracy: float = 0.0) -> np.ndarray:
    """Return v = Q / u at the particles, Eq. (44).

    Parameters
    ----------
    flux, u, x : array, shape (N,)
        Q and u at the particles, and where they are.
    accuracy : float
        The error of u relative to its largest modulus.

    Raises
    ------
    InvalidInput
        If the arrays do not fit together.
    FieldNotPositive
        Unless u has one sign and is larger than its error at all particles; names the worst place.
    NonFiniteSolution
        If the velocity is not finite.
    """
    u = u if isinstance(u, np.ndarray) else check.vector("u", u)
    u = check.operand("u", u, (max(u.size, 1),))
    flux, x = check.operand("flux", flux, u.shape), check.operand("x", x, u.shape)
    low, high = float(u.min()), float(u.max())
    enough = accuracy * max(high, -low)
    if not (low > enough or high < -enough):
        top = int(np.argmax(np.abs(u)))
        worst = int(np.argmin(np.copysign(1.0, u[top]) * u))
        raise FieldNotPositive(
            f"the field is {u[worst]:.3g} at the particle x = {x[worst]:.6g} and {u[top]:.3g} at its peak "
            f"x = {x[top]:.6g}: a velocity Q / u needs a field of one sign, larger than "
            f"{accuracy:.0e} of its peak. Leave out weak particles by a larger threshold, or mend the data. "
            "A Gaussian, which falls faster than the solution, takes a threshold of 1e-4."
        )
    with np.errstate(over="ignore", invalid="ignore"):
        velocity = flux / u
    if not np.isfinite(velocity).all():
        where = x[~np.isfinite(velocity)][0]
        raise NonFiniteSolution(f"the velocity Q / u is not finite at the particle x = {where:.6g}")
    return velocity


def advance(
    x: Any,
    strength: Any,
    velocity: Velocity,
    *,
    dt: float,
    steps: int,
    start: float = 0.0,
    remeshing: Remeshing | None = None,
    threshold: float = THRESHOLD,
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
    x = check.positions("x", x).copy()
    strength = check.vector("strength", strength, x.size).copy()
    dt, start = check.scale("dt", dt), check.finite_real("start", start)
    steps = check.positive_integer("steps", steps, most=check.MOST_STEPS)
    check.function("velocity", velocity)
    if remeshing is not None:
        check.instance("remeshing", remeshing, Remeshing)
    if observe is not None:
        check.function("observe", observe)
    history = History(total_initial=total_of(strength))
    x, strength = _keep(x, strength, threshold, history)
    history.particles.append(x.size)
    order = None if (x[1:] >= x[:-1]).all() else np.argsort(x, kind="stable")
    if observe is not None:
        observe(start, x, strength)
    for n in range(1, steps + 1):
        time = start + n * dt
        try:
            halfway = _moved(x, 0.5 * dt, velocity(x, strength))
            moved = _moved(x, dt, velocity(halfway, strength))
            if not np.isfinite(moved).all():
                lost = x[~np.isfinite(moved)][0]
                raise NonFiniteSolution(f"the particle from x = {lost:.6g} went to infinity")
            spacing, where, order = _largest_gap(x, moved, order, history)
            if remeshing is not None and spacing > remeshing.above * remeshing.spacing:
                history.remeshing_times.append(time)
                history.spacings_before.append(spacing)
                history.spacings_where.append(where)
                before = moved, strength
                moved, strength = _redistribute(*before, remeshing, history)
                if remeshing.noticed is not None:
                    remeshing.noticed(before, (moved, strength))
                moved, strength = _keep(moved, strength, threshold, history)
                history.particles.append(moved.size)
                order = None
        except FracparticlesError as error:
            if isinstance(error, InvalidInput) and error.field == "velocity":
                raise  # it is not made for particles
            raise stopped(error, n, steps, time, dt) from error
        x = moved
        if observe is not None:
            observe(time, x, strength)
    history.velocity_evaluations = 2 * steps
    history.total_final = total_of(strength)
    return x, strength, history


def stopped(
    error: FracparticlesError, n: int, steps: int, time: float, dt: float
) -> NonFiniteSolution:
    """Return the error of a run that cannot go on after step n, which would have ended at `time`."""
    kind = FieldNotPositive if isinstance(error, FieldNotPositive) else NonFiniteSolution
    when = f"step {n} of {steps}, from t = {time - dt:.6g} to {time:.6g}"
    return kind(f"{when}: {error}")


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
    added = 0.0
    if remeshing.continued is not None:
        own = total_of(strength)
        x, strength = remeshing.continued(x, strength)
        added = total_of(strength) - own
    x, strength = remesh(x, strength, remeshing.spacing, remeshing.name)
    history.lost_strength -= added
    if remeshing.ends is None:
        return x, strength
    slack = 0.25 * remeshing.spacing  # the ends are lattice points, up to round-off
    inside = (x > remeshing.ends[0] - slack) & (x < remeshing.ends[1] + slack)
    history.lost_strength += total_of(strength[~inside])
    return x[inside], strength[inside]


def _moved(x: np.ndarray, time: float, velocity: Any) -> np.ndarray:
    v = check.operand("velocity", velocity, x.shape)
    with np.errstate(over="ignore", invalid="ignore"):
        return x + time * v


def _largest_gap(
    x: np.ndarray, moved: np.ndarray, order: np.ndarray | None, history: History
) -> tuple[float, float, np.ndarray | None]:
    """Return the largest distance between neighbours, the middle of that gap, and the order after the step.

    `order` sorts x, the positions before; it is None where they are in order as they are.
    """
    if moved.size < 2:
        return 0.0, float(moved[0]), None
    now = moved if order is None else moved[order]
    gap = np.diff(now)
    if gap.min() < 0.0:
        # Particles that were in one place had no order.
        now = moved[np.lexsort((moved, x))]
        history.overtaking_steps += int(np.diff(now).min() < 0.0)
        order = np.argsort(moved, kind="stable")
        now = moved[order]
        gap = np.diff(now)
    widest = int(np.argmax(gap))
    largest = float(gap[widest])
    history.largest_spacing = max(history.largest_spacing, largest)
    return largest, float(0.5 * (now[widest] + now[widest + 1])), order
