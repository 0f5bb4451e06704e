"""A problem, validated: the equation, its coefficients, the particles, the times, and how well it is to be solved.

    u_t + div(a(x,t) u) = div(D(x,t) grad^beta u) + f(x,t,u),    div grad^beta = -(-Laplacian)^(alpha/2),

alpha = 1 + beta, in one and two dimensions.
"""

from __future__ import annotations

import json
from functools import cached_property
from typing import Any, Literal

import numpy as np
from pydantic import Field, model_validator

from fracparticles.errors import InvalidInput
from fracparticles.problems.expressions import Coefficient
from fracparticles.problems.order import with_any_order
from fracparticles.run.case import Case
from fracparticles.run.checked import Checked
from fracparticles.run.parameters import OVERLAPS, SIZES
from fracparticles.run.times import with_times

__all__ = ["FORMS", "Problem"]

FORMS = {"FPSE": "FPSE", "DD": "DD", "exchange": "KPSE"}
"""The schemes of a constant diffusivity, by the form of the equation."""

_AXES = ("x", "y")
_COEFFICIENT = "A number, an expression in x, y and t, or a function of them."
_SHORT = 0.05  # of the half-width, how far the solution spreads
_LOOKS = 33  # between t_initial and t_final, at coefficients that depend on time
_FUNCTION = "a function, which the file does not hold"  # in JSON


