"""Errors of the exchange forms against the disorder of the particles and against their spacing."""

import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import COLOURS, MARKERS, Axes, Figure, Look

_FORMS = ("DD", "FPSE", "KPSE", "GPSE", "DPSE")
_KPSE: Look = {"color": COLOURS["KPSE"], "marker": MARKERS["KPSE"]}
_WRONG: Look = {"linestyle": "--", "markerfacecolor": "none"}
_PREDICTED: Look = {"color": "black", "linewidth": 0.9, "linestyle": ":"}
_LEVELS: dict[str, Look] = {
    "lattice": {"color": "0.3", "marker": "o"},
    "jitter 0.3, right volumes": _KPSE,
    "jitter 0.3, wrong volumes": _KPSE | _WRONG,
}


def figure(series: pd.DataFrame) -> Figure:
    """(a) The error of du/dt against the jitter, (b) against h for a fixed overlap."""
    titles = ("error due to disorder", r"KPSE, $\epsilon = 2 h$")
    drawn, (jitter, spacing) = style.axes_row(titles, height=3.7)
    _jitter(jitter, pick(series, panel="jitter"))
    _spacing(spacing, pick(series, panel="spacing"))
    handles = [style.entry(form, color=COLOURS[form], marker=MARKERS[form]) for form in _FORMS]
    handles.append(style.entry("KPSE, predicted random part", **_PREDICTED))
    handles.append(style.entry("hollow, dashed: all volumes h", color="0.4", marker="o", **_WRONG))
    style.legend_below(drawn, handles, columns=4)
    return drawn


def _jitter(ax: Axes, part: pd.DataFrame) -> None:
    for (form, right), points in part.groupby(["series", "right"]):
        look = _PREDICTED
        if form in _FORMS:
            look = {"color": COLOURS[form], "marker": MARKERS[form], "markersize": 4.5}
            look |= {} if right else _WRONG
        style.draw(ax, points, **look)
    style.log_log(ax, xlabel="largest jitter $J$, in units of $h$")
    ax.set_ylabel(r"relative error of $du/dt$ due to disorder")
    style.name_ticks(ax, sorted(part["x"].unique()))


def _spacing(ax: Axes, part: pd.DataFrame) -> None:
    for name, points in part.groupby("series"):
        style.draw(ax, points, label=name, **_LEVELS[str(name)])
    style.log_log(ax, xlabel=r"particle spacing $h$", ylabel=r"relative error of $du/dt$")
    style.name_ticks(ax, sorted(part["x"].unique()))
    finest = pick(part, series="lattice").sort_values("x").iloc[0]
    style.slope_triangle(ax, 1.2 * finest["x"], 0.22 * finest["y"], 2.0)
    style.small_legend(ax, "lower right")
