"""Growth at the stability limit, and the work that a stiff operator takes."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from fracstudy.style import COLOURS, MARKERS, axes_row, slope_triangle

__all__ = ["figure"]

_SIZES = {"DD": 8.0, "FPSE": 5.5, "KPSE": 3.5}
_WORK: dict[str, dict[str, Any]] = {
    "RK2, stepping": {"color": "#D55E00", "marker": "s"},
    "RK2, one series": {
        "color": "#009E73",
        "marker": "^",
        "markersize": 8.0,
        "markerfacecolor": "none",
    },
    "exponential": {"color": "#0072B2", "marker": "o", "markersize": 3.5},
}


def figure(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Measured growth factors (markers) on the predicted ones (lines); operator applications."""
    figure, axes = axes_row(2, height=3.6)
    growth, work = (series[series["panel"] == panel] for panel in ("growth", "work"))
    for scheme in ("DD", "FPSE", "KPSE"):
        points = growth[growth["series"] == scheme].sort_values("x")
        axes[0].plot(points["x"], points["predicted"], color=COLOURS[scheme], linewidth=0.9)
        axes[0].plot(
            points["x"],
            points["y"],
            color=COLOURS[scheme],
            marker=MARKERS[scheme],
            markersize=_SIZES[scheme],
            markerfacecolor="none",
            linestyle="none",
            label=scheme,
        )
    axes[0].axvline(1.0, color="0.5", linewidth=0.8, linestyle=":")
    axes[0].annotate(
        "limit (54)", (1.0, 0.97), xycoords=("data", "axes fraction"), xytext=(-4, 0),
        textcoords="offset points", ha="right", va="top", color="0.35",
    )  # fmt: skip
    axes[0].set(xlabel=r"$\Delta t$ over the stability limit", ylabel="growth factor per step, RK2")
    axes[0].set_title("(a) lines: predicted, markers: measured", loc="left")
    axes[0].legend(loc="center left")
    for name, look in _WORK.items():
        points = work[work["series"] == name].sort_values("x")
        axes[1].plot(points["x"], points["y"], label=name, **look)
    axes[1].set(xscale="log", yscale="log", xlabel=r"stiffness $\mathcal{D} T / h^\alpha$")
    axes[1].set_ylabel("operator applications")
    axes[1].set_title(rf"(b) work of a KPSE run, $\beta = {parameters['beta']:g}$", loc="left")
    axes[1].legend(loc="upper left")
    exponential = work[work["series"] == "exponential"].sort_values("x")
    middle = exponential.iloc[3 * len(exponential) // 4]
    slope_triangle(axes[1], middle["x"], 0.4 * middle["y"], 0.5)
    return figure
