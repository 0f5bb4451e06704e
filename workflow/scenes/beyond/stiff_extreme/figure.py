"""Growth at the stability limit, and the work that a stiff operator takes."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fracstudy.style import COLOURS, MARKERS, axes_row, log_log, note, panel_title, slope_triangle

__all__ = ["figure"]

_HOLLOW: dict[str, Any] = {"markerfacecolor": "none"}
_SIZES = {"DD": 8.0, "FPSE": 5.5, "KPSE": 3.5}
_WORK: dict[str, dict[str, Any]] = {
    "RK2, stepping": {"color": "#D55E00", "marker": "s"},
    "RK2, one series": {"color": "#009E73", "marker": "^", "markersize": 8.0, **_HOLLOW},
    "exponential": {"color": "#0072B2", "marker": "o", "markersize": 3.5},
}


def figure(series: pd.DataFrame, table: pd.DataFrame, *, beta: float) -> Figure:
    """Measured growth factors (markers) on the predicted ones (lines); operator applications."""
    drawn, (growth, work) = axes_row(2, height=3.6)
    curves = dict(tuple(series.sort_values("x").groupby(["panel", "series"])))
    _growth(growth, {scheme: curves["growth", scheme] for scheme in _SIZES})
    _work(work, {name: curves["work", name] for name in _WORK})
    panel_title(work, "b", rf"work of a KPSE run, $\beta = {beta:g}$")
    return drawn


def _growth(ax: Axes, curves: dict[str, pd.DataFrame]) -> None:
    for scheme, points in curves.items():
        look: dict[str, Any] = {
            "marker": MARKERS[scheme],
            "markersize": _SIZES[scheme],
            "linestyle": "none",
        }
        colour = COLOURS[scheme]
        ax.plot(points["x"], points["predicted"], color=colour, linewidth=0.9)
        ax.plot(points["x"], points["y"], color=colour, label=scheme, **look, **_HOLLOW)
    ax.axvline(1.0, color="0.5", linewidth=0.8, linestyle=":")
    place = {"xycoords": ("data", "axes fraction"), "ha": "right", "va": "top", "fontsize": 9}
    note(ax, "limit (54)", (1.0, 0.97), (-4, 0), color="0.35", **place)
    ax.set(xlabel=r"$\Delta t$ over the stability limit", ylabel="growth factor per step, RK2")
    panel_title(ax, "a", "lines: predicted, markers: measured")
    ax.legend(loc="center left")


def _work(ax: Axes, curves: dict[str, pd.DataFrame]) -> None:
    for name, points in curves.items():
        ax.plot(points["x"], points["y"], label=name, **_WORK[name])
    log_log(ax, xlabel=r"stiffness $\mathcal{D} T / h^\alpha$", ylabel="operator applications")
    ax.legend(loc="upper left")
    exponential = curves["exponential"]
    middle = exponential.iloc[3 * len(exponential) // 4]
    slope_triangle(ax, middle["x"], 0.4 * middle["y"], 0.5)
