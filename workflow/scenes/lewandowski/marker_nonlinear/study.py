"""Nonlinear diffusion with a source by markers, Sec. 3, Figs. 17 and 18: as printed, and at a stable step."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
import pandas as pd

from fracparticles.errors import NonFiniteSolution
from fracparticles.markers import SHAPES, Gaussian, MarkerVelocity, run, uniform
from fracparticles.markers.fourier import FourierMarkerVelocity
from fracparticles.markers.nonlinear import Lines, NonlinearDiffusion
from fracparticles.markers.stability import extremes
from fracparticles.time.rkc import ChebyshevStep, stages_for
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels

_MARGIN = 1.5  # of the stability interval, for what the linear limit leaves out
# A scanned step is stable if F is that close to f_inf, the runs that are not are far off.
_CLOSE = 0.02
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


def study(
    inputs: Inputs,
    *,
    problem: dict[str, float],
    half_width: float,
    markers: int,
    dt: float,
    t_final: float,
    small_dt: float,
    small_until: float,
    scan_dt: list[float],
    scan_until: float,
    times: list[float],
    compared_at: float,
    reference_times: list[float],
    lines: dict[str, Any],
) -> Result:
    """Markers beside the steady state (24), the limit of the time step, and the equation's own solution.

    The runs are the printed one, one with a smaller step, one with a stable integrator, and a scan of the step. The
    reference is `markers.nonlinear.Lines`, without markers. The linear limit of the step is eta eps^2 e / D_0.
    """
    setting = Markers(NonlinearDiffusion(**problem), half_width, markers)
    stages = stages_for(_MARGIN * 2.0 * dt / setting.limit)
    keep = [0.0, *times, compared_at]
    runs = {
        "as printed": Evolution(setting, dt).to(t_final, keep),
        "smaller step": Evolution(setting, small_dt).to(small_until, keep),
        "stable integrator": Evolution(setting, dt, stages).to(t_final, keep),
    }
    printed, _, stable = runs.values()
    scans = [Evolution(setting, s).to(scan_until) for s in scan_dt]
    half_as_many = {**lines, "cells": lines["cells"] // 2}
    reference, coarse = (Lines(setting.problem, **parts) for parts in (lines, half_as_many))
    start = Gaussian().value(reference.x)
    lost, place = reference.positivity_lost(start, t_final)
    lost_coarse, _ = coarse.positivity_lost(Gaussian().value(coarse.x), t_final)
    rows = [
        found.row(label, t)
        for label, found in runs.items()
        for t in sorted({*times, found.times[-1]})
        if t <= found.last * (1.0 + 1e-9)
    ]
    rows += [scan.row("scan of the step", scan.last) for scan in scans]
    x = stable.at(compared_at)
    exact = np.interp(x, reference.x, reference.solve(start, [compared_at])[0])
    apart = np.abs(setting.field(x) - exact).max() / np.abs(exact).max()
    findings = [
        *_set_up(setting, half_width, apart),
        *_time_stepping(setting, runs, scans, t_final),
        _long_time(setting, stable, [lost, lost_coarse, place]),
        _porous(128, max(t_final, 10.0)),
    ]
    panels = _panels(setting, printed, stable)
    for scan in scans:
        far = setting.deviation(scan.end) / setting.peak
        panels.add("step", "midpoint", scan.dt, far, stopped=bool(scan.stopped))
    far = setting.deviation(stable.at(scan_until)) / setting.peak
    panels.add("step", "RKC2", dt, far, stopped=False)
    panels.add("step", "limit", setting.limit, 0.0)
    for t, f in zip(reference_times, reference.solve(start, reference_times), strict=True):
        panels.add("lost", "lines", reference.x, f, t=t)
        if min(abs(t - s) for s in stable.times) < 0.5 * dt:
            panels.add("lost", "markers", stable.at(t), setting.field(stable.at(t)), t=t)
    panels.add("lost", "zero", place, 0.0, t=lost)
    return Result(pd.DataFrame(rows), inputs.judged(findings), panels.frame)


def _panels(setting: Markers, printed: Evolution, stable: Evolution) -> Panels:
    """Panels "profile" and "approach", and the steady state of "lost"."""
    panels, z = Panels(), np.linspace(-3.0, 3.0, 601)
    for panel in ("profile", "lost"):
        panels.add(panel, "steady", z, setting.problem.steady(z))
    panels.add("profile", "initial", setting.x, setting.field(setting.x), t=0.0)
    for label, found in (("printed", printed), ("stable", stable)):
        panels.add("profile", label, found.end, setting.field(found.end), t=found.times[-1])
    for t, x in zip(stable.times[1:], stable.positions[1:], strict=True):
        panels.add("approach", "core", t, setting.deviation(x))
        panels.add("approach", "excess", t, setting.excess(x))
    return panels


def _set_up(setting: Markers, half_width: float, off: float) -> Iterator[Finding]:
    p, z = setting.problem, np.linspace(-half_width, half_width, 2001)
    nodes, gauss = np.polynomial.legendre.leggauss(8)
    middle, width = 0.5 * (z[:-1] + z[1:]), 0.5 * (z[1] - z[0])
    integral = width * p.source(middle[:, None] + width * nodes) @ gauss
    closed = p.cumulative_source(z)
    gap = float(np.abs(np.cumsum(integral - np.diff(closed))).max()) / float(np.abs(closed).max())
    yield measured("M-F17.steady", gap=gap)
    yield measured("M-F17.velocity", apart=off)
    points, markers = _quadrature(p, setting.x), setting.x.size
    work = {"by quadrature from far left": points / markers, "in closed form": 1.0 / markers}
    yield measured("M-F17.integral", work=work, gap=gap, points=points, markers=markers)
    misfit = np.abs(setting.field(setting.x) - Gaussian().value(setting.x)).max()
    yield measured("M-F17.initial", misfit=misfit, epsilon=setting.epsilon)


def _quadrature(p: NonlinearDiffusion, x: np.ndarray, left: float = -4.0) -> int:
    """How many Gauss points from far left give (23) at every marker to a thousandth of its maximum."""
    exact = p.cumulative_source(x)
    half = 0.5 * (x - left)[:, None]
    for points in range(8, 200, 4):
        nodes, gauss = np.polynomial.legendre.leggauss(points)
        integral = half[:, 0] * (p.source(left + half * (1.0 + nodes)) @ gauss)
        if np.abs(integral - exact).max() < 1e-3 * np.abs(exact).max():
            break
    return points


def _time_stepping(
    setting: Markers, runs: dict[str, Evolution], scans: list[Evolution], t_final: float
) -> Iterator[Finding]:
    printed, small, stable = runs.values()
    peak = setting.peak
    good = [e.dt for e in scans if not e.stopped and setting.deviation(e.end) < _CLOSE * peak]
    same = max(
        abs(setting.deviation(small.at(t)) - setting.deviation(stable.at(t)))
        for t in set(np.round(small.times, 9)) & set(np.round(stable.times, 9))
    )
    yield measured(
        "M-F18.time_step",
        apart=setting.deviation(printed.end) / peak,
        left=1.0 - printed.last / t_final,
        last=printed.last,
        overtaking=printed.overtaking,
        limit=setting.limit,
        good=max(good, default=0.0),
        bad=min((e.dt for e in scans if e.dt not in good), default=0.0),
    )
    titled = {
        "as printed, midpoint rule": printed,
        "midpoint rule at a smaller step": small,
        "stabilised integrator": stable,
    }
    off = {name: setting.deviation(e.end, everywhere=True) / peak for name, e in titled.items()}
    last = {name: e.last for name, e in titled.items()}
    more: dict[str, Any] = {"stages": stable.stages, "dt": small.dt, "same": same}
    yield measured("M-F18.agreement", apart=off, last=last, **more)


def _long_time(setting: Markers, stable: Evolution, lost: Sequence[float]) -> Finding:
    times = np.array(stable.times[1:])
    late = times >= 0.05 * stable.last
    excess = np.array([setting.excess(x) for x in stable.positions[1:]])[late]
    slope = np.polyfit(np.log(times[late]), np.log(excess), 1)[0] if late.sum() > 1 else 0.0
    return measured(
        "M-F18.long_time",
        part=lost[0] / stable.last,
        lost=lost,
        slope=slope,
        excess=excess[-1] / setting.weights.sum(),
        end=stable.last,
    )


def _porous(markers: int, until: float) -> Finding:
    """f_t = (f f_x)_x from t = 1 by markers, V = -f_x, beside f = t^(-1/3) (1 - x^2 t^(-2/3) / 6) > 0."""

    def exact(x: np.ndarray, t: float) -> np.ndarray:
        return t ** (-1.0 / 3.0) * np.maximum(0.0, 1.0 - x * x * t ** (-2.0 / 3.0) / 6.0)

    x, w = uniform(lambda x: exact(x, 1.0), (-math.sqrt(6.0), math.sqrt(6.0)), markers)
    velocity = MarkerVelocity(SHAPES["S8"], 0.5, lambda x, fields: -fields[0] * fields[1])
    steps = round((until - 1.0) / 0.05)
    x = run(x, w, velocity, dt=(until - 1.0) / steps, steps=steps, start=1.0).x
    z = np.linspace(-1.5, 1.5, 801) * math.sqrt(6.0) * until ** (1.0 / 3.0)
    f = exact(z, until)
    gap = np.abs(velocity.fields(x, w, z)[0] - f)
    return measured("M-F18.shown", apart=gap.max() / f.max(), markers=markers, until=until)
