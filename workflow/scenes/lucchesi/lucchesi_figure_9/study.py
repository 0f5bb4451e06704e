"""Error (59) in two dimensions against the particle spacing, Fig. 9, and what the truncation adds to it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import netCDF4
import numpy as np
import pandas as pd

from fracparticles.special.stable import central_mass, green
from fracstudy.inputs import ORDERS, Inputs, Result, observed_order, statement
from scenes.beyond.solution_map_2d.study import DISK, reconstructed, with_count

__all__ = ["disk_error", "study"]

_SECOND = 0.3  # how far from 2 an observed order may be
_WEAK = 0.05  # share of the error that a weak effect may change
_PAPER = ["DD", "FPSE"]


def disk_error(
    deviation: np.ndarray, radius: np.ndarray, run: Mapping[Any, Any] | pd.Series
) -> float:
    """Return the sum of V |deviation| over the disk |x| <= 5, in parts of the mass of the exact solution there."""
    dim, alpha = int(run["dim"]), 1.0 + float(run["beta"])
    inside = radius <= DISK * (1.0 + 1e-12)
    volume = float(run["particle_spacing"]) ** dim
    mass = float(central_mass(DISK, float(run["t_final"]), alpha, dim))
    return float(volume * np.abs(deviation[inside]).sum() / mass)


def study(inputs: Inputs) -> Result:
    """Errors by lattice, of the strengths and of the field (7); by C; and of the schemes that the paper leaves out."""
    runs = with_count(inputs.scalars)
    plane = runs[runs["dim"] == 2]
    usual = np.isclose(plane["truncation"], inputs.parameters["truncation"])
    errors = _by_lattice(plane[usual])
    widths = _by_width(plane, inputs)
    shift = _by_dimension(runs, inputs)
    series = pd.concat([errors, widths], ignore_index=True)
    findings = _findings(errors, widths, shift, inputs)
    return Result(_table(series), findings, series)


def _table(errors: pd.DataFrame) -> pd.DataFrame:
    """One row a lattice: truncated and open side by side."""
    keys = ["scheme", "order", "C", "N", "h"]
    pair = {
        exterior: errors[errors["exterior"] == exterior].set_index(keys)
        for exterior in ("truncated", "open")
    }
    columns = {
        "error (59), truncated": pair["truncated"]["error (59)"],
        "observed order, truncated": pair["truncated"]["observed order"],
        "error of the field (7), truncated": pair["truncated"]["error of the field (7)"],
        "observed order, field": pair["truncated"]["observed order, field"],
        "error (59), open exterior": pair["open"]["error (59)"],
        "observed order, open": pair["open"]["observed order"],
    }
    return pd.DataFrame(columns).reset_index().sort_values(["order", "scheme", "C", "N"])


def _by_lattice(runs: pd.DataFrame) -> pd.DataFrame:
    rows = []
    for run in runs.to_dict("records"):
        row = {
            "scheme": run["scheme"],
            "order": ORDERS[run["order"]],
            "exterior": run["exterior"],
            "C": round(run["truncation"], 6),
            "N": run["N"],
            "h": run["particle_spacing"],
            "error (59)": run["relative_l1_error"],
            "error of the field (7)": np.nan,
        }
        with netCDF4.Dataset(run["run"]) as file:
            paper = run["scheme"] in _PAPER and run["exterior"] == "truncated"
            if "u" in file.variables and paper and run["order"] == 2:
                u, x = np.asarray(file["u"][:]), np.asarray(file["x"][:])
                r = np.hypot(x[:, None], x[None, :])
                exact = green(r, run["t_final"], 1.0 + run["beta"], 2)
                row["error of the field (7)"] = disk_error(
                    reconstructed(u, run["overlap"]) - exact, r, run
                )
        rows.append(row)
    keys = ["exterior", "scheme", "order", "N"]
    errors = pd.DataFrame(rows).sort_values(keys, ascending=[False, True, True, True])
    errors = errors.reset_index(drop=True)
    for name, column in (
        ("observed order", "error (59)"),
        ("observed order, field", "error of the field (7)"),
    ):
        errors[name] = np.nan
        for _, part in errors.groupby(keys[:-1]):
            errors.loc[part.index[1:], name] = observed_order(part["h"], part[column])
    return errors


def _by_width(plane: pd.DataFrame, inputs: Inputs) -> pd.DataFrame:
    """The errors on wider squares of the same h."""
    wide = plane[plane["truncation"] > inputs.parameters["truncation"] * 1.001]
    return pd.DataFrame(
        {
            "scheme": wide["scheme"],
            "order": wide["order"].map(ORDERS),
            "exterior": wide["exterior"],
            "C": wide["truncation"].round(6),
            "N": wide["N"],
            "h": wide["particle_spacing"],
            "error (59)": wide["relative_l1_error"],
            "error of the field (7)": np.nan,
        }
    ).sort_values(["scheme", "C"])


def _by_dimension(runs: pd.DataFrame, inputs: Inputs) -> dict[tuple[str, int], float]:
    """What the truncation changes of u: truncated less open in the disk (the interval) |x| <= 5, by scheme and n."""
    shift = {}
    h, truncation = inputs.parameters["compared_h"], inputs.parameters["truncation"]
    for dim in (1, 2):
        here = runs[(runs["dim"] == dim) & np.isclose(runs["spacing"], h, rtol=1e-6)]
        here = here[np.isclose(here["truncation"], truncation)]
        for scheme in sorted(here["scheme"].unique()):
            pair = here[(here["scheme"] == scheme) & (here["order"] == 2)].set_index("exterior")
            fields = []
            for exterior in ("truncated", "open"):
                with netCDF4.Dataset(pair.loc[exterior, "run"]) as file:
                    fields.append(np.asarray(file["u"][:]))
                    x = np.asarray(file["x"][:])
            r = np.abs(x) if dim == 1 else np.hypot(x[:, None], x[None, :])
            shift[scheme, dim] = disk_error(fields[0] - fields[1], r, pair.loc["open"])
    return shift


def _findings(errors: pd.DataFrame, widths: pd.DataFrame, shift: dict, inputs: Inputs) -> list:
    printed = inputs.parameters["particles"]
    here = errors[(errors["exterior"] == "truncated") & (errors["order"] == "II")]
    here = here[here["scheme"].isin(_PAPER) & here["N"].isin(printed)]
    error = here.pivot_table(index="N", columns="scheme", values="error (59)")
    ours = here[here["N"] > min(printed)].pivot_table(
        index="N", columns="scheme", values="observed order"
    )
    field = here[here["N"] > min(printed)].pivot_table(
        index="N", columns="scheme", values="observed order, field"
    )
    ratio = error["FPSE"] / error["DD"]
    wide, change = [], {}
    for scheme in ("DD", "FPSE", "KPSE", "GPSE"):
        part = widths[(widths["scheme"] == scheme) & (widths["exterior"] == "truncated")]
        h = part["h"].iloc[0]
        usual = errors[
            (errors["scheme"] == scheme)
            & (errors["order"] == "II")
            & (errors["exterior"] == "truncated")
            & np.isclose(errors["h"], h)
        ]["error (59)"].iloc[0]
        values = [usual, *part["error (59)"]]
        change[scheme] = max(values) / min(values) - 1.0
        wide.append(f"{scheme} {', '.join(f'{value:.3g}' for value in values)}")
    at = ", ".join(
        f"{c:g}" for c in [inputs.parameters["truncation"], *sorted(widths["C"].unique())]
    )
    files = list(inputs.scalars["run"])
    counts = ", ".join(map(str, printed))
    return [
        statement(
            "L-F9.decreases",
            bool((np.diff(error, axis=0) < 0.0).all()),
            f"Error (59) at N = {counts}: {_rows(error, '.3g')}.",
            "It does not fall from each lattice to the next.",
            files,
        ),
        statement(
            "L-F9.second_order",
            bool(((ours - 2.0).abs() < _SECOND).all(axis=None)),
            f"Observed order between neighbouring lattices: {_rows(ours, '.2f')}; of the field (7): "
            f"{_rows(field, '.2f')}.",
            "Between the two coarsest lattices the order is not 2 yet.",
            files,
        ),
        statement(
            "L-F9.fpse_larger",
            bool((ratio > 1.0).all()),
            f"The error of FPSE is {', '.join(f'{value:.3g}' for value in ratio)} times that of DD.",
            "It is not larger on every lattice.",
            files,
        ),
        statement(
            "L-F9.truncation",
            max(change[scheme] for scheme in _PAPER) < _WEAK,
            f"Error (59) at C = {at}: {'; '.join(wide)}. KPSE and GPSE, which Sec. 5 does not use, have little else "
            "than truncation error.",
            "The error changes by more than 5 %.",
            files,
        ),
        statement(
            "L-F9.weaker",
            all(shift[scheme, 1] > shift[scheme, 2] for scheme in _PAPER),
            "At C = 4 the truncation changes u within |x| <= 5, n = 1 and 2, by "
            + "; ".join(
                f"{shift[scheme, 1]:.2g} and {shift[scheme, 2]:.2g} ({scheme})"
                for scheme in ("DD", "FPSE", "KPSE", "GPSE")
            )
            + ". It is weaker for DD and FPSE, whose lost part falls like D^(-n-2 alpha) with kernel and solution; not "
            "for the exchange schemes, D^-alpha for every n.",
            "The truncation changes u as much in two dimensions as in one.",
            files,
        ),
    ]  # fmt: skip


def _rows(values: pd.DataFrame, digits: str) -> str:
    return "; ".join(
        f"{scheme} {', '.join(format(value, digits) for value in values[scheme])}"
        for scheme in _PAPER
    )
