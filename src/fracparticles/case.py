"""One run, validated: a `Case` holds every parameter and what follows from them."""

from __future__ import annotations

import json
import os
from functools import cached_property
from math import ceil
from typing import Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from fracparticles.complaints import allowed, first_complaint
from fracparticles.errors import InvalidInput
from fracparticles.integrators import STEP_POLYNOMIALS
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.special.stable import mean_radius
from fracparticles.stability import stability_limit

__all__ = ["FUNDAMENTAL", "Case"]

FUNDAMENTAL = "fundamental"
_BYTES_PER_PARTICLE = 200  # measured: about 20 arrays of float64 at the peak
_TINY, _HUGE = 1e-100, 1e100  # lengths and times; nothing made of them overflows
_OVERLAPS = 0.25, 1000.0
_MOST_STEPS = 2**53  # more are not told apart in float64
_STIFFEST = 1e12  # T D / h^alpha; a Chebyshev series takes about the square root of 40 times this
_STEP_SLACK = 1e-9  # a time span of n (1 + 1e-9) steps still takes n steps

SchemeName = Literal["DD", "DPSE", "FPSE", "KPSE", "GPSE", "FD", "PSE29", "RIESZ"]


class Case(BaseModel):
    """One run of one scheme for u_t = -D (-Laplacian)^(alpha/2) u, alpha = 1 + beta, on a lattice.

    `spacing` and `dt` are what is asked for; the lattice ends at the half-width exactly and the last step at
    `t_final` exactly, so that the realised `particle_spacing` and `time_step` may differ slightly.

    The fields are the parameters, keyword only. NumPy scalars are taken for what they hold.

    Raises
    ------
    InvalidInput
        With the field, the value, what is allowed and what to do.
    """

    # The docstring below a field is its description: in the flags of the command line, too.
    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        strict=True,
        allow_inf_nan=False,
        use_attribute_docstrings=True,
    )

    scheme: SchemeName
    """Particle scheme, or one of the rejected PSE29 and RIESZ."""
    order: Literal[2, 4] = 2
    """Order of the kernels."""
    beta: float = Field(gt=0.0, lt=1.0)
    """Fractional order beta = alpha - 1, 0 < beta < 1."""
    dim: Literal[1] = 1
    """Space dimension."""
    truncation: float | None = Field(default=None, ge=_TINY, le=_HUGE)
    """C of D = C (D t_f)^(1/alpha) R_alpha, Eq. (46). Either this or half_width."""
    half_width: float | None = Field(default=None, ge=_TINY, le=_HUGE)
    """The half-width of the lattice itself."""
    spacing: float = Field(ge=_TINY, le=_HUGE)
    """Particle spacing h."""
    overlap: float | None = Field(default=None, ge=_OVERLAPS[0], le=_OVERLAPS[1])
    """epsilon / h; 2 if left out. For GPSE it follows from dt if that is given."""
    dt: float | None = Field(default=None, ge=_TINY, le=_HUGE)
    """Time step; needed by the explicit integrators. GPSE takes epsilon^alpha / D if left out."""
    diffusivity: float = Field(default=1.0, ge=_TINY, le=_HUGE)
    """D of Eq. (2)."""
    t_initial: float = Field(default=0.5, ge=0.0, le=_HUGE)
    """Start of the run."""
    t_final: float = Field(default=1.5, ge=_TINY, le=_HUGE)
    """End of the run."""
    initial: str = FUNDAMENTAL
    """"fundamental" for the fundamental solution at t_initial, or the path of a NetCDF file with u(x)."""
    integrator: Literal["euler", "rk2", "rk4", "exponential"] | None = None
    """Time integrator; rk2 if left out. GPSE is an Euler step by construction."""
    evaluation: Literal["series", "stepping"] = "series"
    """How the integrator's polynomial is evaluated: one Chebyshev series, or step by step."""
    summation: Literal["fft", "naive"] = "fft"
    """How sums over particles are done."""
    exterior: Literal["truncated", "open"] = "truncated"
    """The papers' truncation of the lattice, or the far-field closure."""
    store: Literal["field", "profile", "metrics"] = "field"
    """What a data set keeps: u everywhere, u for |x| <= 5 R_alpha, or scalars only."""

    def __init__(self, **data: Any) -> None:
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise first_complaint(error, type(self)) from None

    @model_validator(mode="before")
    @classmethod
    def _plain(cls, data: dict[str, Any]) -> dict[str, Any]:
        for name, field in cls.model_fields.items():
            if isinstance(data.get(name), bool | np.bool_):  # True == 1, which Literal takes
                raise InvalidInput(name, data[name], allowed(field), "Give such a value.")
        return {name: v.item() if isinstance(v, np.generic) else v for name, v in data.items()}

    @model_validator(mode="after")
    def _consistent(self) -> Case:
        _check_time(self)
        _check_domain(self)
        _check_scheme(self)
        _check_integrator(self)
        _check_work(self)
        return self

    # --- what follows from the parameters -------------------------------------------------------------------

    @property
    def alpha(self) -> float:
        """Fractional order alpha = 1 + beta."""
        return 1.0 + self.beta

    @property
    def domain(self) -> float:
        """The half-width of the lattice, Eq. (46)."""
        if self.half_width is not None:
            return self.half_width
        assert self.truncation is not None
        spread = (self.diffusivity * self.t_final) ** (1.0 / self.alpha)
        return self.truncation * spread * mean_radius(self.alpha)

    @property
    def n(self) -> int:
        """Half the number of lattice intervals: the particles are x_i = i h, i = -n .. n."""
        return max(1, round(self.domain / self.spacing))

    @property
    def particles(self) -> int:
        """The number N = 2 n + 1 of particles."""
        return 2 * self.n + 1

    @property
    def particle_spacing(self) -> float:
        """The realised spacing h = D / n."""
        return self.domain / self.n

    @property
    def x(self) -> np.ndarray:
        """The particle positions, shape (N,)."""
        return np.arange(-self.n, self.n + 1) * self.particle_spacing

    @property
    def method(self) -> str:
        """The integrator, the default resolved."""
        if self.integrator is not None:
            return self.integrator
        return "euler" if self.scheme == "GPSE" else "rk2"

    @cached_property
    def steps(self) -> int:
        """The number of time steps; 0 for the exponential."""
        if self.method == "exponential":
            return 0
        return max(1, ceil((self.t_final - self.t_initial) / self.asked_step * (1 - _STEP_SLACK)))

    @property
    def time_step(self) -> float:
        """The realised step (t_final - t_initial) / steps; 0 for the exponential."""
        return (self.t_final - self.t_initial) / self.steps if self.steps else 0.0

    @property
    def asked_step(self) -> float:
        """The step asked for: dt, or for GPSE the one that its overlap implies, Eq. (40)."""
        if self.dt is not None:
            return self.dt
        return ((self.overlap or 2.0) * self.particle_spacing) ** self.alpha / self.diffusivity

    @property
    def epsilon_over_h(self) -> float:
        """The realised overlap s = epsilon / h; for GPSE from the realised step, Eq. (40)."""
        if self.scheme == "GPSE":
            epsilon = (self.diffusivity * self.time_step) ** (1.0 / self.alpha)
            return epsilon / self.particle_spacing
        return 2.0 if self.overlap is None else self.overlap

    @property
    def setting(self) -> Setting:
        """The scheme on its lattice."""
        return Setting(
            n=self.n,
            spacing=self.particle_spacing,
            alpha=self.alpha,
            order=self.order,
            overlap=self.epsilon_over_h,
            diffusivity=self.diffusivity,
            summation=self.summation,
            exterior=self.exterior,
        )

    @cached_property
    def largest_stable_step(self) -> float:
        """The largest dt inside the stability interval; infinite for the exponential."""
        if self.method == "exponential":
            return float("inf")
        limit = stability_limit(self.scheme, self.beta, self.order, self.epsilon_over_h)
        reach = STEP_POLYNOMIALS[self.method].stability_interval / 2.0
        return float(reach * limit * self.particle_spacing**self.alpha / self.diffusivity)

    def refuse_point_mass(self) -> None:
        """Refuse to start from the fundamental solution at t = 0, where it is a point mass.

        Not part of the validation: initial data of one's own may come with the call of `solve`.

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
            If the text is not such an object, or its case is not valid.
        """
        try:
            fields = json.loads(text)
        except (TypeError, ValueError, RecursionError):
            fields = None
        if not isinstance(fields, dict):
            raise InvalidInput("case", text, "a JSON object", "Give what Case.to_json returns.")
        return cls(**fields)

    @property
    def path(self) -> str:
        """A relative file name that shows every parameter: equal cases, equal paths."""
        width = f"C{self.truncation:g}" if self.truncation is not None else f"D{self.half_width:g}"
        step = self.method if self.dt is None else f"{self.method}_dt{self.dt:.6g}"
        parts = [
            f"{width}_h{self.spacing:.7g}",
            *([] if self.overlap is None else [f"s{self.overlap:g}"]),
            step,
            f"t{self.t_initial:g}-{self.t_final:g}",
            *([] if self.diffusivity == 1.0 else [f"diffusivity{self.diffusivity:g}"]),
            *([] if self.initial == FUNDAMENTAL else [f"from-{_slug(self.initial)}"]),
            *([] if self.evaluation == "series" else [self.evaluation]),
            *([] if self.summation == "fft" else [self.summation]),
            self.exterior,
            self.store,
        ]
        return f"{self.scheme}-{self.order}/beta{self.beta:g}/{'_'.join(parts)}.nc"


