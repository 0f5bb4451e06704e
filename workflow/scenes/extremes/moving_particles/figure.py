"""Growth at the limit of a step, and errors of runs that speak or do not."""

import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import Axes, Figure, Look

_LOOKS: dict[str, Look] = {
    "DVM 2": {"color": "#7F3C8D", "marker": "p"},
    "DVM 4": {"color": style.BLUE, "marker": "o"},
    "S4": {"color": style.RED, "marker": "s"},
    "S6": {"color": style.PINK, "marker": "D"},
    "S8": {"color": style.GREEN, "marker": "^"},
}
_POINTS: Look = {"linestyle": "none"}
_HOLLOW: Look = {"linestyle": "none", "markerfacecolor": "none"}
_ASKED = 0.05


def figure(series: pd.DataFrame) -> Figure:
    """(a) Growth of the fastest wave in a step, (b) error against smoothing length over spacing."""
    titles = ("lines: predicted, markers: measured", "a warning is required above the dotted line")
    drawn, (growth, error) = style.axes_row(titles, height=3.7)
    _growth(growth, pick(series, panel="growth"))
    _errors(error, pick(series, panel="error"))
    names = [name for name in _LOOKS if name in set(series["series"])]
    handles = [style.entry(name, **_POINTS, **_LOOKS[name]) for name in names]
    handles.append(style.entry("filled: no warning", marker="o", color="0.4", **_POINTS))
    handles.append(style.entry("hollow: warning", marker="o", color="0.4", **_HOLLOW))
    style.legend_below(drawn, handles, columns=4)
    return drawn


def _growth(ax: Axes, part: pd.DataFrame) -> None:
    for name, points in part.groupby("series"):
        look = _LOOKS[str(name)]
        ax.plot(points["x"], points["predicted"], color=look["color"], linewidth=0.9)
        style.draw(ax, points, **look, **_HOLLOW)
    ax.axvline(1.0, **style.DOTTED)
    style.border(ax, 1.0)
    ax.set_xlabel(r"time step $\Delta t$ / stability limit")
    ax.set_ylabel("growth of the fastest wave per step")


def _errors(ax: Axes, part: pd.DataFrame) -> None:
    for name, points in part.dropna(subset=["y"]).groupby("series"):
        look = _LOOKS[str(name)]
        style.draw(ax, points, color=look["color"], linewidth=0.9)
        for spoke, some in points.groupby("spoke"):
            style.draw(ax, some, **look, **(_HOLLOW if spoke else _POINTS))
    style.border(ax, _ASKED)
    style.log_log(ax, xlabel=r"smoothing length / spacing, $\epsilon / h$")
    ax.set_ylabel("relative error of the run")
