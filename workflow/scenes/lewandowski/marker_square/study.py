"""Figs. 5-7: the square profile with a small, a large and an intermediate support parameter."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from fracstudy.panels import Panels
from scenes.lewandowski.square_profile import CLOSE, LOADINGS, SQUARE, SquareRuns, Trace, delay

__all__ = ["study"]

_NEAR = [LOADINGS["midpoints"], LOADINGS["random"]]


def study(
    inputs: Inputs, *, run: SquareRuns, supports: list[float], shown: list[float], seed: int
) -> Result:
    """Run the square profile with S8 for a range of support parameters and every start.

    `shown` are the small, the large and the intermediate one of Figs. 5, 6, 7. A run whose F turns negative at a marker
    has no results, but says when and where. The slope is the largest |F_x| on the fixed grid against the largest |f_x|,
    the delay that of the exact solution nearest to F. A solution oscillates if F has more than one maximum above a
    hundredth of its largest. A statement holds if it does for one of the starts within [-1, 1].
    """
    square = SquareRuns.model_validate(run)
    rows, panels = [], Panels()
    panels.add("field", "exact", square.z, square.exact)
    for loading, title in LOADINGS.items():
        for epsilon in sorted({*supports, *shown}):
            trace = square.having(support=epsilon).trace("S8", loading, seed, follow=False)
            row: dict[str, Any] = {"loading": title, "ε": epsilon}
            if trace.run:
                row |= _measured(square, trace)
                f = trace.end.field(square.z)
                panels.add("field", loading, square.z, f, support=epsilon)
                panels.add("error", loading, epsilon, row["relative error"])
                panels.add("slope", loading, epsilon, row["largest slope / exact"])
            rows.append({**row, "stopped": trace.stopped.split(": a velocity")[0]})
    table = pd.DataFrame(rows)
    table["stopped"] = table.pop("stopped")  # last, also if the first run stopped
    return Result(table, inputs.judged(_findings(table, *map(float, shown))), panels.frame)


def _measured(square: SquareRuns, trace: Trace) -> dict[str, Any]:
    z, end, exact = square.z, trace.end, square.exact
    step = z[1] - z[0]
    f, slope = end.velocity.fields(end.x, end.weights, z)
    inner = f[1:-1]
    maxima = (inner > f[:-2]) & (inner >= f[2:]) & (inner > 0.01 * f.max())
    tau, left = delay(z, f, square.t_final)
    norm = np.sqrt(step * np.sum(exact**2))
    return {
        "relative error": np.sqrt(step * np.sum((f - exact) ** 2)) / norm,
        "largest slope / exact": np.abs(slope).max() / np.abs(SQUARE.slope(z, square.t_final)).max(),
        "F(0) / f(0)": square.peak(f),
        "maxima": int(np.sum(maxima)),
        "delay": tau,
        "error left by the delay": left,
    }  # fmt: skip


def _findings(table: pd.DataFrame, small: float, large: float, middle: float) -> Iterator[Finding]:
    by = table.set_index(["loading", "ε"])

    def at(epsilon: float, column: str) -> pd.Series:
        return by.xs(epsilon, level="ε")[column].dropna()

    def said(values: pd.Series, form: str = ".2f") -> str:
        return ", ".join(f"{value:{form}} ({name})" for name, value in values.dropna().items())

    error = by["relative error"].unstack()
    best = error.idxmin(axis=1)
    of_three = error[[small, large, middle]].dropna().idxmin(axis=1)
    quiet = error.loc[_NEAR[0]]
    steep, flat = (at(e, "largest slope / exact") for e in (small, large))
    waves, peak = at(small, "maxima"), at(large, "F(0) / f(0)")
    late, left = at(large, "delay"), at(large, "error left by the delay")
    yield statement(
        "M-F5.slope",
        (steep.reindex(_NEAR) > 1.0).any(),
        f"The largest slope is {said(steep)} times the exact one.",
        "It is not larger than the exact one.",
    )
    yield statement(
        "M-F5.oscillates",
        (waves.reindex(_NEAR) > 1).any(),
        f"At ε = {small:g} F has {said(waves, '.0f')} maxima; f has one.",
        "F has no more maxima than f.",
    )
    yield statement(
        "M-F6.slope",
        (flat < 1.0).any(),
        f"At ε = {large:g} the largest slope is {said(flat)} times the exact one.",
        "It is too large, whatever the loading: F starts smoothed over ε, so the markers start too slowly and stay "
        f"behind. F is nearest to the exact solution {said(late)} earlier, which leaves {left.min():.0%} to "
        f"{left.max():.0%} of the error.",
    )
    yield statement(
        "M-F6.smoothed",
        (peak < 1.0).any(),
        f"At ε = {large:g}, F(0) is {said(peak)} times f(0).",
        "A smoothed f would be lower at its peak and wider: F is higher and narrower.",
    )
    yield statement(
        "M-F7.good",
        (error.loc[_NEAR, middle] <= CLOSE).any(),
        f"At ε = {middle:g} the relative error is {said(error[middle], '.3f')}.",
        "The error is above 5 %.",
    )
    yield statement(
        "M-F7.optimal",
        (best[_NEAR] == middle).any(),
        f"Of the three it is best for {', '.join(of_three.index[of_three == middle])}. Of all, the best ε is "
        f"{said(best)}; the error there is {quiet.min() / quiet[middle]:.2f} times that at ε = {middle:g} "
        f"({_NEAR[0]}).",
        "It is the best of the three shown only: about half of it is better.",
    )
