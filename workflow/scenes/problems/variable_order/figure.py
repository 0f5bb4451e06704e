"""Errors of the rows, of their interpolation, the two tails of a solution and what their continuation is worth."""

from __future__ import annotations

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fracstudy.panels import pick
from fracstudy.style import (
    axes_row,
    entry,
    guide,
    log_log,
    name_ticks,
    note,
    panel_title,
    slope_triangle,
)

__all__ = ["figure"]

_LINE, _PLANE = "#0072B2", "#D55E00"
_SIDES = {"left": "#0072B2", "right": "#D55E00"}
_INTERVALS = ("#009E73", "#CC79A7")


def figure(series: pd.DataFrame, table: pd.DataFrame, middle: float, swing: float) -> Figure:
    """Draw (a) errors against h, (b) against the number of sums, (c) tails, (d) errors of narrow lattices."""
    drawn, axes = axes_row(4, height=3.6, width=3.3)
    _orders(axes[0], pick(series, panel="order"))
    _sums(axes[1], pick(series, panel="sums"))
    _tails(axes[2], pick(series, panel="tail"), middle, swing)
    _exteriors(axes[3], pick(series, panel="exterior"))
    return drawn


def _orders(ax: Axes, part: pd.DataFrame) -> None:
    for (dim, order), points in part.groupby(["dim", "series"], sort=False):
        style = {"color": _LINE, "marker": "o"} if dim == 1 else {"color": _PLANE, "marker": "s"}
        ax.plot(
            points["x"], points["y"], linestyle="-" if dim == 1 else "--", markersize=4.0, **style
        )
        if dim == 1:
            last = points.iloc[-1]
            note(ax, f"{order}", (last["x"], last["y"]), (-7, 0), ha="right", va="center")
    second = pick(part, dim=1, series=2)
    slope_triangle(ax, second["x"].iloc[-1], 0.3 * second["y"].iloc[-1], 2.0)
    ticks = sorted(part["x"].unique())
    log_log(ax, xlabel="particle spacing $h$", ylabel="error over the greatest $|du/dt|$")
    ax.set_xlim(0.6 * ticks[0], 1.3 * ticks[-1])
    name_ticks(ax, ticks)
    entries = [
        entry("line", color=_LINE, marker="o"),
        entry("plane", color=_PLANE, marker="s", linestyle="--"),
    ]
    ax.legend(handles=entries, loc="lower right", fontsize=7)
    panel_title(ax, "a", "kernels of several orders")


def _sums(ax: Axes, part: pd.DataFrame) -> None:
    for (name, points), colour in zip(part.groupby("series", sort=False), _INTERVALS, strict=False):
        ours, bound = pick(points, kind="ours"), pick(points, kind="bound")
        ax.plot(
            ours["x"],
            ours["y"],
            color=colour,
            marker="o",
            markersize=4.0,
            label=f"α in {name}".replace("-", " to "),
        )
        ax.plot(bound["x"], bound["y"], color=colour, marker="", linestyle=":", label="its bound")
    ax.set(
        yscale="log",
        xlabel="number $K$ of lattice sums",
        ylabel="error of a weight over $h^{-α}$",
        ylim=(1e-18, 1.0),
    )
    ax.legend(loc="upper right", fontsize=7)
    panel_title(ax, "b", "rows from few sums")


def _tails(ax: Axes, part: pd.DataFrame, middle: float, swing: float) -> None:
    for side, sign in (("left", -1.0), ("right", 1.0)):
        points = pick(part, series=side)
        ax.plot(points["x"], points["y"], color=_SIDES[side], marker="")
        slope = -(1.0 + middle + sign * swing)
        last = points.iloc[-1]
        guide(ax, list(points["x"]), (last["x"], last["y"]), slope)
        nearly = points.iloc[len(points) * 3 // 4]
        shift, ha = ((4, 4), "left") if side == "left" else ((-4, -10), "right")
        note(ax, rf"{side}, $|x|^{{{slope:g}}}$", (nearly["x"], nearly["y"]), shift, ha=ha)
    log_log(ax, xlabel="$|x|$", ylabel="$u(x, 1)$")
    panel_title(ax, "c", "each end has its tail")


def _exteriors(ax: Axes, part: pd.DataFrame) -> None:
    for name, style in (
        ("truncated", {"color": "0.45", "marker": "s"}),
        ("open", {"color": _LINE, "marker": "o"}),
    ):
        points = pick(part, series=name)
        ax.plot(points["x"], points["y"], label=name, markersize=4.0, **style)
    log_log(ax, xlabel="half-width", ylabel="error over the greatest $u$")
    name_ticks(ax, sorted(part["x"].unique()))
    ax.legend(loc="lower left", fontsize=7)
    panel_title(ax, "d", "what beyond the lattice")
