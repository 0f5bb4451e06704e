"""Where the mass goes in two dimensions, Sec. 5: what the truncation leaves out, and what DD loses."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.special.plane import square_tail_mass
from fracparticles.special.stable import tail_mass
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import pick
from scenes.plane import particles_per_side

NEEDS: dict[str, list[Any]] = {"scheme": ["DD"], "dim": [1, 2], "exterior": ["truncated"]}

_DIGITS = 10  # of a loss in per cent: what a conservative scheme loses is round-off
_LOST, _START = "lost in the run, % of the initial mass", "left out at the start, %"
_MISSING = "missing at the end, %"


def study(inputs: Inputs) -> Result:
    """The mass outside at the start, the loss of each run, and what the exact solution sends out of the square."""
    key = ["dim", "scheme", "truncation", "N"]
    runs = inputs.scalars.assign(N=particles_per_side(inputs.scalars))
    runs = runs.sort_values(key, ascending=[False, True, True, True])
    before = np.array([_outside(run, run.t_initial) for run in runs.itertuples()])
    after = np.array([_outside(run, run.t_final) for run in runs.itertuples()])
    initial, final = runs["mass_initial"], runs["mass_final"]
    columns = {
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
    table = pd.DataFrame(columns)
    findings = _findings(table.assign(h=runs["particle_spacing"], run=runs["run"]))
    return Result(table.reset_index(drop=True), inputs.judged(findings))


def _outside(run: Any, t: float) -> float:
    """The mass of the fundamental solution beyond the lattice."""
    half, alpha = float(run.half_width), 1.0 + float(run.beta)
    return square_tail_mass(half, t, alpha) if run.dim == 2 else float(tail_mass(half, t, alpha, 1))


def _findings(table: pd.DataFrame) -> Iterator[Finding]:
    """Of DD on the paper's square, that of the least C; beside it the interval of the same h."""
    here = pick(table, scheme="DD", exterior="truncated")
    here = pick(here, C=here["C"].min())
    plane, line = pick(here, n=2), pick(here, n=1).iloc[0]
    finest = plane.loc[plane["N"].idxmax()]
    matching = plane.loc[(plane["h"] - line["h"]).abs().idxmin()]
    columns = {"left out at the start": _START, "lost by DD in the run": _LOST}
    yield measured(
        "L-2D-MASS.dd_loss",
        runs=table["run"],
        ours=finest[_LOST],
        by_count=plane.set_index("N")[_LOST],
        start=finest[_START],
        missing=finest[_MISSING],
    )
    yield measured(
        "L-2D-MASS.weaker",
        runs=table["run"],
        ratio={name: matching[column] / line[column] for name, column in columns.items()},
        plane={name: matching[column] for name, column in columns.items()},
        line={name: line[column] for name, column in columns.items()},
    )
