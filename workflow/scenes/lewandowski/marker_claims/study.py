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
_LITTLE = 0.1  # "much smaller": a tenth at most
_CLOSE = 0.1  # accurate enough: E within a tenth of that of the most markers


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
    """Measure what Sections 2.1, 2.3 and 2.4 say of the accuracy.

    `counts` are numbers of markers, `law` the shape functions of the error law and `spacings` those of its optimum.
    Positions are compared at `times`. Runs from random positions are watched for a field that turns negative.
    """
    square = SquareRuns.model_validate(run)
    numbers = _numbers(square, shapes, counts, seed)
    exponents = pd.DataFrame([_exponents(name) for name in law])
    optimum = pd.DataFrame([_optimum(name, h) for name in law for h in spacings])
    positions = pd.DataFrame(
        [
            row
            for shape in shapes
            for loading in _NEAR
            for row in _positions(square, shape, loading, seed, times)
        ]
    )
    stops = {
        dt: [
            square.having(dt=dt, t_final=watched).trace("S8", "random", s, follow=False)
            for s in range(seed, seed + seeds)
        ]
        for dt in (square.dt, small_dt)
    }
    findings = [
        *_enough(numbers),
        _law(exponents),
        _best(optimum),
        _in_time(square, times),
        _position(positions),
        _denominator(stops),
    ]
    panels = Panels()
    for panel, frame, x, y in (
        ("numbers", numbers, "N per ε", "E"),
        ("optimum", optimum, "h", "best ε"),
        ("formula", optimum, "h", "predicted"),
        ("representation", positions, "t", "representation"),
        ("position", positions, "t", "position"),
    ):
        panels.add(panel, frame["S"], frame[x], frame[y], loading=frame.get("loading"))
    failed = next((trace for part in stops.values() for trace in part if not trace.run), None)
    if failed:
        dt = next(dt for dt, part in stops.items() if failed in part)
        _last_field(panels, failed, square.support, dt)
    table = _table(numbers, exponents, optimum, pick(positions, t=positions["t"].max()))
    return Result(table, inputs.judged(findings), panels.frame)


def _table(
    numbers: pd.DataFrame, exponents: pd.DataFrame, optimum: pd.DataFrame, last: pd.DataFrame
) -> pd.DataFrame:
    """One row a measurement: what, shape function, loading, at, ours, predicted or compared with."""
    parts = [
        exponents.melt(["S", "k predicted", "M predicted"], ["k", "M"], "what", "ours"),
        optimum.rename(columns={"best ε": "ours"}),
        numbers.rename(columns={"E": "ours"}),
        last.melt(["S", "loading", "t"], ["representation", "position"], "what", "ours"),
    ]
    return pd.concat(parts)


# --- markers per eps (M-C2) -----------------------------------------------------------------------


def _numbers(square: SquareRuns, shapes: list[str], counts: list[int], seed: int) -> pd.DataFrame:
    rows = []
    for shape in shapes:
        for loading in _NEAR:
            for count in counts:
                trace = square.having(markers=count).trace(shape, loading, seed, follow=False)
                if trace.run:
                    per_support = count * square.support / np.ptp(trace.end.x)
                    row = {"S": shape, "loading": loading, "N per ε": per_support}
                    rows.append({**row, "E": trace.error[-1]})
    return pd.DataFrame(rows)


def _enough(numbers: pd.DataFrame) -> Iterator[Finding]:
    quiet, noisy, level = (
        pick(numbers, S=shape, loading=loading)
        for shape, loading in (("S8", "midpoints"), ("S4", "random"), ("S4", "midpoints"))
    )
    excess = quiet.set_index("N per ε")["E"] / quiet["E"].iloc[-1] - 1.0
    enough, fewer = excess[excess.index >= 10.0], excess[excess.index < 10.0]
    said = ", ".join(f"{e:.1%} at {n:.1f}" for n, e in enough.iloc[:-1].items()) + " per ε"
    said += f", and {fewer.iloc[-1]:.0%} at {fewer.index[-1]:.1f}" if len(fewer) else ""
    last = noisy.iloc[-1]
    falls = [(np.diff(part["E"]) < 0.0).all() for _, part in numbers.groupby(["S", "loading"])]
    yield statement(
        "M-C2.enough",
        len(enough) > 0 and (enough <= _CLOSE).all(),
        f"With S8 from midpoints E exceeds that of the most markers by {said}. With S4 from random positions E is "
        f"{last['E'] / level['E'].iloc[-1]:.1f} times that from midpoints even at {last['N per ε']:.0f} per ε: clusters.",
        "E still falls by more than a tenth beyond that.",
    )
    yield statement(
        "M-C2.more",
        all(falls),
        f"E falls with every increase of N in {sum(falls)} of {len(falls)} cases (shape function and loading).",
        "From random positions it does not always: more markers change the noise, the seed of clusters with S4.",
    )
