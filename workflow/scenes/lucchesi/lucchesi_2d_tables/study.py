"""Kernels interpolated in tables, the remark of Sec. 5: what the step of the table does to DD and FPSE."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.run.case import Case
from fracparticles.schemes.base import lattice_radii
from fracparticles.schemes.dd import DirectDifferentiation
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.orders import orders_by
from scenes.plane import particles_per_side

_KERNELS = {"DD": "G", "FPSE": "F"}
NEEDS: dict[str, list[Any]] = {"scheme": list(_KERNELS), "kernel_table": [None]}


def spurious_rate(case: Case, step: float) -> float:
    """Return the rate of decay of a uniform strength that a table of this step adds to DD.

    sum_j V_j (table - G)_epsilon(x_i - x_j) / epsilon^alpha over the square: the integral of G is zero, that of its
    chords is not, and by Euler and Maclaurin the difference is near (step^2 / 12) int G'' = pi step^2 G(0) / 6 < 0,
    over epsilon^alpha: it grows when h falls.
    """
    n, dd = case.n, DirectDifferentiation()
    radii = lattice_radii(n + 1, 2)
    error = dd.weights(radii, replace(case.setting, kernel_table=step))
    error -= dd.weights(radii, replace(case.setting, kernel_table=None))
    # The quadrant m >= 0: points on an axis stand for two, the others for four.
    copies = np.where(np.arange(n + 1) > 0, 2.0, 1.0)
    return float(-case.setting.rate * copies @ error @ copies)


def study(inputs: Inputs) -> Result:
    """Errors (59) with exact kernels and with the tables, and the spurious decay of DD."""
    runs = inputs.scalars
    steps = runs["kernel_table"].fillna(0.0) if "kernel_table" in runs else 0.0
    runs = runs.assign(N=particles_per_side(runs), step=steps)
    runs = runs.sort_values(["step", "scheme", "N"], ignore_index=True)
    runs["h"], runs["y"] = runs["particle_spacing"], runs["relative_l1_error"]
    runs["order"] = orders_by(runs, ["step", "scheme"], "y")
    runs["spurious"] = [_spurious_decay(run) for run in runs.itertuples()]
    wide = runs.pivot(index=["scheme", "N"], columns="step")
    first = wide.index.to_frame(index=False)
    first.insert(1, "kernel", first["scheme"].map(_KERNELS))
    columns: dict[str, Any] = {"h": wide["h"].bfill(axis=1).iloc[:, 0]}
    for step in wide["y"]:
        columns[f"error (59), {_name(step)}"] = wide["y"][step]
        columns[f"observed order, {_name(step)}"] = wide["order"][step]
    for step in wide["y"].columns[1:]:
        columns[f"spurious decay in the run, step {step:g}"] = wide["spurious"][step]
    table = first.join(pd.DataFrame(columns).reset_index(drop=True))
    findings = _findings(runs, list(inputs.scalars["run"]))
    return Result(table, inputs.judged(findings), runs[["scheme", "h", "step", "y", "spurious"]])


def _name(step: float) -> str:
    return f"table, step {step:g}" if step else "exact kernel"


def _spurious_decay(run: Any) -> float:
    """1 - exp(-rate T) for DD with a table; a flux of zero mean has none."""
    if run.scheme != "DD" or run.step == 0.0:
        return np.nan
    grid = {"beta": run.beta, "dim": 2, "truncation": run.truncation, "spacing": run.h}
    case = Case(scheme="DD", integrator="exponential", **grid)
    return float(-np.expm1(-spurious_rate(case, run.step) * (run.t_final - run.t_initial)))


def _findings(runs: pd.DataFrame, files: list[str]) -> Iterator[Finding]:
    """For each scheme and table: the error over that with exact kernels, and how much lower the last order is."""
    parts = {key: part.set_index("N") for key, part in runs.groupby(["scheme", "step"])}
    for (scheme, step), tabled in parts.items():
        if step == 0.0 or scheme not in _KERNELS or (scheme, 0.0) not in parts:
            continue
        exact = parts[scheme, 0.0]
        ratio, usual = tabled["y"] / exact["y"], exact["order"].iloc[-1]
        decay = {"the solution for its error": {"change": tabled["spurious"]}}
        yield measured(
            f"L-2D-TAB.{_KERNELS[scheme]}.step{step:g}",
            runs=files,
            others=decay if scheme == "DD" else {},
            ratio=ratio,
            last=ratio.iloc[-1],
            change=(ratio - 1.0).abs(),
            drop=usual - tabled["order"].iloc[-1],
            order=tabled["order"].iloc[-1],
            usual=usual,
            difference=(tabled["y"] - exact["y"]).iloc[1:],
        )
