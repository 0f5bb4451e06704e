"""Effect of the particle spacing: error (48) against h, Figs. 3b, 4b, 5b."""

from collections.abc import Iterator

import pandas as pd

from fracstudy.findings import Finding, measured
from fracstudy.inputs import NUMERALS, ORDERS, Inputs, Result
from fracstudy.orders import orders_by
from fracstudy.panels import pick

NEEDS: dict[str, list] = {
    "exterior": ["truncated", "open"],
    "scheme": ["DD", "FPSE", "KPSE"],
    "order": [2, 4],
}

# A level shows the order of a scheme if its error is well above what time step, exterior and round-off leave, and if
# truncation is less than this part of it.
_FLOOR, _CLEAN = 1e-7, 0.05


def study(inputs: Inputs) -> Result:
    """Tabulate the errors, truncated and open, and the observed orders, of one beta.

    Runs with the exponential integrator, truncated, tell the error of the time step apart.
    """
    runs = inputs.scalars
    runs = runs.assign(h=runs["particle_spacing"].map(lambda h: float(f"{h:.5g}")))
    key = ["beta", "scheme", "order", "h"]
    exact = runs["integrator"] == "exponential"
    errors = runs[~exact].set_index([*key, "exterior"])["relative_l1_error"].unstack()
    errors["exponential"] = runs[exact].set_index(key)["relative_l1_error"]
    errors = errors.reset_index().sort_values(key, ascending=[True, True, True, False])
    columns = {
        **errors[["beta", "scheme"]],
        "order": errors["order"].map(NUMERALS),
        "h": errors["h"],
        "error, truncated": errors["truncated"],
        "observed order, truncated": orders_by(errors, key[:-1], "truncated"),
        "error, open exterior": errors["open"],
        "observed order, open": orders_by(errors, key[:-1], "open"),
        "error, truncated, exact in time": errors["exponential"],
    }
    table = pd.DataFrame(columns)
    series = runs.rename(columns={"h": "x", "relative_l1_error": "y"})
    series = series[["scheme", "order", "exterior", "integrator", "x", "y"]]
    findings = _findings(inputs.items[0], table, runs["run"]) if inputs.items else ()
    return Result(table, [*findings], series)


def _findings(item: str, table: pd.DataFrame, runs: pd.Series) -> Iterator[Finding]:
    for order, name in ORDERS.items():
        parts = pick(table, order=name).groupby("scheme")
        observed = pd.Series({scheme: settled(part, "truncated") for scheme, part in parts})
        away = (observed - order).abs()
        yield measured(f"{item}.O_h{order}", runs=runs, away=away, observed=observed)
    plotted = {"the error as plotted, truncated": {"ratio": _fpse_over_others(table, "truncated")}}
    largest = _fpse_over_others(table, "open exterior")
    yield measured(f"{item}.fpse_largest", runs=runs, others=plotted, ratio=largest)
    kpse = pick(table, scheme="KPSE").sort_values("h").groupby("order")["error, truncated"]
    change = kpse.agg(lambda e: abs(e.iloc[1] / e.iloc[0] - 1.0))
    yield measured(f"{item}.kpse_levels_off", runs=runs, change=change)


def settled(part: pd.DataFrame, exterior: str) -> float:
    """Return the observed order of a scheme between the two finest levels on which its error is that of the spacing.

    That is an error above 1e-7, of which the truncation is less than 5 %, on both levels; where no two have it, the
    coarsest two are taken. `exterior` is "truncated" or "open".
    """
    part = part.sort_values("h", ascending=False)
    opened = part["error, open exterior"]
    error = part["error, truncated"] if exterior == "truncated" else opened
    spatial = (error > _FLOOR) & ((error / opened - 1.0).abs() < _CLEAN)
    observed = part[f"observed order, {exterior}"]
    found = observed[spatial & spatial.shift(1, fill_value=False)]
    return float(found.iloc[-1] if len(found) else observed.dropna().iloc[0])


def _fpse_over_others(table: pd.DataFrame, exterior: str) -> pd.Series:
    """The error of FPSE over the larger one of DD and KPSE, the least over h, by order."""
    wide = table.pivot(index=["order", "h"], columns="scheme", values=f"error, {exterior}")
    return (wide["FPSE"] / wide[["DD", "KPSE"]].max(axis=1)).groupby("order").min()
