"""The fields of a problem, one by one; `problem` checks them together."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from fracparticles.arguments import SIZES
from fracparticles.run.checked import Checked
from fracparticles.run.parameters import OVERLAPS

__all__ = ["ProblemFields"]

_COEFFICIENT = "A number, an expression in x, y and t, or a function of them."


class ProblemFields(Checked):
    """The fields that define a problem."""

    beta: Any = Field(
        description="Fractional order beta = alpha - 1. Between 0 and 1 (exclusive); a number, or for a variable order "
        "an expression in x and y, or a function of them. alpha may be given instead.",
        json_schema_extra={"remedy": "Give beta = alpha - 1, or alpha itself."},
    )
    diffusivity: Any = Field(
        default=1.0, description=f"Diffusivity D. Not negative. {_COEFFICIENT}"
    )
    velocity: Any = Field(
        default=None,
        description=f"Velocity a, one for each coordinate. None if left out. {_COEFFICIENT}",
    )
    source: Any = Field(
        default=None, description="Source f. None if left out. It may depend on u: a reaction."
    )
    dim: Literal[1, 2] = Field(default=1, description="Space dimension.")
    half_width: float = Field(
        ge=SIZES[0],
        le=SIZES[1],
        description="Half-width of the lattice in each coordinate, of the interval or the square; radius of the "
        "disc.",
    )
    spacing: float | None = Field(
        default=None,
        ge=SIZES[0],
        le=SIZES[1],
        description="Particle spacing h. The nearest that divides the half-width is taken. Of the whole space.",
    )
    domain: Literal["interval", "square", "disc"] | None = Field(
        default=None,
        description="Bounded domain. The interval on the line if left out, with such an exterior; in the plane a "
        "square or a disc.",
    )
    particles: int | None = Field(
        default=None,
        ge=8,
        le=4000,
        description="Particles of a bounded domain. On the interval, along a side of the square, or rings of the disc; "
        "200, 64 and 64 if left out.",
    )
    order: Literal[2, 4, 6, 8, 10, 12] = Field(
        default=4,
        description="Order of the kernels. FPSE in the plane has 2 and 4 where the diffusivity is the same everywhere.",
    )
    overlap: float = Field(
        default=2.0,
        ge=OVERLAPS[0],
        le=OVERLAPS[1],
        description="Overlap epsilon / h. For the last digits of order 10 and 12 take 2.5 or more.",
    )
    form: Literal["FPSE", "DD", "exchange"] = Field(
        default="FPSE",
        description="Form of the diffusion. The flux and its divergence; direct differentiation; exchange. A variable "
        "order has the second alone. The exchange with a diffusivity that varies in space is that of the mean of a "
        "pair, (D L u + L(D u) - u L D) / 2 with L of D = 1: another equation.",
    )
    exterior: Literal["open", "truncated", "absorbing", "reflecting", "given"] = Field(
        default="open",
        description="What lies beyond the lattice. A tail, continued by powers; or nothing. Of a bounded domain: u = 0 "
        "outside; nothing crosses the edge; u = exterior_data outside.",
    )
    exterior_data: Any = Field(
        default=None, description=f"Values of u outside, for a given exterior. {_COEFFICIENT}"
    )
    far_terms: Literal[1, 2, 3] | None = Field(
        default=None,
        description="Terms that continue the solution in an open exterior on the line. 1 if left out.",
    )
    t_initial: float = Field(default=0.0, ge=0.0, le=SIZES[1], description="Initial time.")
    t_final: float = Field(ge=SIZES[0], le=SIZES[1], description="Final time.")
    times: tuple[float, ...] | None = Field(
        default=None, description="Output times. In ascending order; the last is the final time."
    )
    rtol: float = Field(
        default=1e-6, ge=1e-13, le=0.1, description="Relative tolerance of the time integration."
    )
    atol: float | None = Field(
        default=None, ge=1e-300, le=SIZES[1],
        description="Absolute tolerance of the time integration. rtol times the greatest |u| of the time if left out. "
        "Both are of the root mean square over the part of the lattice that the data fill.",
    )  # fmt: skip
    integrator: Literal["auto", "exponential", "rkc2", "dop853"] = Field(
        default="auto",
        description="Time integrator. By Krylov spaces if all is linear and constant in time; stabilised; of order 8.",
    )
