"""One marker solver for other equations, Secs. 2.1 and 4: Burgers, Korteweg-de Vries, a source."""

import math
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.errors import NonFiniteSolution
from fracparticles.markers import SHAPES, Gaussian, MarkerVelocity, equal_weight, run, uniform
from fracparticles.markers.burgers import PointSource, burgers
from fracparticles.markers.fourier import FourierMarkerVelocity
from fracparticles.markers.kdv import Soliton, kdv
from fracparticles.markers.profiles import Square
from fracparticles.markers.source import GaussianSource, advance_weights, source_flux
from fracstudy.errors import off
from fracstudy.findings import Finding, each, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels

_STEP = 1e-3  # of difference quotients
# By derivative of the Gaussian.
_SOURCES = {2: "a source without total", 0: "a source with a total"}
_VELOCITY, _WEIGHTS = "in the velocity", "in the weights"


class _Errors:
    """The errors of all cases, as the table has them, and what is drawn."""

    def __init__(self) -> None:
        self.rows: list[dict[str, Any]] = []
        self.panels = Panels()

    def add(self, drawn: str, field: np.ndarray, f: np.ndarray, **case: Any) -> None:
        """Compare F with f; the relative error is that to f above `background`; draw it as that series, if any."""
        above, stopped = f - case.pop("background", 0.0), case.pop("stopped", "")
        gap = np.abs(field - f)
        l1 = float(gap.sum() / np.abs(above).sum())
        found = {"max error": float(gap.max()), "relative L1 error": l1}
        self.rows.append({**case, **found, "stopped": stopped.split(". Leave")[0]})
        if drawn:
            self.panels.add("errors", drawn, case["N"], l1)

    def of(self, case: str) -> list[float]:
        """The relative L1 errors of a case, by the number of markers."""
        return [row["relative L1 error"] for row in self.rows if row["case"] == case]


def study(
    inputs: Inputs, *, burgers: dict[str, Any], kdv: dict[str, Any], source: dict[str, Any]
) -> Result:
    """Burgers against Cole-Hopf, KdV against the soliton, and a source in the velocity or in the weights."""
    errors = _Errors()
    findings = [*_burgers(errors, **burgers), *_kdv(errors, **kdv)]
    findings += [*_source(errors, **source), _carried()]
    findings.append(_flexible(findings))
    return Result(pd.DataFrame(errors.rows), inputs.judged(findings), errors.panels.frame)


# --- Burgers ----------------------------------------------------------------------------------------


def _burgers(
    errors: _Errors,
    total: float,
    reynolds: list[float],
    start: float,
    times: list[float],
    dt: float,
    support: float,
    markers: list[int],
    shown: float,
) -> list[Finding]:
    """Markers of equal weight, started at the quantiles of the solution at `start`."""
    end, z = times[-1], np.linspace(-1.5, 4.0, 801)
    for r in reynolds:
        exact, case = PointSource(total / (2.0 * r), total), f"R = {r:g}"
        for count in markers:
            epsilon = support * math.sqrt(markers[0] / count)
            g = total * (np.arange(count) + 0.5) / count
            x, w = exact.quantile(g, start), np.full(count, total / count)
            velocity = FourierMarkerVelocity(epsilon, burgers(exact.mu))
            for t0, t1 in zip([start, start, *times], [start, *times], strict=False):
                if t1 > t0:
                    x = run(x, w, velocity, dt=dt, steps=round((t1 - t0) / dt), start=t0).x
                if (r, count) == (shown, markers[-1]):
                    at = np.sort(x)
                    errors.panels.add("burgers", "markers", at, velocity.fields(x, w, at)[0], t=t1)
                    errors.panels.add("burgers", "exact", z, exact.value(z, t1), t=t1)
            low, high = exact.quantile(np.array([1e-6, 1.0 - 1e-6]) * total, end)
            s = np.linspace(low, high, 2001)
            row = {"equation": "Burgers", "case": case, "N": count, "eps": epsilon, "dt": dt}
            field, f = velocity.fields(x, w, s)[0], exact.value(s, end)
            errors.add(f"Burgers, {case}", field, f, **row, t=end)
    cases = each(lambda r: errors.of(f"R = {r:g}"), R=reynolds)
    many, few = cases.str[-1], cases.str[0]
    falls = cases.map(lambda e: np.diff(e).max())
    # The jump is sqrt(2 M / t), the pulse sqrt(2 M t) long, the front 8 mu / jump wide.
    sharp, ends = reynolds[-1], [markers[0], markers[-1]]
    of_sharp: dict[str, Any] = {"error": many[sharp], "change": falls[sharp], "few": few[sharp]}
    of_sharp |= {"front": 2.0 / sharp, "support": epsilon / math.sqrt(2.0 * total * end)}
    return [
        measured("M-C6.burgers", error=many, few=few, change=falls, markers=ends),
        measured("M-C6.shocks", **of_sharp),
    ]


