"""Errors on the interval and in the plane, and a bump that is carried."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fracstudy.panels import pick
from fracstudy.style import axes_row, log_log, name_ticks, panel_title, slope_triangle

_COLOURS = ("#0072B2", "#D55E00", "#009E73")
_MARKERS = "osD"


def figure(series: pd.DataFrame, table: pd.DataFrame, *, drawn: float) -> Figure:
    """Draw (a) interval, (b) disc and square, (c) profiles."""
    figure, axes = axes_row(3, height=3.7, width=4.0)
    line = pick(series, panel="interval", alpha=drawn)
    _errors(axes[0], line, "-")
    first = pick(line, series="D(x, t)").sort_values("x").iloc[0]
    slope_triangle(axes[0], 1.1 * first["x"], 2e-3 * first["y"], drawn - 8.0)
    log_log(axes[0], xlabel="particles $N$", ylabel=r"mean error at $t = 1$, relative")
    name_ticks(axes[0], sorted(line["x"].astype(int).unique()))
    axes[0].legend(loc="upper right", fontsize=7)
    panel_title(axes[0], "a", "interval")
    for domain, style in (("disc", "-"), ("square", "--")):
        _errors(axes[1], pick(series, panel=domain, alpha=drawn), style, f"{domain}: ")
    log_log(axes[1], xlabel="rings, particles along a side $N$")
    every = series[series["panel"].isin(["disc", "square"])]
    name_ticks(axes[1], sorted(every["x"].astype(int).unique()))
    axes[1].legend(loc="lower left", fontsize=7)
    panel_title(axes[1], "b", "disc and square")
    for (exterior, d), points in pick(series, panel="profile").groupby(["series", "alpha"]):
        colour = _COLOURS[exterior == "reflecting"]
        style = "-" if d == 1.0 else "--"
        label = f"{exterior}, $D$ = {d:g}"
        axes[2].plot(
            points["x"], points["y"], color=colour, linestyle=style, marker="", label=label
        )
    axes[2].set(xlabel="position $x$", ylabel="$u$")
    axes[2].legend(loc="upper left", fontsize=7)
    panel_title(axes[2], "c", r"carried by $a = 4(1 - x^2)$")
    return figure


def _errors(ax: Axes, part: pd.DataFrame, line: str, prefix: str = "") -> None:
    groups = part.groupby("series", sort=False)
    for (name, points), colour, marker in zip(groups, _COLOURS, _MARKERS, strict=False):
        ax.plot(
            points["x"], points["y"], color=colour, marker=marker, linestyle=line, label=f"{prefix}{name}"
        )  # fmt: skip
