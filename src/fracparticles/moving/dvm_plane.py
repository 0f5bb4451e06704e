r"""The diffusion velocity method in the plane: Eqs. (42)-(45) with vectors,

    dx_i/dt = v_i = Q(x_i) / u(x_i),     U_i = V_i u_i constant,
    u(x) = sum_j U_j eta_eps(x - x_j),     Q(x) = -(D / eps^beta) sum_j U_j F_eps(x - x_j),

in steps of the midpoint rule, with the sums of `plane_sums`. For the fundamental solution v is exactly x / (alpha t).

The particles spread. When two that were next to one another on the last lattice are farther apart than `remesh_above`
spacings, all are redistributed onto the lattice (p h, q h) by the product of the interpolation functions of
`remeshing`: the total, and the moments that these keep in one dimension, are kept in each. What falls beyond the
lattice, which is the initial square, is left out and counted, as on the line; an extended one goes on as far as the
particles need, and keeps the total to round-off.

The field must have one sign at all particles: `FieldNotPositive`, with the step, the time and the place.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.errors import AccuracyWarning, InvalidInput, NonFiniteSolution, StabilityWarning
from fracparticles.moving.dvm import LATTICES, DiffusionVelocity
from fracparticles.moving.lagrangian import REMESH_ABOVE, REMESHING, FieldNotPositive
from fracparticles.moving.plane_sums import ACCURACY, PlaneSums
from fracparticles.moving.remeshing import REMESHINGS, interpolation_function

__all__ = ["PlaneRun", "PlaneVelocity", "remesh_plane", "run_plane"]

_MOST = 2**21  # particles
_REACH = 4  # lattice points that share a particle, in each coordinate
_GONE = 0.05  # of the total strength: what may be left out without a word


class PlaneVelocity:
    """v(x_i) for particles in the plane.

    Parameters
    ----------
    alpha : float
        Fractional order, alpha = 1 + beta.
    order : {2, 4}
        Order of the kernels.
    epsilon, diffusivity : float
        Smoothing length, and D.
    """

    def __init__(self, alpha: float, order: int, epsilon: float, diffusivity: float = 1.0) -> None:
        line = DiffusionVelocity(alpha, order, epsilon, diffusivity)  # the checks, and the symbol
        self.alpha, self.epsilon, self.diffusivity = line.alpha, line.epsilon, line.diffusivity
        self.largest_stable_step = line.largest_stable_step
        self._sums = PlaneSums(self.alpha, order, self.epsilon)

    def field_and_flux(
        self, x: FloatArray, strength: FloatArray, z: FloatArray | None = None
    ) -> tuple[FloatArray, FloatArray]:
        """Return u, shape (M,), and Q, shape (M, 2), at the points z, or at the particles."""
        u, s = self._sums(x, strength, z)
        return u, -(self.diffusivity / self.epsilon ** (self.alpha - 1.0)) * s

    def __call__(self, x: FloatArray, strength: FloatArray) -> FloatArray:
        """Return v, shape (N, 2).

        Raises
        ------
        FieldNotPositive
            If u vanishes or changes sign at a particle.
        """
        u, flux = self.field_and_flux(x, strength)
        low, high = float(u.min()), float(u.max())
        if not (low > ACCURACY * high or high < ACCURACY * low):
            top = int(np.argmax(np.abs(u)))
            worst = int(np.argmin(u * np.sign(u[top])))
            place = ", ".join(f"{one:.6g}" for one in x[worst])
            raise FieldNotPositive(
                f"the field is {u[worst]:.3g} at the particle ({place}) and {u[top]:.3g} at its peak: a velocity Q / u "
                "needs a field of one sign. Take a smaller dt, a larger overlap, or data without a jump."
            )
        return flux / u[:, None]


@dataclass(frozen=True)
class PlaneRun:
    """The particles at the end of a run.

    Attributes
    ----------
    x, strength : array, shape (N, 2) and (N,)
    remeshing_times : list of float
    total_initial, total_final, lost : float
        Total strength given, at the end, and of what remeshing put beyond the initial lattice.
    velocity : PlaneVelocity
    """

    x: FloatArray
    strength: FloatArray
    remeshing_times: list[float]
    total_initial: float
    total_final: float
    lost: float
    velocity: PlaneVelocity

    def field(self, z: Any) -> FloatArray:
        """Return u(z) at the points z, shape (M, 2)."""
        return self.velocity.field_and_flux(self.x, self.strength, _points("z", z))[0]


def remesh_plane(
    x: FloatArray, strength: FloatArray, spacing: float, name: str
) -> tuple[FloatArray, FloatArray]:
    """Return the first lattice point (p, q), and strengths on the lattice from there on, shape (P, Q).

    Raises `InvalidInput` if the lattice would have too many points.
    """
    cell = x / spacing
    nearest = np.rint(cell)  # particles on the lattice keep their strengths
    cell = np.where(np.abs(cell - nearest) <= 4.0 * np.spacing(np.abs(cell)), nearest, cell)
    left = np.floor(cell)
    first = left.min(axis=0) - 1.0
    shape = (left.max(axis=0) - first + 3.0).astype(np.int64)
    if not shape.astype(float).prod() <= _MOST:
        allowed = f"a lattice of at most {_MOST} particles"
        shown = f"particles over {shape[0]} x {shape[1]} spacings"
        raise InvalidInput("x", shown, allowed, "Look for a particle that ran away.")
    along = np.arange(_REACH) - 1.0
    weights = interpolation_function(name, (cell - left)[..., None] - along)
    base = (left - first).astype(np.int64)
    total = np.zeros(shape.prod())
    for a in range(_REACH):
        for b in range(_REACH):
            at = (base[:, 0] + a - 1) * shape[1] + base[:, 1] + b - 1
            share = strength * weights[:, 0, a] * weights[:, 1, b]
            total += np.bincount(at, share, total.size)
    return first, total.reshape(tuple(shape))


def run_plane(
    x: FloatArray,
    u: FloatArray | Callable[..., Any],
    *,
    alpha: float,
    dt: float,
    steps: int,
    order: int = 2,
    overlap: float = 2.0,
    diffusivity: float = 1.0,
    remeshing: str = REMESHING,
    remesh_above: float = REMESH_ABOVE,
    lattice: str = "initial",
) -> PlaneRun:
    """Advance a field by midpoint steps.

    Parameters
    ----------
    x : array, shape (P,)
        Coordinates p h of the lattice, the same along both axes, equally spaced and 0 among them.
    u : array, shape (P, P), or callable
        The field there, or a function of (x, y); of one sign.
    alpha, dt, steps, order, diffusivity
        As on the line, see `dvm`.
    overlap : float
        epsilon / h.
    remeshing : {"M4'", "Lambda3", "none"}
    remesh_above : float
        In spacings, see above.
    lattice : {"initial", "extended"}
        Whether remeshing keeps to the initial square, or goes on as far as the particles need.

    Raises
    ------
    InvalidInput
        If the arguments cannot be worked with.
    NonFiniteSolution
        If the run cannot go on; `FieldNotPositive` if that is for the field.

    Warns
    -----
    StabilityWarning
        If dt is larger than `PlaneVelocity.largest_stable_step`.
    AccuracyWarning
        If remeshing left out more than 5 % of the total.
    """
    line = check.positions("x", x, least=3, rising=True)
    h = float(line[-1] - line[0]) / (line.size - 1)
    if not np.allclose(line / h, np.rint(line / h), rtol=0.0, atol=1e-9):
        allowed = "equally spaced coordinates p h with whole numbers p"
        raise InvalidInput("x", line, allowed, "Take h * numpy.arange(-n, n + 1).")
    if line.size**2 > _MOST:
        allowed = f"at most {int(_MOST**0.5)} coordinates"
        raise InvalidInput("x", f"{line.size} coordinates", allowed, "Take a larger spacing.")
    grid = np.meshgrid(line, line, indexing="ij")
    given = (
        check.sampled("u", u, *grid) if callable(u) else check.finite_array("u", u, grid[0].shape)
    )
    check.choice("remeshing", remeshing, (*REMESHINGS, "none"))
    above = check.real_between("remesh_above", remesh_above, 1.0, inside=True, remedy="Give 1.5.")
    check.choice("lattice", lattice, LATTICES)
    dt, steps = check.scale("dt", dt), check.positive_integer("steps", steps)
    velocity = PlaneVelocity(alpha, order, check.positive_real("overlap", overlap) * h, diffusivity)
    if dt > velocity.largest_stable_step:
        warnings.warn(
            f"dt = {dt:.6g} lies outside the stability interval of DVM: at most {velocity.largest_stable_step:.6g} is "
            "stable. The run is computed as it is. Take a smaller dt.",
            StabilityWarning,
            stacklevel=2,
        )
    ends = np.rint(line[[0, -1]] / h)
    strength, shape = (h * h * given).reshape(-1), grid[0].shape
    place = np.stack([one.reshape(-1) for one in grid], axis=1)
    start, lost, times = float(strength.sum()), 0.0, []
    for n in range(1, steps + 1):
        try:
            halfway = place + 0.5 * dt * velocity(place, strength)
            place = place + dt * velocity(halfway, strength)
            if not np.isfinite(place).all():
                raise NonFiniteSolution("a particle went to infinity")
            if remeshing != "none" and _widest(place.reshape(*shape, 2)) > above * h:
                times.append(n * dt)
                first, total = remesh_plane(place, strength, h, remeshing)
                if lattice == "initial":
                    first, total, beyond = _within(first, total, ends)
                    lost += beyond
                strength, shape = total.reshape(-1), total.shape
                place = _lattice(first, shape, h)
        except NonFiniteSolution as error:
            when = f"step {n} of {steps}, from t = {(n - 1) * dt:.6g} to {n * dt:.6g}"
            raise type(error)(f"{when}: {error}") from error
    if abs(lost) > _GONE * abs(start):
        warnings.warn(
            f"remeshing onto the initial lattice has left out {abs(lost / start):.2g} of the total strength. Take a "
            "wider lattice, or lattice='extended'.",
            AccuracyWarning,
            stacklevel=2,
        )
    return PlaneRun(place, strength, times, start, float(strength.sum()), lost, velocity)


def _widest(place: FloatArray) -> float:
    """The largest distance between particles that were next to one another on the lattice."""
    gaps = (np.diff(place, axis=axis) for axis in range(2))
    return max(float(np.hypot(gap[..., 0], gap[..., 1]).max()) for gap in gaps)


def _within(
    first: FloatArray, total: FloatArray, ends: FloatArray
) -> tuple[FloatArray, FloatArray, float]:
    """What lies on the initial square, and the total of what does not."""
    low = np.maximum(first, ends[0])
    high = np.minimum(first + total.shape - 1.0, ends[1])
    i, j = (slice(int(a), int(b) + 1) for a, b in zip(low - first, high - first, strict=True))
    kept = np.ascontiguousarray(total[i, j])
    return low, kept, float(total.sum() - kept.sum())


def _lattice(first: FloatArray, shape: tuple[int, ...], h: float) -> FloatArray:
    axes = (h * (start + np.arange(count)) for start, count in zip(first, shape, strict=True))
    return np.stack([one.reshape(-1) for one in np.meshgrid(*axes, indexing="ij")], axis=1)


def _points(field: str, z: Any) -> FloatArray:
    z = check.places(field, z)
    if z.ndim != 2 or z.shape[1] != 2:
        raise InvalidInput(field, f"array of shape {z.shape}", "shape (M, 2)", "Give pairs (x, y).")
    return z
