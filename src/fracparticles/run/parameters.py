"""The parameters of a run, each with its meaning. `derived` has the quantities that follow from them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field

from fracparticles.arguments import SIZES
from fracparticles.errors import spelled
from fracparticles.moving.dvm import largest_gap
from fracparticles.moving.lagrangian import REMESHING, THRESHOLD
from fracparticles.run.checked import Checked
from fracparticles.schemes import ALL_SCHEMES, Scheme

__all__ = ["FUNDAMENTAL", "OVERLAPS", "Parameters", "fastest_evaluation"]

FUNDAMENTAL = "fundamental"  # initial data: the fundamental solution
OVERLAPS = 0.25, 1000.0  # the least and the greatest epsilon / h

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
    """Return the meaning of evaluation="auto": "convolution" where it is allowed, and None elsewhere."""
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
    """The fields of a `Case`; see there. They are not checked here against each other.

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
        default=1.0,
        ge=SIZES[0],
        le=SIZES[1],
        description="Diffusivity D of Eq. (2). A constant.",
        json_schema_extra={"remedy": "Give a positive number; one that varies is for fp.Problem."},
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
        f"{THRESHOLD:g} if left out; a Gaussian, which falls faster than the solution, takes 1e-4.",
    )
    store: Literal["field", "profile", "metrics"] = Field(
        default="field",
        description="What a data set keeps. field: u everywhere. profile: u for |x| <= 5 R_alpha, in the plane and in "
        "space along an axis and a diagonal. metrics: scalars only.",
    )
