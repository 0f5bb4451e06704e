"""A validated problem: the equation, its coefficients, the particles, the times, and the tolerances.

    u_t + div(a(x,t) u) = div(D(x,t) grad^beta u) + f(x,t,u),    div grad^beta = -(-Laplacian)^(alpha/2),

alpha = 1 + beta, in one and two dimensions: on the whole space, or on an interval, a square or a disc, see `domains`.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from pydantic import model_validator

from fracparticles.arguments import SIZES, told_apart
from fracparticles.bounded.domain import Domain
from fracparticles.called import AXES
from fracparticles.errors import InvalidInput
from fracparticles.problems.coefficients import WithCoefficients
from fracparticles.problems.domains import (
    OF_A_LATTICE,
    check_domain,
    is_bounded,
    make_domain,
    sample_points,
    with_dim,
)
from fracparticles.problems.order import with_any_order
from fracparticles.run.case import Case
from fracparticles.run.times import with_times

__all__ = ["FORMS", "Problem"]

FORMS = {"FPSE": "FPSE", "DD": "DD", "exchange": "KPSE"}
"""The schemes of a constant diffusivity, by the form of the equation."""

_SHORT = 0.05  # share of the half-width to which the solution spreads in the short run of `case`
_LOOKS = 33  # times from t_initial to t_final at which coefficients that depend on time are checked
_FUNCTION = "a function, which the file does not hold"  # in JSON


class Problem(WithCoefficients):
    """One problem; the fields are the parameters, keyword only.

    A text is an expression, see `formulas`: "1 + 0.5*sin(x)*exp(-t)". A function takes arrays: those of x, y and t, and
    for a source of u, that its arguments are named after, see `called`. `alpha` may be given instead of `beta`.

    Raises
    ------
    InvalidInput
        If a field is wrong; names the field, the value, what is allowed and what to do. For a coefficient it names the
        place where it is wrong.
    """

    elsewhere: ClassVar[Mapping[str, str]] = dict.fromkeys(
        Case.model_fields.keys() - WithCoefficients.model_fields.keys(),
        "It is a field of fp.Case, for fp.solve.",
    )

    def __init__(self, **data: Any) -> None:  # alpha is no field: for type checkers
        super().__init__(**data)

    @model_validator(mode="before")
    @classmethod
    def _plain(cls, data: dict[str, Any]) -> dict[str, Any]:
        plain = cls._plain_values(data)
        if isinstance(plain.get("velocity"), list | np.ndarray):
            plain["velocity"] = tuple(plain["velocity"])
        return with_times(with_any_order(with_dim(plain)))

    @model_validator(mode="after")
    def _consistent(self) -> Problem:
        beta, points = self.order_coefficient, self._samples
        values = beta.checked(points)
        if not ((values > 0.0) & (values < 1.0)).all():
            allowed = f"0 < beta < 1, alpha = 1 + beta, and it is from {values.min():.6g} to {values.max():.6g}"
            raise InvalidInput(
                "beta", beta.given, allowed, "Give beta = alpha - 1, or alpha itself."
            )
        if beta.constant is None and not self.is_bounded:
            if self.form != "DD":
                raise InvalidInput("form", self.form, "DD for a variable order", "Take form='DD'.")
            if self.diffusion.depends_on - {"t"}:
                what = "a number, or an expression in t alone, beside a variable order"
                raise InvalidInput("diffusivity", self.diffusivity, what, "Leave the place out.")
        between = np.linspace(self.t_initial, self.t_final, _LOOKS)
        check_domain(self, between)
        places = points if self.is_bounded else self.places
        if self.times is not None and self.times[0] <= self.t_initial:
            later = f"numbers > t_initial = {self.t_initial:g}"
            raise InvalidInput(
                "times", self.times, later, "Leave out times up to it: u is given there."
            )
        if any("t" in one.depends_on for one in self.coefficients):
            told_apart("t_final", self.t_final, self.t_initial, self.t_final)
        least_d = SIZES[0] if self.is_bounded else 0.0
        for one in (self.diffusion, *self.transport):
            least = least_d if one is self.diffusion else None
            for time in (self.t_initial, *self.output_times):
                one.checked({**places, "t": np.array(time)}, least)
            for time in between if "t" in one.depends_on else ():
                one.checked({**points, "t": np.array(time)}, least)
        return self

    @property
    def alpha(self) -> float:
        """The order alpha = 1 + beta; raises `InvalidInput` if it varies."""
        beta = self.order_coefficient.constant
        if beta is None:
            what = "a number, to speak of one alpha"
            raise InvalidInput("beta", self.beta, what, "Evaluate order_coefficient at places.")
        return 1.0 + beta

    @property
    def output_times(self) -> tuple[float, ...]:
        """The output times, the last of them t_final."""
        return self.times or (self.t_final,)

    @property
    def span(self) -> float:
        """The time of the run, t_final - t_initial."""
        return self.t_final - self.t_initial

    # --- the lattice ----------------------------------------------------------------------------------------

    @property
    def is_bounded(self) -> bool:
        """Whether the problem is on a bounded domain."""
        return is_bounded(self.exterior)

    @property
    def places(self) -> dict[str, np.ndarray]:
        """Where the particles are, by coordinate."""
        at = self.bounded_domain.points if self.is_bounded else self.case.positions
        return dict(zip(AXES, at, strict=False))

    @property
    def _samples(self) -> dict[str, np.ndarray]:
        points = sample_points(self.domain, self.half_width, self.dim)
        return dict(zip(AXES, points, strict=False))

    @cached_property
    def bounded_domain(self) -> Domain:
        """The particles of a bounded domain, of diffusivity 1; raises `InvalidInput` if there is none."""
        if not self.is_bounded:
            what = "absorbing, reflecting or given for a bounded domain"
            raise InvalidInput("exterior", self.exterior, what, "Take such an exterior.")
        return make_domain(self)

    @cached_property
    def case(self) -> Case:
        """The lattice and its scheme, as a run of constant coefficients: the greatest at t_initial.

        For diffusion alone the case also has the times, and refuses a lattice that the solution outgrows. A velocity
        may hold the solution together, and a source may spread it. Then the case is a short run, and the solution tells
        how much has left the lattice.
        """
        if self.is_bounded:
            what = "open or truncated for a lattice"
            raise InvalidInput("exterior", self.exterior, what, "Use bounded_domain.")
        points = self._samples
        beta = float(self.order_coefficient(points).max())
        d = float(self.diffusion.checked({**points, "t": np.array(self.t_initial)}, 0.0).max())
        fields = self.model_dump(include=_OF_THE_CASE, exclude_none=True)
        if self.transport or self.reaction or self.diffusion.constant is None:
            short = (_SHORT * self.half_width) ** (1.0 + beta) / (d or 1.0)
            soon = max(self.t_initial + short, float(np.nextafter(self.t_initial, np.inf)))
            fields["t_final"] = min(self.t_final, soon)
        # Where D varies, the flux has kernels of every order in the plane too. The lattice is that of any scheme.
        varies = bool(self.diffusion.depends_on - {"t"})
        scheme = "DD" if varies and self.form == "FPSE" else FORMS[self.form]
        return Case(
            scheme=scheme, beta=beta, integrator="exponential", diffusivity=d or 1.0, **fields,
        )  # fmt: skip

    def to_json(self) -> str:
        """Return the problem as one JSON object; `from_json` reads it, unless a coefficient is a function."""
        absent = set(OF_A_LATTICE) if self.is_bounded else set()
        fields = self.model_dump(exclude_none=True, exclude=absent)
        return json.dumps(fields, sort_keys=True, default=lambda _: _FUNCTION)

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


# Fields that a problem hands to its case.
_OF_THE_CASE = {
    "dim", "half_width", "spacing", "order", "overlap", "exterior", "far_terms", "t_initial", "t_final",
}  # fmt: skip
