"""Errors of the plane and the line against the spacing."""

import pandas as pd
from matplotlib.figure import Figure

from fracstudy.panels import pick
from fracstudy.style import axes_row, log_log, name_ticks, panel_title

_TITLES = {
    "none, open": "open, not remeshed",
    "Lambda3, open": r"open, remeshed by $\Lambda_3$",
    "M4', truncated": "truncated, by M4'",
    "Lambda6,4, truncated": r"truncated, by $\Lambda_{6,4}$",
}


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw a panel for each way to end and to remesh the particles: solid the plane, dashed the line."""
    drawn, axes = axes_row(4, height=3.7, width=2.9, sharey=True)
    for ax, letter, (panel, title) in zip(axes, "abcd", _TITLES.items(), strict=True):
        for name, points in pick(series, panel=panel).groupby("series", sort=False):
            plane, second = points["dim"].iloc[0] == 2, points["order"].iloc[0] == 2
            ax.plot(points["x"], points["y"], label=str(name), linestyle="-" if plane else "--",
                    color="#0072B2" if second else "#D55E00", marker="o" if second else "s")  # fmt: skip
        log_log(ax, xlabel="particle spacing $h$")
        name_ticks(ax, sorted(series["x"].unique()))
        panel_title(ax, letter, title)
    axes[0].set_ylabel("error relative to the peak")
    axes[0].legend(loc="lower right", fontsize=7)
    return drawn