# --- Korteweg-de Vries --------------------------------------------------------------------------------


def kdv_residual(soliton: Soliton, half: float) -> float:
    """Return max |V f - (3 f^2 + f_xx)| relative to its maximum, f_xx by Fourier series, V by `Soliton.velocity`."""
    points = 512
    x = half * (2.0 * np.arange(points) / points - 1.0)
    f = soliton.value(x)
    k = np.pi / half * np.fft.rfftfreq(points, 1.0 / points)
    flux = 3.0 * f * f + np.fft.irfft(-k * k * np.fft.rfft(f), points)
    return off(soliton.velocity(f) * f, flux)


def _kdv(
    errors: _Errors,
    c: float,
    background: float,
    period: float,
    t_final: float,
    residual_half_width: float,
    runs: list[list[Any]],
    bare: dict[str, Any],
) -> list[Finding]:
    """A soliton on a background, by `runs` of N, eps, dt; and a `bare` one."""
    soliton, centre = Soliton(c, background), 0.25 * period
    z, case = np.linspace(0.0, period, 801), "soliton on a background"
    f = soliton.value(z - centre, t_final)
    for count, epsilon, dt in runs:
        x, w = uniform(lambda x: soliton.value(x - centre), (0.0, period), count)
        velocity = MarkerVelocity(SHAPES["S8"], epsilon, kdv, derivatives=2, period=period)
        end = run(x, w, velocity, dt=dt, steps=round(t_final / dt))
        row = {"equation": "KdV", "case": case, "N": count, "eps": epsilon, "dt": dt, "t": t_final}
        errors.add("KdV, on a background", end.field(z), f, **row, background=background)
    at = np.sort(np.mod(end.x, period))
    errors.panels.add("kdv", "markers", at, end.field(at), t=t_final)
    for t in (0.0, t_final):
        errors.panels.add("kdv", "exact", z, soliton.value(z - centre, t), t=t)
    reached = _bare_soliton(errors, Soliton(c), t_final, **bare)
    found, alone = errors.of(case), errors.rows[-1]
    (positive, signed), (finer, finer_signed) = _signed(128), _signed(256)
    stopped = alone["stopped"] or "it goes on to the end"
    numbers: dict[str, Any] = {"reached": reached, "stopped": stopped}
    return [
        measured("M-C6.kdv_velocity", miss=kdv_residual(soliton, residual_half_width)),
        measured(
            "M-C6.kdv",
            error={case: found[-1], "soliton alone": alone["relative L1 error"]},
            left={case: 0.0, "soliton alone": 1.0 - reached / t_final},
            first=found[0],
            way=soliton.speed * t_final,
            **numbers,
        ),
        measured(
            "M-C6.positive",
            ratio=signed / positive,
            positive=positive,
            signed=signed,
            others={"twice as many markers": {"ratio": finer_signed / finer}},
            **numbers,
        ),
    ]


def _signed(count: int) -> tuple[float, float]:
    """The relative L1 errors of exp(-x^2) and of x exp(-x^2) by markers that take (7) whatever the sign of F."""
    epsilon, until = 0.3, 0.25
    errors, z, steps = [], np.linspace(-4.0, 4.0, 401), math.ceil(until / (0.25 * epsilon**2))
    velocity = MarkerVelocity(SHAPES["S8"], epsilon)
    for power in (0, 1):

        def exact(x: np.ndarray, t: float = 0.0, power: int = power) -> np.ndarray:
            return (x / (1.0 + 4.0 * t)) ** power * Gaussian().value(x, t)

        x, w = uniform(exact, (-4.0, 4.0), count)

        def v(x: np.ndarray, w: np.ndarray = w) -> np.ndarray:
            f, slope = velocity.fields(x, w)
            return -slope / f

        for _ in range(steps):
            x = x + until / steps * v(x + 0.5 * until / steps * v(x))
        f = exact(z, until)
        errors.append(float(np.abs(velocity.fields(x, w, z)[0] - f).sum() / np.abs(f).sum()))
    return errors[0], errors[1]


