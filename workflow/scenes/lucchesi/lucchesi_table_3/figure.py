"""The stability limit against beta and the symbols behind it (Table 3)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fracstudy.style import COLOURS, MARKERS, axes_row

__all__ = ["figure"]

_LINES: dict[str, Any] = {"II": "-", "IV": "--"}
_SCHEMES = ("DD", "FPSE", "KPSE")


def figure(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw (a) the limit a against beta with the printed values, (b) the symbols at the middle beta."""
    figure, (left, right) = axes_row(2, height=3.6)
    betas = sorted(parameters["beta"])
    middle = betas[len(betas) // 2]

    curves = series[series["panel"] == "limit"]
    for (scheme, order), curve in curves.groupby(["scheme", "order"]):
        left.plot(curve["x"], curve["y"], _LINES[order], color=COLOURS[scheme])
    for scheme, points in series[series["panel"] == "printed"].groupby("scheme"):
        left.plot(
            points["x"], points["y"], MARKERS[scheme], color=COLOURS[scheme], markerfacecolor="white",
            markersize=6,
        )  # fmt: skip
    for scheme, x, above in (("FPSE", 0.3, 0.45), ("DD", 0.3, 0.2), ("KPSE", 0.3, 0.2)):
        curve = curves[(curves["scheme"] == scheme) & (curves["order"] == "II")]
        y = float(np.interp(x, curve["x"], curve["y"]))
        left.text(x, y + above, scheme, color=COLOURS[scheme], ha="center", va="bottom")
    left.set(xlim=(0.0, 1.0), ylim=(0.0, None))
    left.set_xlabel(r"fractional order of the flux $\beta = \alpha - 1$")
    left.set_ylabel(r"stability limit $a = \mathcal{D}\,\Delta t / h^\alpha$")

    symbols = series[series["panel"] == "symbol"]
    exact = symbols[symbols["scheme"] == "exact"]
    top = 1.25 * symbols.loc[symbols["scheme"] != "exact", "y"].max()
    right.plot(exact["x"], exact["y"], color=COLOURS["exact"], linewidth=1.0)
    for (scheme, order), curve in symbols[symbols["scheme"] != "exact"].groupby(
        ["scheme", "order"]
    ):
        right.plot(curve["x"], curve["y"], _LINES[order], color=COLOURS[scheme])
        highest = curve.loc[curve["y"].idxmax()]
        right.plot(
            highest["x"], highest["y"], MARKERS[scheme], color=COLOURS[scheme], clip_on=False
        )
    edge = exact[exact["y"] <= top].iloc[-1]
    right.annotate(
        r"exact, $\theta^\alpha$",
        (edge["x"], edge["y"]),
        xytext=(5, -4),
        textcoords="offset points",
        va="top",
    )
    right.set(xlim=(0.0, np.pi), ylim=(0.0, top))
    right.set_xticks(np.pi * np.linspace(0.0, 1.0, 5), ["0", "π/4", "π/2", "3π/4", "π"])
    right.set_xlabel(r"wavenumber $\theta = k h$")
    right.set_ylabel(r"symbol $-A(\theta)\, h^\alpha / \mathcal{D}$")
    right.set_title(rf"(b)  $\beta = {middle:g}$; markers: the maximum, $2 / a$", loc="left")

    entries = [Line2D([], [], color=COLOURS[s], label=s) for s in _SCHEMES]
    entries += [
        Line2D([], [], color="0.3", linestyle=_LINES[o], label=f"order {o}") for o in _LINES
    ]
    entries.append(
        Line2D(
            [],
            [],
            color="0.3",
            linestyle="",
            marker="o",
            markerfacecolor="white",
            label="printed, Table 3",
        )
    )
    figure.legend(handles=entries, loc="outside lower center", ncols=len(entries))
    return figure
