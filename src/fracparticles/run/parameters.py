"""The parameters of a run, each with what it means, and what follows from them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from pydantic import Field

from fracparticles.errors import spelled
from fracparticles.graded.particles import graded_particles
from fracparticles.moving.dvm import largest_gap
from fracparticles.moving.lagrangian import REMESHING, THRESHOLD
from fracparticles.run.checked import Checked
from fracparticles.run.times import legs, steps_in
from fracparticles.schemes import ALL_SCHEMES, Scheme, Setting
from fracparticles.schemes.stability import stability_limit, symbol_range
from fracparticles.special.stable import mean_radius
from fracparticles.time import STEP_POLYNOMIALS

__all__ = ["FUNDAMENTAL", "OVERLAPS", "SIZES", "Parameters"]

FUNDAMENTAL = "fundamental"
SIZES = 1e-100, 1e100  # lengths and times; nothing made of them overflows
OVERLAPS = 0.25, 1000.0

if TYPE_CHECKING:
    SchemeName = str
else:
    SchemeName = Literal[tuple(ALL_SCHEMES)]


def _schemes(which: Callable[[Scheme], object]) -> str:
    return spelled((name for name, scheme in ALL_SCHEMES.items() if which(scheme)), " and ")


_REJECTED = _schemes(lambda scheme: scheme.rejected)
_WITH_FAMILIES = _schemes(lambda scheme: scheme.families)
_IN_A_BOX = _schemes(lambda scheme: scheme.box_orders)
_OPEN = _schemes(lambda scheme: "open" in scheme.exteriors)
_ONE_SUM = _schemes(lambda scheme: "open" in scheme.exteriors and not scheme.moving)


def fastest_evaluation(fields: Mapping[str, Any]) -> str | None:
    """Return what evaluation="auto" stands for: "convolution" where it is allowed, nothing elsewhere."""
    named = {name: value for name, value in fields.items() if isinstance(value, str)}
    scheme = ALL_SCHEMES.get(named.get("scheme", ""))
    allowed = (
        scheme is not None
        and not scheme.moving
        and named.get("exterior") == "open"
        and fields.get("kernel_table") is None
        and fields.get("graded_scale") is None
        and named.get("summation", "fft") == "fft"
        and (scheme.self_timed or named.get("integrator") == "exponential")
    )
    return "convolution" if allowed else None


class Parameters(Checked):
    """What a `Case` holds; see there. Not checked here against each other.

    The `description` of a field is written once. (pydantic would take docstrings, too, but reads the source for them in
    each process, 40 ms.) Its first sentence names the field: it is the label in a data set. All of it is the help of
    the flag, and stands in the table of the configuration.
    """

    scheme: SchemeName = Field(description=f"Particle scheme. The paper rejects {_REJECTED}.")
    order: Literal[2, 4, 6, 8, 10, 12] = Field(
        default=2, description="Order of the kernels. 2 or 4; up to 12 for some schemes."
    )
    kernel_family: Literal["printed", "gamma"] | None = Field(
        default=None,
        description=f"Family of the kernels. For {_WITH_FAMILIES}. printed is the paper's, of orders 2 and 4; gamma "
        "has all orders. If left out, printed for orders 2 and 4, gamma beyond.",
    )
    beta: float = Field(
        gt=0.0,
        lt=1.0,
        description="Fractional order beta = alpha - 1. Between 0 and 1 (exclusive). alpha may be given instead.",
        json_schema_extra={"remedy": "Give beta = alpha - 1, or alpha itself."},
    )
    dim: Literal[1, 2, 3] = Field(
        default=1,
        description=f"Space dimension. For {_IN_A_BOX} also 2 and 3: the lattice is a square or a cube.",
    )
    truncation: float | None = Field(
        default=None,
        ge=SIZES[0],
        le=SIZES[1],
        description="Truncation factor C = D / ((diffusivity t_final)^(1/alpha) R_alpha), Eq. (46). "
        "Give either this or half_width.",
    )
    half_width: float | None = Field(
        default=None,
        ge=SIZES[0],
        le=SIZES[1],
        description="Half-width D of the lattice in each coordinate. Graded particles end there too.",
    )
    spacing: float = Field(
        ge=SIZES[0],
        le=SIZES[1],
        description="Particle spacing h. The nearest value that divides D is used. Graded particles have "
        "this spacing in the middle.",
    )
    overlap: float | None = Field(
        default=None,
        ge=OVERLAPS[0],
        le=OVERLAPS[1],
        description="Overlap epsilon / h. 2 if left out; for GPSE it follows from dt if that is "
        "given.",
    )
    dt: float | None = Field(
        default=None,
        ge=SIZES[0],
        le=SIZES[1],
        description="Time step. The explicit integrators need it; GPSE takes epsilon^alpha / "
        "diffusivity if left out.",
    )
    diffusivity: float = Field(
        default=1.0, ge=SIZES[0], le=SIZES[1], description="Diffusivity D of Eq. (2). A constant."
    )
    t_initial: float = Field(default=0.5, ge=0.0, le=SIZES[1], description="Initial time.")
    t_final: float = Field(default=1.5, ge=SIZES[0], le=SIZES[1], description="Final time.")
    times: tuple[float, ...] | None = Field(
        default=None,
        description="Output times. Several in one run, in ascending order. The last is the final time, so "
        "t_final may be left out. A step ends at each of them.",
    )
    initial: str = Field(
        default=FUNDAMENTAL,
        description='Initial data. "fundamental" is the fundamental solution at t_initial. A path names a NetCDF file '
        "with u on the same particles, or a table with x and u in columns (csv, tsv, txt, dat), which is interpolated. "
        "measured:PATH names a NetCDF file with other points, which is interpolated too.",
    )
    integrator: Literal["euler", "rk2", "rk4", "exponential"] | None = Field(
        default=None,
        description="Time integrator. rk2 if left out; GPSE is an Euler step by construction.",
    )
    evaluation: Literal["auto", "series", "stepping", "convolution"] | None = Field(
        default=None,
        description="Evaluation of the time integrator. series, the default, is one Chebyshev series. stepping "
        "goes step by step, as DVM and a single step always do. Both give the same discrete solution to round-off. "
        f"convolution is one pair of transforms with the symbol, for {_ONE_SUM} with an open exterior, exponential "
        "in time except GPSE. auto is convolution where it is allowed, and series elsewhere.",
    )
    summation: Literal["fft", "naive"] = Field(
        default="fft",
        description="Sum over particles. For DVM the fast Fourier transform is non-uniform.",
    )
    exterior: Literal["truncated", "open"] = Field(
        default="truncated",
        description="What lies beyond the lattice. truncated: nothing, as in the papers. "
        f"open: the far field, for {_OPEN}.",
    )
    far_terms: Literal[1, 2, 3] | None = Field(
        default=None,
        description="Terms that continue the solution beyond the lattice. For an open exterior on "
        "the line, or by convolution; 1 if left out.",
    )
    kernel_table: float | None = Field(
        default=None,
        ge=1e-6,
        le=1.0,
        description="Step of the kernel table, in units of epsilon. Kernels are interpolated in it "
        "(paper, Sec. 5); exact if left out.",
    )
    graded_scale: float | None = Field(
        default=None,
        ge=SIZES[0],
        le=SIZES[1],
        description="Length L of particles graded like sinh. They lie at x_j = L sinh(s_j), s_j "
        "equally spaced, instead of on a lattice; for one step of GPSE on the line.",
    )
    graded_form: Literal["exchange", "quadrature", "interpolated"] | None = Field(
        default=None,
        description="Form of the step on graded particles. exchange is Eq. (41), quadrature its plain sum. "
        "interpolated, the default, is the step of the field between the particles, which need not resolve the "
        "Green's function.",
    )
    remeshing: Literal["M4'", "Lambda3", "Lambda6,4", "none"] | None = Field(
        default=None, description=f"Remeshing kernel of DVM. {REMESHING} if left out."
    )
    remesh_above: float | None = Field(
        default=None,
        gt=1.0,
        le=100.0,
        description="Spacing between two neighbours above which DVM remeshes, in units of h. "
        f"{largest_gap('truncated'):g} if left out, {largest_gap('open'):g} with an open exterior.",
    )
    threshold: float | None = Field(
        default=None,
        ge=0.0,
        lt=1.0,
        description="Share of the greatest strength up to which DVM leaves a particle out when it remeshes. "
        f"{THRESHOLD:g} if left out.",
    )
    store: Literal["field", "profile", "metrics"] = Field(
        default="field",
        description="What a data set keeps. field: u everywhere. profile: u for |x| <= 5 R_alpha, in the plane and in "
        "space along an axis and a diagonal. metrics: scalars only.",
    )

    # --- what follows from the parameters -------------------------------------------------------------------

    @property
    def alpha(self) -> float:
        """Fractional order alpha = 1 + beta."""
        return 1.0 + self.beta

    @property
    def span(self) -> float:
        """The time of the run, t_final - t_initial."""
        return self.t_final - self.t_initial

    @property
    def reach(self) -> float:
        """The half-width D, given or from C by Eq. (46): the outermost particles are at -D and D in each coordinate."""
        if self.half_width is not None:
            return self.half_width
        assert self.truncation is not None
        spread = (self.diffusivity * self.t_final) ** (1.0 / self.alpha)
        return self.truncation * spread * mean_radius(self.alpha)

    @property
    def is_graded(self) -> bool:
        """Whether the particles are graded like sinh, see `graded`, and not on a lattice."""
        return self.graded_scale is not None

    @property
    def extent(self) -> float:
        """What the spacing divides: the half-width D, or L arcsinh(D / L), the end of graded particles in L s."""
        if self.graded_scale is None:
            return self.reach
        return float(self.graded_scale * np.arcsinh(self.reach / self.graded_scale))

    @property
    def n(self) -> int:
        """Half the number of intervals: x_i = i h, or x_i = L sinh(i h / L), i = -n .. n in each coordinate."""
        return max(1, round(self.extent / self.spacing))

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the lattice, 2 n + 1 particles in each coordinate."""
        return (2 * self.n + 1,) * self.dim

    @property
    def particles(self) -> int:
        """The number of particles."""
        return int((2 * self.n + 1) ** self.dim)

    @property
    def particle_spacing(self) -> float:
        """The realised spacing h = D / n, of graded particles that in the middle."""
        return self.extent / self.n

    @property
    def x(self) -> np.ndarray:
        """The particle positions along one axis, shape (2 n + 1,)."""
        if self.graded_scale is not None:
            return graded_particles(self.particles, self.reach, self.graded_scale)[0]
        return np.arange(-self.n, self.n + 1) * self.particle_spacing

    @property
    def volumes(self) -> np.ndarray | float:
        """The particle volumes V_i: h^n for all on a lattice, of graded particles one for each."""
        if self.graded_scale is not None:
            return graded_particles(self.particles, self.reach, self.graded_scale)[1]
        return float(self.particle_spacing**self.dim)

    def integral(self, values: np.ndarray) -> float:
        """Return sum_i V_i f_i from the values at the particles; numpy sums pairwise: to a few ulp."""
        volumes = self.volumes
        with np.errstate(over="ignore"):  # it is infinite then
            if isinstance(volumes, float):
                return float(volumes * values.sum())
            return float((volumes * values).sum())

    @property
    def positions(self) -> list[np.ndarray]:
        """The coordinates of the particles, `dim` arrays that broadcast to `shape`."""
        return list(np.meshgrid(*(self.x,) * self.dim, indexing="ij", sparse=True))

    @property
    def radius(self) -> np.ndarray:
        """The distances |x| of the particles from the origin, of that shape."""
        if self.dim == 1:
            return np.abs(self.x)  # does not underflow
        return np.sqrt(sum(np.square(part) for part in self.positions))

    @property
    def error_radius(self) -> float:
        """The errors are taken over |x| <= 5 R_alpha (47) for dim = 1, over |x| <= 5 (59) otherwise, or the lattice.

        That is for the papers' D t_f = 1.5; for another it grows with the solution, like (D t_f)^(1/alpha), so that
        the error does not depend on the units.
        """
        half = 5.0 * mean_radius(self.alpha) if self.dim == 1 else 5.0
        spread = (self.diffusivity * self.t_final / 1.5) ** (1.0 / self.alpha)
        return min(half * spread, self.reach)

    @property
    def kind(self) -> Scheme:
        """The scheme itself: what it is, and what it takes."""
        return ALL_SCHEMES[self.scheme]

    @property
    def resolved_integrator(self) -> str:
        """The integrator, the default resolved."""
        if self.integrator is not None:
            return self.integrator
        return "euler" if self.kind.self_timed else "rk2"

    @cached_property
    def steps(self) -> int:
        """The number of time steps; 0 for the exponential."""
        if self.resolved_integrator == "exponential":
            return 0
        if self.times is None or self.kind.self_timed:
            return steps_in(self.span, self.resolved_dt)
        return sum(steps for _, steps in self.legs)

    @property
    def time_step(self) -> float:
        """The realised step, (t_final - t_initial) / steps or the longest between `times`; 0 for the exponential."""
        if self.times is None or self.kind.self_timed or not self.steps:
            return self.span / self.steps if self.steps else 0.0
        return max(dt for dt, _ in self.legs)

    @property
    def legs(self) -> list[tuple[float, int]]:
        """The step from each output time to the next, and how many of them."""
        return legs(self)

    @property
    def resolved_dt(self) -> float:
        """The step asked for: dt, or for GPSE the one of its overlap, Eq. (40), on graded particles all of the time."""
        if self.dt is not None:
            return self.dt
        if self.is_graded:
            return self.span
        return ((self.overlap or 2.0) * self.particle_spacing) ** self.alpha / self.diffusivity

    @property
    def resolved_overlap(self) -> float:
        """The realised overlap s = epsilon / h; for GPSE from the realised step, Eq. (40)."""
        if self.kind.self_timed:
            epsilon = (self.diffusivity * self.time_step) ** (1.0 / self.alpha)
            return epsilon / self.particle_spacing
        return 2.0 if self.overlap is None else self.overlap

    @property
    def redistribution(self) -> dict[str, Any]:
        """What DVM does with particles that are too far apart or too weak, the defaults resolved."""
        return {
            "remeshing": self.remeshing or REMESHING,
            "remesh_above": self.remesh_above or largest_gap(self.exterior),
            "threshold": self.threshold or THRESHOLD,
        }

    @property
    def setting(self) -> Setting:
        """The scheme on its lattice."""
        return Setting(
            n=self.n,
            spacing=self.particle_spacing,
            alpha=self.alpha,
            order=self.order,
            overlap=self.resolved_overlap,
            diffusivity=self.diffusivity,
            summation=self.summation,
            exterior=self.exterior,
            dim=self.dim,
            kernel_table=self.kernel_table,
            family=self.kernel_family,
            far_terms=self.far_terms or 1,
        )

    @property
    def is_one_step(self) -> bool:
        """Whether the whole run is a single Euler step: one application of the operator."""
        return self.resolved_integrator == "euler" and self.steps == 1

    @property
    def steps_taken(self) -> bool:
        """Whether the steps are taken one by one; a single Euler step has nothing to gain from a series."""
        if self.evaluation is None and self.is_one_step:
            return True
        return self.evaluation == "stepping" or self.kind.moving

    @property
    def _series_by_default(self) -> bool:
        """Whether `evaluation` says "series" where it would be one anyway: but for a single Euler step."""
        return self.evaluation == "series" and not self.is_one_step

    @cached_property
    def largest_stable_step(self) -> float:
        """The largest dt inside the stability interval; infinite for the exponential and on graded particles."""
        if self.resolved_integrator == "exponential" or self.is_graded:
            return float("inf")
        limit = stability_limit(*self._of_the_symbol)
        longer = STEP_POLYNOMIALS[self.resolved_integrator].stability_interval / 2.0
        return float(longer * limit * self.particle_spacing**self.alpha / self.diffusivity)

    @property
    def symbol_range(self) -> tuple[float, float]:
        """The least and the greatest value of A(theta) h^alpha / D."""
        return symbol_range(*self._of_the_symbol)

    @property
    def _of_the_symbol(self) -> tuple[str, float, int, float, int, str | None]:
        scheme = self.kind.symbol_of or self.scheme
        overlap = self.resolved_overlap
        return scheme, self.beta, self.order, overlap, self.dim, self.kernel_family
