"""Runs of the markers of nonlinear diffusion, and what is measured of them."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np

from fracparticles.errors import NonFiniteSolution
from fracparticles.markers import SHAPES, Gaussian, run, uniform
from fracparticles.markers.fourier import FourierMarkerVelocity
from fracparticles.markers.nonlinear import NonlinearDiffusion
from fracparticles.markers.stability import extremes
from fracparticles.time.rkc import ChebyshevStep

_CORE, _FLANK = 1.2, 1.7  # |x|: within, F is compared with f_inf; beyond, f reaches zero


class Markers:
    """The markers at equal distances h with epsilon = h^(1/2), and what is measured of them.

    `limit` is that of the time step by the linear equation at the largest D, eta eps^2 e / D_0.
    """

    def __init__(self, problem: NonlinearDiffusion, half_width: float, markers: int) -> None:
        self.problem = problem
        self.x, self.weights = uniform(Gaussian().value, (-half_width, half_width), markers)
        self.epsilon = math.sqrt(2.0 * half_width / markers)
        self.limit = problem.step_limit(self.epsilon, extremes(SHAPES["S8"]).eta)
        self._velocity = self.velocity()
        self.peak = float(problem.steady(self.x).max())

    def velocity(self) -> FourierMarkerVelocity:
        """Return a new velocity: the box of its transforms, and so the round-off, depends on what it did before."""
        return FourierMarkerVelocity(self.epsilon, self.problem.flux)

    def field(self, x: np.ndarray) -> np.ndarray:
        """Return F at the markers when they are at x."""
        return self._velocity.fields(x, self.weights)[0]

    def deviation(self, x: np.ndarray, everywhere: bool = False) -> float:
        """Return max |F - f_inf| at the markers, those in the core or all."""
        gap = np.abs(self.field(x) - self.problem.steady(x))
        return float(gap.max() if everywhere else gap[np.abs(x) < _CORE].max(initial=0.0))

    def excess(self, x: np.ndarray) -> float:
        """Return what the markers have in the flanks, less what f_inf has there."""
        there = self.weights[np.abs(x) > _FLANK].sum()
        return float(there - self.problem.steady_beyond(_FLANK))


@dataclass
class Evolution:
    """A run: its markers at some times, and why it stopped if it did.

    It is by the midpoint rule, or by RKC2 if `stages` are given.
    """

    markers: Markers
    dt: float
    stages: int | None = None
    times: list[float] = field(default_factory=list)
    positions: list[np.ndarray] = field(default_factory=list)
    last: float = 0.0
    overtaking: int = 0
    stopped: str = ""

    @property
    def end(self) -> np.ndarray:
        """The markers at the last time that was kept."""
        return self.positions[-1]

    def at(self, t: float) -> np.ndarray:
        """The markers at the time kept nearest to t."""
        return self.positions[int(np.argmin(np.abs(np.array(self.times) - t)))]

    def to(self, until: float, keep: Iterable[float] = ()) -> Self:
        """Run, and keep the markers at these times, at the end, and where the run stops."""
        wanted = np.sort([t for t in {*keep, until} if t <= until * (1.0 + 1e-9)])
        x, weights, velocity = self.markers.x, self.markers.weights, self.markers.velocity()
        order, latest = np.argsort(x), x

        def keep_now() -> None:
            self.times.append(self.last)
            self.positions.append(latest)

        def observe(t: float, x: np.ndarray, _: Any = None) -> None:
            nonlocal latest
            self.overtaking += int((np.diff(x[order]) < 0.0).any())
            order[:] = np.argsort(x)
            self.last, latest = t, x  # both integrators make a new array in every step
            if np.abs(wanted - t).min() < 0.5 * self.dt:
                keep_now()

        how: dict[str, Any] = {"dt": self.dt, "steps": round(until / self.dt), "observe": observe}
        try:
            if self.stages is None:
                run(x, weights, velocity, **how)
            else:
                ChebyshevStep(self.stages).advance(lambda x: velocity(x, weights), x, **how)
        except NonFiniteSolution as error:
            self.stopped = str(error)
            keep_now()
        return self

    def row(self, label: str, t: float) -> dict[str, Any]:
        """Return a row of the table."""
        x, stages = self.at(t), self.stages
        return {
            "run": label,
            "integrator": f"RKC2, {stages} stages" if stages else "midpoint",
            "dt": self.dt,
            "t": t,
            "max |F - f_inf|, core": self.markers.deviation(x),
            "max |F - f_inf|, all markers": self.markers.deviation(x, everywhere=True),
            "excess in the flanks": self.markers.excess(x),
            "outermost marker": float(np.abs(x).max()),
            "steps with overtaking": self.overtaking,
            "evaluations": round(t / self.dt) * (stages or 2),
            "stopped": self.stopped.split(":")[0],
        }
