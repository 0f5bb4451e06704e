"""The first eigenvalue on five maps, what truncated schemes solve, and what ends do to a bump."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fracstudy.panels import pick
from fracstudy.style import (
    COLOURS,
    MARKERS,
    axes_row,
    log_log,
    name_ticks,
    note,
    panel_title,
    slope_triangle,
)

__all__ = ["figure"]

_MARKERS = "osD^vP"
_ENDS = {"absorbing": "-", "reflecting": "--", "given": "-.", "no flux, final state": ":"}


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw (a) errors of the eigenvalue, (b) of truncated schemes, (c) profiles."""
    drawn, axes = axes_row(3, height=3.7, width=4.0)
    _eigenvalues(axes[0], pick(series, panel="eigenvalue"))
    _truncated(axes[1], pick(series, panel="truncated"))
    _profiles(axes[2], pick(series, panel="profile"))
    return drawn


def _eigenvalues(ax: Axes, part: pd.DataFrame) -> None:
    for name, marker in zip(part["series"].unique(), _MARKERS, strict=False):
        points = pick(part, series=name)
        ax.plot(points["x"], points["y"], marker=marker, label=name)
    log_log(ax, xlabel="particles $N$", ylabel=r"relative error of $\lambda_1$")
    ax.set_ylim(top=300.0)
    name_ticks(ax, sorted(part["x"].astype(int).unique()))
    ax.legend(loc="upper right", ncols=2, fontsize=7)
    panel_title(ax, "a", r"first eigenvalue, absorbing ends")


def _truncated(ax: Axes, part: pd.DataFrame) -> None:
    for name in part["series"].unique():
        points = pick(part, series=name).sort_values("x")
        ends = points["ends"].iloc[0]
        style: dict[str, Any] = {"color": COLOURS[name], "marker": MARKERS[name]}
        ax.plot(points["x"], points["y"], label=f"{name}: {ends}", **style)
    log_log(ax, xlabel="particle spacing $h$", ylabel="relative deviation")
    first = pick(part, series="DD").sort_values("x").iloc[0]
    slope_triangle(ax, first["x"], 0.22 * first["y"], 1.0)
    second = pick(part, series="KPSE").sort_values("x").iloc[0]
    slope_triangle(ax, second["x"], 0.35 * second["y"], 2.0)
    name_ticks(ax, (0.003, 0.01, 0.03))
    low = part["y"].min()
    ax.set_ylim(bottom=0.15 * low)
    ax.legend(loc="upper left", fontsize=7)
    ax.set_ylim(top=20.0 * part["y"].max())
    panel_title(ax, "b", "truncated schemes: problem and deviation")


def _profiles(ax: Axes, part: pd.DataFrame) -> None:
    for name, line in _ENDS.items():
        points = pick(part, series=name)
        ax.plot(points["x"], points["y"], linestyle=line, marker="", label=name)
    ax.set(xlabel="position $x$", ylabel="$u$", ylim=(0.0, 1.5 * part["y"].median() + 0.4))
    note(ax, "given: 0.2 outside", (0.0, 0.02), (0, 0), ha="center")
    ax.legend(loc="upper left", fontsize=7, ncols=2)
    panel_title(ax, "c", "a bump at $t = 0.2$, and where FPSE ends")
