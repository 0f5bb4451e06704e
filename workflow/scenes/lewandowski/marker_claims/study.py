"""Sections 2.1, 2.3 and 2.4: markers per eps, the error law (19), position errors, and the denominator of (7)."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import minimize_scalar

from fracparticles.markers import Gaussian, MarkerVelocity, run, shape_function, uniform
from fracparticles.markers.accuracy import (
    optimal_support,
    predicted_support,
    quadrature_exponent,
    quadrature_order,
    smoothing_exponent,
)
from fracparticles.moving.lagrangian import FieldNotPositive
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from scenes.lewandowski.square_profile import LOADINGS, SQUARE, SquareRuns, Trace, load

_NEAR = ("midpoints", "random")
_COLUMNS = ["what", "S", "loading", "at", "ours", "predicted"]
_ENOUGH = (10.0, 16.0)  # markers per eps: 10-15
_TIMES_MORE = 4  # how many times as many markers are compared
_H, _LENGTH = 0.1, math.sqrt(5.0)  # of the markers of a Gaussian, exp(-x^2 / 5) after t = 1

Rows = Iterator[dict[str, Any]]


def study(
    inputs: Inputs,
    *,
    run: SquareRuns,
    shapes: list[str],
    counts: list[int],
    law: list[str],
    spacings: list[float],
    times: list[float],
    watched: float,
    small_dt: float,
    seed: int,
    seeds: int,
) -> Result:
    """Measure what Sections 2.1, 2.3 and 2.4 say of the accuracy: one row a measurement.

    `counts` are numbers of markers, `law` the shape functions of the error law and `spacings` those of its optimum.
    Positions are compared at `times`. Until `watched`, runs from random positions may meet a field that turns negative.
    """
    square = SquareRuns.model_validate(run)
    starts = [(shape, loading) for shape in shapes for loading in _NEAR]
    rows = [row for name in law for row in _exponents(name)]
    rows += [_optimum(name, h) for name in law for h in spacings]
    rows += [row for start in starts for row in _numbers(square, *start, seed, counts)]
    rows += [row for start in starts for row in _positions(square, *start, seed, times)]
    found = pd.DataFrame(rows)
    of = dict(tuple(found.groupby("what")))
    stops = {
        dt: [
            square.having(dt=dt, t_final=watched).trace("S8", "random", s, follow=False)
            for s in range(seed, seed + seeds)
        ]
        for dt in (square.dt, small_dt)
    }
    findings = [
        _enough(of["E"], square),
        _more(of["E"], square, range(seed, seed + (seeds + 1) // 2)),
        _per_support(),
        *_parameters(square, seed),
        _law(of["k of (19)"], of["M of (19)"].dropna(subset=["ours"])),
        *_best(of["best ε"]),
        *_supports(law),
        *_position(of["position error"], of["representation error"]),
        *_denominator(square.having(t_final=watched), stops, seed),
    ]
    drawn, panels = found.dropna(subset=["x"]), Panels()
    named = {"predicted": drawn["predicted"], "loading": drawn["loading"]}
    panels.add(drawn["what"], drawn["S"], drawn["x"], drawn["ours"], **named)
    failed = [(dt, trace) for dt, traces in stops.items() for trace in traces if not trace.run]
    for dt, trace in failed[:1]:
        _last_field(panels, trace, square.support, dt)
    early = found["what"].str.endswith(" error") & (found["x"] < max(times))
    table = found.loc[~early, _COLUMNS].dropna(subset=["ours"])
    return Result(table, inputs.judged(findings), panels.frame)


# --- the number of markers, and other parameters (M-C2) --------------------------------------------


def _numbers(square: SquareRuns, shape: str, loading: str, seed: int, counts: list[int]) -> Rows:
    for count in counts:
        trace = square.having(markers=count).trace(shape, loading, seed, follow=False)
        if trace.run:
            n = count * square.support / np.ptp(trace.end.x)
            row = {"what": "E", "S": shape, "loading": LOADINGS[loading], "x": n, "N": count}
            yield {**row, "at": f"{n:.1f} markers per ε", "ours": trace.error[-1]}


def _norm(square: SquareRuns) -> float:
    """The norm of f on the fixed grid, as E is a norm."""
    return float(np.sqrt((square.z[1] - square.z[0]) * np.sum(square.exact**2)))


def _enough(numbers: pd.DataFrame, square: SquareRuns) -> Finding:
    error, beyond = {}, {}
    for (shape, loading), part in numbers.groupby(["S", "loading"]):
        there = part[part["x"].between(*_ENOUGH)]
        e = (there if len(there) else part)["ours"]
        error[shape, loading] = e.max() / _norm(square)
        beyond[shape, loading] = e.max() / part["ours"].iloc[-1]
    return measured("M-C2.enough", error=error, beyond=beyond)


def _more(numbers: pd.DataFrame, square: SquareRuns, seeds: range) -> Finding:
    """E with four times as many markers over E, the largest of all numbers; from random positions of the means."""

    def largest(e: pd.Series) -> float:
        return max(e[_TIMES_MORE * n] / e[n] for n in e.index if _TIMES_MORE * n in e.index)

    one = {
        (shape, loading): part.set_index("N")["ours"]
        for (shape, loading), part in numbers.groupby(["S", "loading"])
    }
    means = dict(one)
    for (shape, loading), e in one.items():
        if loading == LOADINGS["random"]:
            counts = [int(n) for n in e.index]
            each = [
                pd.DataFrame(_numbers(square, shape, "random", s, counts)).set_index("N")["ours"]
                for s in seeds
            ]
            means[shape, loading] = pd.concat(each, axis=1).mean(axis=1)
    others = {"one seed alone": {"ratio": {key: largest(e) for key, e in one.items()}}}
    ratio = {key: largest(e) for key, e in means.items()}
    every = {key: float((np.diff(e) < 0.0).mean()) for key, e in one.items()}
    return measured("M-C2.more", ratio=ratio, every=every, others=others)


def _per_support() -> Finding:
    """Part of the error that is due to finite h, with N / eps or N eps kept, over a factor of four in eps."""

    def part(count: float, epsilon: float) -> float:
        return _lattice("S4", epsilon, 2.0 * 14.0 / count)[1]

    kept = {"N / ε": [part(112.0 * e, e) for e in (0.5, 1.0, 2.0)]}
    kept["N ε"] = [part(112.0 / e, e) for e in (0.5, 1.0, 2.0)]
    spread = {name: max(parts) / min(parts) for name, parts in kept.items()}
    return measured("M-C2.per_support", quotient=spread["N / ε"], product=spread["N ε"])


def _parameters(square: SquareRuns, seed: int) -> Iterator[Finding]:
    """What changes E of S8 from midpoints; Euler's method with the hat; and whether dt must follow a small F."""

    def error(**changes: Any) -> float:
        return float(square.having(**changes).trace("S8", "midpoints", follow=False).error[-1])

    base = error()
    at_random = square.trace("S8", "random", seed, follow=False)
    other = {
        "half as many markers": error(markers=square.markers // 2),
        "a time step five times as large": error(dt=5.0 * square.dt),
        "random positions": at_random.error[-1] if at_random.run else 2.0 * base,
        "Euler's method": _euler(square, "S8"),
    }
    yield measured(
        "M-C2.influence", change={name: abs(e / base - 1.0) for name, e in other.items()}
    )
    e = _euler(square, "S2")
    guess = np.linalg.norm(SQUARE.value(square.z) - square.exact) / np.linalg.norm(square.exact)
    yield measured("M-C2.crude", ratio=e / _norm(square) / guess, error=e / _norm(square))
    end = square.trace("S8", "midpoints", follow=False).end
    f, v = end.field(), np.abs(end.velocity(end.x, end.weights))
    fast = v[f < 0.1 * f.max()].max(initial=0.0) / v[f > 0.5 * f.max()].max()
    finer = abs(error(dt=0.25 * square.dt) / base - 1.0)
    yield measured("M-C5.velocity", ratio=fast)
    yield measured("M-C5.step", change=finer)


def _euler(square: SquareRuns, name: str) -> float:
    """E at the end by Euler's method, from midpoints."""
    x, w = load("midpoints", square.markers)
    velocity = MarkerVelocity(shape_function(name), square.support)
    for _ in range(round(square.t_final / square.dt)):
        x = x + square.dt * velocity(x, w)
    return square.relative_error(velocity.fields(x, w, square.z)[0]) * _norm(square)


# --- the error law (M-C3) -------------------------------------------------------------------------


def _exponents(name: str) -> Rows:
    shape = shape_function(name)
    k, m = shape.moment_order, quadrature_order(shape)
    ours = math.nan if math.isnan(m) else quadrature_exponent(shape)
    yield {"what": "k of (19)", "S": name, "ours": smoothing_exponent(shape), "predicted": k}
    yield {"what": "M of (19)", "S": name, "ours": ours, "predicted": m}


def _optimum(name: str, h: float) -> dict[str, Any]:
    shape = shape_function(name)
    plain, robust = optimal_support(shape, h)
    best = {"ours": robust, "plain": plain, "predicted": predicted_support(shape, h)}
    return {"what": "best ε", "S": name, "x": h, "at": f"h = {h:g}", **best}


def _law(k: pd.DataFrame, m: pd.DataFrame) -> Finding:
    k, m = k.set_index("S"), m.set_index("S")
    return measured(
        "M-C3.law",
        k_off=(k["ours"] - k["predicted"]).abs(),
        m_off=(m["ours"] - m["predicted"]).abs(),
        k=k["ours"],
        m=m["ours"],
    )


def _best(optimum: pd.DataFrame) -> Iterator[Finding]:
    finite, smooth = optimum.dropna(subset=["predicted"]), optimum[optimum["predicted"].isna()]
    by = pd.MultiIndex.from_frame(finite[["S", "x"]].set_axis(["S", "h"], axis=1))
    robust, plain = (
        pd.Series((finite[column] / finite["predicted"]).to_numpy(), by)
        for column in ("ours", "plain")
    )
    factor, strict = (np.maximum(r, 1.0 / r) for r in (robust, plain))
    yield measured(
        "M-C3.optimum",
        factor=factor,
        robust=robust,
        plain=plain,
        smooth=list(smooth["ours"] / smooth["x"]),
        others={"the least error at any ε, where the lattice error happens to vanish": {"factor": strict}},
    )  # fmt: skip
    off = {}
    for row in finite.itertuples():
        k, m = shape_function(row.S).moment_order, quadrature_order(shape_function(row.S))
        least = minimize_scalar(
            lambda s, k=k, m=m, h=row.x: np.exp(k * s) + (h * np.exp(-s)) ** m,
            bounds=(np.log(row.x) - 3.0, 3.0),
            method="bounded",
            options={"xatol": 1e-12},
        )
        off[row.S, f"h = {row.x:g}"] = abs(np.exp(least.x) / row.predicted - 1.0)
    yield measured("M-C3.formula", miss=max(off.values()), number=len(off))


def _lattice(name: str, epsilon: float, h: float, z: Any = None) -> tuple[float, float]:
    """The error of F for a Gaussian after t = 1 by markers h apart, and the part of it that is due to h; over f(0)."""
    gaussian, z = Gaussian(), np.linspace(-1.0, 1.0, 41) if z is None else z
    reach = 1.5 + shape_function(name).reach * epsilon
    fields = []
    for spacing in (h, epsilon / 100.5):
        n = math.ceil(reach / spacing) + 1
        x, w = uniform(lambda x: gaussian.value(x, 1.0), (-n * spacing, n * spacing), 2 * n)
        velocity = MarkerVelocity(shape_function(name), epsilon, derivatives=0)
        fields.append(velocity.fields(x, w, z)[0])
    f = gaussian.value(z, 1.0)
    peak = float(gaussian.value(0.0, 1.0))
    return float(np.abs(fields[0] - f).max()) / peak, float(
        np.abs(fields[0] - fields[1]).max()
    ) / peak


def _supports(law: list[str]) -> Iterator[Finding]:
    """Where eps may lie between the distance of the markers and the length of f; what makes (6) inexact."""
    epsilons = _H * np.geomspace(0.5, 40.0, 120)
    over_h, under, at_h, at_length = {}, {}, {}, {}
    for name in law:
        error = np.array([_lattice(name, e, _H)[0] for e in epsilons])
        good = epsilons[error <= max(0.01, error.min())]
        over_h[name], under[name] = good.min() / _H, _LENGTH / good.max()
        at_h[name] = _lattice(name, 0.9 * _H, _H)[0] / error.min()
        at_length[name] = _lattice(name, _LENGTH, _H)[0] / error.min()
    yield measured("M-C3.between", at_h=at_h, at_length=at_length)
    yield measured("M-C3.much", over_h=over_h, under=under)
    rough, smooth = (_lattice(name, 0.5, 0.2)[1] for name in ("S4", "S8"))
    cause = {
        "(a) ε is finite": _lattice("S4", 0.5, 0.01)[0],
        "(b) S is not smooth": rough - smooth,
        "(c) h is finite": rough,
    }
    yield measured("M-C3.inexact", part=cause, s8=smooth)
    growing = {
        name: min(
            _lattice(name, 0.5, 0.5 / r)[1] / _lattice(name, 0.5, 0.25 / r)[1] for r in (0.8, 1.1)
        )
        for name in law
    }
    yield measured("M-C3.with_h", ratio=growing)


# --- positions (M-C4) -----------------------------------------------------------------------------


def _positions(square: SquareRuns, shape: str, loading: str, seed: int, times: list[float]) -> Rows:
    """The parts of (17): f - F at the exact positions, which keep the mass to their left, and e-hat (18)."""
    x, weights = load(loading, square.markers, seed)
    mass, z, then = SQUARE.cumulative(x), square.z, 0.0
    velocity = MarkerVelocity(shape_function(shape), square.support)
    for t in times:
        steps = round((t - then) / square.dt)
        x = run(x, weights, velocity, dt=(t - then) / steps, steps=steps).x
        then = t
        at_exact = velocity.fields(SQUARE.quantile(mass, t), weights, z)[0]
        f, ours = SQUARE.value(z, t), velocity.fields(x, weights, z)[0]
        row = {"S": shape, "loading": LOADINGS[loading], "x": t, "at": f"t = {t:g}"}
        whole = {"extent": np.ptp(x), "E": np.linalg.norm(f - ours)}
        yield {"what": "representation error", **row, "ours": np.abs(f - at_exact).max(), **whole}
        yield {"what": "position error", **row, "ours": np.abs(at_exact - ours).max()}


def _position(position: pd.DataFrame, representation: pd.DataFrame) -> Iterator[Finding]:
    ratio = position["ours"].to_numpy() / representation["ours"]
    by = [representation["S"], representation["loading"]]
    greatest, least = ratio.groupby(by).max(), ratio.groupby(by).min()
    greatest.index.names = least.index.names = [None, None]
    yield measured("M-C4.position", ratio=dict(greatest), least=dict(least))
    parts = {key: part for key, part in representation.groupby(["S", "loading"])}
    ends = {key: part.iloc[[0, -1]] for key, part in parts.items()}
    growth = {
        column: {key: e[column].iloc[1] / e[column].iloc[0] for key, e in ends.items()}
        for column in ("extent", "ours", "E")
    }
    falls = {key: int((np.diff(part["extent"]) <= 0.0).sum()) for key, part in parts.items()}
    yield measured("M-C2.domain", ratio=growth["extent"], falls=falls)
    yield measured("M-C3.spreads", ratio=growth["extent"])
    times = representation["x"]
    peaks = SQUARE.value(0.0, float(times.min())) / SQUARE.value(0.0, float(times.max()))
    of_peak = {key: float(peaks) * g for key, g in growth["ours"].items()}
    yield measured(
        "M-C3.in_time",
        ratio=growth["ours"],
        whole=growth["E"],
        others={"errors relative to f(0, t)": {"ratio": of_peak}},
    )


# --- the denominator (M-C5) -----------------------------------------------------------------------


def _denominator(
    square: SquareRuns, stops: dict[float, list[Trace]], seed: int
) -> Iterator[Finding]:
    """The least denominator over its first term, at the paper's time step and at a smaller one."""
    cases = {"S4": ("S4", "random"), "S7": ("S7", "random"), "S8, midpoints": ("S8", "midpoints")}
    least = {
        dt: {case: _least(square, dt, *of, seed) for case, of in cases.items()} for dt in stops
    }
    for dt, traces in stops.items():
        least[dt]["S8, random positions"] = min(
            _least(square, dt, "S8", "random", t.seed) if t.run else 0.0 for t in traces
        )
    (dt, ours), (small_dt, fine) = stops.items()
    stopped = [trace.stopped.split(": a velocity")[0] for trace in fine if not trace.run]
    yield measured(
        "M-C5.denominator",
        least=least[small_dt],
        stopped=[sum(not trace.run for trace in part) for part in (ours, fine)],
        number=len(fine),
        steps=[dt, small_dt],
        example=stopped[0] if stopped else "none",
        depth=float(-shape_function("S8")(math.sqrt(2.5)) / shape_function("S8")(0.0)),
        others={f"the time step of the paper, {dt:g}": {"least": least[dt]}},
    )
    # W_j at x_j and zero elsewhere, as a Kronecker delta gives it, has the integral zero as the grid is refined.
    x, w = load("midpoints", square.markers)
    kernel = MarkerVelocity(shape_function("S4"), 0.1, derivatives=0)
    z = np.linspace(-1.2, 1.2, 48001)
    spikes = np.bincount(np.searchsorted(z, x), w, z.size)
    singular, smooth = (
        (z[1] - z[0]) * f.sum() / w.sum() for f in (spikes, kernel.fields(x, w, z)[0])
    )
    yield measured("M-C5.delta", kronecker=abs(singular - 1.0), dirac=abs(smooth - 1.0))


def _least(square: SquareRuns, dt: float, name: str, loading: str, seed: int) -> float:
    """The least of sum_k W_k S_eps(x_j - x_k) over W_j S_eps(0); zero if it vanishes or turns negative."""
    velocity = MarkerVelocity(shape_function(name), square.support)
    first = float(velocity.shape(0.0)) / square.support
    x, weights = load(loading, square.markers, seed)
    ratios: list[float] = []

    def observe(t: float, x: np.ndarray, w: np.ndarray) -> None:
        ratios.append(float((velocity.fields(x, w)[0] / (w * first)).min()))

    try:
        run(x, weights, velocity, dt=dt, steps=round(square.t_final / dt), observe=observe)
    except FieldNotPositive:
        return 0.0
    return max(0.0, min(ratios))


def _last_field(panels: Panels, stopped: Trace, epsilon: float, dt: float) -> None:
    """F on a grid, and at the markers, half a step after the last one that a stopped run could take."""
    velocity = MarkerVelocity(shape_function(stopped.shape), epsilon)
    (t, x), weights = stopped.last, stopped.weights
    if (velocity.fields(x, weights)[0] > 0.0).all():
        x = x + 0.5 * dt * velocity(x, weights)
    half = 1.15 * float(np.abs(x).max())
    z = np.linspace(-half, half, 801)
    panels.add("denominator", "F", z, velocity.fields(x, weights, z)[0], t=t)
    panels.add("denominator", "markers", x, velocity.fields(x, weights)[0], t=t)
