"""Nonlinear diffusion with a source by markers, Sec. 3, Figs. 17 and 18: as printed, and at a stable step."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
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

__all__ = ["Setting", "evolve", "study"]

_EXCELLENT = 0.01  # of the peak: cannot be seen in a figure
_MARGIN = 1.5  # of the stability interval, for what the linear limit leaves out
_CLOSE = (
    0.02  # a scanned step is stable if F is that close to f_inf, the runs that are not are far off
)
_MIDPOINT = "midpoint"


@dataclass(frozen=True)
class Setting:
    """The parameters of the scene, and what follows from them."""

    parameters: Mapping[str, Any]
    problem: NonlinearDiffusion
    x: np.ndarray
    weights: np.ndarray
    velocity: FourierMarkerVelocity
    limit: float

    @classmethod
    def of(cls, parameters: Mapping[str, Any]) -> Setting:
        """Load the markers at equal distances h, with epsilon = h^(1/2)."""
        problem = NonlinearDiffusion(**parameters["problem"])
        half, count = float(parameters["half_width"]), int(parameters["markers"])
        x, weights = uniform(Gaussian().value, (-half, half), count)
        epsilon = math.sqrt(2.0 * half / count)
        limit = problem.step_limit(epsilon, extremes(SHAPES["S8"]).eta)
        velocity = FourierMarkerVelocity(epsilon, problem.flux)
        return cls(parameters, problem, x, weights, velocity, limit)

    def deviation(self, x: np.ndarray, everywhere: bool = False) -> float:
        """Return max |F - f_inf| at the markers, those in the core or all."""
        gap = np.abs(self.velocity.fields(x, self.weights)[0] - self.problem.steady(x))
        core = np.abs(x) < float(self.parameters["core"])
        return float(gap.max() if everywhere else gap[core].max(initial=0.0))

    def excess(self, x: np.ndarray) -> float:
        """Return what the markers have beyond |x| = `flank`, less what f_inf has there."""
        c, p = float(self.parameters["flank"]), self.problem
        root = math.sqrt(p.alpha)
        steady = math.sqrt(math.pi) / root * sum(math.erfc(root * (c + s * p.x0)) for s in (1, -1))
        return float(self.weights[np.abs(x) > c].sum() - steady)


@dataclass
class Evolution:
    """A run: its markers at some times, and why it stopped if it did."""

    label: str
    integrator: str
    dt: float
    stages: int
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


def evolve(
    setting: Setting,
    label: str,
    dt: float,
    until: float,
    keep: Sequence[float],
    stages: int | None = None,
) -> Evolution:
    """Run the markers by the midpoint rule, or by RKC2 if `stages` are given, and keep them at times."""
    integrator = _MIDPOINT if stages is None else "RKC2"
    found = Evolution(label, integrator, dt, stages or 2)
    wanted = np.sort([t for t in {*keep, until} if t <= until * (1.0 + 1e-9)])

    # A velocity of its own: the box of its transforms, and so the round-off, depends on what it did before.
    velocity = FourierMarkerVelocity(setting.velocity.epsilon, setting.problem.flux)
    order, latest = np.argsort(setting.x), setting.x

    def keep_now() -> None:
        found.times.append(found.last)
        found.positions.append(latest)

    def observe(t: float, x: np.ndarray, _: Any = None) -> None:
        nonlocal latest
        found.overtaking += int((np.diff(x[order]) < 0.0).any())
        order[:] = np.argsort(x)
        found.last, latest = t, x  # both integrators make a new array in every step
        if np.abs(wanted - t).min() < 0.5 * dt:
            keep_now()

    steps = round(until / dt)
    try:
        if stages is None:
            run(setting.x, setting.weights, velocity, dt=dt, steps=steps, observe=observe)
        else:
            ChebyshevStep(stages).advance(
                lambda x: velocity(x, setting.weights), setting.x, dt=dt, steps=steps,
                observe=observe,
            )  # fmt: skip
    except NonFiniteSolution as error:
        found.stopped = str(error)
        keep_now()
    return found


def study(inputs: Inputs) -> Result:
    """Markers beside the steady state (24), the limit of the time step, and the equation's own solution.

    The reference is `markers.nonlinear.Lines`, without markers. The linear limit of the step is eta eps^2 e / D_0.
    """
    p = inputs.parameters
    setting = Setting.of(p)
    dt, until = float(p["dt"]), float(p["t_final"])
    stages = stages_for(_MARGIN * 2.0 * dt / setting.limit)
    keep = [0.0, *map(float, p["times"]), float(p["compared_at"])]
    printed = evolve(setting, "as printed", dt, until, keep)
    small = evolve(setting, "smaller step", float(p["small_dt"]), float(p["small_until"]), keep)
    stable = evolve(setting, "stable integrator", dt, until, keep, stages)
    scans = [
        evolve(setting, "scan of the step", float(s), float(p["scan_until"]), [])
        for s in p["scan_dt"]
    ]
    reference = _Reference.of(setting)
    rows = [
        _row(setting, e, t)
        for e in (printed, small, stable)
        for t in sorted({*map(float, p["times"]), e.times[-1]})
        if t <= e.last * (1.0 + 1e-9)
    ] + [_row(setting, e, e.last) for e in scans]
    findings = [
        *_set_up(setting),
        *_time_stepping(setting, printed, small, stable, scans),
        _long_time(setting, stable, reference),
    ]
    series = _series(setting, printed, stable, scans, reference)
    return Result(pd.DataFrame(rows), findings, series)


@dataclass(frozen=True)
class _Reference:
    """The solution without markers, until it vanishes somewhere."""

    lines: Lines
    lost: float
    place: float
    lost_coarse: float
    times: list[float]
    profiles: np.ndarray

    @classmethod
    def of(cls, setting: Setting) -> _Reference:
        q = setting.parameters["lines"]
        cells, half = int(q["cells"]), float(q["half_width"])
        lines, coarse = (
            Lines(setting.problem, half, n, float(q["within"])) for n in (cells, cells // 2)
        )
        until = float(setting.parameters["t_final"])
        lost, place = lines.positivity_lost(Gaussian().value(lines.x), until)
        lost_coarse, _ = coarse.positivity_lost(Gaussian().value(coarse.x), until)
        times = [*map(float, setting.parameters["reference_times"])]
        profiles = lines.solve(Gaussian().value(lines.x), times)
        return cls(lines, lost, place, lost_coarse, times, profiles)


def _row(setting: Setting, e: Evolution, t: float) -> dict[str, Any]:
    x = e.at(t)
    evaluations = round(t / e.dt) * e.stages
    return {
        "run": e.label,
        "integrator": e.integrator if e.integrator == _MIDPOINT else f"RKC2, {e.stages} stages",
        "dt": e.dt,
        "t": t,
        "max |F - f_inf|, core": setting.deviation(x),
        "max |F - f_inf|, all markers": setting.deviation(x, everywhere=True),
        "excess in the flanks": setting.excess(x),
        "outermost marker": float(np.abs(x).max()),
        "steps with overtaking": e.overtaking,
        "evaluations": evaluations,
        "stopped": e.stopped.split(":")[0],
    }


def _set_up(setting: Setting) -> list[Finding]:
    p, half = setting.problem, float(setting.parameters["half_width"])
    z = np.linspace(-half, half, 2001)
    nodes, gauss = np.polynomial.legendre.leggauss(8)
    middle, width = 0.5 * (z[:-1] + z[1:]), 0.5 * (z[1] - z[0])
    integral = width * p.source(middle[:, None] + width * nodes) @ gauss
    closed = np.diff(p.cumulative_source(z))
    scale = float(np.abs(p.cumulative_source(z)).max())
    gap = float(np.abs(np.cumsum(integral - closed)).max()) / scale
    f0, loaded = Gaussian().value(setting.x), setting.velocity.fields(setting.x, setting.weights)[0]
    misfit = float(np.abs(loaded - f0).max())
    said = f"int Q dx (by quadrature) and -D(f_inf) f_inf' differ by {gap:.1e} of their maximum"
    return [
        statement(
            "M-F17.steady",
            gap < 1e-9,
            f"{said}: the flux D f_x + S^ vanishes where f = f_inf.",
            "The source does not balance the diffusion of (24).",
        ),
        statement(
            "M-F17.integral",
            gap > 1e-9,
            f"{said}: (23) has a closed form, and takes no table.",
            "(21) is the derivative of -D(f_inf) f_inf': the integral (23) is known wherever f_inf is.",
        ),
        statement(
            "M-F17.initial",
            misfit < _EXCELLENT,
            f"{setting.x.size} markers at equal distances with eps = h^(1/2) = "
            f"{setting.velocity.epsilon:.4f}: F differs from exp(-x^2) by {misfit:.1e} at most at the markers.",
            "The markers do not represent the initial profile.",
        ),
    ]


def _time_stepping(
    setting: Setting,
    printed: Evolution,
    small: Evolution,
    stable: Evolution,
    scans: Sequence[Evolution],
) -> list[Finding]:
    peak = float(setting.problem.steady(setting.x).max())
    far = setting.deviation(printed.end) / peak
    good = [e.dt for e in scans if not e.stopped and setting.deviation(e.end) < _CLOSE * peak]
    below, above = (
        max(good, default=0.0),
        min((e.dt for e in scans if e.dt not in good), default=math.inf),
    )
    ended = f"stops after t = {printed.last:.2g}, when F is no longer positive at a marker" if printed.stopped else (
        f"is off f_inf by {100 * far:.0f} % of the peak at t = {printed.times[-1]:g}"
    )  # fmt: skip
    worst = setting.deviation(stable.end, everywhere=True) / peak
    reached = bool(
        not stable.stopped and stable.last >= 0.999 * float(setting.parameters["t_final"])
    )
    same = max(
        abs(setting.deviation(small.at(t)) - setting.deviation(stable.at(t)))
        for t in set(np.round(small.times, 9)) & set(np.round(stable.times, 9))
    )
    return [
        statement(
            "M-F18.time_step",
            not printed.stopped and far < _EXCELLENT,
            f"The midpoint rule with dt = {printed.dt:g} {ended}, after {printed.overtaking} steps in which markers "
            f"overtook one another. It works up to dt = {below:g}, not from {above:g} on.",
            f"dt is above the explicit limit eta eps^2 / max D = eta eps^2 e / D_0 = {setting.limit:.3g}, the one of "
            f"Sec. 2.3 at the largest D; the scan finds it between {below:g} and {above:g}.",
        ),
        statement(
            "M-F18.agreement",
            reached and worst < _EXCELLENT,
            f"With RKC2 of {stable.stages} stages at dt = {stable.dt:g}, F at the markers is within "
            f"{100 * worst:.2g} % of the peak of f_inf at t = {stable.last:g}, in the core within "
            f"{100 * setting.deviation(stable.end) / peak:.2g} %; the midpoint rule at dt = {small.dt:g} agrees with "
            f"it to {same:.1e} up to t = {small.last:g}.",
            f"F is off f_inf by {100 * worst:.2g} % of the peak.",
        ),
    ]


def _long_time(setting: Setting, stable: Evolution, reference: _Reference) -> Finding:
    t = float(setting.parameters["compared_at"])
    x = stable.at(t)
    exact = np.interp(x, reference.lines.x, reference.lines.solve(
        Gaussian().value(reference.lines.x), [t])[0])  # fmt: skip
    gap = float(np.abs(setting.velocity.fields(x, setting.weights)[0] - exact).max())
    evidence = (
        f"A solution of (20) without markers ({reference.lines.x.size} cells) stays positive until "
        f"t = {reference.lost:.4g} (half as many cells: {reference.lost_coarse:.4g}), when it vanishes at "
        f"|x| = {reference.place:.4g}. The markers agree with it to {gap:.1e} at t = {t:g}."
    )
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
        reference.lost > float(setting.parameters["t_final"]),
        evidence,
        "With the initial profile (25) the sink Q < 0 in the flanks drives the solution of (20) through zero, where "
        "D < 0 and the equation is ill-posed: there is no long-time behaviour to determine. Markers keep their weights "
        "and cannot follow; those left outside spread without end, as slowly as t^(1/4), so that f_inf is approached "
        "by a power of t only.",
    )


def _series(
    setting: Setting,
    printed: Evolution,
    stable: Evolution,
    scans: Sequence[Evolution],
    reference: _Reference,
) -> pd.DataFrame:
    parts: list[pd.DataFrame] = []

    def add(panel: str, series: str, x: Any, y: Any, **more: Any) -> None:
        columns = {"panel": panel, "series": series, "x": np.atleast_1d(x), "y": np.atleast_1d(y)}
        parts.append(pd.DataFrame({**columns, **more}))

    def field_of(x: np.ndarray) -> np.ndarray:
        return setting.velocity.fields(x, setting.weights)[0]

    z = np.linspace(-3.0, 3.0, 601)
    add("profile", "steady", z, setting.problem.steady(z))
    for label, x, t in (
        ("initial", setting.x, 0.0),
        ("printed", printed.end, printed.times[-1]),
        ("stable", stable.end, stable.times[-1]),
    ):
        add("profile", label, x, field_of(x), t=t)
    peak = float(setting.problem.steady(z).max())
    for e in scans:
        add("step", e.integrator, e.dt, setting.deviation(e.end) / peak, stopped=bool(e.stopped))
    scanned = float(setting.parameters["scan_until"])
    add("step", "RKC2", stable.dt, setting.deviation(stable.at(scanned)) / peak, stopped=False)
    add("step", "limit", setting.limit, 0.0)
    for t, f in zip(reference.times, reference.profiles, strict=True):
        add("lost", "lines", reference.lines.x, f, t=t)
        if min(abs(t - s) for s in stable.times) < 0.5 * stable.dt:
            x = stable.at(t)
            add("lost", "markers", x, field_of(x), t=t)
    add("lost", "steady", z, setting.problem.steady(z))
    add("lost", "zero", reference.place, 0.0, t=reference.lost)
    for t, x in zip(stable.times[1:], stable.positions[1:], strict=True):
        add("approach", "core", t, setting.deviation(x))
        add("approach", "excess", t, setting.excess(x))
    return pd.concat(parts, ignore_index=True)
