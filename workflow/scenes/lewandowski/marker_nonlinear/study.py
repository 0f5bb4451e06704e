"""Nonlinear diffusion with a source by markers, Sec. 3, Figs. 17 and 18: as printed, and at a stable step."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.errors import NonFiniteSolution
from fracparticles.markers import SHAPES, Gaussian, run, uniform
from fracparticles.markers.fourier import FourierMarkerVelocity
from fracparticles.markers.nonlinear import Lines, NonlinearDiffusion
from fracparticles.markers.stability import extremes
from fracparticles.time.rkc import ChebyshevStep, stages_for
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from fracstudy.panels import Panels

__all__ = ["Evolution", "Markers", "study"]

_EXCELLENT = 0.01  # of the peak: cannot be seen in a figure
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

    def to(self, until: float, keep: Iterable[float] = ()) -> Evolution:
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
    without = (
        f"A solution of (20) without markers ({reference.x.size} cells) stays positive until t = {lost:.4g} (half as "
        f"many cells: {lost_coarse:.4g}), when it vanishes at |x| = {place:.4g}. The markers agree with it to "
        f"{np.abs(setting.field(x) - exact).max():.1e} at t = {compared_at:g}."
    )
    findings = [
        *_set_up(setting, half_width),
        *_time_stepping(setting, runs, scans, t_final),
        _long_time(setting, stable, without, lost > t_final),
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


def _set_up(setting: Markers, half_width: float) -> Iterator[Finding]:
    p, z = setting.problem, np.linspace(-half_width, half_width, 2001)
    nodes, gauss = np.polynomial.legendre.leggauss(8)
    middle, width = 0.5 * (z[:-1] + z[1:]), 0.5 * (z[1] - z[0])
    integral = width * p.source(middle[:, None] + width * nodes) @ gauss
    closed = p.cumulative_source(z)
    gap = float(np.abs(np.cumsum(integral - np.diff(closed))).max()) / float(np.abs(closed).max())
    misfit = float(np.abs(setting.field(setting.x) - Gaussian().value(setting.x)).max())
    said = f"int Q dx (by quadrature) and -D(f_inf) f_inf' differ by {gap:.1e} of their maximum"
    yield statement(
        "M-F17.steady",
        gap < 1e-9,
        f"{said}: the flux D f_x + S^ vanishes where f = f_inf.",
        "The source does not balance the diffusion of (24).",
    )
    yield statement(
        "M-F17.integral",
        gap > 1e-9,
        f"{said}: (23) has a closed form, and takes no table.",
        "(21) is the derivative of -D(f_inf) f_inf': the integral (23) is known wherever f_inf is.",
    )
    yield statement(
        "M-F17.initial",
        misfit < _EXCELLENT,
        f"{setting.x.size} markers at equal distances with eps = h^(1/2) = {setting.epsilon:.4f}: F differs from "
        f"exp(-x^2) by {misfit:.1e} at most at the markers.",
        "The markers do not represent the initial profile.",
    )


def _time_stepping(
    setting: Markers, runs: dict[str, Evolution], scans: list[Evolution], t_final: float
) -> Iterator[Finding]:
    printed, small, stable = runs.values()
    peak = setting.peak
    far = setting.deviation(printed.end) / peak
    good = [e.dt for e in scans if not e.stopped and setting.deviation(e.end) < _CLOSE * peak]
    below = max(good, default=0.0)
    above = min((e.dt for e in scans if e.dt not in good), default=math.inf)
    ended = f"is off f_inf by {100 * far:.0f} % of the peak at t = {printed.times[-1]:g}"
    if printed.stopped:
        ended = f"stops after t = {printed.last:.2g}, when F is no longer positive at a marker"
    worst = setting.deviation(stable.end, everywhere=True) / peak
    core = setting.deviation(stable.end) / peak
    same = max(
        abs(setting.deviation(small.at(t)) - setting.deviation(stable.at(t)))
        for t in set(np.round(small.times, 9)) & set(np.round(stable.times, 9))
    )
    yield statement(
        "M-F18.time_step",
        not printed.stopped and far < _EXCELLENT,
        f"The midpoint rule with dt = {printed.dt:g} {ended}, after {printed.overtaking} steps in which markers "
        f"overtook one another. It works up to dt = {below:g}, not from {above:g} on.",
        f"dt is above the explicit limit eta eps^2 / max D = eta eps^2 e / D_0 = {setting.limit:.3g}, the one of "
        f"Sec. 2.3 at the largest D; the scan finds it between {below:g} and {above:g}.",
    )
    yield statement(
        "M-F18.agreement",
        not stable.stopped and stable.last >= 0.999 * t_final and worst < _EXCELLENT,
        f"With RKC2 of {stable.stages} stages at dt = {stable.dt:g}, F at the markers is within "
        f"{100 * worst:.2g} % of the peak of f_inf at t = {stable.last:g}, in the core within {100 * core:.2g} %; "
        f"the midpoint rule at dt = {small.dt:g} agrees with it to {same:.1e} up to t = {small.last:g}.",
        f"F is off f_inf by {100 * worst:.2g} % of the peak.",
    )


def _long_time(setting: Markers, stable: Evolution, evidence: str, positive: bool) -> Finding:
    times = np.array(stable.times[1:])
    late = times >= 0.05 * stable.last
    if late.sum() > 1:
        excess = np.array([setting.excess(x) for x in stable.positions[1:]])[late]
        slope = np.polyfit(np.log(times[late]), np.log(excess), 1)[0]
        evidence += (
            f" Beyond, what they hold in the flanks falls like t^{slope:.2f}; it is "
            f"{excess[-1] / setting.weights.sum():.1e} of the total at t = {stable.last:g}."
        )
    return statement(
        "M-F18.long_time",
        positive,
        evidence,
        "With the initial profile (25) the sink Q < 0 in the flanks drives the solution of (20) through zero, where "
        "D < 0 and the equation is ill-posed: there is no long-time behaviour to determine. Markers keep their weights "
        "and cannot follow; those left outside spread without end, as slowly as t^(1/4), so that f_inf is approached "
        "by a power of t only.",
    )
