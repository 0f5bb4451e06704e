"""A solution that stays stable, errors of two ways of transport, and a blob that turns."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fracstudy.panels import pick
from fracstudy.style import axes_row, legend_below, log_log, name_ticks, panel_title, small_legend

_TIMES = ("#56B4E9", "#009E73", "#E69F00", "#D55E00")
_WAYS: dict[str, dict[str, Any]] = {
    "lattice, order 4": {"color": "#56B4E9", "marker": "^"},
    "lattice, order 8": {"color": "#009E73", "marker": "D"},
    "lattice, order 12": {"color": "#0072B2", "marker": "o"},
    "particles, Lambda3": {"color": "#D55E00", "marker": "s", "linestyle": "--"},
    "particles, Lambda6,4": {"color": "#E69F00", "marker": "P", "linestyle": "--"},
    "particles, M4'": {"color": "#CC79A7", "marker": "v", "linestyle": "--"},
}
_LEVELS = (0.03, 0.05)


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw (a) the linear field, (b), (c) errors against the spacing, (d) contours of the blob."""
    drawn, axes = axes_row(4, height=3.7, width=3.3)
    _linear(axes[0], pick(series, panel="linear field"))
    for ax, letter, field in zip(axes[1:3], "bc", ("uniform", "linear"), strict=True):
        part = pick(series, panel=f"error, {field}")
        for way, points in part.groupby("series", sort=False):
            ax.plot(points["x"], points["y"], label=way, **_WAYS[str(way)])
        log_log(ax, xlabel="particle spacing $h$", ylim=(3e-11, 1.0))
        name_ticks(ax, sorted(part["x"].unique()))
        panel_title(ax, letter, f"{field} field, error")
    axes[1].set_ylabel("error / largest $u$")
    _rotation(axes[3], pick(series, panel="rotation"))
    legend_below(drawn, axes[1], columns=5)
    return drawn


def _linear(ax: Axes, part: pd.DataFrame) -> None:
    start = pick(part, series="start")
    ax.plot(start["x"], start["y"], color="0.5", linestyle=":", marker="")
    names = [name for name in part["series"].unique() if name.startswith("exact")]
    for name, colour in zip(names, _TIMES, strict=False):
        exact, ours = pick(part, series=name), pick(part, series=name.replace("exact", "ours"))
        ax.plot(exact["x"], exact["y"], color=colour, marker="", label=name.removeprefix("exact, "))
        some = ours.iloc[:: max(1, len(ours) // 24)]
        ax.plot(some["x"], some["y"], color=colour, linestyle="", marker="o", markersize=3.0)
    ax.set(xlabel="position $x$", ylabel="$u(x, t)$", xlim=(-6.0, 6.0), ylim=(0.0, None))
    small_legend(ax, "upper right")
    panel_title(ax, "a", "linear field $a = -x$")


def _rotation(ax: Axes, part: pd.DataFrame) -> None:
    for k, colour in zip(sorted(part["series"].unique(), key=int), _TIMES[1:], strict=False):
        field = pick(part, series=k).pivot(index="x", columns="y", values="value")
        x, y = field.index.to_numpy(), field.columns.to_numpy()
        ax.contour(x, y, field.to_numpy().T, levels=_LEVELS, colors=colour, linewidths=1.0)
    angle = np.linspace(0.0, 2.0 * np.pi, 200)
    ax.plot(1.5 * np.cos(angle), 1.5 * np.sin(angle), color="0.6", linestyle=":", marker="")
    ax.set(xlabel="$x$", ylabel="$y$", xlim=(-2.2, 3.4), ylim=(-1.6, 4.0), aspect="equal")
    ax.grid(visible=False)
    panel_title(ax, "d", "rotation")
