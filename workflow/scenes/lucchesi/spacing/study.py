"""Effect of the particle spacing: error (48) against h, Figs. 3b, 4b, 5b."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracparticles.run.orders import observed_order
from fracstudy.claims import Finding
from fracstudy.inputs import NUMERALS, ORDERS, Inputs, Result, spelled, statement

__all__ = ["fpse_over_others", "last_order_of_kpse_four", "settled", "study"]

NEEDS: dict[str, list] = {
    "exterior": ["truncated", "open"],
    "scheme": ["DD", "FPSE", "KPSE"],
    "order": [2, 4],
}

# A level shows the order of a scheme if truncation is less than this part of its error.
_CLEAN = 0.05


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
    for exterior in NEEDS["exterior"]:
        for _, part in errors.groupby(key[:-1]):
            orders = [np.nan, *observed_order(part["h"], part[exterior])]
            errors.loc[part.index, f"observed order, {exterior}"] = orders
    table = pd.DataFrame(
        {
            **errors[["beta", "scheme"]],
            "order": errors["order"].map(NUMERALS),
            "h": errors["h"],
            "error, truncated": errors["truncated"],
            "observed order, truncated": errors["observed order, truncated"],
            "error, open exterior": errors["open"],
            "observed order, open": errors["observed order, open"],
            "error, truncated, exact in time": errors["exponential"],
        }
    )
    series = runs.rename(columns={"h": "x", "relative_l1_error": "y"})
    series = series[["scheme", "order", "exterior", "integrator", "x", "y"]]
    findings = _findings(inputs.items[0], table, runs["run"]) if inputs.items else []
    return Result(table, findings, series)


def _findings(item: str, table: pd.DataFrame, files: pd.Series) -> list[Finding]:
    findings = []
    for order, name in ORDERS.items():
        observed = _coarse_orders(table, name)
        findings.append(
            statement(
                f"{item}.O_h{order}",
                bool(((observed - order).abs() < 0.3).all()) if len(observed) else None,
                f"Observed order at the largest h where it has settled: {spelled(observed, '.3f') or 'none'}.",
                "KPSE reaches its truncation error before its order settles; with the open exterior it settles (L-C7).",
                files,
            )
        )
    largest = fpse_over_others(table, "error, truncated")
    last = last_order_of_kpse_four(table)
    return [
        *findings,
        statement(
            f"{item}.fpse_largest",
            (largest > 1.0).all(),
            f"Error of FPSE over the largest of DD and KPSE, over all h and orders: {largest.min():.3g} to "
            f"{largest.max():.3g}.",
            "True of the spatial error, see L-C7; at small h the truncation error of KPSE is larger than the error of "
            "FPSE.",
            files,
        ),
        statement(
            f"{item}.kpse_levels_off",
            (last.abs() < 0.5).all(),
            f"Observed order of KPSE IV between the two smallest h: {last.iloc[-1]:.3g}.",
            "It still falls at the smallest h.",
            files,
        ),
    ]


def settled(observed: pd.Series, order: str) -> float:
    """Return the observed order nearest to the theory's: pre-asymptotic at large h, at the floor at small h."""
    expected = next(p for p, name in NUMERALS.items() if name == order)
    observed = observed.dropna().to_numpy()
    return float(observed[np.argmin(np.abs(observed - expected))])


def _coarse_orders(table: pd.DataFrame, order: str) -> pd.Series:
    """The settled order of each scheme over the levels that truncation does not spoil."""
    found = {}
    for scheme, part in table[table["order"] == order].groupby("scheme"):
        excess = part["error, truncated"] / part["error, open exterior"] - 1.0
        clean = part[excess.abs() < _CLEAN]
        if len(clean) > 1:
            found[scheme] = settled(clean["observed order, truncated"], order)
    return pd.Series(found, dtype=float)


def fpse_over_others(table: pd.DataFrame, column: str) -> pd.Series:
    """Return the error of FPSE over the larger one of DD and KPSE, by beta, order and h."""
    wide = table.pivot(index=["beta", "order", "h"], columns="scheme", values=column)
    return (wide["FPSE"] / wide[["DD", "KPSE"]].max(axis=1)).dropna()


def last_order_of_kpse_four(table: pd.DataFrame) -> pd.Series:
    """Return the observed order of truncated KPSE IV between the two smallest h, by beta."""
    kpse = table[(table["scheme"] == "KPSE") & (table["order"] == "IV")]
    kpse = kpse.sort_values("h", ascending=False)
    return kpse.groupby("beta")["observed order, truncated"].last()
