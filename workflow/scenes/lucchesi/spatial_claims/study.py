"""What Sec. 4.3 concludes from Figs. 3b, 4b and 5b, all beta together."""

from __future__ import annotations

import pandas as pd

from fracstudy.inputs import ORDERS, Inputs, Result, statement
from scenes.lucchesi.spacing.study import fpse_over_others, last_order_of_kpse_four, settled

__all__ = ["study"]


def study(inputs: Inputs) -> Result:
    """Give the settled orders and the plateaus of the tables of the three figures, and judge the statements."""
    table = pd.concat(inputs.tables.values(), ignore_index=True)
    table = table.sort_values("h", ascending=False)
    summary = pd.DataFrame(
        _summary(part, *key) for key, part in table.groupby(["scheme", "order", "beta"])
    )
    findings = []
    for order, name in ORDERS.items():
        observed = summary[summary["order"] == name]["observed order, open"]
        findings.append(
            statement(
                f"L-C7.O_h{order}",
                ((observed - order).abs() < 0.1).all(),
                f"With the open exterior the order of DD, FPSE, KPSE settles at {observed.min():.3f} to "
                f"{observed.max():.3f} over all beta.",
                "The order does not settle on these lattices.",
            )
        )
    ratio = fpse_over_others(table, "error, open exterior")
    orders = last_order_of_kpse_four(table)
    each = ", ".join(f"{p:.3g} at beta {beta:g}" for beta, p in orders.items())
    kpse = summary[(summary["scheme"] == "KPSE") & (summary["order"] == "IV")]
    share = kpse["share of the time step"]
    gain = kpse["error at the smallest h"] / kpse["the same, open exterior"]
    findings += [
        statement(
            "L-C7.fpse_largest",
            (ratio > 1.0).all(),
            "Error of FPSE over the larger of DD and KPSE, open exterior, all beta, orders and h: "
            f"{ratio.min():.3g} to {ratio.max():.3g}.",
            "At the smallest h the far-field closure, the same for all, is what is left of the order-IV errors.",
        ),
        statement(
            "L-C8.levels_off",
            (orders.abs() < 0.5).all(),
            f"Observed order of KPSE IV between the two smallest h: {each}.",
            "It still falls at the smallest h.",
        ),
        statement(
            "L-C8.cause",
            (share > 0.5).any(),
            f"Exact integration in time changes the plateau of KPSE IV by {share.max():.2g} of it at most; "
            f"the open exterior lowers it {gain.min():.3g} to {gain.max():.3g} times.",
            "The plateau is the truncation of the domain: it stays when the time integration is exact and goes "
            "with the open exterior.",
        ),
    ]
    return Result(summary, findings)


def _summary(part: pd.DataFrame, scheme: str, order: str, beta: float) -> dict[str, object]:
    finest = part.iloc[-1]
    truncated, exact = finest["error, truncated"], finest["error, truncated, exact in time"]
    return {
        "scheme": scheme,
        "order": order,
        "beta": beta,
        "observed order, open": settled(part["observed order, open"], order),
        "error at the smallest h": truncated,
        "the same, exact in time": exact,
        "the same, open exterior": finest["error, open exterior"],
        "share of the time step": abs(truncated - exact) / truncated,
    }
