"""Where the mass goes in two dimensions, Sec. 5: what the truncation leaves out, and what DD loses."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.special.stable import tail_mass
from fracstudy.inputs import Inputs, Result, statement, value
from scenes.beyond.solution_map_2d.study import square_tail_mass, with_count

__all__ = ["study"]

_DIGITS = 10  # of a loss in per cent: what a conservative scheme loses is round-off


def study(inputs: Inputs) -> Result:
    """The mass outside at the start, the loss of each run, and what the exact solution sends out of the square."""
    runs = with_count(inputs.scalars).sort_values(["dim", "scheme", "truncation", "N"])
    runs = runs.sort_values("dim", ascending=False, kind="stable")
    rows = []
    for run in runs.to_dict("records"):
        outside = [_outside(run, run[name]) for name in ("t_initial", "t_final")]
        rows.append(
            {
                "n": run["dim"],
                "scheme": run["scheme"],
                "exterior": run["exterior"],
                "C": round(run["truncation"], 6),
                "N": run["N"],
                "left out at the start, %": 100.0 * (1.0 - run["mass_initial"]),
                "the same, exact, %": 100.0 * outside[0],
                "lost in the run, % of the initial mass": round(
                    100.0 * (1.0 - run["mass_final"] / run["mass_initial"]), _DIGITS
                ),
                "the same, exact solution, %": 100.0
                * (1.0 - (1.0 - outside[1]) / (1.0 - outside[0])),
                "missing at the end, %": 100.0 * (1.0 - run["mass_final"]),
                "the same, exact solution on the lattice, %": 100.0 * outside[1],
            }
        )
    table = pd.DataFrame(rows)
    return Result(table, _findings(table, runs, inputs))


def _outside(run: Mapping[Any, Any], t: float) -> float:
    """The mass of the fundamental solution beyond the lattice."""
    half, alpha = float(run["half_width"]), 1.0 + float(run["beta"])
    return (
        square_tail_mass(half, t, alpha) if run["dim"] == 2 else float(tail_mass(half, t, alpha, 1))
    )


def _findings(table: pd.DataFrame, runs: pd.DataFrame, inputs: Inputs) -> list:
    usual = np.isclose(table["C"], inputs.parameters["truncation"]) & (
        table["exterior"] == "truncated"
    )
    here = table[usual & (table["scheme"] == "DD")]
    plane, line = here[here["n"] == 2], here[here["n"] == 1].iloc[0]
    lost, start = "lost in the run, % of the initial mass", "left out at the start, %"
    finest = plane.loc[plane["N"].idxmax()]
    matching = plane.loc[plane["N"] == inputs.parameters["compared_count"]].iloc[0]
    printed = inputs.printed["L-2D-MASS.dd_loss"]
    files = list(runs["run"])
    return [
        value(
            "L-2D-MASS.dd_loss",
            finest[lost],
            f"{finest[lost]:.2f} % is what DD loses from t_0 to t_f at N = {finest['N']:.0f} ({plane[lost].min():.2f} "
            f"to {plane[lost].max():.2f} % over the four N). What the initial condition leaves out beyond the square, "
            f"with any scheme, is {finest[start]:.2f} %, to be compared with the printed {printed} %. Together "
            f"{finest['missing at the end, %']:.2f} % are missing at t_f.",
            files,
        ),
        statement(
            "L-2D-MASS.weaker",
            bool(matching[lost] < line[lost] and matching[start] < line[start]),
            f"At C = {matching['C']:g} and the same h, n = 1 and 2: left out at the start {line[start]:.2f} and "
            f"{matching[start]:.2f} %, lost by DD in the run {line[lost]:.2f} and {matching[lost]:.2f} %.",
            "By mass the truncation is stronger in two dimensions: the mass beyond D falls like D^-alpha for every n, "
            "with a larger factor for n = 2. Weaker is its effect on the error (see L-F9.weaker).",
            files,
        ),
    ]
