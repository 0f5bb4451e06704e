"""Errors of the exchange forms against the disorder of the particles and against their spacing."""

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fracstudy.style import (
    COLOURS,
    MARKERS,
    axes_row,
    entry,
    legend_below,
    log_log,
    name_ticks,
    panel_title,
    slope_triangle,
)

_FORMS = ("DD", "FPSE", "KPSE", "GPSE", "DPSE")
_HOLLOW: dict[str, Any] = {"markerfacecolor": "none"}
_PREDICTED: dict[str, Any] = {"color": "black", "linewidth": 0.9, "linestyle": ":"}
_LEVELS: dict[str, dict[str, Any]] = {
    "lattice": {"color": "0.3", "marker": "o"},
    "jitter 0.3, right volumes": {"color": COLOURS["KPSE"], "marker": MARKERS["KPSE"]},
    "jitter 0.3, wrong volumes": {
        "color": COLOURS["KPSE"], "marker": MARKERS["KPSE"], "linestyle": "--", **_HOLLOW,
    },
}  # fmt: skip


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """(a) The error of du/dt against the jitter, (b) against h for a fixed overlap."""
    drawn, (jitter, spacing) = axes_row(2, height=3.7)
    panels = dict(tuple(series.groupby("panel")))
    _jitter(jitter, panels["jitter"])
    _spacing(spacing, panels["spacing"])
    handles = [entry(form, **_look(form)) for form in _FORMS]
    handles.append(entry("KPSE, predicted random part", **_PREDICTED))
    wrong: dict[str, Any] = {"color": "0.4", "linestyle": "--", "marker": "o", **_HOLLOW}
    handles.append(entry("hollow, dashed: all volumes h", **wrong))
    legend_below(drawn, handles, columns=4)
    return drawn


def _look(form: str) -> dict[str, Any]:
    return {"color": COLOURS.get(form, "0.4"), "marker": MARKERS.get(form, "x")}


def _jitter(ax: Axes, part: pd.DataFrame) -> None:
    for (form, right), points in part.groupby(["series", "right"]):
        if form == "KPSE, predicted":
            ax.plot(points["x"], points["y"], **_PREDICTED)
            continue
        line = {} if right else {"linestyle": "--", **_HOLLOW}
        ax.plot(points["x"], points["y"], markersize=4.5, **{**_look(str(form)), **line})
    log_log(
        ax,
        xlabel="largest jitter $J$, in units of $h$",
        ylabel=r"relative error of $du/dt$ due to disorder",
    )
    name_ticks(ax, sorted(part["x"].unique()))
    panel_title(ax, "a", "error due to disorder")


def _spacing(ax: Axes, part: pd.DataFrame) -> None:
    for name, points in part.groupby("series"):
        ax.plot(points["x"], points["y"], label=name, **_LEVELS[str(name)])
    log_log(ax, xlabel=r"particle spacing $h$", ylabel=r"relative error of $du/dt$")
    name_ticks(ax, sorted(part["x"].unique()))
    finest = part[part["series"] == "lattice"].sort_values("x").iloc[0]
    slope_triangle(ax, 1.2 * finest["x"], 0.6 * finest["y"], 2.0)
    ax.legend(loc="lower right", fontsize=7)
    panel_title(ax, "b", r"KPSE, $\epsilon = 2 h$")
