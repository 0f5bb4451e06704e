"""Effect of the domain truncation: error (48) against C, Figs. 3a, 4a, 5a."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from fracparticles.special.tails import exchange_truncation_error
from fracstudy.findings import Finding, measured
from fracstudy.inputs import NUMERALS, Inputs, Result
from fracstudy.panels import pick

NEEDS = {"exterior": ["truncated", "open"]}


def study(inputs: Inputs) -> Result:
    """Tabulate the errors, truncated and open, and measure what truncation does to them at the largest C."""
    runs = inputs.scalars.assign(C=inputs.scalars["truncation"].round(6))
    table = pd.concat([_table(part) for _, part in runs.groupby("beta")], ignore_index=True)
    columns = {"C": "x", "relative_l1_error": "y"}
    series = runs[["beta", "scheme", "order", "exterior", *columns]].rename(columns=columns)
    return Result(table, [*_findings(inputs.items[0], runs, table)] if inputs.items else [], series)


def _table(runs: pd.DataFrame) -> pd.DataFrame:
    """The errors of one beta."""
    beta = float(runs["beta"].iloc[0])
    key = ["scheme", "order", "C"]
    errors = runs.set_index([*key, "exterior"])["relative_l1_error"].unstack().reset_index()
    widths, spacings = (runs.groupby("C")[s].first() for s in ("half_width", "particle_spacing"))
    time = float((runs["t_final"] - runs["t_initial"]).iloc[0])
    predicted = exchange_truncation_error(errors["C"].map(widths), 1.0 + beta, time)
    exchange = errors["scheme"].isin(["KPSE", "GPSE"])
    columns = {
        "beta": beta,
        "scheme": errors["scheme"],
        "order": errors["order"].map(NUMERALS),
        "C": errors["C"],
        "h": float(spacings.iloc[-1]),
        "error, truncated": errors["truncated"],
        "truncation error, predicted": np.where(exchange, predicted, np.nan),
        "error, open exterior": errors["open"],
    }
    return pd.DataFrame(columns)


def _findings(item: str, runs: pd.DataFrame, table: pd.DataFrame) -> Iterator[Finding]:
    largest = table["C"].max()
    widest = pick(table, C=largest).set_index(["scheme", "order"])
    change = (widest["error, truncated"] - widest["error, open exterior"]).abs()
    numbers = {"share": change / widest["error, truncated"], "change": change, "C": largest}
    yield measured(f"{item}.negligible", runs=pick(runs, C=largest)["run"], **numbers)
    for _, gpse in pick(runs, scheme="GPSE").head(1).iterrows():
        step = (2.0 * gpse["spacing"]) ** (1.0 + gpse["beta"])
        yield measured(f"{item}.gpse_dt", runs=[gpse["run"]], ours=step, overlap=gpse["overlap"])
