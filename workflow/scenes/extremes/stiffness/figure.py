"""Operator applications and error over the stiffness, for each way of the time integration."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from fracstudy.panels import pick
from fracstudy.style import axes_row, legend_below, log_log, panel_title

_HOLLOW = {"markerfacecolor": "none"}
_LOOK: dict[str, dict[str, Any]] = {
    "rk2, stepping": {"color": "#D55E00", "marker": "s"},
    "stabilised": {"color": "#CC79A7", "marker": "D"},
    "rk2, series": {"color": "#009E73", "marker": "^", "markersize": 8.0, **_HOLLOW},
    "exponential": {"color": "#0072B2", "marker": "o", "markersize": 3.5},
}
_TITLES = {"applications": ("operator applications", "work"), "error": ("relative error", "error")}


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw (a) applications and (b) errors of KPSE; ways that take too many applications have no error."""
    drawn, axes = axes_row(2, height=3.6)
    for ax, letter, (panel, (label, title)) in zip(axes, "ab", _TITLES.items(), strict=True):
        points = pick(series, panel=panel)
        for way, look in _LOOK.items():
            part = pick(points, series=way)
            ax.plot(part["x"], part["y"], label=way, **look)
        log_log(ax, xlabel=r"stiffness $T\,|\lambda|$", ylabel=label)
        panel_title(ax, letter, title)
    x = np.array([series["x"].min(), series["x"].max()])
    axes[1].plot(x, 64.0 * np.finfo(float).eps * x, color="0.5", linewidth=0.9, linestyle=":")
    legend_below(drawn, axes[0])
    return drawn
