"""The change of the total strength over time."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from fracstudy.style import COLOURS, MARKERS, axes_row

__all__ = ["figure"]

_FLOOR = float(np.finfo(float).eps) / 2.0  # a change of nil is drawn here


def figure(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """|M / M0 - 1|: round-off below, what leaves the lattice above."""
    figure, axes = axes_row(1, width=6.4, height=4.2)
    ax = axes[0]
    moving = series["scheme"] == "DVM"
    for part, style, label in (
        (series[~moving], "-", "exact outflow"),
        (series[moving], ":", "exact outflow, DVM's $D$"),
    ):
        outflow = part.groupby("x")["outflow"].first()
        ax.plot(
            outflow.index, outflow, color="black", linewidth=4.0, alpha=0.25, linestyle=style, label=label
        )  # fmt: skip
    truncated = series[series["exterior"] == "truncated"]
    for scheme, points in truncated.groupby("scheme"):
        points = points.sort_values("x")
        y = points["y"].clip(lower=_FLOOR)
        ax.plot(points["x"], y, color=COLOURS[scheme], marker=MARKERS[scheme], label=scheme)
    opened = series[series["exterior"] == "open"]
    for scheme, size in (("DD", 9.0), ("FPSE", 7.0), ("KPSE", 5.0)):
        points = opened[opened["scheme"] == scheme].sort_values("x")
        ax.plot(
            points["x"],
            points["y"],
            color=COLOURS[scheme],
            marker=MARKERS[scheme],
            markersize=size,
            markerfacecolor="none",
            linestyle="none",
            label=f"{scheme}, open exterior",
        )
    for exterior, points in series[moving].groupby("exterior", sort=False):
        points = points.sort_values("x")
        if len(points) == 1:  # the table has it
            continue
        face = "none" if exterior == "remeshing none" else COLOURS["DVM"]
        name = exterior.replace("M4'", "$M_4'$").replace("remeshing none", "no remeshing")
        ax.plot(
            points["x"], points["y"].clip(lower=_FLOOR), color=COLOURS["DVM"], marker=MARKERS["DVM"],
            markerfacecolor=face, linestyle="--" if face == "none" else "-", label=f"DVM, {name}",
        )  # fmt: skip
    ax.axhline(2.0 * _FLOOR, color="0.5", linewidth=0.8, linestyle=":")
    ax.annotate(
        "one unit in the last place",
        (1.0, 2.0 * _FLOOR),
        xycoords=("axes fraction", "data"),
        xytext=(0, 3),
        textcoords="offset points",
        ha="right",
        va="bottom",
        color="0.35",
        fontsize=8,
    )
    ax.set(xscale="log", yscale="log", xlabel=r"time $t_f - t_0$")
    ax.set_ylabel(r"change of the total strength, $|M(t_f) / M(t_0) - 1|$")
    ax.set_ylim(_FLOOR / 2.0, 0.1)
    ax.set_xlim(right=1.6 * series["x"].max())
    ticks = sorted(series["x"].unique())
    ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    ax.minorticks_off()
    figure.legend(loc="outside right center")
    return figure
