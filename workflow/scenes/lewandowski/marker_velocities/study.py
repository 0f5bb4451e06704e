"""One marker solver for other equations, Secs. 2.1 and 4: Burgers, Korteweg-de Vries, a source."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.errors import NonFiniteSolution
from fracparticles.markers import SHAPES, Gaussian, MarkerVelocity, equal_weight, run, uniform
from fracparticles.markers.burgers import PointSource, burgers
from fracparticles.markers.fourier import FourierMarkerVelocity
from fracparticles.markers.kdv import Soliton, kdv
from fracparticles.markers.source import GaussianSource, advance_weights, source_flux
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement

__all__ = ["kdv_residual", "study"]

_GOOD = 0.02  # relative to the solution: hardly seen in a figure
_WITH_TOTAL, _WITHOUT = 0, 2  # derivative of the Gaussian that is the source
_VELOCITY, _WEIGHTS = "in the velocity", "in the weights"


class _Part:
    """Rows of the table and parts of the series of one equation."""

    def __init__(self) -> None:
        self.rows: list[dict[str, Any]] = []
        self.series: list[pd.DataFrame] = []

    def row(self, equation: str, case: str, count: int, epsilon: float, dt: float, t: float,
            maximum: float, l1: float, stopped: str = "") -> None:  # fmt: skip
        self.rows.append(
            {
                "equation": equation,
                "case": case,
                "N": count,
                "eps": epsilon,
                "dt": dt,
                "t": t,
                "max error": maximum,
                "relative L1 error": l1,
                "stopped": stopped.split(". Leave")[0],
            }
        )

    def add(self, panel: str, series: str, x: Any, y: Any, **more: Any) -> None:
        columns = {"panel": panel, "series": series, "x": np.atleast_1d(x), "y": np.atleast_1d(y)}
        self.series.append(pd.DataFrame({**columns, **more}))

    def errors(self, equation: str, case: str) -> np.ndarray:
        """The relative L1 errors of a case, by the number of markers."""
        return np.array(
            [
                r["relative L1 error"]
                for r in self.rows
                if (r["equation"], r["case"]) == (equation, case)
            ]
        )


def study(inputs: Inputs) -> Result:
    """Burgers against Cole-Hopf, KdV against the soliton, and a source in the velocity or in the weights.

    A solution is called good if its error is below 2 % of the solution, relative L1 norm.
    """
    part = _Part()
    findings = [
        *_burgers(inputs.parameters["burgers"], part),
        *_kdv(inputs.parameters["kdv"], part),
        _source(inputs.parameters["source"], part),
    ]
    return Result(pd.DataFrame(part.rows), findings, pd.concat(part.series, ignore_index=True))


def _relative_l1(error: np.ndarray, exact: np.ndarray) -> float:
    return float(np.abs(error).sum() / np.abs(exact).sum())


# --- Burgers ----------------------------------------------------------------------------------------


def _burgers(p: Mapping[str, Any], part: _Part) -> list[Finding]:
    total, start, dt = float(p["total"]), float(p["start"]), float(p["dt"])
    times = [start, *map(float, p["times"])]
    counts, shown = p["markers"], float(p["shown"])
    for reynolds in map(float, p["reynolds"]):
        exact = PointSource(total / (2.0 * reynolds), total)
        case = f"R = {reynolds:g}"
        for count in counts:
            epsilon = float(p["support"]) * math.sqrt(counts[0] / count)
            g = total * (np.arange(count) + 0.5) / count
            x, w = exact.quantile(g, start), np.full(count, total / count)
            velocity = FourierMarkerVelocity(epsilon, burgers(exact.mu))
            for t0, t1 in zip([start, *times[:-1]], times, strict=True):
                if t1 > t0:
                    x = run(x, w, velocity, dt=dt, steps=round((t1 - t0) / dt), start=t0).x
                if reynolds == shown and count == counts[-1]:
                    at = np.sort(x)
                    part.add("burgers", "markers", at, velocity.fields(x, w, at)[0], t=t1)
                    z = np.linspace(-1.5, 4.0, 801)
                    part.add("burgers", "exact", z, exact.value(z, t1), t=t1)
            low, high = exact.quantile(np.array([1e-6, 1.0 - 1e-6]) * total, times[-1])
            z = np.linspace(low, high, 2001)
            f = exact.value(z, times[-1])
            error = velocity.fields(x, w, z)[0] - f
            l1 = _relative_l1(error, f)
            part.row("Burgers", case, count, epsilon, dt, times[-1], float(np.abs(error).max()), l1)
            part.add("errors", f"Burgers, {case}", count, l1)
    largest, shock = (f"R = {float(r):g}" for r in (p["reynolds"][0], p["reynolds"][-1]))
    errors = {case: part.errors("Burgers", case) for case in (largest, shock)}
    falls = {case: bool((np.diff(e) < 0.0).all()) for case, e in errors.items()}

    def said(case: str) -> str:
        return (
            f"{case}: the relative L1 error against Cole-Hopf at t = {times[-1]:g} goes from "
            f"{errors[case][0]:.2g} with {counts[0]} markers to {errors[case][-1]:.2g} with {counts[-1]}"
        )

    # The jump is sqrt(2 M / t), the pulse sqrt(2 M t) long, the front 8 mu / jump wide. A jump smeared over eps has a
    # relative L1 error of about eps / length.
    smeared = epsilon / math.sqrt(2.0 * total * times[-1])
    return [
        statement(
            "M-C6.burgers",
            falls[largest] and errors[largest][-1] < _GOOD,
            f"V = f / 2 - mu f_x / f, no random numbers. {said(largest)}.",
            "The error does not fall below 2 %.",
        ),
        statement(
            "M-C6.shocks",
            falls[shock] and errors[shock][-1] < smeared,
            f"{said(shock)}. The front is {2.0 / reynolds:.2g} of the length of the pulse, eps {smeared:.2g}: the "
            "shock is where it should be, smeared over eps.",
            "The error is more than that of a shock smeared over eps.",
        ),
    ]


# --- Korteweg-de Vries --------------------------------------------------------------------------------


def kdv_residual(soliton: Soliton, half: float = 8.0, points: int = 512) -> float:
    """Return max |V f - (3 f^2 + f_xx)| relative to its maximum, f_xx by Fourier series, V by `Soliton.velocity`."""
    x = half * (2.0 * np.arange(points) / points - 1.0)
    f = soliton.value(x)
    k = np.pi / half * np.fft.rfftfreq(points, 1.0 / points)
    flux = 3.0 * f * f + np.fft.irfft(-k * k * np.fft.rfft(f), points)
    return float(np.abs(soliton.velocity(f) * f - flux).max() / np.abs(flux).max())


def _kdv(p: Mapping[str, Any], part: _Part) -> list[Finding]:
    period, until = float(p["period"]), float(p["t_final"])
    soliton = Soliton(float(p["c"]), float(p["background"]))
    z = np.linspace(0.0, period, 801)
    centre = 0.25 * period
    residual = kdv_residual(soliton, half=float(p["residual_half_width"]))
    for count, epsilon, dt in p["runs"]:
        x, w = uniform(lambda x: soliton.value(x - centre), (0.0, period), count)
        velocity = MarkerVelocity(SHAPES["S8"], epsilon, kdv, derivatives=2, period=period)
        end = run(x, w, velocity, dt=dt, steps=round(until / dt))
        f = soliton.value(z - centre, until)
        error = end.field(z) - f
        l1 = _relative_l1(error, f - soliton.background)
        part.row(
            "KdV",
            "soliton on a background",
            count,
            epsilon,
            dt,
            until,
            float(np.abs(error).max()),
            l1,
        )
        part.add("errors", "KdV, on a background", count, l1)
    at = np.sort(np.mod(end.x, period))
    part.add("kdv", "markers", at, end.field(at), t=until)
    for t in (0.0, until):
        part.add("kdv", "exact", z, soliton.value(z - centre, t), t=t)
    stopped = _bare_soliton(p, part)
    errors = part.errors("KdV", "soliton on a background")
    said = (
        f"on a background of {soliton.background:g} (height {0.5 * soliton.c:g} above it) its error relative to the "
        f"soliton goes from {errors[0]:.2g} to {errors[-1]:.2g} after a way of {soliton.speed * until:g}"
    )
    return [
        statement(
            "M-C6.kdv_velocity",
            residual < 1e-5,
            f"V f = 3 f^2 + f_xx for the soliton, to {residual:.1e} of its maximum.",
            "The velocity is not that of the equation.",
        ),
        statement(
            "M-C6.kdv",
            errors[-1] < _GOOD,
            f"The same solver moves a soliton: {said}."
            + (f" Without a background it stops: {stopped}." if stopped else ""),
            f"Not within 2 %: {said}.",
        ),
        statement(
            "M-C6.positive",
            bool(stopped),
            f"A soliton on a background can be done ({said}); a bare one, positive but vanishing at infinity, "
            f"cannot: {stopped or 'it did'}. So f > 0 is needed, and is not enough: F must be above the errors of S8, "
            "which is not positive.",
            "The soliton without a background went on to the end.",
        ),
    ]


def _bare_soliton(p: Mapping[str, Any], part: _Part) -> str:
    """Run a soliton without a background on the whole line; return why and when it stopped."""
    q = p["bare"]
    soliton, half = Soliton(float(p["c"])), float(q["half_width"])
    count, epsilon, dt = int(q["markers"]), float(q["support"]), float(q["dt"])
    x, w = uniform(soliton.value, (-half, half), count)
    velocity = MarkerVelocity(SHAPES["S8"], epsilon, kdv, derivatives=2)
    latest: dict[str, Any] = {}

    def observe(t: float, x: np.ndarray, w: np.ndarray) -> None:
        latest.update(t=t, x=x)

    message = ""
    try:
        run(x, w, velocity, dt=dt, steps=round(float(p["t_final"]) / dt), observe=observe)
    except NonFiniteSolution as error:
        message = str(error).split(": ", 1)[1].split(" and ")[0]
    t, x = latest["t"], latest["x"]
    z = np.linspace(-half, half, 801) + soliton.c * t
    f = soliton.value(z, t)
    gap = velocity.fields(x, w, z)[0] - f
    part.row("KdV", "soliton alone", count, epsilon, dt, t, float(np.abs(gap).max()),
             _relative_l1(gap, f), message)  # fmt: skip
    return f"at t = {t:.2g} {message}" if message else ""


# --- a source -------------------------------------------------------------------------------------------


def _source(p: Mapping[str, Any], part: _Part) -> Finding:
    until, counts = float(p["t_final"]), p["markers"]
    z = np.linspace(-4.0, 4.0, 801)
    missing = 0.0
    for derivative, name in (
        (_WITHOUT, "a source without total"),
        (_WITH_TOTAL, "a source with a total"),
    ):
        source = GaussianSource(float(p["q"][str(derivative)]), derivative)
        exact = source.solution(z, until)
        missing = source.total * until / (Gaussian().total + source.total * until)
        for way in (_VELOCITY, _WEIGHTS):
            case = f"{name}, {way}"
            for count in counts:
                epsilon = float(p["support"]) * math.sqrt(counts[0] / count)
                steps = math.ceil(until / (float(p["step"]) * epsilon**2))
                x, w = equal_weight(Gaussian(), count)
                if way == _VELOCITY:
                    velocity = FourierMarkerVelocity(epsilon, source_flux(source.cumulative))
                    x = run(x, w, velocity, dt=until / steps, steps=steps).x
                else:
                    velocity = FourierMarkerVelocity(epsilon)
                    x, w = advance_weights(
                        x, w, velocity, source.rate, dt=until / steps, steps=steps
                    )
                field = velocity.fields(x, w, z)[0]
                l1 = _relative_l1(field - exact, exact)
                part.row("source", case, count, epsilon, until / steps, until,
                         float(np.abs(field - exact).max()), l1)  # fmt: skip
                part.add("errors", case, count, l1)
            part.add(f"source {derivative}", way, z, field)
        part.add(f"source {derivative}", "exact", z, exact)
        part.add(f"source {derivative}", "initial", z, Gaussian().value(z))
    ends = {
        case: part.errors("source", case)[-1]
        for name in ("a source without total", "a source with a total")
        for case in (f"{name}, {_VELOCITY}", f"{name}, {_WEIGHTS}")
    }
    printed = ends[f"a source with a total, {_VELOCITY}"]
    return statement(
        "M-C6.source",
        printed < _GOOD,
        f"With {counts[-1]} markers the relative L1 errors are: "
        + "; ".join(f"{case} {error:.2g}" for case, error in ends.items())
        + ".",
        "Constant weights keep the total of F, but the equation gains int Q dx: the error cannot be less than "
        f"the missing part of the total, {missing:.2g} here. The velocity serves a source with int Q dx = 0, as "
        "(21); for any other the weights must change.",
    )