def _slug(text: str) -> str:
    return "".join(c if c.isalnum() else "-" for c in text)


def _check_time(case: Case) -> None:
    if not 1.0 < case.alpha < 2.0:
        raise InvalidInput(
            "beta", case.beta, "a number that makes 1 + beta differ from 1 and 2", "Move it inward."
        )
    if case.t_final <= case.t_initial:
        raise InvalidInput(
            "t_final",
            case.t_final,
            f"a number > t_initial = {case.t_initial:g}",
            "Give a later final time.",
        )


def _check_domain(case: Case) -> None:
    if (case.truncation is None) == (case.half_width is None):
        raise InvalidInput(
            "truncation",
            case.truncation,
            "exactly one of truncation and half_width",
            "Give the factor C of Eq. (46) or the half-width itself.",
        )
    if case.spacing > case.domain / 8.0:
        raise InvalidInput(
            "spacing",
            case.spacing,
            f"at most an eighth of the half-width, {case.domain / 8.0:.6g}",
            "Take a smaller spacing or a wider domain.",
        )
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    needed = _BYTES_PER_PARTICLE * 2.0 * case.domain / case.spacing
    if needed > 0.5 * memory:
        least = _BYTES_PER_PARTICLE * 4.0 * case.domain / memory
        raise InvalidInput(
            "spacing",
            case.spacing,
            f"at least {least:.3g} on this domain and this machine: "
            f"{2.0 * case.domain / case.spacing:.3g} particles would take {needed / 2**30:.3g} GiB, "
            f"half of the memory is {memory / 2**31:.3g} GiB",
            "Take a larger spacing or a narrower domain.",
        )


