"""Where the mass goes in two dimensions, Sec. 5: what the truncation leaves out, and what DD loses."""

from typing import Any

import numpy as np
import pandas as pd

from fracparticles.special.plane import square_tail_mass
from fracparticles.special.stable import tail_mass
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from scenes.plane import particles_per_side

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
            "left out, exact, %": 100.0 * before,
            _LOST: (100.0 * (1.0 - final / initial)).round(_DIGITS),
            "lost, exact, %": 100.0 * (1.0 - (1.0 - after) / (1.0 - before)),
            _MISSING: 100.0 * (1.0 - final),
            "missing, exact, %": 100.0 * after,
        }
    )
    findings = _findings(table.assign(h=runs["particle_spacing"], run=runs["run"]))
    return Result(table.reset_index(drop=True), inputs.judged(findings))


def _outside(run: Any, t: float) -> float:
    """The mass of the fundamental solution beyond the lattice."""
    half, alpha = float(run.half_width), 1.0 + float(run.beta)
    return square_tail_mass(half, t, alpha) if run.dim == 2 else float(tail_mass(half, t, alpha, 1))


def _findings(table: pd.DataFrame) -> list[Finding]:
    """Of DD on the paper's square, that of the least C; beside it the interval of the same h."""
    here = table[(table["scheme"] == "DD") & (table["exterior"] == "truncated")]
    here = here[here["C"] == here["C"].min()]
    plane, line = here[here["n"] == 2], here[here["n"] == 1].iloc[0]
    finest = plane.loc[plane["N"].idxmax()]
    matching = plane.loc[(plane["h"] - line["h"]).abs().idxmin()]
    columns = {"left out at the start": _START, "lost by DD in the run": _LOST}
    files = list(table["run"])
    return [
        measured(
            "L-2D-MASS.dd_loss",
            runs=files,
            ours=finest[_LOST],
            by_count=plane.set_index("N")[_LOST],
            start=finest[_START],
            missing=finest[_MISSING],
        ),
        measured(
            "L-2D-MASS.weaker",
            runs=files,
            ratio={name: matching[column] / line[column] for name, column in columns.items()},
            plane={name: matching[column] for name, column in columns.items()},
            line={name: line[column] for name, column in columns.items()},
        ),
    ]
