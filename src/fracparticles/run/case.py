"""One run, validated: a `Case` holds every parameter and what follows from them."""

from __future__ import annotations

import json
from functools import cached_property
from hashlib import sha256
from math import ceil
from typing import Any, Literal
from urllib.parse import quote

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from fracparticles.errors import InvalidInput
from fracparticles.run.checks import FUNDAMENTAL, OVERLAPS, SIZES, check
from fracparticles.run.complaints import allowed, first_complaint
from fracparticles.schemes import Setting
from fracparticles.schemes.stability import stability_limit, symbol_range
from fracparticles.special.stable import mean_radius
from fracparticles.time import STEP_POLYNOMIALS

__all__ = ["FUNDAMENTAL", "Case"]

_STEP_SLACK = 1e-9  # a time span of n (1 + 1e-9) steps still takes n steps
_LONGEST_NAME = 240  # bytes; file systems take 255, suffix included

SchemeName = Literal["DD", "DPSE", "FPSE", "KPSE", "GPSE", "DVM", "FD", "PSE29", "RIESZ"]


class Case(BaseModel):
    """One run of one scheme for u_t = -D (-Laplacian)^(alpha/2) u, alpha = 1 + beta, from particles on a lattice.

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
    order: Literal[2, 4, 6, 8, 10, 12] = 2
    """Order of the kernels: 2 or 4; for DD, FPSE (in one dimension) and KPSE up to 12."""
    kernel_family: Literal["printed", "gamma"] | None = None
    """Kernels of DD, FPSE and KPSE: the printed ones of orders 2 and 4, or gamma; gamma from order 6 if left out."""
    beta: float = Field(gt=0.0, lt=1.0)
    """Fractional order beta = alpha - 1, 0 < beta < 1."""
    dim: Literal[1, 2, 3] = 1
    """Space dimension; the lattice is a square or a cube for 2 and 3."""
    truncation: float | None = Field(default=None, ge=SIZES[0], le=SIZES[1])
    """C of D = C (D t_f)^(1/alpha) R_alpha, Eq. (46). Either this or half_width."""
    half_width: float | None = Field(default=None, ge=SIZES[0], le=SIZES[1])
    """The half-width of the lattice itself, in each coordinate."""
    spacing: float = Field(ge=SIZES[0], le=SIZES[1])
    """Particle spacing h."""
    overlap: float | None = Field(default=None, ge=OVERLAPS[0], le=OVERLAPS[1])
    """epsilon / h; 2 if left out. For GPSE it follows from dt if that is given."""
    dt: float | None = Field(default=None, ge=SIZES[0], le=SIZES[1])
    """Time step; needed by the explicit integrators. GPSE takes epsilon^alpha / D if left out."""
    diffusivity: float = Field(default=1.0, ge=SIZES[0], le=SIZES[1])
    """D of Eq. (2)."""
    t_initial: float = Field(default=0.5, ge=0.0, le=SIZES[1])
    """Start of the run."""
    t_final: float = Field(default=1.5, ge=SIZES[0], le=SIZES[1])
    """End of the run."""
    initial: str = FUNDAMENTAL
    """"fundamental" for the fundamental solution at t_initial, or the path of a NetCDF file with u(x)."""
    integrator: Literal["euler", "rk2", "rk4", "exponential"] | None = None
    """Time integrator; rk2 if left out. GPSE is an Euler step by construction."""
    evaluation: Literal["series", "stepping", "convolution"] | None = None
    """How the integrator's polynomial is evaluated: one Chebyshev series (if left out), step by step (always DVM, and
    a single step), or the whole run as one lattice sum, from the symbol."""
    summation: Literal["fft", "naive"] = "fft"
    """How sums over particles are done; the fast Fourier transform of DVM is a non-uniform one."""
    exterior: Literal["truncated", "open"] = "truncated"
    """The papers' truncation of the lattice, or the far-field closure."""
    far_terms: Literal[1, 2, 3] | None = None
    """Terms of the expansion that continues the solution in an open exterior (dim = 1); 1 if left out."""
    kernel_table: float | None = Field(default=None, ge=1e-6, le=1.0)
    """Step of the table, in units of epsilon, that kernels are interpolated in (paper, Sec. 5); exact if left out."""
    remeshing: Literal["M4'", "Lambda3", "none"] | None = None
    """Remeshing kernel of DVM; M4' if left out."""
    remesh_above: float | None = Field(default=None, gt=1.0, le=100.0)
    """DVM remeshes when two neighbours are further apart than this many h; 1.5 if left out."""
    threshold: float | None = Field(default=None, ge=0.0, lt=1.0)
    """DVM leaves out, when it remeshes, particles weaker than this share of the strongest; zero if left out."""
    store: Literal["field", "profile", "metrics"] = "field"
    """What a data set keeps: u everywhere; u for |x| <= 5 R_alpha (dim = 1), or along an axis and a diagonal; or
    scalars only."""

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
        check(self)
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
        """Half the number of lattice intervals: the particles are x_i = i h, i = -n .. n in each coordinate."""
        return max(1, round(self.domain / self.spacing))

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
        """The realised spacing h = D / n."""
        return self.domain / self.n

    @property
    def x(self) -> np.ndarray:
        """The particle positions along one axis, shape (2 n + 1,)."""
        return np.arange(-self.n, self.n + 1) * self.particle_spacing

    @property
    def positions(self) -> list[np.ndarray]:
        """The coordinates of the particles, `dim` arrays that broadcast to `shape`."""
        return list(np.meshgrid(*(self.x,) * self.dim, indexing="ij", sparse=True))

    @property
    def radius(self) -> np.ndarray:
        """The distances |x| of the particles from the origin, of that shape."""
        return np.sqrt(sum(np.square(part) for part in self.positions))

    @property
    def error_radius(self) -> float:
        """The errors are taken over |x| <= 5 R_alpha (47) for dim = 1, over |x| <= 5 (59) otherwise, or the lattice.

        That is for the papers' D t_f = 1.5; for another it grows with the solution, like (D t_f)^(1/alpha), so that
        the error does not depend on the units.
        """
        half = 5.0 * mean_radius(self.alpha) if self.dim == 1 else 5.0
        spread = (self.diffusivity * self.t_final / 1.5) ** (1.0 / self.alpha)
        return min(half * spread, self.domain)

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
            dim=self.dim,
            kernel_table=self.kernel_table,
            family=self.kernel_family,
            far_terms=self.far_terms or 1,
        )

    @property
    def steps_taken(self) -> bool:
        """Whether the steps are taken one by one; a single Euler step has nothing to gain from a series."""
        if self.evaluation is None and self.method == "euler" and self.steps == 1:
            return True
        return self.evaluation == "stepping" or self.scheme == "DVM"

    @property
    def _series_by_default(self) -> bool:
        """Whether `evaluation` says "series" where it would be one anyway: but for a single Euler step."""
        return self.evaluation == "series" and not (self.method == "euler" and self.steps == 1)

    @cached_property
    def largest_stable_step(self) -> float:
        """The largest dt inside the stability interval; infinite for the exponential."""
        if self.method == "exponential":
            return float("inf")
        limit = stability_limit(*self._of_the_symbol)
        reach = STEP_POLYNOMIALS[self.method].stability_interval / 2.0
        return float(reach * limit * self.particle_spacing**self.alpha / self.diffusivity)

    @property
    def symbol_range(self) -> tuple[float, float]:
        """The least and the greatest value of A(theta) h^alpha / D."""
        return symbol_range(*self._of_the_symbol)

    @property
    def _of_the_symbol(self) -> tuple[str, float, int, float, int, str | None]:
        # A displacement wave of DVM's particles in a uniform field decays by DD's symbol.
        scheme = "DD" if self.scheme == "DVM" else self.scheme
        overlap = self.epsilon_over_h
        return scheme, self.beta, self.order, overlap, self.dim, self.kernel_family

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
        """A relative file name that shows every parameter: equal cases, equal paths, and only they.

        Numbers are as short as they can be; the name of a file is percent-encoded; a name too long for a file system
        ends in a digest of the whole.
        """
        if self.truncation is not None:
            width = f"C{_digits(self.truncation)}"
        else:
            assert self.half_width is not None
            width = f"D{_digits(self.half_width)}"
        step = self.method if self.dt is None else f"{self.method}_dt{_digits(self.dt)}"
        parts = [
            f"{width}_h{_digits(self.spacing, 7)}",
            *([] if self.overlap is None else [f"s{_digits(self.overlap)}"]),
            step,
            f"t{_digits(self.t_initial)}-{_digits(self.t_final)}",
            *([] if self.diffusivity == 1.0 else [f"diffusivity{_digits(self.diffusivity)}"]),
            *([] if self.initial == FUNDAMENTAL else [f"from-{_encoded(self.initial)}"]),
            *([] if self.evaluation is None or self._series_by_default else [self.evaluation]),
            *([] if self.summation == "fft" else [self.summation]),
            *([] if self.kernel_family is None else [self.kernel_family]),
            *([] if self.kernel_table is None else [f"table{_digits(self.kernel_table)}"]),
            *([] if self.remeshing is None else [self.remeshing.replace("'", "-")]),
            *([] if self.remesh_above is None else [f"above{_digits(self.remesh_above)}"]),
            *([] if self.threshold is None else [f"threshold{_digits(self.threshold)}"]),
            self.exterior + ("" if self.far_terms is None else str(self.far_terms)),
            self.store,
        ]
        name = "_".join(parts)
        if len(name) > _LONGEST_NAME:  # no other part begins like the digest
            digest = sha256(name.encode()).hexdigest()
            name = f"{name[: _LONGEST_NAME - len(digest) - 8]}_sha256-{digest}"
        kind = f"{self.scheme}-{self.order}" + ("" if self.dim == 1 else f"-{self.dim}d")
        return f"{kind}/beta{_digits(self.beta)}/{name}.nc"


def _digits(number: float, digits: int = 6) -> str:
    """The number in so many digits if these say it, or else in as many as do; 0 has no sign."""
    short = f"{number + 0.0:.{digits}g}"
    return short if float(short) == number else repr(float(number))


def _encoded(text: str) -> str:
    """The text for a part of a file name: no two texts have the same."""
    return quote(text.encode("utf-8", "surrogatepass"), safe="").replace("_", "%5F")
