"""Sections 2.1, 2.3 and 2.4: markers per eps, the error law (19), position errors, and the denominator of (7)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.markers import SHAPES, Gaussian, MarkerVelocity, run, shape_function, uniform
from fracparticles.markers.accuracy import (
    optimal_support,
    predicted_support,
    quadrature_exponent,
    quadrature_order,
    smoothing_exponent,
)
from fracparticles.moving.lagrangian import FieldNotPositive
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from fracstudy.panels import Panels, pick
from scenes.lewandowski.square_profile import LOADINGS, SQUARE, SquareRuns, Trace, load

__all__ = ["study"]

_NEAR = ("midpoints", "random")
_COLUMNS = ["what", "S", "loading", "at", "ours", "predicted"]
_LITTLE = 0.1  # "much smaller": a tenth at most
_CLOSE = 0.1  # accurate enough: E within a tenth of that of the most markers

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
        *_enough(of["E"]),
        _law(of["k of (19)"], of["M of (19)"].dropna(subset=["ours"])),
        _best(of["best ε"]),
        _in_time(square, times),
        _position(of["position error"], of["representation error"]),
        _denominator(stops),
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


# --- markers per eps (M-C2) -----------------------------------------------------------------------


def _numbers(square: SquareRuns, shape: str, loading: str, seed: int, counts: list[int]) -> Rows:
    for count in counts:
        trace = square.having(markers=count).trace(shape, loading, seed, follow=False)
        if trace.run:
            n = count * square.support / np.ptp(trace.end.x)
            row = {"what": "E", "S": shape, "loading": LOADINGS[loading], "x": n}
            yield {**row, "at": f"{n:.1f} markers per ε", "ours": trace.error[-1]}


def _enough(numbers: pd.DataFrame) -> Iterator[Finding]:
    quiet, noisy, level = (
        pick(numbers, S=shape, loading=LOADINGS[loading])
        for shape, loading in (("S8", "midpoints"), ("S4", "random"), ("S4", "midpoints"))
    )
    excess = quiet.set_index("x")["ours"] / quiet["ours"].iloc[-1] - 1.0
    enough, fewer = excess[excess.index >= 10.0], excess[excess.index < 10.0]
    said = ", ".join(f"{e:.1%} at {n:.1f}" for n, e in enough.iloc[:-1].items())
    said += f" per ε, and {fewer.iloc[-1]:.0%} at {fewer.index[-1]:.1f}" if len(fewer) else ""
    ratio = noisy["ours"].iloc[-1] / level["ours"].iloc[-1]
    falls = [(np.diff(part["ours"]) < 0.0).all() for _, part in numbers.groupby(["S", "loading"])]
    yield statement(
        "M-C2.enough",
        len(enough) > 0 and (enough <= _CLOSE).all(),
        f"With S8 from midpoints E exceeds that of the most markers by {said}. With S4 from random positions E is "
        f"{ratio:.1f} times that from midpoints even at {noisy['x'].iloc[-1]:.0f} per ε: clusters.",
        "E still falls by more than a tenth beyond that.",
    )
    yield statement(
        "M-C2.more",
        all(falls),
        f"E falls with every increase of N in {sum(falls)} of {len(falls)} cases (shape function and loading).",
        "From random positions it does not always: more markers change the noise, the seed of clusters with S4.",
    )


# --- the error law (M-C3) -------------------------------------------------------------------------


def _exponents(name: str) -> Rows:
    shape = shape_function(name)
    k, m = shape.moment_order, quadrature_order(shape)
    measured = math.nan if math.isnan(m) else quadrature_exponent(shape)
    yield {"what": "k of (19)", "S": name, "ours": smoothing_exponent(shape), "predicted": k}
    yield {"what": "M of (19)", "S": name, "ours": measured, "predicted": m}


def _optimum(name: str, h: float) -> dict[str, Any]:
    shape = shape_function(name)
    plain, robust = optimal_support(shape, h)
    best = {"ours": robust, "plain": plain, "predicted": predicted_support(shape, h)}
    return {"what": "best ε", "S": name, "x": h, "at": f"h = {h:g}", **best}


def _law(k: pd.DataFrame, m: pd.DataFrame) -> Finding:
    gap_k, gap_m = ((part["ours"] - part["predicted"]).abs().max() for part in (k, m))
    ks = ", ".join(f"{row.ours:.2f} ({row.S})" for row in k.itertuples())
    ms = ", ".join(
        f"{row.ours:.2f} ({row.S}, predicted {row.predicted:.0f})" for row in m.itertuples()
    )
    return statement(
        "M-C3.law",
        gap_k <= 0.1 and gap_m <= 0.3,
        f"Measured on a lattice of markers, k = {ks}; M = {ms}. With S8, smooth, the error falls faster than any "
        "power. The markers are at equal distances.",
        "The exponents are others.",
    )


def _best(optimum: pd.DataFrame) -> Finding:
    finite, smooth = optimum.dropna(subset=["predicted"]), optimum[optimum["predicted"].isna()]
    plain, robust = (finite[column] / finite["predicted"] for column in ("plain", "ours"))
    at = smooth["ours"] / smooth["x"]
    return statement(
        "M-C3.optimum",
        plain.between(0.5, 2.0).all(),
        f"On a lattice of markers the best ε is {plain.min():.2f} to {plain.max():.2f} times the formula for "
        f"{', '.join(finite['S'].unique())}; {robust.min():.2f} to {robust.max():.2f} times if the worst over a range "
        "of ε as wide as h counts, since the error happens to vanish at some ε / h. S8 has no M: there it is "
        f"{at.min():.2f} to {at.max():.2f} h.",
        "The best ε is not within a factor of 2 of the formula: it falls where the lattice error happens to vanish, "
        "and the two terms of (19) have different constants, which the formula leaves out.",
    )


def _in_time(square: SquareRuns, times: list[float]) -> Finding:
    trace = square.trace("S8", "midpoints")
    steps = [int(np.argmin(np.abs(trace.t - t))) for t in (times[0], times[-1])]
    (first, last), (t0, t1) = trace.error[steps], trace.t[steps]
    spread = np.ptp(trace.end.x) / np.ptp(trace.x0)
    return statement(
        "M-C3.in_time",
        last > first,
        f"With S8 from midpoints the mean distance grows {spread:.1f} times, and E goes from {first:.4f} at "
        f"t = {t0:g} to {last:.4f} at t = {t1:g}.",
        "The solution gets wider too, and ε matters less for it: E falls (also in Fig. 16) as long as markers stay "
        "closer than ε.",
    )


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
        yield {"what": "representation error", **row, "ours": np.abs(f - at_exact).max()}
        yield {"what": "position error", **row, "ours": np.abs(at_exact - ours).max()}


def _position(position: pd.DataFrame, representation: pd.DataFrame) -> Finding:
    ratio = position["ours"].to_numpy() / representation["ours"]
    by = ratio.groupby([representation["loading"], representation["S"]])
    said = "; ".join(
        f"{loading}, {S}: {part.min():.1f} to {part.max():.1f}" for (loading, S), part in by
    )
    return statement(
        "M-C4.position",
        (ratio <= _LITTLE).all(),
        f"The largest ê is so many times the largest of the other part over t = {position['x'].min():g} to "
        f"{position['x'].max():g}: {said}.",
        "The positions are wrong by as much as the representation or more: F, which is smoothed, gives the velocity.",
    )


# --- the denominator (M-C5) -----------------------------------------------------------------------


def _denominator(stops: dict[float, list[Trace]]) -> Finding:
    """The paper's own run with S8 from random positions, at its time step and at a smaller one."""
    (dt, ours), (small_dt, fine) = stops.items()
    stopped = [[trace.stopped for trace in part if not trace.run] for part in (ours, fine)]
    example = f' ("{stopped[1][0].split(": a velocity")[0]}")' if stopped[1] else ""
    x, weights = uniform(Gaussian().value, (-5.0, 5.0), 100)
    s8, tail = SHAPES["S8"], ""
    try:
        run(x, weights, MarkerVelocity(s8, 1.0), dt=1e-3, steps=1)
    except FieldNotPositive as error:
        what = str(error).split(": a velocity")[0]
        tail = f" exp(-x²) by 100 uniform markers in [-5, 5], ε = 1: {what}."
    depth = float(-s8(math.sqrt(2.5)) / s8(0.0))
    return statement(
        "M-C5.denominator",
        not (any(stopped) or tail),
        f"S8 is negative for |x| > sqrt(3/2) ε, {depth:.4f} S(0) deep. With S8 from random positions {len(stopped[0])} "
        f"of {len(ours)} runs stop at dt = {dt:g}, and {len(stopped[1])} at dt = {small_dt:g}{example}.{tail}",
        "W_j S(0) is positive, but the other terms need not be: it holds for S >= 0 only, not for S8.",
    )


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
