"""Particles that move and exchange, with a source, between two placements:

    u_t + (a u)_x = C int (D(x) + D(y)) / 2 (u(y) - u(x)) |x - y|^(-1-alpha) dy + f(x, t, u).

Particles are carried along, dx_i/dt = a(x_i, t), and with them strengths U_i = V_i u_i,

    dU_i/dt = V_i sum_j K_ij V_j (u_j - u_i) + V_i f(x_i, t, u_i),   V_i = V_i(0) (dx/ds)_i / (dx/ds)_i(0),

s the variable of the map, which the particles keep. One step of Strang's splitting is half of the source, the exchange
where the particles are half-way, exactly in time (`flow`), and half of the source. It is symmetric, so that n of them
err by a series in n^(-2), which is extrapolated,

    T_(n,1) = n steps,   T_(n,k+1) = T_(n,k) + (T_(n,k) - T_(n-1,k)) / ((n / (n - k))^2 - 1),   n = 1, 2, ..,

until T_(n,n) and T_(n,n-1) are close. Where 6 steps do not do, the time is halved. Sums are kept by each of them: sum U
changes by the source alone. With neither velocity nor source one step is exact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import count

import numpy as np
from scipy.integrate import solve_ivp

from fracparticles import arguments as check
from fracparticles.adaptive.flow import ExchangeFlow
from fracparticles.adaptive.placement import LineParticles
from fracparticles.adaptive.transfer import slopes
from fracparticles.arguments import FloatArray
from fracparticles.errors import InvalidInput, NonFiniteSolution

__all__ = ["Physics", "Splitting"]

_MOST_STEPS = 6  # of an interval, and so the rows of its extrapolation
_HALVINGS = 12  # of an interval for which these steps are not enough
_PARTS = 2  # of the classical Runge-Kutta scheme, in each half of the source
_MOST_CALLS = 5000  # of the velocity, from one placement to the next
_ALONG = 1e-9  # of the volumes: how closely the paths of particles are followed


@dataclass(frozen=True)
class Physics:
    """What the particles do; None for nothing.

    Attributes
    ----------
    alpha : float
    near : int
    diffusivity : float or callable
        D, or D(x).
    velocity : callable, optional
        a(x, t).
    source : callable, optional
        f(x, t, u).
    """

    alpha: float
    near: int
    diffusivity: float | Callable[[FloatArray], FloatArray]
    velocity: Callable[[FloatArray, float], FloatArray] | None = None
    source: Callable[[FloatArray, float, FloatArray], FloatArray] | None = None

    def diffusivity_at(self, x: FloatArray) -> FloatArray:
        """Return D at these places. Raises `InvalidInput` if it is not finite, or negative."""
        if not callable(self.diffusivity):
            return np.full(x.size, self.diffusivity)
        return check.within("diffusivity", check.sampled("diffusivity", self.diffusivity, x), 0.0)

    def velocity_at(self, x: FloatArray, t: float) -> FloatArray:
        """Return a at these places. Raises `InvalidInput` if it is not finite."""
        if self.velocity is None:
            return np.zeros(x.size)
        return check.sampled("velocity", self.velocity, x, np.asarray(t))

    def source_at(self, x: FloatArray, t: float, u: FloatArray) -> FloatArray:
        """Return f at these places. Raises `InvalidInput` if it is not finite."""
        if self.source is None:
            return np.zeros(x.size)
        return check.sampled("source", self.source, x, np.asarray(t), u)

    @property
    def is_diffusion(self) -> bool:
        """Whether there is neither velocity nor source."""
        return self.velocity is None and self.source is None


@dataclass
class Splitting:
    """The step from one time to another.

    Attributes
    ----------
    physics : Physics
    tolerance : float
        Share of sum |U| within which T_(n,n) and T_(n,n-1) are.
    """

    physics: Physics
    tolerance: float
    _still: tuple[LineParticles, ExchangeFlow] | None = field(default=None, repr=False)

    def __call__(
        self, particles: LineParticles, u: FloatArray, start: float, end: float
    ) -> tuple[LineParticles, FloatArray]:
        """Return the particles and u at the end, from those at the start.

        Raises
        ------
        NonFiniteSolution
            If u becomes infinite, particles meet, or the time would be halved too often.
        InvalidInput
            If a coefficient is not finite there.
        """
        if self.physics.is_diffusion:
            return particles, self._flow(particles)(u, end - start)
        return self._advance(particles, particles.volumes * u, start, end, _HALVINGS)

    def _advance(
        self, particles: LineParticles, strength: FloatArray, start: float, end: float, more: int
    ) -> tuple[LineParticles, FloatArray]:
        path = _Path(particles, self.physics, start, end)
        row: list[FloatArray] = []
        for n in range(1, _MOST_STEPS + 1):
            with np.errstate(over="ignore", invalid="ignore"):
                above, row = row, [self._steps(path, strength, n)]
            if not np.isfinite(row[0]).all():
                break  # shorter steps may do
            for k, last in enumerate(above, start=1):
                row.append(row[-1] + (row[-1] - last) / ((n / (n - k)) ** 2 - 1.0))
            if n > 2 and np.abs(row[-1] - row[-2]).sum() <= self.tolerance * np.abs(row[-1]).sum():
                there = path(end)
                return there, row[-1] / there.volumes
        if not more:
            raise NonFiniteSolution(
                f"u changes too fast near t = {start:.6g}: steps of {end - start:.3g} do not meet the tolerance. "
                "The solution may blow up; else take a larger tolerance."
            )
        middle = 0.5 * (start + end)
        particles, u = self._advance(particles, strength, start, middle, more - 1)
        return self._advance(particles, particles.volumes * u, middle, end, more - 1)

    def _steps(self, path: _Path, strength: FloatArray, count: int) -> FloatArray:
        times = np.linspace(path.start, path.end, 2 * count + 1).tolist()
        for before, half, after in zip(times[:-2:2], times[1::2], times[2::2], strict=True):
            strength = self._sourced(path, strength, before, half)
            if not np.isfinite(strength).all():
                return strength
            middle = path(half)
            strength = middle.volumes * self._flow(middle)(
                strength / middle.volumes, after - before
            )
            strength = self._sourced(path, strength, half, after)
        return strength

    def _sourced(self, path: _Path, strength: FloatArray, start: float, end: float) -> FloatArray:
        """The classical Runge-Kutta scheme for dU/dt = V f, along the paths."""
        if self.physics.source is None:
            return strength
        times = np.linspace(start, end, 2 * _PARTS + 1)
        dt = (end - start) / _PARTS

        def rate(t: float, strength: FloatArray) -> FloatArray:
            if not np.isfinite(strength).all():
                return np.full(strength.size, np.nan)
            at = path(t)
            try:
                return at.volumes * self.physics.source_at(at.x, t, strength / at.volumes)
            except InvalidInput:  # it is finite at the start: the step is too long, or u blows up
                return np.full(strength.size, np.nan)

        for before, half, after in zip(times[:-2:2], times[1::2], times[2::2], strict=True):
            first = rate(before, strength)
            second = rate(half, strength + 0.5 * dt * first)
            third = rate(half, strength + 0.5 * dt * second)
            fourth = rate(after, strength + dt * third)
            strength = strength + dt / 6.0 * (first + 2.0 * (second + third) + fourth)
        return strength

    def _flow(self, particles: LineParticles) -> ExchangeFlow:
        """Kept as long as the particles do not move."""
        if self._still is None or self._still[0] is not particles:
            physics = self.physics
            flow = ExchangeFlow(
                particles, physics.alpha, physics.near, physics.diffusivity_at(particles.x)
            )
            self._still = particles, flow
        return self._still[1]


class _Path:
    """Where the particles are, and what they stand for, from one time to another."""

    def __init__(
        self, particles: LineParticles, physics: Physics, start: float, end: float
    ) -> None:
        self.start, self.end = start, end
        self._known = {start: particles}
        self._particles, self._moves = particles, physics.velocity is not None
        if self._moves:
            calls = count()

            def velocity(t: float, x: FloatArray) -> FloatArray:
                if next(calls) > _MOST_CALLS:
                    raise NonFiniteSolution(
                        f"the velocity is too rough to be followed near t = {t:.6g}"
                    )
                return physics.velocity_at(x, t)

            run = solve_ivp(
                velocity, (start, end), particles.x,
                method="DOP853", dense_output=True, rtol=1e-13, atol=_ALONG * particles.volumes,
            )  # fmt: skip
            if run.status != 0:
                raise NonFiniteSolution(f"particles cannot be followed after t = {run.t[-1]:.6g}")
            self._places = run.sol
            self._slopes = slopes(particles.x)

    def __call__(self, t: float) -> LineParticles:
        if not self._moves:
            return self._particles
        if t not in self._known:
            x = self._places(t)
            stretched = slopes(x) / self._slopes
            if not (np.diff(x).min() > 0.0 and stretched.min() > 0.0):
                raise NonFiniteSolution(f"particles meet before t = {t:.6g}")
            volumes = self._particles.volumes * stretched
            self._known[t] = replace(self._particles, x=x, volumes=volumes)
        return self._known[t]
