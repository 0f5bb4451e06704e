"""The particles of DVM: paths and lattice."""

import numpy as np
import pandas as pd
from matplotlib import colormaps

from fracstudy.panels import pick
from fracstudy.style import (
    COLOURS,
    RED,
    Axes,
    Figure,
    Look,
    axes_row,
    border,
    draw,
    entry,
    legend_under,
)

_ABOVE = 1.5  # the spacing that calls for remeshing, in units of h
_DASHES: Look = {"linewidth": 0.7, "linestyle": (0, (4, 3))}
_EXACT = {"color": "0.15", **_DASHES}
_DOTS: Look = {"color": RED, "marker": "o", "markersize": 2.5, "linestyle": ""}
_DOTS |= {"alpha": 0.5, "markeredgewidth": 0.0}


def figure(series: pd.DataFrame) -> Figure:
    """Draw (a) the paths of the particles, (b) the spacing against position, (c) the overlap against time."""
    titles = ("paths, no remeshing", "spacing", "least overlap")
    drawn, axes = axes_row(titles, width=3.5, height=3.9)
    _paths(axes[0], pick(series, panel="path"))
    _spacings(axes[1], pick(series, panel="spacing"))
    _overlaps(axes[2], pick(series, panel="overlap"))
    return drawn


def _paths(ax: Axes, series: pd.DataFrame) -> None:
    last = series["label"].max()
    bulk: Look = {"color": COLOURS["DVM"], "alpha": 0.55, "linewidth": 1.0}
    end: Look = {"color": RED, "linewidth": 1.4}
    for (name, particle), path in series.groupby(["series", "label"]):
        look = end if particle in (0, last) else bulk
        draw(ax, path, **(_EXACT if name == "exact" else look))
    ax.set(xlabel="position $x$", ylabel="time $t$")
    ax.margins(y=0.0)
    handles = [
        entry("particles", color=COLOURS["DVM"]),
        entry("the last ones", color=RED),
        entry(r"exact, $x\propto t^{1/\alpha}$", **{**_EXACT, "linestyle": "--"}),
    ]
    legend_under(ax, handles=handles)


def _spacings(ax: Axes, series: pd.DataFrame) -> None:
    free, exact = pick(series, series="none"), pick(series, series="exact").set_index("label")
    times = sorted(free["label"].unique())
    shades = colormaps["viridis"](np.linspace(0.0, 0.85, len(times)))
    for time, shade in zip(times, shades, strict=True):
        line = pick(free, label=time).sort_values("x")
        draw(ax, line, color=shade, label=f"$t = {time:g}$")
        stretched = exact.loc[time]
        ax.plot([0.0, stretched["x"]], [stretched["y"]] * 2, color=shade, **_DASHES)
    rest = series[~series["series"].isin(["none", "exact"])]
    draw(ax, rest, label="remeshed (just before)", **_DOTS)
    border(ax, _ABOVE, f"remesh above {_ABOVE:g}", shift=(0, -2), va="top", fontsize=7)
    ax.set(xlabel="position $x$", ylabel=r"spacing $\Delta x / h$")
    legend_under(ax, 3, columnspacing=1.0)


def _overlaps(ax: Axes, series: pd.DataFrame) -> None:
    of_exact = r"exact, $2\,(t_0/t)^{1/\alpha}$"
    dvm: Look = {"color": COLOURS["DVM"]}
    looks: dict[str, Look] = {
        "exact": {**_EXACT, "linewidth": 0.8, "zorder": 3, "label": of_exact},
        "none, bulk": {**dvm, "linewidth": 2.2, "alpha": 0.6, "label": "not remeshed, bulk"},
        "none, ends": {**dvm, "linewidth": 1.0, "label": "not remeshed, ends"},
    }
    remeshed = {**_DOTS, "label": "remeshed (just before), ends"}
    for name, part in series.sort_values("x").groupby("series"):
        draw(ax, part, **looks.get(name, remeshed))
    border(ax, 1.0, "no overlap below 1", 0.2, ha="left", va="bottom")
    ax.set(xlabel="time $t$", ylabel=r"overlap $\epsilon / \Delta x$", ylim=(0.0, 2.1))
    legend_under(ax, columnspacing=1.0)
