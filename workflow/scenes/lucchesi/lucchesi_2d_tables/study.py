"""Kernels interpolated in tables, the remark of Sec. 5: what the step of the table does to DD and FPSE."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.run.case import Case
from fracparticles.schemes.base import lattice_radii
from fracparticles.schemes.dd import DirectDifferentiation
from fracstudy.inputs import Inputs, Result, observed_order, statement
from scenes.beyond.solution_map_2d.study import with_count

__all__ = ["spurious_rate", "study"]

_VISIBLE = 0.05  # share of the error that a table may change and still be insignificant
_DROP = 0.5  # of the order: an appreciable drop
_SCHEMES = {"DD": "G", "FPSE": "F"}


def spurious_rate(case: Case, step: float) -> float:
    """Return the rate of decay of a uniform strength that a table of this step adds to DD.

    sum_j V_j (table - G)_epsilon(x_i - x_j) / epsilon^alpha over the square: the integral of G is nil, that of its
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
    runs = with_count(inputs.scalars)
    runs["step"] = runs["kernel_table"].fillna(0.0)
    steps = [0.0, *sorted(inputs.parameters["steps"])]
    errors = runs.pivot_table(
        index=["scheme", "N"], columns="step", values="relative_l1_error"
    ).reset_index()
    h = runs.groupby("N")["particle_spacing"].first()
    table = pd.DataFrame(
        {
            "scheme": errors["scheme"],
            "kernel": errors["scheme"].map(_SCHEMES),
            "N": errors["N"],
            "h": errors["N"].map(h),
        }
    )
    for step in steps:
        name = "exact kernel" if step == 0.0 else f"table, step {step:g}"
        table[f"error (59), {name}"] = errors[step]
        table[f"observed order, {name}"] = np.nan
        for _, part in table.groupby("scheme"):
            order = observed_order(part["h"], part[f"error (59), {name}"])
            table.loc[part.index[1:], f"observed order, {name}"] = order
    for step in steps[1:]:
        table[f"spurious decay in the run, step {step:g}"] = [
            _spurious(inputs.parameters, row, step) for row in table.to_dict("records")
        ]
    files = list(runs["run"])
    findings = [
        *_coarse(table, max(steps), files),
        *_fine(table, steps[1], files),
    ]
    return Result(table, findings, _series(table, steps))


def _spurious(parameters: Mapping[str, Any], row: dict[str, Any], step: float) -> float:
    """1 - exp(-rate T) for DD; a flux of zero mean has none."""
    if row["scheme"] != "DD":
        return np.nan
    case = Case(
        scheme="DD",
        beta=parameters["beta"],
        dim=2,
        truncation=parameters["truncation"],
        spacing=row["h"],
        integrator="exponential",
    )
    return float(-np.expm1(-spurious_rate(case, step) * (case.t_final - case.t_initial)))


def _series(table: pd.DataFrame, steps: list[float]) -> pd.DataFrame:
    parts = []
    for step in steps:
        name = "exact kernel" if step == 0.0 else f"table, step {step:g}"
        part = table[["scheme", "h"]].assign(step=step, y=table[f"error (59), {name}"])
        if step > 0.0:
            part["spurious"] = table[f"spurious decay in the run, step {step:g}"]
        parts.append(part)
    return pd.concat(parts, ignore_index=True)


def _coarse(table: pd.DataFrame, step: float, files: list[str]) -> list:
    findings = []
    for scheme, kernel_name in _SCHEMES.items():
        part = table[table["scheme"] == scheme]
        tabled, exact = part[f"error (59), table, step {step:g}"], part["error (59), exact kernel"]
        order = part[f"observed order, table, step {step:g}"].iloc[-1]
        usual = part["observed order, exact kernel"].iloc[-1]
        ratio = tabled / exact
        change = ", ".join(f"{value:.1e}" for value in (tabled - exact).iloc[1:])
        findings.append(
            statement(
                f"L-2D-TAB.{kernel_name}.step{step:g}",
                bool(usual - order > _DROP and ratio.iloc[-1] > 1.0 + _VISIBLE),
                f"{scheme}: the error is {', '.join(f'{r:.3g}' for r in ratio)} times that with exact kernels at N = "
                f"{', '.join(map(str, part['N']))}; the order between the two finest lattices is {order:.2f} instead "
                f"of {usual:.2f}.",
                "F is a vector kernel: in a uniform field the errors of its chords cancel, and what is left falls "
                f"with h (the error changes by {change} from the second lattice on)."
                if scheme == "FPSE"
                else "On these lattices the order of DD does not drop.",
                files,
            )
        )
    return findings


def _fine(table: pd.DataFrame, step: float, files: list[str]) -> list:
    findings = []
    for scheme, kernel_name in _SCHEMES.items():
        part = table[table["scheme"] == scheme]
        ratio = part[f"error (59), table, step {step:g}"] / part["error (59), exact kernel"]
        visible = part["N"][(ratio - 1.0).abs() > _VISIBLE]
        order = part[f"observed order, table, step {step:g}"].iloc[-1]
        findings.append(
            statement(
                f"L-2D-TAB.{kernel_name}.step{step:g}",
                visible.empty,
                f"{scheme}: the error is {', '.join(f'{r:.4g}' for r in ratio)} times that with exact kernels at N = "
                f"{', '.join(map(str, part['N']))}; the order between the two finest lattices is {order:.2f}.",
                f"Visible with DD at N = {', '.join(map(str, visible))}: the chords of G have a negative integral, "
                "which acts as a decay of u at a rate proportional to epsilon^-alpha.",
                files,
            )
        )
    return findings
