r"""The diffusion velocity method in the plane, Eqs. (42)-(45) with two components:

    dx_i/dt = v_i = Q(x_i) / u(x_i),     U_i constant,
    u(x) = sum_j U_j eta_eps(x - x_j),     Q(x) = -(D / eps^beta) sum_j U_j F_eps(x - x_j).

For the fundamental solution the velocity is exactly x / (alpha t). The midpoint rule, the limit of its step and the
sums by non-uniform transforms (`plane_sums`) are those of the line (`dvm`). The particles start on a rectangle of the
lattice x = p h, y = q h. When two neighbours of this lattice are farther apart than `remesh_above` h, all particles are
redistributed, by the interpolation function of the line in each coordinate. Remeshing keeps the total strength. What
it puts beyond the ends of the lattice is left out and counted.

Beyond the particles is nothing, as in the paper, or the far field (`plane_tail`).
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from math import ceil

import numpy as np

from fracparticles import arguments as check
from fracparticles.errors import AccuracyWarning, FracparticlesError, NonFiniteSolution
from fracparticles.moving.diffusion_velocity import EXTERIORS, DiffusionVelocity
from fracparticles.moving.dvm import GONE, largest_gap
from fracparticles.moving.lagrangian import REMESHING, quotient_velocity, stopped, strengths_of
from fracparticles.moving.plane_remeshing import Particles, on_square, remesh_plane
from fracparticles.moving.plane_sums import PlaneSums
from fracparticles.moving.plane_tail import REACH, PlaneTail
from fracparticles.moving.reliability import (
    END,
    Changes,
    ripple,
    warn_of_misfit,
    warn_of_remeshing,
    warn_of_ripple,
    warn_of_smoothing,
    warn_of_step,
)
from fracparticles.moving.remeshing import REMESHINGS

__all__ = ["PlaneRun", "PlaneVelocity", "run_in_plane"]

_MISFIT = 0.05  # of the total strength: what the far field may hold wrongly
_REMESHED = (
    0.07  # of the peak: what remeshings may change. The error of a run is about two thirds of it.
)


class PlaneVelocity:
    """v of Eq. (44), both components.

    Parameters
    ----------
    alpha : float
    order : {2, 4}
        Of the kernels.
    epsilon, diffusivity : float
    exterior : {"truncated", "open"}
    """

    def __init__(
        self,
        alpha: float,
        order: int,
        epsilon: float,
        diffusivity: float = 1.0,
        exterior: str = "truncated",
    ) -> None:
        self._line = DiffusionVelocity(alpha, order, epsilon, diffusivity)  # checks them, too
        self._sums = PlaneSums(alpha, order, epsilon)
        self._tail: PlaneTail | None = None
        if check.choice("exterior", exterior, EXTERIORS) == "open":
            self._tail = PlaneTail(alpha, order, epsilon)
        self._epsilon = epsilon
        self._factor = -diffusivity / epsilon ** (alpha - 1.0)

    @property
    def largest_stable_step(self) -> float:
        """That of the line: the transform of eta is the same function of |k|."""
        return self._line.largest_stable_step

    def ripple(self, x: np.ndarray, strength: np.ndarray) -> float:
        """Return the ripple of the field, see `reliability`, of particles at x, shape (N,), along either axis.

        The strengths of all particles have the shape (N, N).
        """
        share = np.abs(strength).sum(axis=1)
        return 2.0 * ripple(x, share, self._epsilon, self._line.transform) if share.any() else 0.0

    @property
    def reach(self) -> float:
        """How far beyond the particles the field is known."""
        return 0.0 if self._tail is None else 0.5 * REACH * self._epsilon

    def continued(self, x: np.ndarray, y: np.ndarray, strength: np.ndarray) -> Particles:
        """Return the particles, and those of the far field around them."""
        return (x, y, strength) if self._tail is None else self._tail.continued(x, y, strength)

    def misfit(self, x: np.ndarray, y: np.ndarray, strength: np.ndarray) -> float | None:
        """Return what share of the total the far field may hold wrongly; None if there is none."""
        return None if self._tail is None else self._tail.misfit(x, y, strength)

    def field(
        self, x: np.ndarray, y: np.ndarray, strength: np.ndarray, at: tuple[np.ndarray, np.ndarray]
    ) -> np.ndarray:
        """Return u, Eq. (45), of particles, shape (N, N), at the points `at`, shape (M,)."""
        return np.asarray(self._sums(*_flat(self.continued(x, y, strength)), at)[0])

    def __call__(
        self, x: np.ndarray, y: np.ndarray, strength: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the components of v at the particles, all of shape (N, N).

        Raises
        ------
        FieldNotPositive
            If u vanishes or changes sign at a particle.
        """
        wide = self.continued(x, y, strength)
        at = x.reshape(-1), y.reshape(-1)
        u, *flux = self._sums(*_flat(wide), at)
        if self._tail is not None:
            flux = [own + far for own, far in zip(flux, self._tail.flux(wide, *at), strict=True)]
        vx, vy = (quotient_velocity(self._factor * f, u, at[0], self._sums.accuracy) for f in flux)
        return vx.reshape(x.shape), vy.reshape(x.shape)


