"""Error against particles, in time, and where the particles are."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from fracstudy.panels import pick
from fracstudy.style import axes_row, log_log, name_ticks, panel_title

__all__ = ["figure"]

_MARKERS = "osD"


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw (a) errors against particles, (b) errors in time, (c) distances of neighbours."""
    drawn, axes = axes_row(3, height=3.6, width=4.0)
    for ax, panel in zip(axes, ("count", "time"), strict=False):
        part = pick(series, panel=panel)
        for name, marker in zip(part["series"].unique(), _MARKERS, strict=False):
            points = pick(part, series=name)
            ax.plot(points["x"], points["y"], marker=marker, label=name)
        log_log(ax)
    first = pick(series, panel="time")["x"].min()
    axes[0].set(xlabel="particles", ylabel=r"error $\sum V |u - u_\mathrm{exact}|$")
    name_ticks(axes[0], (100, 1000, 10000, 100000))
    axes[0].legend(loc="upper left", fontsize=7)
    axes[0].set_ylim(top=1e3 * pick(series, panel="count")["y"].max())
    panel_title(axes[0], "a", f"error and particles at $t = {first:g}$")
    axes[1].set(xlabel="time $t$", ylabel=r"error $\sum V |u - u_\mathrm{exact}|$")
    low, high = pick(series, panel="time")["y"].agg(["min", "max"])
    axes[1].set_ylim(0.3 * low, 10.0 * high)
    axes[1].legend(loc="upper left", fontsize=7, ncols=3)
    panel_title(axes[1], "b", "error over time, particles placed anew")
    for name, points in pick(series, panel="spacing").groupby("series"):
        axes[2].plot(points["x"], points["y"], marker=".", linewidth=0.8, label=name)
    axes[2].set(xlabel="position $x$", ylabel="volume $V_i$", yscale="log")
    axes[2].legend(loc="lower right", fontsize=7)
    panel_title(axes[2], "c", "volumes of the particles")
    return drawn
