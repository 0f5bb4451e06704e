"""Effect of the domain truncation: error (48) against C, Figs. 3a, 4a, 5a."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracparticles.special.tails import exchange_truncation_error
from fracstudy.claims import Finding
from fracstudy.inputs import NUMERALS, Inputs, Result, statement, value

__all__ = ["study"]

NEEDS = {"exterior": ["truncated", "open"]}

_NEGLIGIBLE = 0.1  # of the error: what the truncation may add and still be called negligible


def study(inputs: Inputs) -> Result:
    """Tabulate the errors, truncated and open, and judge whether truncation is negligible at the largest C."""
    runs = inputs.scalars.assign(C=inputs.scalars["truncation"].round(6))
    table = pd.concat([_table(part) for _, part in runs.groupby("beta")], ignore_index=True)
    columns = {"C": "x", "relative_l1_error": "y"}
    series = runs[["beta", "scheme", "order", "exterior", *columns]].rename(columns=columns)
    return Result(table, _findings(inputs, runs, table) if inputs.items else [], series)


def _table(runs: pd.DataFrame) -> pd.DataFrame:
    """The errors of one beta."""
    beta = float(runs["beta"].iloc[0])
    key = ["scheme", "order", "C"]
    errors = runs.set_index([*key, "exterior"])["relative_l1_error"].unstack().reset_index()
    widths, spacings = (
        runs.groupby("C")[name].first() for name in ("half_width", "particle_spacing")
    )
    time = float((runs["t_final"] - runs["t_initial"]).iloc[0])
    predicted = exchange_truncation_error(errors["C"].map(widths), 1.0 + beta, time)
    exchange = errors["scheme"].isin(["KPSE", "GPSE"])
    return pd.DataFrame(
        {
            "beta": beta,
            "scheme": errors["scheme"],
            "order": errors["order"].map(NUMERALS),
            "C": errors["C"],
            "h": float(spacings.iloc[-1]),
            "error, truncated": errors["truncated"],
            "truncation error, predicted": np.where(exchange, predicted, np.nan),
            "error, open exterior": errors["open"],
        }
    )


def _findings(inputs: Inputs, runs: pd.DataFrame, table: pd.DataFrame) -> list[Finding]:
    item, largest = inputs.items[0], table["C"].max()
    widest = table[table["C"] == largest]
    ratio = widest["error, truncated"] / widest["error, open exterior"]
    names = widest["scheme"] + " " + widest["order"]
    worst = ratio.idxmax()
    each = ", ".join(f"{r:.3g} for {name}" for r, name in zip(ratio, names, strict=True))
    findings = [
        statement(
            f"{item}.negligible",
            (ratio < 1.0 + _NEGLIGIBLE).all(),
            f"Truncated over open error at C = {largest:g}: {each}.",
            f"The truncation is nearly the whole error of {names[worst]} there: the open exterior, which changes "
            f"nothing else, lowers it {ratio[worst]:.0e} times.",
            runs.loc[runs["C"] == largest, "run"],
        )
    ]
    for _, gpse in runs[runs["scheme"] == "GPSE"].head(1).iterrows():
        step = (2.0 * gpse["spacing"]) ** (1.0 + gpse["beta"])
        reason = (
            f"(40) with epsilon = 2 h gives {step:.3g}; the printed step, which we use, means epsilon/h = "
            f"{gpse['overlap']:.3g}."
        )
        findings.append(value(f"{item}.gpse_dt", step, reason, [gpse["run"]]))
    return findings
