"""Effect of the particle spacing: error (48) against h, Figs. 3b, 4b, 5b and Sec. 4.3."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracstudy.inputs import ORDERS, Inputs, Result, observed_order, statement

__all__ = ["spacing", "spacing_claims"]

_CLEAN = (
    0.05  # a level shows the order of a scheme if truncation is less than this part of its error
)
_ORDER = {"II": 2.0, "IV": 4.0}


def spacing(inputs: Inputs) -> Result:
    """One beta: errors, truncated and open, and the observed orders."""
    runs = inputs.scalars
    stepped = runs[runs["integrator"] != "exponential"]
    exact = runs[runs["integrator"] == "exponential"]
    key = ["scheme", "order", "h"]
    runs, stepped, exact = (
        part.assign(h=part["particle_spacing"].map(lambda h: float(f"{h:.5g}")))
        for part in (runs, stepped, exact)
    )
    errors = stepped.pivot_table(index=key, columns="exterior", values="relative_l1_error")
    errors["exponential"] = exact.set_index(key)["relative_l1_error"]
    errors = errors.reset_index().sort_values(
        ["scheme", "order", "h"], ascending=[True, True, False]
    )
    for column in ("truncated", "open"):
        errors[f"order {column}"] = errors.groupby(["scheme", "order"], group_keys=False).apply(
            lambda part, c=column: pd.Series(
                np.append(np.nan, observed_order(part["h"], part[c])), index=part.index
            ),
            include_groups=False,
        )
    table = pd.DataFrame(
        {
            "beta": runs["beta"].iloc[0],
            "scheme": errors["scheme"],
            "order": errors["order"].map(ORDERS),
            "h": errors["h"],
            "error, truncated": errors["truncated"],
            "observed order, truncated": errors["order truncated"],
            "error, open exterior": errors["open"],
            "observed order, open": errors["order open"],
            "error, truncated, exact in time": errors["exponential"],
        }
    )
    series = runs.rename(columns={"h": "x", "relative_l1_error": "y"})[
        ["scheme", "order", "exterior", "integrator", "x", "y"]
    ]
    item = inputs.items[0]
    return Result(table, _findings(item, table, list(runs["run"])), series)


def _findings(item: str, table: pd.DataFrame, files: list[str]) -> list:
    findings = []
    for order, power in (("II", "h2"), ("IV", "h4")):
        observed = _coarse_orders(table, order, "truncated")
        findings.append(
            statement(
                f"{item}.O_{power}",
                bool(((observed - _ORDER[order]).abs() < 0.3).all()) if len(observed) else None,
                f"Observed order at the largest h where it has settled: {_spell(observed)}.",
                "KPSE reaches its truncation error before its order settles; with the open exterior it settles (L-C7).",
                files,
            )
        )
    largest = _fpse_over_others(table, "error, truncated")
    findings.append(
        statement(
            f"{item}.fpse_largest",
            bool((largest > 1.0).all()),
            f"Error of FPSE over the largest of DD and KPSE, over all h and orders: {largest.min():.3g} to "
            f"{largest.max():.3g}.",
            "True of the spatial error, see L-C7; at small h the truncation error of KPSE is larger than the error of "
            "FPSE.",
            files,
        )
    )
    kpse = table[(table["scheme"] == "KPSE") & (table["order"] == "IV")]
    last = float(kpse["observed order, truncated"].iloc[-1])
    findings.append(
        statement(
            f"{item}.kpse_levels_off",
            abs(last) < 0.5,
            f"Observed order of KPSE IV between the two smallest h: {last:.3g}.",
            "It still falls at the smallest h.",
            files,
        )
    )
    return findings


def spacing_claims(inputs: Inputs) -> Result:
    """All beta together: the statements L-C7 and L-C8 of Sec. 4.3."""
    table = pd.concat(inputs.tables.values(), ignore_index=True)
    rows = []
    for (scheme, order, beta), part in table.groupby(["scheme", "order", "beta"]):
        part = part.sort_values("h", ascending=False)
        truncated = part["error, truncated"].to_numpy()
        exact = part["error, truncated, exact in time"].to_numpy()
        rows.append(
            {
                "scheme": scheme,
                "order": order,
                "beta": beta,
                "observed order, open": _settled(part, "open", order),
                "error at the smallest h": truncated[-1],
                "the same, exact in time": exact[-1],
                "the same, open exterior": part["error, open exterior"].to_numpy()[-1],
                "share of the time step": abs(truncated[-1] - exact[-1]) / truncated[-1],
            }
        )
    summary = pd.DataFrame(rows)
    findings = []
    for order, power in (("II", "h2"), ("IV", "h4")):
        observed = summary[summary["order"] == order]["observed order, open"]
        findings.append(
            statement(
                f"L-C7.O_{power}",
                bool(((observed - _ORDER[order]).abs() < 0.1).all()),
                f"With the open exterior the order of DD, FPSE, KPSE settles at {observed.min():.3f} to "
                f"{observed.max():.3f} over all beta.",
                "The order does not settle on these lattices.",
            )
        )
    ratio = _fpse_over_others(table, "error, open exterior")
    findings.append(
        statement(
            "L-C7.fpse_largest",
            bool((ratio > 1.0).all()),
            f"Error of FPSE over the larger of DD and KPSE, open exterior, all beta, orders and h: "
            f"{ratio.min():.3g} to {ratio.max():.3g}.",
            "At the smallest h the far-field closure, the same for all, is what is left of the order-IV errors.",
        )
    )
    kpse = summary[(summary["scheme"] == "KPSE") & (summary["order"] == "IV")].set_index("beta")
    last = table[(table["scheme"] == "KPSE") & (table["order"] == "IV")].sort_values(
        "h", ascending=False
    )
    orders = last.groupby("beta")["observed order, truncated"].last()
    findings.append(
        statement(
            "L-C8.levels_off",
            bool((orders.abs() < 0.5).all()),
            f"Observed order of KPSE IV between the two smallest h: {_list(orders)}.",
            "It still falls at the smallest h.",
        )
    )
    share = kpse["share of the time step"]
    gain = kpse["error at the smallest h"] / kpse["the same, open exterior"]
    findings.append(
        statement(
            "L-C8.cause",
            bool((share > 0.5).any()),
            f"Exact integration in time changes the plateau of KPSE IV by {share.max():.2g} of it at most; "
            f"the open exterior lowers it {gain.min():.3g} to {gain.max():.3g} times.",
            "The plateau is the truncation of the domain: it stays when the time integration is exact and goes "
            "with the open exterior.",
        )
    )
    return Result(summary, findings)


def _settled(part: pd.DataFrame, exterior: str, order: str) -> float:
    """The observed order that is nearest to the theory's: pre-asymptotic at large h, at the floor at small h."""
    observed = part[f"observed order, {exterior}"].dropna().to_numpy()
    return float(observed[np.argmin(np.abs(observed - _ORDER[order]))])


def _coarse_orders(table: pd.DataFrame, order: str, exterior: str) -> pd.Series:
    """The settled order of each scheme over the levels that truncation does not spoil."""
    found = {}
    for scheme, part in table[table["order"] == order].groupby("scheme"):
        excess = part["error, truncated"] / part["error, open exterior"] - 1.0
        clean = part[(excess.abs() < _CLEAN).to_numpy()]
        if len(clean) > 1:
            found[scheme] = _settled(clean, exterior, order)
    return pd.Series(found, dtype=float)


def _fpse_over_others(table: pd.DataFrame, column: str) -> pd.Series:
    wide = table.pivot_table(index=["beta", "order", "h"], columns="scheme", values=column)
    return wide["FPSE"] / wide[["DD", "KPSE"]].max(axis=1)


def _spell(values: pd.Series) -> str:
    return ", ".join(f"{name} {v:.3f}" for name, v in values.items()) or "none"


def _list(values: pd.Series) -> str:
    return ", ".join(f"{v:.3g} at beta {beta:g}" for beta, v in values.items())
