"""The quantities that follow from the parameters of a run: its particles, its steps, and the scheme on its lattice."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from fracparticles.graded.particles import graded_particles
from fracparticles.moving.dvm import largest_gap
from fracparticles.moving.lagrangian import REMESHING, THRESHOLD
from fracparticles.run.parameters import Parameters
from fracparticles.run.times import legs, steps_in
from fracparticles.schemes import ALL_SCHEMES, Scheme, Setting
from fracparticles.schemes.stability import stability_limit, symbol_range
from fracparticles.special.stable import mean_radius
from fracparticles.time import STEP_POLYNOMIALS

__all__ = ["Derived"]


class Derived(Parameters):
    """Parameters, and the quantities that follow from them. They are not checked here against each other."""

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
        """The length that the spacing divides: the half-width D, or for graded particles the end L arcsinh(D / L)."""
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
        """The realised spacing h = D / n; for graded particles the spacing in the middle."""
        return self.extent / self.n

    @property
    def x(self) -> np.ndarray:
        """The particle positions along one axis, shape (2 n + 1,)."""
        if self.graded_scale is not None:
            return graded_particles(self.particles, self.reach, self.graded_scale)[0]
        return np.arange(-self.n, self.n + 1) * self.particle_spacing

    @property
    def volumes(self) -> np.ndarray | float:
        """The particle volumes V_i: on a lattice one number for all, h^dim, and for graded particles one for each."""
        if self.graded_scale is not None:
            return graded_particles(self.particles, self.reach, self.graded_scale)[1]
        return float(self.particle_spacing**self.dim)

    def integral(self, values: np.ndarray) -> float:
        """Return sum_i V_i f_i from the values at the particles, to a few ulp, since numpy sums pairwise."""
        volumes = self.volumes
        with np.errstate(over="ignore"):  # an overflow gives infinity
            if isinstance(volumes, float):
                return float(volumes * values.sum())
            return float((volumes * values).sum())

    @property
    def positions(self) -> list[np.ndarray]:
        """The coordinates of the particles, `dim` arrays that broadcast to `shape`."""
        return list(np.meshgrid(*(self.x,) * self.dim, indexing="ij", sparse=True))

    @property
    def radius(self) -> np.ndarray:
        """The distances |x| of the particles from the origin, shape `shape`."""
        if self.dim == 1:
            return np.abs(self.x)  # does not underflow
        return np.sqrt(sum(np.square(part) for part in self.positions))

    @property
    def error_radius(self) -> float:
        """The errors are taken over |x| <= 5 R_alpha (47) for dim = 1, over |x| <= 5 (59) otherwise, or the lattice.

        These radii hold for the papers' D t_f = 1.5. For another D t_f they grow with the solution, like
        (D t_f)^(1/alpha), so that the error does not depend on the units.
        """
        half = 5.0 * mean_radius(self.alpha) if self.dim == 1 else 5.0
        spread = (self.diffusivity * self.t_final / 1.5) ** (1.0 / self.alpha)
        return min(half * spread, self.reach)

    @property
    def kind(self) -> Scheme:
        """The scheme itself."""
        return ALL_SCHEMES[self.scheme]

    @property
    def resolved_integrator(self) -> str:
        """The integrator, given or by default."""
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
        """The step from each output time to the next, and the number of these steps."""
        return legs(self)

    @property
    def resolved_dt(self) -> float:
        """The step asked for: dt, or for GPSE that of its overlap, Eq. (40); for graded particles the whole span."""
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
        """The parameters by which DVM treats particles that are too far apart or too weak, given or by default."""
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
        """Whether `evaluation` says "series" and changes nothing: all but single Euler steps are series by default."""
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