class Problem(Checked):
    """One problem; the fields are the parameters, keyword only.

    A text is an expression, see `expressions`: "1 + 0.5*sin(x)*exp(-t)". A function takes arrays x, t on the line and
    x, y, t in the plane, or the first of these alone; that of a source u, too, as the last. `alpha` may be given
    instead of `beta`.

    Raises
    ------
    InvalidInput
        With the field, the value, what is allowed and what to do; of a coefficient with the place where it is wrong.
    """

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
        ge=SIZES[0], le=SIZES[1], description="Half-width of the lattice in each coordinate."
    )
    spacing: float = Field(
        ge=SIZES[0],
        le=SIZES[1],
        description="Particle spacing h. The nearest that divides the half-width is taken.",
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
    exterior: Literal["open", "truncated"] = Field(
        default="open",
        description="What lies beyond the lattice. A tail, continued by powers; or nothing.",
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
        description="Absolute tolerance of the time integration. rtol times the greatest |u| at t_initial if left out. "
        "Both are of the root mean square over the part of the lattice that the data fill.",
    )  # fmt: skip
    integrator: Literal["auto", "exponential", "rkc2", "dop853"] = Field(
        default="auto",
        description="Time integrator. By Krylov spaces if all is linear and constant in time; stabilised; of order 8.",
    )

    def __init__(self, **data: Any) -> None:  # alpha is no field, for those who check types
        super().__init__(**data)

    @model_validator(mode="before")
    @classmethod
    def _plain(cls, data: dict[str, Any]) -> dict[str, Any]:
        plain = cls._plain_values(data)
        if isinstance(plain.get("velocity"), list | np.ndarray):
            plain["velocity"] = tuple(plain["velocity"])
        return with_times(with_any_order(plain))

    @model_validator(mode="after")
    def _consistent(self) -> Problem:
        beta, points = self.order_coefficient, self._samples
        values = beta.checked(points)
        if not ((values > 0.0) & (values < 1.0)).all():
            allowed = f"0 < beta < 1, alpha = 1 + beta, and it is from {values.min():.6g} to {values.max():.6g}"
            raise InvalidInput(
                "beta", beta.given, allowed, "Give beta = alpha - 1, or alpha itself."
            )
        if beta.constant is None:
            if self.form != "DD":
                raise InvalidInput("form", self.form, "DD for a variable order", "Take form='DD'.")
            if self.diffusion.depends_on - {"t"}:
                what = "a number, or an expression in t alone, beside a variable order"
                raise InvalidInput("diffusivity", self.diffusivity, what, "Leave the place out.")
        _ = self.reaction  # which is checked, as the case is
        places = dict(zip(_AXES, self.case.positions, strict=False))
        if self.times is not None and self.times[0] <= self.t_initial:
            later = f"numbers > t_initial = {self.t_initial:g}"
            raise InvalidInput(
                "times", self.times, later, "Leave out the others: there are the data."
            )
        between = np.linspace(self.t_initial, self.t_final, _LOOKS)
        for one in (self.diffusion, *self.transport):
            least = 0.0 if one is self.diffusion else None
            for time in (self.t_initial, *self.output_times):
                one.checked({**places, "t": np.array(time)}, least)
            for time in between if "t" in one.depends_on else ():
                one.checked({**points, "t": np.array(time)}, least)
        return self

    @property
    def output_times(self) -> tuple[float, ...]:
        """The output times, the last of them t_final."""
        return self.times or (self.t_final,)

    @property
    def span(self) -> float:
        """The time of the run, t_final - t_initial."""
        return self.t_final - self.t_initial

    # --- the coefficients -----------------------------------------------------------------------------------

    @cached_property
    def order_coefficient(self) -> Coefficient:
        """Beta, a coefficient of the place alone."""
        return Coefficient("beta", self.beta, _AXES[: self.dim])

    @cached_property
    def diffusion(self) -> Coefficient:
        """D."""
        return Coefficient("diffusivity", self.diffusivity, (*_AXES[: self.dim], "t"))

    @cached_property
    def transport(self) -> tuple[Coefficient, ...]:
        """The components of a; none if there is no velocity."""
        if self.velocity is None:
            return ()
        given = self.velocity if isinstance(self.velocity, tuple) else (self.velocity,)
        if len(given) != self.dim:
            each = f"one expression for each of the {self.dim} coordinate(s)"
            raise InvalidInput("velocity", self.velocity, each, "Give a tuple of them.")
        return tuple(Coefficient("velocity", one, (*_AXES[: self.dim], "t")) for one in given)

    @cached_property
    def reaction(self) -> Coefficient | None:
        """f, or None."""
        if self.source is None:
            return None
        return Coefficient("source", self.source, (*_AXES[: self.dim], "t", "u"))

    @property
    def _coefficients(self) -> list[Coefficient]:
        every = [self.order_coefficient, self.diffusion, *self.transport, self.reaction]
        return [one for one in every if one is not None]

    @property
    def is_linear(self) -> bool:
        """Whether the source says nothing of u."""
        return self.reaction is None or "u" not in self.reaction.depends_on

    @property
    def is_autonomous(self) -> bool:
        """Whether no coefficient says anything of t."""
        return all("t" not in one.depends_on for one in self._coefficients)

    @property
    def reproducible(self) -> bool:
        """Whether the JSON text holds all of it: not if a coefficient is a function."""
        return all(one.reproducible for one in self._coefficients)

    # --- the lattice ----------------------------------------------------------------------------------------

    @property
    def _samples(self) -> dict[str, np.ndarray]:
        """Some points of the domain: the ends, the middle, and what lies between them."""
        axis = np.linspace(-self.half_width, self.half_width, 257 if self.dim == 1 else 33)
        grid = np.meshgrid(*(axis,) * self.dim, indexing="ij", sparse=True)
        return dict(zip(_AXES, grid, strict=False))

    @cached_property
    def case(self) -> Case:
        """The lattice and its scheme, as a run of constant coefficients: the greatest at t_initial.

        Of diffusion alone it has the times, too, and refuses a lattice that the solution outgrows. A field may hold the
        solution together, and a source spread it: then it is a short run, and what leaves the lattice is told after.
        """
        points = self._samples
        beta = float(self.order_coefficient(points).max())
        d = float(self.diffusion.checked({**points, "t": np.array(self.t_initial)}, 0.0).max())
        fields = self.model_dump(include=_OF_THE_CASE, exclude_none=True)
        if self.transport or self.reaction or self.diffusion.constant is None:
            short = (_SHORT * self.half_width) ** (1.0 + beta) / (d or 1.0)
            soon = max(self.t_initial + short, float(np.nextafter(self.t_initial, np.inf)))
            fields["t_final"] = min(self.t_final, soon)
        # Where D varies the flux has kernels of every order, in the plane, too; the lattice is that of any scheme.
        varies = bool(self.diffusion.depends_on - {"t"})
        scheme = "DD" if varies and self.form == "FPSE" else FORMS[self.form]
        return Case(
            scheme=scheme, beta=beta, integrator="exponential", diffusivity=d or 1.0, **fields,
        )  # fmt: skip

    def to_json(self) -> str:
        """Return the problem as one JSON object; `from_json` reads it, unless a coefficient is a function."""
        return json.dumps(
            self.model_dump(exclude_none=True), sort_keys=True, default=lambda _: _FUNCTION
        )

    @classmethod
    def from_json(cls, text: str) -> Problem:
        """Return the problem that `to_json` wrote.

        Raises
        ------
        InvalidInput
            If the text is not such an object, its problem is not valid, or a coefficient was a function.
        """
        fields = cls._read(text)
        for name, value in fields.items():
            if _FUNCTION in (value if isinstance(value, list) else [value]):
                remedy = "Make the problem again, with the function."
                raise InvalidInput(name, value, "a number or an expression", remedy)
        return cls(**fields)


_OF_THE_CASE = {
    "dim", "half_width", "spacing", "order", "overlap", "exterior", "far_terms", "t_initial", "t_final",
}  # fmt: skip
