"""A front with a tail of a power of x, its rate, and what a digit costs."""

from typing import Any

import numpy as np
import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import BLUE, Axes, Figure

_STEPS = {"dop853": "order 8 (DOP853)", "rkc2": "stabilised (RKC2)"}


def figure(series: pd.DataFrame, *, drawn: float) -> Figure:
    """Draw (a) the front, (b) its rate, (c) errors against evaluations, (d) how close particles come to the rate."""
    titles = [
        rf"front, $\alpha = {drawn:g}$",
        r"rate of the front, and $1 / (n + \alpha)$",
        "decay: error and work",
        "rate of the front, by particles",
    ]
    figure, axes = style.axes_row(titles, height=3.6, width=3.4)
    _front(axes[0], pick(series, panel="front"), -1.0 - drawn)
    _rates(axes[1], pick(series, panel="rate"))
    style.curves(axes[2], pick(series, panel="tolerance").replace({"series": _STEPS}))
    work, error = "evaluations of the right-hand side", "error relative to the greatest $u$"
    style.log_log(axes[2], xlabel=work, ylabel=error)
    style.name_ticks(axes[2], (100, 300, 1000, 3000))
    axes[2].legend(loc="upper right")
    style.curves(axes[3], pick(series, panel="followed"))
    axes[3].set(xlabel="time $t$", ylabel="relative distance from $1/(1+\\alpha)$", yscale="log")
    style.small_legend(axes[3], "lower left")
    return figure


def _front(ax: Axes, part: pd.DataFrame, slope: float) -> None:
    names = list(part["series"].unique())
    for name, shade in zip(names, np.linspace(0.35, 1.0, len(names)), strict=True):
        label = f"t = {float(name):g}"
        style.draw(ax, pick(part, series=name), color=BLUE, alpha=shade, marker="", label=label)
    last = pick(part, series=names[-1])
    far = last.iloc[(last["x"] - 0.5 * last["x"].max()).abs().argmin()]
    ends: list[Any] = [0.1 * last["x"].max(), last["x"].max()]
    style.guide(ax, ends, (far["x"], 3.0 * far["y"]), slope, r"$x^{-1-\alpha}$")
    style.log_log(ax, xlabel="position $x$", ylabel="$u(x, t)$")
    ax.set_ylim(top=30.0)  # room for the label of the guide
    style.small_legend(ax, "lower left")


def _rates(ax: Axes, part: pd.DataFrame) -> None:
    for k, (name, points) in enumerate(part.groupby("series", sort=False)):
        style.draw(ax, points, color=f"C{k}", marker="osD^"[k], markersize=3.5, label=name)
        ax.axhline(points["exact"].iloc[0], color=f"C{k}", linestyle=":", linewidth=0.9)
    ax.set(xlabel="time $t$", ylabel=r"rate $\Delta \ln x_{1/2} / \Delta t$")
    style.small_legend(ax, "lower right")
