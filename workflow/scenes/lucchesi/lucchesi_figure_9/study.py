"""Error (59) in two dimensions against the particle spacing, Fig. 9, and what the truncation adds to it."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.kernels.families import kernel
from fracparticles.lattice.field import smoothed_field
from fracparticles.run.solution import relative_l1_deviation
from fracparticles.special.stable import central_mass
from fracstudy.findings import Finding, measured
from fracstudy.inputs import ORDERS, Inputs, Result
from fracstudy.orders import orders_by
from fracstudy.panels import pick
from scenes.plane import DISC, particles_per_side, stored_field

_PAPER = ["DD", "FPSE"]
NEEDS: dict[str, list[Any]] = {"scheme": _PAPER, "dim": [1, 2], "exterior": ["truncated", "open"]}

_ERROR, _FIELD = "error (59)", "error of the field (7)"
_ORDER, _FIELD_ORDER = "observed order", "observed order, field"
# Columns of the table: those of the errors, by exterior.
_COLUMNS = {
    "error (59), truncated": (_ERROR, "truncated"),
    "observed order, truncated": (_ORDER, "truncated"),
    "error of the field (7), truncated": (_FIELD, "truncated"),
    "observed order, field": (_FIELD_ORDER, "truncated"),
    "error (59), open exterior": (_ERROR, "open"),
    "observed order, open": (_ORDER, "open"),
}


def study(inputs: Inputs, *, particles: list[int]) -> Result:
    """Errors by lattice, of the strengths and of the field (7); by C; and of the schemes that the paper leaves out.

    The least C is the paper's, and `particles` are those of its lattices. What the truncation changes is compared
    between one dimension and two at the spacing of the runs in one dimension.
    """
    runs = inputs.scalars
    runs = runs.assign(C=runs["truncation"].round(6), N=particles_per_side(runs))
    least = runs["C"] == runs["C"].min()
    plane = runs[runs["dim"] == 2]
    errors = plane.rename(columns={"particle_spacing": "h", "relative_l1_error": _ERROR})
    errors["order"] = plane["order"].map(ORDERS)
    errors[_FIELD] = [_field_error(run) for run in plane.assign(least=least).itertuples()]
    key = ["exterior", "C", "scheme", "order"]
    errors = errors[[*key, "N", "h", _ERROR, _FIELD]].sort_values(
        [*key, "N"], ascending=[False, *[True] * 4], ignore_index=True
    )
    errors[_ORDER] = orders_by(errors, key, _ERROR)
    errors[_FIELD_ORDER] = orders_by(errors, key, _FIELD)
    wide = errors.pivot(index=["order", "scheme", "C", "N", "h"], columns="exterior")
    wide = wide.reindex(columns=pd.MultiIndex.from_tuples(_COLUMNS.values()))
    table = wide.set_axis(list(_COLUMNS), axis=1).reset_index()
    table = table[["scheme", "order", "C", "N", "h", *_COLUMNS]]
    findings = _findings(errors, _shift(runs[least]), particles, list(runs["run"]))
    return Result(table, inputs.judged(findings), errors)


def _field_error(run: Any) -> float:
    """The error of the field (7) of the paper's schemes on its square; nan for the others."""
    if not run.least or run.scheme not in _PAPER or run.exterior == "open" or run.order != 2:
        return np.nan
    stored = stored_field(run.run)
    if stored is None:
        return np.nan
    _, r, u = stored
    field, volume = smoothed_field(u, run.overlap), run.particle_spacing**2
    time, alpha = run.diffusivity * run.t_final, 1.0 + run.beta
    return relative_l1_deviation(field, r, volume, DISC, time=time, alpha=alpha, dim=2)


def _shift(runs: pd.DataFrame) -> pd.DataFrame:
    """What the truncation changes of u: sum V |truncated - open| in |x| <= 5, over the mass there; by n and scheme."""
    line = runs.loc[runs["dim"] == 1, "spacing"].iloc[0]
    runs = runs[np.isclose(runs["spacing"], line, rtol=1e-6) & (runs["order"] == 2)]
    shift = pd.DataFrame(columns=NEEDS["dim"], dtype=float)
    for key, pair in runs.groupby(["scheme", "dim"]):
        files = pair.set_index("exterior")["run"]
        if len(files) == 2:
            fields = [stored_field(files[exterior]) for exterior in NEEDS["exterior"]]
            (_, r, truncated), (_, _, opened) = (field for field in fields if field)
            run = pair.iloc[0]
            inside = r <= DISC * (1.0 + 1e-12)
            volume = run["particle_spacing"] ** run["dim"]
            change = volume * np.abs(truncated - opened)[inside].sum()
            mass = central_mass(DISC, run["t_final"], 1.0 + run["beta"], run["dim"])
            shift.loc[key] = change / mass
    return shift


def _findings(
    errors: pd.DataFrame, shift: pd.DataFrame, printed: list[int], files: list[str]
) -> list[Finding]:
    second = pick(errors, exterior="truncated", order="II")
    usual = second["C"] == errors["C"].min()
    paper = second[usual & second["scheme"].isin(_PAPER) & second["N"].isin(printed)]
    if not set(printed) <= set(paper["N"]):
        return []
    by_count = paper.pivot(index="N", columns="scheme")
    error = by_count[_ERROR]
    order, field = (by_count[name][1:].unstack() for name in (_ORDER, _FIELD_ORDER))
    # The same h on wider squares.
    wide = second[second["h"].round(9).isin(second.loc[~usual, "h"].round(9))]
    by_width = wide.pivot(index="C", columns="scheme", values=_ERROR)
    change = by_width.max() / by_width.min() - 1.0
    weaker = shift[1] / shift[2]
    line, plane = (_tail_exponents(dim) for dim in NEEDS["dim"])
    found = partial(measured, runs=files)
    fall = (error / error.shift())[1:].unstack()
    of_field = {"the field (7) for the strengths": {"difference": (field - 2.0).abs()}}
    off = (order - 2.0).abs()
    return [
        found("L-F9.decreases", ratio=fall, largest=error.iloc[0], least=error.iloc[-1]),
        found("L-F9.second_order", difference=off, order=order, field=field, others=of_field),
        found("L-F9.fpse_larger", ratio=error["FPSE"] / error["DD"]),
        found("L-F9.truncation", change=change[_PAPER], other=change.drop(_PAPER)),
        found("L-F9.weaker", ratio=weaker[_PAPER], other=weaker.drop(_PAPER)),
        found("L-F9.decay", change=plane - line),
    ]


def _tail_exponents(dim: int) -> pd.Series:
    """d log K / d log r far out, of the kernels of DD and of FPSE's flux."""
    r = np.array([1e5, 1e6])
    tails = {name: np.log10(np.abs(kernel(name, r, 1.5, dim))) for name in ("G", "F")}
    return pd.Series({name: tail @ [-1.0, 1.0] for name, tail in tails.items()})
