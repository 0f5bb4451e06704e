"""Errors against the spacing, the interpolation in the order, the tails of either end, and the exterior."""

from collections.abc import Iterator
from typing import Any

import pandas as pd
from matplotlib.ticker import MaxNLocator

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import BLUE, GREEN, ORANGE, PINK, RED, Axes, Figure

_COLOURS, _MARKERS = (BLUE, RED, GREEN, PINK, ORANGE), "osD^v"
_TAILS = {"own": "of each end", "one for both": "one for both", "none": "none: truncated"}
_TITLES = ("error", r"interpolation in $\alpha$", "tails of a run", "tail beyond the lattice")


def figure(series: pd.DataFrame) -> Figure:
    """Draw (a) errors, (b) interpolation, (c) tails, (d) what is beyond a narrow lattice."""
    drawn, axes = style.axes_row(_TITLES, height=3.7, width=3.4)
    _errors(axes[0], pick(series, panel="error"))
    _interpolation(axes[1], pick(series, panel="interpolation"))
    _tails(axes[2], pick(series, panel="tail"))
    exterior = pick(series, panel="exterior")
    for points, name, look in _styled(exterior):
        style.draw(axes[3], points, label=_TAILS[name], **look)
    style.log_log(axes[3], xlabel="half-width of the lattice", ylabel="error of $du/dt$, relative")
    style.name_ticks(axes[3], sorted(exterior["x"].unique()))
    style.small_legend(axes[3], "lower left", title="tail", title_fontsize=7)
    return drawn


def _styled(part: pd.DataFrame) -> Iterator[tuple[pd.DataFrame, str, dict[str, Any]]]:
    groups = part.groupby("series", sort=False)
    for (name, points), colour, marker in zip(groups, _COLOURS, _MARKERS, strict=False):
        yield points, str(name), {"color": colour, "marker": marker, "markersize": 4.0}


def _errors(ax: Axes, part: pd.DataFrame) -> None:
    for points, name, look in _styled(part):
        plane = points["dim"].iloc[0] == 2
        style.draw(ax, points, linestyle="--" if plane else "-", label=name, **look)
        if not plane:
            style.finest_slope(ax, points, float(points["order"].iloc[0]))
    ticks = sorted(part["x"].unique())
    style.log_log(ax, xlabel="particle spacing $h$", ylabel="error of $du/dt$, relative")
    ax.set_xlim(0.6 * ticks[0], 1.3 * ticks[-1])
    style.name_ticks(ax, ticks[::-2])
    style.small_legend(ax, "lower right")


def _interpolation(ax: Axes, part: pd.DataFrame) -> None:
    for points, name, look in _styled(part):
        style.draw(ax, points, label=name, linestyle="", **look)
        ax.plot(points["x"], points["bound"], color=look["color"], linestyle=":", marker="")
    ax.set(xlabel="number of orders summed, $K$", ylabel="difference of rows; bound (dotted)")
    ax.set_yscale("log")
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    style.small_legend(ax, "upper right", title=r"range of $\alpha$", title_fontsize=7)


def _tails(ax: Axes, part: pd.DataFrame) -> None:
    for points, name, look in _styled(part):
        label = f"{name}, $\\alpha = {points['alpha'].iloc[0]:g}$"
        style.draw(ax, points, label=label, linestyle="", **look)
        ax.plot(points["x"], points["theory"], color=look["color"], linestyle=":", marker="")
    style.log_log(ax, xlabel="distance $|x|$", ylabel="$u(x, t)$")
    style.small_legend(ax, "lower left")
