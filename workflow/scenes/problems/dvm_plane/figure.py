"""Errors of the plane and the line against the spacing."""

import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import BLUE, RED, Figure, axes_row, draw, log_log, name_ticks, small_legend

_TITLES = {
    "none, open": "open, not remeshed",
    "Lambda3, open": r"open, remeshed by $\Lambda_3$",
    "M4', truncated": "truncated, by $M_4'$",
    "Lambda6,4, truncated": r"truncated, by $\Lambda_{6,4}$",
}


def figure(series: pd.DataFrame) -> Figure:
    """Draw a panel for each way to end and to remesh the particles: solid the plane, dashed the line."""
    drawn, axes = axes_row(list(_TITLES.values()), height=3.7, width=2.9, sharey=True)
    for ax, panel in zip(axes, _TITLES, strict=True):
        for name, points in pick(series, panel=panel).groupby("series", sort=False):
            plane, second = points["dim"].iloc[0] == 2, points["order"].iloc[0] == 2
            style = {"color": BLUE, "marker": "o"} if second else {"color": RED, "marker": "s"}
            draw(ax, points, label=str(name), linestyle="-" if plane else "--", **style)
        log_log(ax, xlabel="particle spacing $h$")
        name_ticks(ax, sorted(series["x"].unique()))
    axes[0].set_ylabel("error relative to the peak")
    small_legend(axes[0], "lower right")
    return drawn