def _bare_soliton(
    errors: _Errors, soliton: Soliton, until: float, half_width: float, markers: int, support: float, dt: float
) -> float:  # fmt: skip
    """Run a soliton without a background on the whole line; return until when it went."""
    x, w = uniform(soliton.value, (-half_width, half_width), markers)
    velocity = MarkerVelocity(SHAPES["S8"], support, kdv, derivatives=2)
    t, message = 0.0, ""

    def observe(now: float, places: np.ndarray, w: np.ndarray) -> None:
        nonlocal t, x
        t, x = now, places

    try:
        run(x, w, velocity, dt=dt, steps=round(until / dt), observe=observe)
    except NonFiniteSolution as error:
        message = str(error).split(": ", 1)[1].split(" and ")[0]
    z = np.linspace(-half_width, half_width, 801) + soliton.c * t
    row = {"equation": "KdV", "case": "soliton alone", "N": markers, "eps": support, "dt": dt}
    errors.add("", velocity.fields(x, w, z)[0], soliton.value(z, t), **row, t=t, stopped=message)
    return t


# --- a source -------------------------------------------------------------------------------------------


def _source(
    errors: _Errors, q: dict[str, float], t_final: float, support: float, step: float, markers: list[int]
) -> list[Finding]:  # fmt: skip
    """Sources `q` times the derivative of the Gaussian that is the key; `step` is dt / eps^2."""
    z = np.linspace(-4.0, 4.0, 801)
    sources = {name: GaussianSource(q[str(of)], of) for of, name in _SOURCES.items()}
    last: dict[str, dict[str, float]] = {_VELOCITY: {}, _WEIGHTS: {}}
    for name, source in sources.items():
        exact, panel = source.solution(z, t_final), f"source {source.derivative}"
        for way, count in product(last, markers):
            epsilon = support * math.sqrt(markers[0] / count)
            steps = math.ceil(t_final / (step * epsilon**2))
            time: dict[str, Any] = {"dt": t_final / steps, "steps": steps}
            x, w = equal_weight(Gaussian(), count)
            if way == _VELOCITY:
                velocity = FourierMarkerVelocity(epsilon, source_flux(source.cumulative))
                x = run(x, w, velocity, **time).x
            else:
                velocity = FourierMarkerVelocity(epsilon)
                x, w = advance_weights(x, w, velocity, source.rate, **time)
            field, case = velocity.fields(x, w, z)[0], f"{name}, {way}"
            row = {"equation": "source", "case": case, "N": count, "eps": epsilon}
            errors.add(case, field, exact, **row, dt=time["dt"], t=t_final)
            last[way][name] = errors.of(case)[-1]
            if count == markers[-1]:
                errors.panels.add(panel, way, z, field)
        errors.panels.add(panel, "exact", z, exact)
        errors.panels.add(panel, "initial", z, Gaussian().value(z))
    gain = sources[_SOURCES[0]].total * t_final
    gained, most = gain / (Gaussian().total + gain), markers[-1]
    error, weights = last.values()
    return [
        measured("M-C6.source", error=error, weights=weights, gained=gained, markers=most),
        measured("M-C6.source_velocity", miss=max(map(_substituted, sources.values()))),
    ]


def _substituted(source: GaussianSource, t: float = 0.5) -> float:
    """|f_t + (V f)_x| for V of the paper, by difference quotients, over the maximum of |f_t|."""
    x, d = np.linspace(-4.0, 4.0, 161), _STEP
    rate = (source.solution(x, t + d) - source.solution(x, t - d)) / (2.0 * d)

    def flux(x: np.ndarray) -> np.ndarray:
        slope = (source.solution(x + d, t) - source.solution(x - d, t)) / (2.0 * d)
        return -slope - source.cumulative(x)

    residual = rate + (flux(x + d) - flux(x - d)) / (2.0 * d)
    return float(np.abs(residual).max() / np.abs(rate).max())


def _flexible(findings: list[Finding]) -> Finding:
    """Where the markers go with another velocity and nothing else changed: the errors of all equations above."""
    found = {finding.claim: finding.numbers for finding in findings}
    error = {
        "Burgers": max(found["M-C6.burgers"]["error"].values()),
        **found["M-C6.kdv"]["error"],
        **found["M-C6.source"]["error"],
    }
    return measured("M-C6.flexible", error=error, left=found["M-C6.kdv"]["left"])


def _carried(t: float = 0.5) -> Finding:
    """Points that keep what lies to their left move with V = -f_x / f (3): the square profile."""
    square, g = Square(), np.linspace(0.02, 1.98, 99)
    x = square.quantile(g, t)
    moved = (square.quantile(g, t + _STEP) - square.quantile(g, t - _STEP)) / (2.0 * _STEP)
    velocity = -square.slope(x, t) / square.value(x, t)
    return measured("M-C6.diffusion", miss=off(moved, velocity))