@dataclass(frozen=True)
class PlaneRun:
    """The particles at the end of a run.

    Attributes
    ----------
    x, y, strength : array, shape (N, N)
    velocity : PlaneVelocity
    total_initial, lost : float
        The total strength at the start, and what remeshings have put beyond the ends, less what they took from there.
    remeshing_times : list of float
    """

    x: np.ndarray
    y: np.ndarray
    strength: np.ndarray
    velocity: PlaneVelocity
    total_initial: float
    lost: float = 0.0
    remeshing_times: list[float] = field(default_factory=list)

    @property
    def total_final(self) -> float:
        """The total strength at the end."""
        return float(self.strength.sum())

    def field(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Return u at the points (x, y), of their shape.

        Raises `InvalidInput` for points beyond the rectangle of the particles and, with an open exterior, the next few
        smoothing lengths, where the sums do not hold the field.
        """
        x, y = check.together(x=check.places("x", x), y=check.places("y", y))
        reach = self.velocity.reach
        for name, z, own in (("x", x, self.x), ("y", y, self.y)):
            check.within(name, z, float(own.min()) - reach, float(own.max()) + reach)
        at = x.reshape(-1), y.reshape(-1)
        return self.velocity.field(self.x, self.y, self.strength, at).reshape(x.shape)


def run_in_plane(
    u: np.ndarray,
    *,
    spacing: float,
    alpha: float,
    dt: float,
    steps: int,
    order: int = 2,
    overlap: float = 2.0,
    diffusivity: float = 1.0,
    start: float = 0.0,
    remeshing: str = REMESHING,
    remesh_above: float | None = None,
    exterior: str = "truncated",
) -> PlaneRun:
    """Advance a field by `steps` midpoint steps.

    Parameters
    ----------
    u : array, shape (2 n + 1, 2 n + 1)
        The field at the places (p h, q h), |p|, |q| <= n: the strengths are h^2 u.
    spacing : float
        h.
    alpha, dt, steps, order, overlap, diffusivity, start, remeshing, remesh_above
        As on the line, see `dvm.run_to_outputs`.
    exterior : {"truncated", "open"}
        Nothing beyond the particles, or their far field, see `plane_tail`: for data about the origin.

    Raises
    ------
    InvalidInput
        If the arguments cannot be worked with.
    NonFiniteSolution
        If the run cannot go on; as `FieldNotPositive` where the field is the cause. The message has step and time.

    Warns
    -----
    StabilityWarning
        If the step is larger than `PlaneVelocity.largest_stable_step`.
    AccuracyWarning
        If the particles do not hold the data or are too far apart, the remeshings change the field, much of the
        strength has been left out, or the far field of an open exterior is not what lies beyond.
    """
    h, overlap = check.scale("spacing", spacing), check.positive_real("overlap", overlap)
    alpha, diffusivity = check.fractional_order(alpha), check.scale("diffusivity", diffusivity)
    check.choice("remeshing", remeshing, (*REMESHINGS, "none"))
    check.choice("exterior", exterior, EXTERIORS)
    above = largest_gap(exterior) if remesh_above is None else remesh_above
    above = check.real_between("remesh_above", above, 1.0, inside=True, remedy="Give 1.5.")
    dt, steps = check.scale("dt", dt), check.positive_integer("steps", steps)
    start, u = check.finite_real("start", start), check.finite_array("u", u)
    n = max(len(np.atleast_1d(u)) // 2, 2)
    check.of_shape("u", u, (2 * n + 1, 2 * n + 1), "an odd square of numbers, from 5 by 5 on")
    strength = strengths_of(u, h * h)
    velocity = PlaneVelocity(alpha, order, overlap * h, diffusivity, exterior)
    warn_of_step(dt, velocity.largest_stable_step, stacklevel=2)
    lattice = h * np.arange(-n, n + 1.0)
    x, y = np.meshgrid(lattice, lattice, indexing="ij")
    warn_of_smoothing(velocity.field(x, y, strength, (x.ravel(), y.ravel())), u.ravel())
    coarse = velocity.ripple(lattice, strength)
    total, lost, times = float(strength.sum()), 0.0, []
    inner = slice(margin := min(ceil(END * overlap), n // 2), 2 * n + 1 - margin)
    at = x[inner, inner].ravel(), y[inner, inner].ravel()
    changes = Changes(lambda p: velocity.field(p[0], p[1], p[2], at))
    for step in range(1, steps + 1):
        time = start + step * dt
        try:
            x, y = _stepped(x, y, strength, velocity, dt)
            if remeshing != "none" and _largest_gap(x, y) > above * h:
                before = x, y, strength
                wide = velocity.continued(*before)
                strength = on_square(*remesh_plane(*wide, h, remeshing), h, n)
                x, y = np.meshgrid(lattice, lattice, indexing="ij")
                lost += float(before[2].sum()) - float(strength.sum())
                coarse = max(coarse, velocity.ripple(before[0][:, n], before[2]))
                changes.add(before, (x, y, strength))
                times.append(time)
        except FracparticlesError as error:
            raise stopped(error, step, steps, time, dt) from error
    coarse = max(coarse, velocity.ripple(x[:, n], strength))
    warn_of_ripple(coarse, overlap * h, "Take a larger overlap, or remesh sooner.", stacklevel=2)
    warn_of_remeshing(changes.largest, _REMESHED, stacklevel=2)
    _warn(velocity, x, y, strength, lost / total)
    return PlaneRun(x, y, strength, velocity, total, lost, times)


def _warn(
    velocity: PlaneVelocity, x: np.ndarray, y: np.ndarray, strength: np.ndarray, lost: float
) -> None:
    """What a run can know of itself, as on the line."""
    found = velocity.misfit(x, y, strength)
    if found is None and abs(lost) > GONE:
        warnings.warn(
            f"remeshing has left out {lost:.2g} of the total strength, which now lies beyond the ends of the lattice. "
            "Take a wider one, or exterior='open'.",
            AccuracyWarning,
            stacklevel=3,
        )
    if found is not None:
        warn_of_misfit(found, _MISFIT, stacklevel=3)


def _flat(arrays: Particles) -> Particles:
    x, y, strength = (one.reshape(-1) for one in arrays)
    return x, y, strength


def _stepped(
    x: np.ndarray, y: np.ndarray, strength: np.ndarray, velocity: PlaneVelocity, dt: float
) -> tuple[np.ndarray, np.ndarray]:
    """x* = x + dt/2 v(x), x <- x + dt v(x*)."""
    vx, vy = velocity(x, y, strength)
    vx, vy = velocity(x + 0.5 * dt * vx, y + 0.5 * dt * vy, strength)
    moved = x + dt * vx, y + dt * vy
    if not (np.isfinite(moved[0]).all() and np.isfinite(moved[1]).all()):
        raise NonFiniteSolution("a particle went to infinity")
    return moved


def _largest_gap(x: np.ndarray, y: np.ndarray) -> float:
    """The largest distance of two that are neighbours in the rectangle."""
    return max(float(np.hypot(np.diff(x, axis=a), np.diff(y, axis=a)).max()) for a in (0, 1))
