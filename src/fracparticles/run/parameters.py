"""The parameters of a run, each with what it means, and what follows from them."""

from __future__ import annotations

from functools import cached_property
from math import ceil
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from fracparticles.schemes import Setting
from fracparticles.schemes.stability import stability_limit, symbol_range
from fracparticles.special.stable import mean_radius
from fracparticles.time import STEP_POLYNOMIALS

__all__ = ["FUNDAMENTAL", "OVERLAPS", "SIZES", "Parameters"]

FUNDAMENTAL = "fundamental"
SIZES = 1e-100, 1e100  # lengths and times; nothing made of them overflows
OVERLAPS = 0.25, 1000.0
_STEP_SLACK = 1e-9  # a time span of n (1 + 1e-9) steps still takes n steps

SchemeName = Literal["DD", "DPSE", "FPSE", "KPSE", "GPSE", "DVM", "FD", "PSE29", "RIESZ"]


class Parameters(BaseModel):
    """What a `Case` holds; see there. Not checked here against each other."""

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
