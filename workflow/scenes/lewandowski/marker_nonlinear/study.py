"""Nonlinear diffusion with a source by markers, Sec. 3, Figs. 17 and 18: as printed, and at a stable step."""

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.markers import SHAPES, Gaussian, MarkerVelocity, run, uniform
from fracparticles.markers.nonlinear import Lines, NonlinearDiffusion
from fracparticles.time.rkc import stages_for
from fracstudy.errors import off
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.orders import fitted_power
from fracstudy.panels import Panels
from scenes.lewandowski.marker_nonlinear.evolution import Evolution, Markers

_MARGIN = 1.5  # of the stability interval, for what the linear limit leaves out
# A scanned step is stable if F is that close to f_inf, the runs that are not are far off.
_CLOSE = 0.02


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
    apart = off(setting.field(x), exact)
    findings = [
        *_set_up(setting, half_width, apart),
        *_time_stepping(setting, runs, scans, t_final),
        *_long_time(setting, stable, [lost, lost_coarse, place]),
        _porous(max(t_final, 10.0)),
    ]
    panels = _panels(setting, printed, stable)
    _scan(panels, setting, scans, stable, scan_until)
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


def _scan(
    panels: Panels, setting: Markers, scans: list[Evolution], stable: Evolution, until: float
) -> None:
    """Panel "step": the deviation from the steady state at the time `until`, against the step."""
    for scan in scans:
        far = setting.deviation(scan.end) / setting.peak
        panels.add("step", "midpoint", scan.dt, far, stopped=bool(scan.stopped))
    far = setting.deviation(stable.at(until)) / setting.peak
    panels.add("step", "RKC2", stable.dt, far, stopped=False)
    panels.add("step", "limit", setting.limit, 0.0)


def _set_up(setting: Markers, half_width: float, apart: float) -> Iterator[Finding]:
    p, z = setting.problem, np.linspace(-half_width, half_width, 2001)
    nodes, gauss = np.polynomial.legendre.leggauss(8)
    middle, width = 0.5 * (z[:-1] + z[1:]), 0.5 * (z[1] - z[0])
    integral = width * p.source(middle[:, None] + width * nodes) @ gauss
    closed = p.cumulative_source(z)
    gap = float(np.abs(np.cumsum(integral - np.diff(closed))).max()) / float(np.abs(closed).max())
    yield measured("M-F17.steady", gap=gap)
    yield measured("M-F17.velocity", apart=apart)
    points, markers = _quadrature(p, setting.x), setting.x.size
    work = {"by quadrature from far left": points / markers, "in closed form": 1.0 / markers}
    yield measured("M-F17.integral", work=work, gap=gap, points=points, markers=markers)
    misfit = np.abs(setting.field(setting.x) - Gaussian().value(setting.x)).max()
    yield measured("M-F17.initial", misfit=misfit)


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
    apart = {name: setting.deviation(e.end, everywhere=True) / peak for name, e in titled.items()}
    last = {name: e.last for name, e in titled.items()}
    more: dict[str, Any] = {"stages": stable.stages, "dt": small.dt, "same": same}
    yield measured("M-F18.agreement", apart=apart, last=last, **more)


def _long_time(setting: Markers, stable: Evolution, lost: Sequence[float]) -> Iterator[Finding]:
    times = np.array(stable.times[1:])
    late = times >= 0.05 * stable.last
    excess = np.array([setting.excess(x) for x in stable.positions[1:]])[late]
    slope = fitted_power(times[late], excess) if late.sum() > 1 else 0.0
    part, end = lost[0] / stable.last, stable.last
    yield measured("M-F18.demonstrated", part=part, lost=lost[0], end=end)
    yield measured(
        "M-F18.long_time",
        part=part,
        lost=lost,
        slope=slope,
        excess=excess[-1] / setting.weights.sum(),
        end=end,
    )


def _porous(until: float) -> Finding:
    """f_t = (f f_x)_x from t = 1 by markers, V = -f_x, beside f = t^(-1/3) (1 - x^2 t^(-2/3) / 6) > 0."""

    def exact(x: np.ndarray, t: float) -> np.ndarray:
        return t ** (-1.0 / 3.0) * np.maximum(0.0, 1.0 - x * x * t ** (-2.0 / 3.0) / 6.0)

    markers = 128
    x, w = uniform(lambda x: exact(x, 1.0), (-math.sqrt(6.0), math.sqrt(6.0)), markers)
    velocity = MarkerVelocity(SHAPES["S8"], 0.5, lambda x, fields: -fields[0] * fields[1])
    steps = round((until - 1.0) / 0.05)
    x = run(x, w, velocity, dt=(until - 1.0) / steps, steps=steps, start=1.0).x
    z = np.linspace(-1.5, 1.5, 801) * math.sqrt(6.0) * until ** (1.0 / 3.0)
    apart = off(velocity.fields(x, w, z)[0], exact(z, until))
    return measured("M-F18.shown", apart=apart, markers=markers, until=until)
