"""What remeshing does to the error of DVM."""

import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import (
    Axes,
    Figure,
    Look,
    axes_row,
    border,
    draw,
    entry,
    legend_under,
    log_log,
    name_ticks,
)

_REMESHINGS = {  # colour, marker, label
    "M4'": (style.BLUE, "o", "$M_4'$"),
    "Lambda3": (style.RED, "s", r"$\Lambda_3$"),
    "none": (style.GREEN, "^", "none"),
}
_KINDS = {"II, field (7)": "-", "II, strengths": ":", "IV, field (7)": "--"}


def figure(series: pd.DataFrame, *, shown: float) -> Figure:
    """Draw (a) the error against h, (b) the deviation along x, (c) the error in time against the step."""
    titles = ("error", rf"near the peak, $h = {shown:.3g}$", "error in time")
    drawn, axes = axes_row(titles, width=3.5, height=3.9)
    series = series.sort_values("x", kind="stable")
    _errors(axes[0], pick(series, panel="spacing"))
    _deviations(axes[1], pick(series, panel="profile"))
    _steps(axes[2], pick(series, panel="time"))
    return drawn


def _look(remeshing: str, kind: str = "field", order: int = 2) -> Look:
    colour, marker, _ = _REMESHINGS[remeshing]
    line = ":" if kind == "strengths" else "--" if order == 4 else "-"
    face = colour if kind == "field" and order == 2 else "none"
    return {"color": colour, "marker": marker, "linestyle": line, "markerfacecolor": face}


def _errors(ax: Axes, series: pd.DataFrame) -> None:
    for (kind, order, name), part in series.groupby(["kind", "order", "remeshing"]):
        if (kind, order) != ("strengths", 4):  # those of order II again
            draw(ax, part, **_look(name, kind, order))
    log_log(ax, xlabel="particle spacing $h$", ylabel=style.ERROR)
    names = [
        entry(label, color=colour, marker=marker, linestyle="none")
        for colour, marker, label in _REMESHINGS.values()
    ]
    lines = [entry(label, color="0.3", linestyle=line) for label, line in _KINDS.items()]
    spacings = sorted(series["x"].unique())
    if len(spacings) > 1:
        x = spacings[-2]
        style.slope_triangle(ax, x, 0.2 * series.loc[series["x"] == x, "y"].min(), 2.0)
    name_ticks(ax, (0.01, 0.02, 0.05, 0.1, 0.2, 0.5), inside=True)
    legend_under(ax, handles=names + lines)


def _deviations(ax: Axes, series: pd.DataFrame) -> None:
    here = series[(series["order"] == 2) & (series["remeshing"] != "none")]
    looks: dict[str, Look] = {
        "field": {"linestyle": "-", "marker": ""},
        "strengths": {"linestyle": ":", "marker": ".", "markersize": 3.5, "linewidth": 0.8},
    }
    for (kind, name), part in here.groupby(["kind", "remeshing"]):
        label = f"{_REMESHINGS[name][2]}, {'field (7)' if kind == 'field' else 'strengths'}"
        ax.plot(part["x"], 100.0 * part["y"], label=label, **{**_look(name, kind), **looks[kind]})
    ax.set_yscale("symlog", linthresh=0.1, linscale=0.6)
    name_ticks(ax, (-10.0, -1.0, -0.1, 0.0, 0.1, 1.0, 10.0), "y")
    ax.set_xlabel("position $x$")
    ax.set_ylabel("deviation from the exact solution, %\n(linear between -0.1 and 0.1)")
    legend_under(ax)


def _steps(ax: Axes, series: pd.DataFrame) -> None:
    finer = {"linestyle": ":", "markerfacecolor": "none"}
    for (h, name), part in series.groupby(["h", "remeshing"]):
        look = _look(name) if h == series["h"].max() else {**_look(name), **finer}
        draw(ax, part, label=rf"{_REMESHINGS[name][2]}, $h = {h:.3g}$", **look)
    border(ax, 1e-3, "a thousandth", va="bottom")
    log_log(ax, xlabel=r"time step $\Delta t$")
    ax.set_ylabel("change from the smallest step / error (48)")
    name_ticks(ax, sorted(series["x"].unique()), inside=True)
    legend_under(ax)
