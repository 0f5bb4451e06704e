"""A front with a tail of a power of x, its rate, and what a digit costs."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fracstudy.panels import pick
from fracstudy.style import axes_row, guide, log_log, name_ticks, note, panel_title, small_legend

_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00")
_MARKERS = "osD^v"
_STEPS = {"dop853": "order 8 (DOP853)", "rkc2": "stabilised (RKC2)"}


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw (a) the front, (b) its rate, (c) errors against evaluations, (d) how close particles come to the rate."""
    drawn, axes = axes_row(4, height=3.6, width=3.4)
    _front(axes[0], pick(series, panel="front"))
    _rates(axes[1], pick(series, panel="rate"))
    for (name, label), colour, marker in zip(_STEPS.items(), _COLOURS, _MARKERS, strict=False):
        part = pick(series, panel="tolerance", series=name)
        axes[2].plot(part["x"], part["y"], color=colour, marker=marker, label=label)
    log_log(
        axes[2],
        xlabel="evaluations of the right-hand side",
        ylabel="error relative to the greatest $u$",
    )
    name_ticks(axes[2], (100, 300, 1000, 3000))
    axes[2].legend(loc="upper right")
    panel_title(axes[2], "c", "decay: error and work")
    followed = pick(series, panel="followed").groupby("series", sort=False)
    for (name, points), colour, marker in zip(followed, _COLOURS, _MARKERS, strict=False):
        axes[3].plot(points["x"], points["y"], color=colour, marker=marker, label=name)
    axes[3].set(xlabel="time $t$", ylabel="relative distance from $1/(1+\\alpha)$", yscale="log")
    small_legend(axes[3], "lower left")
    panel_title(axes[3], "d", "rate of the front, by particles")
    return drawn


def _front(ax: Axes, part: pd.DataFrame) -> None:
    names = list(part["series"].unique())
    shades = np.linspace(0.35, 1.0, len(names))
    for name, shade in zip(names, shades, strict=True):
        points = pick(part, series=name)
        ax.plot(
            points["x"],
            points["y"],
            color=_COLOURS[0],
            alpha=shade,
            marker="",
            label=f"t = {float(name):g}",
        )
    last = pick(part, series=names[-1])
    far = last.iloc[(last["x"] - 0.5 * last["x"].max()).abs().argmin()]
    ends: list[Any] = [0.1 * last["x"].max(), last["x"].max()]
    guide(ax, ends, (far["x"], 3.0 * far["y"]), -2.5)
    top = 3.0 * far["y"] * (far["x"] / ends[0]) ** 2.5
    note(ax, "$x^{-1-\\alpha}$", (ends[0], top), (5, -2))
    log_log(ax, xlabel="position $x$", ylabel="$u(x, t)$")
    small_legend(ax, "lower left")
    panel_title(ax, "a", r"front, $\alpha = 1.5$")


def _rates(ax: Axes, part: pd.DataFrame) -> None:
    for name, colour, marker in zip(part["series"].unique(), _COLOURS, _MARKERS, strict=False):
        points = pick(part, series=name)
        style: dict[str, Any] = {"color": colour, "marker": marker, "markersize": 3.5}
        ax.plot(points["x"], points["y"], label=name, **style)
        ax.axhline(points["exact"].iloc[0], color=colour, linestyle=":", linewidth=0.9)
    ax.set(xlabel="time $t$", ylabel=r"rate $\Delta \ln x_{1/2} / \Delta t$")
    small_legend(ax, "lower right")
    panel_title(ax, "b", r"rate of the front, and $1 / (n + \alpha)$")