def _check_work(case: Case) -> None:
    span = case.t_final - case.t_initial
    if case.evaluation == "series" and span * case.setting.rate > _STIFFEST:
        raise InvalidInput(
            "t_final",
            case.t_final,
            f"at most {case.t_initial + _STIFFEST / case.setting.rate:.6g} with this spacing and diffusivity",
            "Take a shorter run or a larger spacing.",
        )
    if case.method != "exponential" and span / case.asked_step > _MOST_STEPS:
        raise InvalidInput(
            "dt", case.dt, f"at least {span / _MOST_STEPS:.3g}: 2^53 steps", "Take a larger step."
        )


def _check_scheme(case: Case) -> None:
    scheme = SCHEMES[case.scheme]
    if case.order not in scheme.ORDERS:
        raise InvalidInput(
            "order",
            case.order,
            f"{' or '.join(map(str, scheme.ORDERS))} for {case.scheme}",
            "Choose one of these.",
        )
    if case.exterior not in scheme.EXTERIORS:
        raise InvalidInput(
            "exterior",
            case.exterior,
            f"{' or '.join(scheme.EXTERIORS)} for {case.scheme}",
            "The far-field closure exists for DD, FPSE, KPSE and GPSE.",
        )
    if case.scheme == "FD" and case.overlap is not None:
        raise InvalidInput(
            "overlap", case.overlap, "nothing for FD, which has no kernel", "Leave it out."
        )


def _check_integrator(case: Case) -> None:
    if case.method == "exponential":
        if case.dt is not None:
            raise InvalidInput(
                "dt", case.dt, "nothing for integrator='exponential'", "Leave dt out."
            )
        if case.evaluation == "stepping":
            raise InvalidInput(
                "evaluation",
                case.evaluation,
                "'series' for integrator='exponential', which takes no steps",
                "Leave it out.",
            )
    if case.scheme == "GPSE":
        if case.method != "euler":
            raise InvalidInput(
                "integrator",
                case.method,
                "nothing or 'euler' for GPSE, whose step is part of the scheme",
                "Leave it out.",
            )
        if case.dt is not None and case.overlap is not None:
            raise InvalidInput(
                "overlap",
                case.overlap,
                "one of dt and overlap for GPSE, since epsilon = (D dt)^(1/alpha), Eq. (40)",
                "Leave one of them out.",
            )
        if case.dt is not None and not _OVERLAPS[0] <= case.epsilon_over_h <= _OVERLAPS[1]:
            least, most = ((s * case.particle_spacing) ** case.alpha for s in _OVERLAPS)
            raise InvalidInput(
                "dt",
                case.dt,
                f"a step from {least / case.diffusivity:.4g} to {most / case.diffusivity:.4g} for GPSE, so that "
                f"epsilon / h is from {_OVERLAPS[0]:g} to {_OVERLAPS[1]:g}",
                "Change dt or the spacing.",
            )
    elif case.dt is None and case.method != "exponential":
        limit = stability_limit(case.scheme, case.beta, case.order, case.epsilon_over_h)
        largest = limit * case.particle_spacing**case.alpha / case.diffusivity
        raise InvalidInput(
            "dt",
            None,
            f"a number > 0 for integrator={case.method!r}, stable up to {largest:.4g}",
            "Give dt, or integrator='exponential', which needs none.",
        )
