"""Growth at the limit of a step, and errors of runs that speak or do not."""

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fracstudy.style import axes_row, entry, legend_below, log_log, panel_title

_LOOKS: dict[str, dict[str, Any]] = {
    "DVM 2": {"color": "#7F3C8D", "marker": "p"},
    "DVM 4": {"color": "#0072B2", "marker": "o"},
    "S4": {"color": "#D55E00", "marker": "s"},
    "S6": {"color": "#CC79A7", "marker": "D"},
    "S8": {"color": "#009E73", "marker": "^"},
}
_HOLLOW: dict[str, Any] = {"markerfacecolor": "none"}
_ASKED = 0.05


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """(a) Growth of the fastest wave in a step, (b) error against smoothing length over spacing."""
    drawn, (growth, error) = axes_row(2, height=3.7)
    panels = dict(tuple(series.groupby("panel")))
    _growth(growth, panels["growth"])
    _errors(error, panels["error"])
    names = [name for name in _LOOKS if name in set(series["series"])]
    handles = [entry(name, linestyle="none", **_LOOKS[name]) for name in names]
    handles.append(entry("filled: no warning", linestyle="none", marker="o", color="0.4"))
    handles.append(entry("hollow: warning", linestyle="none", marker="o", color="0.4", **_HOLLOW))
    legend_below(drawn, handles, columns=4)
    return drawn


def _growth(ax: Axes, part: pd.DataFrame) -> None:
    for name, points in part.groupby("series"):
        look = _LOOKS[str(name)]
        ax.plot(points["x"], points["predicted"], color=look["color"], linewidth=0.9)
        ax.plot(points["x"], points["y"], linestyle="none", **look, **_HOLLOW)
    ax.axvline(1.0, color="0.5", linewidth=0.8, linestyle=":")
    ax.axhline(1.0, color="0.5", linewidth=0.8, linestyle=":")
    ax.set(
        xlabel=r"time step $\Delta t$ / stability limit",
        ylabel="growth of the fastest wave per step",
    )
    panel_title(ax, "a", "lines: predicted, markers: measured")


def _errors(ax: Axes, part: pd.DataFrame) -> None:
    for name, points in part.dropna(subset=["y"]).groupby("series"):
        look = _LOOKS[str(name)]
        ax.plot(points["x"], points["y"], color=look["color"], linewidth=0.9)
        for spoke, some in points.groupby("spoke"):
            ax.plot(some["x"], some["y"], linestyle="none", **look, **(_HOLLOW if spoke else {}))
    ax.axhline(_ASKED, color="0.5", linewidth=0.8, linestyle=":")
    log_log(
        ax, xlabel=r"smoothing length / spacing, $\epsilon / h$", ylabel="relative error of the run"
    )
    panel_title(ax, "b", "a warning is required above the dotted line")
