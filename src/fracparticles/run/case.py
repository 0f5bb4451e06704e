"""One run, validated: a `Case` holds every parameter, and the quantities that follow from them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from hashlib import sha256
from typing import Any, ClassVar
from urllib.parse import quote

from pydantic import model_validator

from fracparticles.arguments import instance
from fracparticles.errors import InvalidInput
from fracparticles.run.checks import check
from fracparticles.run.derived import Derived
from fracparticles.run.fractional_order import with_beta
from fracparticles.run.parameters import FUNDAMENTAL, fastest_evaluation
from fracparticles.run.times import parts, with_times

__all__ = ["FUNDAMENTAL", "Case", "a_case"]

_LONGEST_NAME = 240  # bytes; file systems take 255, suffix included


class Case(Derived):
    """One run of one scheme for u_t = -D (-Laplacian)^(alpha/2) u, alpha = 1 + beta, from particles on a lattice.

    `spacing` and `dt` are requests: the lattice ends at the half-width exactly and the last step at `t_final` exactly,
    so that the realised `particle_spacing` and `time_step` may differ slightly.

    The fields are the parameters, keyword only. NumPy scalars are taken as Python numbers. `alpha` may be given
    instead of `beta`.

    Raises
    ------
    InvalidInput
        Names the field, the value, what is allowed and what to do.
    """

    elsewhere: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ["velocity", "source", "domain", "particles", "form", "exterior_data", "rtol", "atol"],
        "It is a field of fp.Problem, for fp.solve_problem.",
    )

    def __init__(self, **data: Any) -> None:  # alpha is no field, for those who check types
        super().__init__(**data)

    @model_validator(mode="before")
    @classmethod
    def _plain(cls, data: dict[str, Any]) -> dict[str, Any]:
        plain = cls._plain_values(data)
        if isinstance(plain.get("evaluation"), str) and plain["evaluation"] == "auto":
            plain["evaluation"] = fastest_evaluation(plain)
        return with_times(with_beta(plain))

    @model_validator(mode="after")
    def _consistent(self) -> Case:
        check(self)
        if self.times is not None:
            parts(self)  # making the parts checks each of them
        return self

    def refuse_point_mass(self) -> None:
        """Refuse to start from the fundamental solution at t = 0, where it is a point mass.

        This is not part of the validation, since other initial data may come with the call of `solve`.

        Raises
        ------
        InvalidInput
            If the case starts from the fundamental solution at t_initial = 0.
        """
        if self.initial == FUNDAMENTAL and self.t_initial <= 0.0:
            raise InvalidInput(
                "t_initial",
                self.t_initial,
                "a number > 0 when the run starts from the fundamental solution, a point mass at t = 0",
                "Give a positive time, or initial data of your own.",
            )

    def until(self, *times: float) -> Case:
        """Return the run on the same lattice that ends at one time, or has several output times."""
        fields = self.model_dump(exclude_none=True) | {"half_width": self.reach}
        for name in ("truncation", "times", "t_final"):
            fields.pop(name, None)
        return type(self)(
            **fields, **({"t_final": times[0]} if len(times) == 1 else {"times": times})
        )

    # --- identity -------------------------------------------------------------------------------------------

    def to_json(self) -> str:
        """Return the case as one JSON object; `Case.from_json` reads it."""
        return json.dumps(self.model_dump(exclude_none=True), sort_keys=True)

    @classmethod
    def from_json(cls, text: str) -> Case:
        """Return the case that `to_json` wrote.

        Raises
        ------
        InvalidInput
            If the text is not a JSON object, or its case is not valid.
        """
        return cls(**cls._read(text))

    @property
    def path(self) -> str:
        """A relative file name that shows every parameter: two cases have the same path if and only if they are equal.

        Numbers are as short as they can be. The name of a file of data is percent-encoded. A name too long for a file
        system ends in a digest of the whole name.
        """
        width = _said("C", self.truncation) or _said("D", self.half_width)
        parts = [
            f"{width}_h{_digits(self.spacing, 7)}",
            _said("s", self.overlap),
            self.resolved_integrator,
            _said("dt", self.dt),
            f"t{_digits(self.t_initial)}-{_digits(self.t_final)}",
            f"at{','.join(map(_digits, self.times))}" if self.times else "",
            _said("diffusivity", self.diffusivity, default=1.0),
            "" if self.initial == FUNDAMENTAL else f"from-{_encoded(self.initial)}",
            None if self._series_by_default else self.evaluation,
            "" if self.summation == "fft" else self.summation,
            self.kernel_family,
            _said("table", self.kernel_table),
            _said("graded", self.graded_scale),
            self.graded_form,
            self.remeshing and self.remeshing.replace("'", "-"),
            _said("above", self.remesh_above),
            _said("threshold", self.threshold),
            f"{self.exterior}{self.far_terms or ''}",
            self.store,
        ]
        name = "_".join(filter(None, parts))
        if len(name) > _LONGEST_NAME:  # no other part begins like the digest
            digest = sha256(name.encode()).hexdigest()
            name = f"{name[: _LONGEST_NAME - len(digest) - 8]}_sha256-{digest}"
        kind = f"{self.scheme}-{self.order}" + ("" if self.dim == 1 else f"-{self.dim}d")
        return f"{kind}/beta{_digits(self.beta)}/{name}.nc"


def a_case(value: Any) -> Case:
    """Return the value if it is a case; raises `InvalidInput` otherwise."""
    remedy = "Make one: fp.Case(scheme='KPSE', ...). A fp.Problem is for fp.solve_problem."
    return instance("case", value, Case, "a fp.Case", remedy)


def _said(word: str, number: float | None, default: float | None = None) -> str:
    """The word and the number, empty for the default."""
    return "" if number == default else f"{word}{_digits(number or 0.0)}"


def _digits(number: float, digits: int = 6) -> str:
    """The number in so many digits if they are exact, or else in as many as needed; 0 has no sign."""
    short = f"{number + 0.0:.{digits}g}"
    return short if float(short) == number else repr(float(number))


def _encoded(text: str) -> str:
    """The text encoded for a part of a file name; different texts have different codes."""
    return quote(text.encode("utf-8", "surrogatepass"), safe="").replace("_", "%5F")
