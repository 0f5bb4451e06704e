"""Order of self-convergence (49) in two dimensions, Sec. 5, in every reading of the printed numbers."""

from __future__ import annotations

from itertools import product

import netCDF4
import numpy as np
import pandas as pd

from fracstudy.inputs import Inputs, Result, statement, value
from scenes.beyond.solution_map_2d.study import DISK, reconstructed, with_count
from scenes.lucchesi.lucchesi_table_2.study import self_convergence_order

__all__ = ["study"]

_SECOND = 0.1  # how far from 2 the order on the finest lattices may be
# Which of the three levels of (49) the printed h may be: the level's place among them.
_LEVELS = {"middle": 1, "coarse": 0, "fine": 2}
_SCHEMES = ("DD", "FPSE")

# By N: h, x, and u of the strengths and of the field (7).
_Levels = dict[int, tuple[float, np.ndarray, dict[str, np.ndarray]]]


def study(inputs: Inputs) -> Result:
    """The printed orders, ours from the field (7) over the disk with h as middle level, and the other readings."""
    printed = inputs.printed
    counts = {float(h): int(count) for h, count in inputs.parameters["spacing"].items()}
    runs = with_count(inputs.scalars)
    if "kernel_table" not in runs:
        runs["kernel_table"] = np.nan
    exact, tabulated = runs[runs["kernel_table"].isna()], runs[runs["kernel_table"].notna()]
    rows, findings = [], []
    for scheme in _SCHEMES:
        levels = _read(exact[exact["scheme"] == scheme])
        by_table = _read(tabulated[tabulated["scheme"] == scheme])
        for h, count in counts.items():
            claim = f"L-2D-ORD.{scheme}.h{h:g}"
            for what, region in product(("field (7)", "strengths"), ("disk", "all")):
                orders = {
                    name: _order(levels, count, place, what, region)
                    for name, place in _LEVELS.items()
                }
                rows.append(
                    {
                        "scheme": scheme,
                        "h": levels[count][0],
                        "N": count,
                        "of the": what,
                        "over": "r <= 5" if region == "disk" else "all particles",
                        "printed": float(printed[claim]),
                        "ours, h as middle level": orders["middle"],
                        "deviation": orders["middle"] - float(printed[claim]),
                        "h as coarse level": orders["coarse"],
                        "h as fine level": orders["fine"],
                        "with kernel tables": _order(by_table, count, 1, what, region),
                    }
                )
    table = pd.DataFrame(rows)
    files = list(runs["run"])
    for scheme, h in product(_SCHEMES, counts):
        claim = f"L-2D-ORD.{scheme}.h{h:g}"
        here = table[(table["scheme"] == scheme) & (table["N"] == counts[h])]
        ours = here["ours, h as middle level"]
        nearest = (ours - float(printed[claim])).abs().idxmin()
        findings.append(
            value(
                claim,
                ours.iloc[0],
                "Ours: field (7) over r <= 5, h as middle level, exact kernels; the print does not name the reading. "
                f"Of the readings with h as middle level the nearest is the {table.loc[nearest, 'of the']}, "
                f"{table.loc[nearest, 'over']}, {abs(table.loc[nearest, 'deviation']):.3f} off.",
                files,
            )
        )
    findings += _others(table, counts, runs, inputs)
    return Result(table, findings)


def _read(runs: pd.DataFrame) -> _Levels:
    """By N: h, x and u, both of the strengths and of the field (7)."""
    found = {}
    for run in runs.to_dict("records"):
        with netCDF4.Dataset(run["run"]) as file:
            x, u = np.asarray(file["x"][:]), np.asarray(file["u"][:])
        found[run["N"]] = (
            float(run["particle_spacing"]),
            x,
            {"strengths": u, "field (7)": reconstructed(u, run["overlap"])},
        )
    return found


def _order(levels: _Levels, count: int, place: int, what: str, region: str) -> float:
    """(49) of three lattices, that of `count` particles a side at `place` among them; nan if one is missing."""
    names = [round((count - 1) * 2.0 ** (level - place)) + 1 for level in range(3)]
    if not set(names) <= set(levels):
        return np.nan
    x = levels[names[0]][1]
    r = np.hypot(x[:, None], x[None, :])
    inside = r <= (DISK * (1.0 + 1e-12) if region == "disk" else np.inf)
    return self_convergence_order(
        [levels[name][2][what][:: 2**k, :: 2**k][inside] for k, name in enumerate(names)]
    )


def _others(table: pd.DataFrame, counts: dict, runs: pd.DataFrame, inputs: Inputs) -> list:
    spacings = runs.groupby("N")["particle_spacing"].first()
    findings = [
        value(
            f"L-2D-ORD.spacing.h{h:g}",
            float(spacings[count]),
            f"2 D / (N - 1) at N = {count}.",
        )
        for h, count in counts.items()
    ]
    finest = table[(table["N"] == max(counts.values())) & (table["over"] == "r <= 5")]
    orders = finest.set_index(["of the", "scheme"])["ours, h as middle level"]
    everywhere = table[(table["N"] == max(counts.values())) & (table["over"] != "r <= 5")]
    least = everywhere["ours, h as middle level"].min()
    findings.append(
        statement(
            "L-2D-ORD.second_order",
            bool(((orders - 2.0).abs() < _SECOND).all()),
            "On the finest three lattices, over r <= 5: "
            + "; ".join(
                f"{order:.3f} ({scheme}, {what})" for (what, scheme), order in orders.items()
            )
            + f". Over all particles it is down to {least:.2f}: as in one dimension, the layer of FPSE at the edge "
            "does not converge.",
            "On the finest three lattices the order is not near 2.",
            list(runs["run"]),
        )
    )
    return findings
