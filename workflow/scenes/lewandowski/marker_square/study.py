"""Figs. 5-7: the square profile with a small, a large and an intermediate support parameter."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from scenes.lewandowski.marker_runs import LOADINGS, SQUARE, delay, fixed_grid, trace

__all__ = ["study"]

_SHAPE = "S8"
_CLOSE = 0.05  # "good": an error of at most 5 % of the norm of f


def study(inputs: Inputs) -> Result:
    """Run the square profile for a range of support parameters and every loading.

    Parameters of the scene: `supports`, `shown` (small, large, intermediate: Figs. 5, 6, 7), `dt`, `t_final`,
    `markers`, `half_width`, `grid`, `seed`. A run whose F turns negative at a marker has no results, but says when and
    where. The slope is the largest |F_x| on the fixed grid against the largest |f_x|, the delay that of the exact
    solution nearest to F. A solution oscillates if F has more than one maximum above a hundredth of its largest. A
    statement holds if it does for one of the loadings within [-1, 1].
    """
    parameters = inputs.parameters
    supports = sorted({*parameters["supports"], *parameters["shown"]})
    grid, t = fixed_grid(parameters), float(parameters["t_final"])
    exact, slope = SQUARE.value(grid, t), np.abs(SQUARE.slope(grid, t)).max()
    step = grid[1] - grid[0]
    norm = np.sqrt(step * np.sum(exact**2))
    rows: list[dict[str, Any]] = []
    fields: dict[tuple[str, float], np.ndarray] = {}
    for loading in LOADINGS:
        for epsilon in supports:
            found = trace(
                parameters, _SHAPE, loading, int(parameters["seed"]), support=epsilon, follow=False
            )
            row: dict[str, Any] = {"loading": LOADINGS[loading], "ε": epsilon}
            rows.append(row)
            if found.run is None:
                row["stopped"] = found.stopped.split(": a velocity")[0]
                continue
            end = found.run
            fields[loading, epsilon] = f = end.field(grid)
            tau, left = delay(grid, f, t)
            row.update(
                {
                    "relative error": np.sqrt(step * np.sum((f - exact) ** 2)) / norm,
                    "largest slope / exact": np.abs(end.velocity.fields(end.x, end.weights, grid)[1]).max() / slope,
                    "F(0) / f(0)": np.interp(0.0, grid, f) / np.interp(0.0, grid, exact),
                    "maxima": _maxima(f),
                    "delay": tau,
                    "error left by the delay": left,
                }
            )  # fmt: skip
    table = pd.DataFrame(rows)
    if "stopped" not in table:
        table["stopped"] = ""
    table["stopped"] = table["stopped"].fillna("")
    return Result(table, _findings(table, parameters), _series(fields, grid, exact, table))


def _maxima(f: np.ndarray) -> int:
    inner = f[1:-1]
    return int(np.sum((inner > f[:-2]) & (inner >= f[2:]) & (inner > 0.01 * f.max())))


def _findings(table: pd.DataFrame, parameters: Mapping[str, Any]) -> list[Finding]:
    small, large, middle = map(float, parameters["shown"])
    by = table.set_index(["loading", "ε"])
    near = [LOADINGS["midpoints"], LOADINGS["random"]]

    def at(epsilon: float, column: str) -> pd.Series:
        return by.xs(epsilon, level="ε")[column].dropna()

    def spelled(values: pd.Series, form: str = ".2f") -> str:
        return ", ".join(f"{value:{form}} ({name})" for name, value in values.dropna().items())

    error = by["relative error"].unstack()
    best = error.idxmin(axis=1)
    of_three = error[[small, large, middle]].dropna().idxmin(axis=1)
    quiet = error.loc[near[0]]
    steep, flat = (at(e, "largest slope / exact") for e in (small, large))
    waves, peak = at(small, "maxima"), at(large, "F(0) / f(0)")
    late, left = at(large, "delay"), at(large, "error left by the delay")
    return [
        statement(
            "M-F5.slope",
            bool((steep.reindex(near) > 1.0).any()),
            f"The largest slope is {spelled(steep)} times the exact one.",
            "It is not larger than the exact one.",
        ),
        statement(
            "M-F5.oscillates",
            bool((waves.reindex(near) > 1).any()),
            f"At ε = {small:g} F has {spelled(waves, '.0f')} maxima; f has one.",
            "F has no more maxima than f.",
        ),
        statement(
            "M-F6.slope",
            bool((flat < 1.0).any()),
            f"At ε = {large:g} the largest slope is {spelled(flat)} times the exact one.",
            "It is too large, whatever the loading: F starts smoothed over ε, so the markers start too slowly and stay "
            f"behind. F is nearest to the exact solution {spelled(late)} earlier, which leaves {left.min():.0%} to "
            f"{left.max():.0%} of the error.",
        ),
        statement(
            "M-F6.smoothed",
            bool((peak < 1.0).any()),
            f"At ε = {large:g}, F(0) is {spelled(peak)} times f(0).",
            "A smoothed f would be lower at its peak and wider: F is higher and narrower.",
        ),
        statement(
            "M-F7.good",
            bool((error.loc[near, middle] <= _CLOSE).any()),
            f"At ε = {middle:g} the relative error is {spelled(error[middle], '.3f')}.",
            "The error is above 5 %.",
        ),
        statement(
            "M-F7.optimal",
            bool((best[near] == middle).any()),
            f"Of the three it is best for {', '.join(of_three.index[of_three == middle])}. Of all, the best ε is "
            f"{spelled(best)}; the error there is {quiet.min() / quiet[middle]:.2f} times that at ε = {middle:g} "
            f"({near[0]}).",
            "It is the best of the three shown only: about half of it is better.",
        ),
    ]


def _series(
    fields: Mapping[tuple[str, float], np.ndarray],
    grid: np.ndarray,
    exact: np.ndarray,
    table: pd.DataFrame,
) -> pd.DataFrame:
    """Panel "field": F by loading and eps, and exact; panels "error" and "slope" against eps."""
    parts = [pd.DataFrame({"panel": "field", "series": "exact", "x": grid, "y": exact})]
    parts += [
        pd.DataFrame({"panel": "field", "series": loading, "support": epsilon, "x": grid, "y": f})
        for (loading, epsilon), f in fields.items()
    ]
    names = {title: loading for loading, title in LOADINGS.items()}
    for panel, column in (("error", "relative error"), ("slope", "largest slope / exact")):
        parts.append(
            pd.DataFrame(
                {"panel": panel, "series": table["loading"].map(names), "x": table["ε"], "y": table[column]}
            ).dropna(subset=["y"])
        )  # fmt: skip
    return pd.concat(parts, ignore_index=True)
