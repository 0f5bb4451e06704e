"""Where the mass goes in two dimensions, Sec. 5: what the truncation leaves out, and what DD loses."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from fracparticles.special.plane import square_tail_mass
from fracparticles.special.stable import tail_mass
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement, value
from scenes.plane import particles_per_side

__all__ = ["study"]

NEEDS: dict[str, list[Any]] = {"scheme": ["DD"], "dim": [1, 2], "exterior": ["truncated"]}

_DIGITS = 10  # of a loss in per cent: what a conservative scheme loses is round-off
_LOST, _START = "lost in the run, % of the initial mass", "left out at the start, %"
_MISSING = "missing at the end, %"


def study(inputs: Inputs) -> Result:
    """The mass outside at the start, the loss of each run, and what the exact solution sends out of the square."""
    runs = inputs.scalars
    runs = runs.assign(N=particles_per_side(runs)).sort_values(
        ["dim", "scheme", "truncation", "N"], ascending=[False, True, True, True]
    )
    before, after = (
        np.array([_outside(run, getattr(run, time)) for run in runs.itertuples()])
        for time in ("t_initial", "t_final")
    )
    initial, final = runs["mass_initial"], runs["mass_final"]
    table = pd.DataFrame(
        {
            "n": runs["dim"],
            "scheme": runs["scheme"],
            "exterior": runs["exterior"],
            "C": runs["truncation"].round(6),
            "N": runs["N"],
            _START: 100.0 * (1.0 - initial),
            "the same, exact, %": 100.0 * before,
            _LOST: (100.0 * (1.0 - final / initial)).round(_DIGITS),
            "the same, exact solution, %": 100.0 * (1.0 - (1.0 - after) / (1.0 - before)),
            _MISSING: 100.0 * (1.0 - final),
            "the same, exact solution on the lattice, %": 100.0 * after,
        }
    )
    findings = _findings(table.assign(h=runs["particle_spacing"], run=runs["run"]), inputs)
    return Result(table.reset_index(drop=True), inputs.judged(findings))


def _outside(run: Any, t: float) -> float:
    """The mass of the fundamental solution beyond the lattice."""
    half, alpha = float(run.half_width), 1.0 + float(run.beta)
    return square_tail_mass(half, t, alpha) if run.dim == 2 else float(tail_mass(half, t, alpha, 1))


def _findings(table: pd.DataFrame, inputs: Inputs) -> list[Finding]:
    """Of DD on the paper's square, that of the least C; beside it the interval of the same h."""
    here = table[(table["scheme"] == "DD") & (table["exterior"] == "truncated")]
    here = here[here["C"] == here["C"].min()]
    plane, line = here[here["n"] == 2], here[here["n"] == 1].iloc[0]
    lost = plane[_LOST]
    finest = plane.loc[plane["N"].idxmax()]
    matching = plane.loc[(plane["h"] - line["h"]).abs().idxmin()]
    files = list(table["run"])
    return [
        value(
            "L-2D-MASS.dd_loss",
            finest[_LOST],
            f"{finest[_LOST]:.2f} % is what DD loses from t_0 to t_f at N = {finest['N']:.0f} ({lost.min():.2f} to "
            f"{lost.max():.2f} % over the four N). What the initial condition leaves out beyond the square, "
            f"with any scheme, is {finest[_START]:.2f} %, to be compared with the printed "
            f"{inputs.printed.get('L-2D-MASS.dd_loss')} %. Together {finest[_MISSING]:.2f} % are missing at t_f.",
            files,
        ),
        statement(
            "L-2D-MASS.weaker",
            matching[_LOST] < line[_LOST] and matching[_START] < line[_START],
            f"At C = {matching['C']:g} and the same h, n = 1 and 2: left out at the start {line[_START]:.2f} and "
            f"{matching[_START]:.2f} %, lost by DD in the run {line[_LOST]:.2f} and {matching[_LOST]:.2f} %.",
            "By mass the truncation is stronger in two dimensions: the mass beyond D falls like D^-alpha for every n, "
            "with a larger factor for n = 2. Weaker is its effect on the error (see L-F9.weaker).",
            files,
        ),
    ]
