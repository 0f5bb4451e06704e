"""Errors against the spacing, the interpolation in the order, the tails of either end, and the exterior."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from fracstudy.panels import pick
from fracstudy.style import axes_row, log_log, name_ticks, panel_title, slope_triangle, small_legend

_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00")
_MARKERS = "osD^v"
_TAILS = {"own": "of each end", "one for both": "one for both", "none": "none: truncated"}


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw (a) errors, (b) interpolation, (c) tails, (d) what is beyond a narrow lattice."""
    drawn, axes = axes_row(4, height=3.7, width=3.4)
    _errors(axes[0], pick(series, panel="error"))
    _interpolation(axes[1], pick(series, panel="interpolation"))
    _tails(axes[2], pick(series, panel="tail"))
    for points, style in _styled(pick(series, panel="exterior")):
        name = points["series"].iloc[0]
        axes[3].plot(points["x"], points["y"], label=_TAILS[name], **style)
    log_log(axes[3], xlabel="half-width of the lattice", ylabel="error of $du/dt$, relative")
    name_ticks(axes[3], sorted(pick(series, panel="exterior")["x"].unique()))
    small_legend(axes[3], "lower left", title="tail", title_fontsize=7)
    panel_title(axes[3], "d", "tail beyond the lattice")
    return drawn


def _styled(part: pd.DataFrame) -> list[tuple[pd.DataFrame, dict[str, Any]]]:
    groups = [points for _, points in part.groupby("series", sort=False)]
    looks = [
        {"color": colour, "marker": marker, "markersize": 4.0}
        for colour, marker in zip(_COLOURS, _MARKERS, strict=True)
    ]
    return list(zip(groups, looks, strict=False))


def _errors(ax: Axes, part: pd.DataFrame) -> None:
    for points, style in _styled(part):
        plane = points["dim"].iloc[0] == 2
        ax.plot(
            points["x"],
            points["y"],
            linestyle="--" if plane else "-",
            label=points["series"].iloc[0],
            **style,
        )
        h, error = points.sort_values("x")[["x", "y"]].to_numpy().T
        slopes = np.diff(np.log(error)) / np.diff(np.log(h))
        if not plane and slopes.size and slopes.argmax() == 0:  # it does not end at round-off
            slope_triangle(ax, h[0], 1.8 * error[0], float(points["order"].iloc[0]), above=True)
    ticks = sorted(part["x"].unique())
    log_log(ax, xlabel="particle spacing $h$", ylabel="error of $du/dt$, relative")
    ax.set_xlim(0.6 * ticks[0], 1.3 * ticks[-1])
    name_ticks(ax, ticks)
    small_legend(ax, "lower right")
    panel_title(ax, "a", "error")


def _interpolation(ax: Axes, part: pd.DataFrame) -> None:
    for points, style in _styled(part):
        ax.plot(points["x"], points["y"], label=points["series"].iloc[0], linestyle="", **style)
        ax.plot(points["x"], points["bound"], color=style["color"], linestyle=":", marker="")
    ax.set(
        yscale="log",
        xlabel="number of orders summed, $K$",
        ylabel="difference of rows; bound (dotted)",
    )
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    small_legend(ax, "upper right", title=r"range of $\alpha$", title_fontsize=7)
    panel_title(ax, "b", r"interpolation in $\alpha$")


def _tails(ax: Axes, part: pd.DataFrame) -> None:
    for points, style in _styled(part):
        label = f"{points['series'].iloc[0]}, $\\alpha = {points['alpha'].iloc[0]:g}$"
        ax.plot(points["x"], points["y"], label=label, linestyle="", **style)
        ax.plot(points["x"], points["theory"], color=style["color"], linestyle=":", marker="")
    log_log(ax, xlabel="distance $|x|$", ylabel="$u(x, t)$")
    small_legend(ax, "lower left")
    panel_title(ax, "c", "tails of a run")
