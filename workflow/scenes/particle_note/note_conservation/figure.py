"""Particle strength exchange on particles anywhere."""

import numpy as np
import pandas as pd

from fracstudy import style
from fracstudy.style import Axes, Figure, Look, axes_row, draw, entry, legend_below, log_log, note

_LOOKS: dict[str, Look] = {
    "lattice": {"color": style.GREEN, "marker": "s"},
    "mapped": {"color": style.PINK, "marker": "D"},
    "jittered": {"color": style.RED, "marker": "^"},
    "random": {"color": style.BLUE, "marker": "o"},
}
_HOLLOW = {"markerfacecolor": "none"}
_KERNELS = {"Gaussian (20)": {"linestyle": "-"}, "skewed (20)": {"linestyle": "--", **_HOLLOW}}
_FLOOR = 1e-17


def figure(series: pd.DataFrame, *, half_width: float, particles: int) -> Figure:
    """(a) Strengths per volume on random particles, (b) total strength over time, (c) accuracy by arrangement."""
    drawn, axes = axes_row(3, height=3.7, width=3.3)
    panels = dict(tuple(series.groupby("panel")))
    _solution(axes[0], panels["solution"], panels["exact"], 2.0 * half_width / particles)
    _mass(axes[1], panels["mass"])
    _accuracy(axes[2], panels["operator"])
    handles = axes[2].get_legend_handles_labels()[0]
    legend_below(drawn, [*handles, entry("random", **_LOOKS["random"])])
    return drawn


def _solution(ax: Axes, part: pd.DataFrame, exact: pd.DataFrame, width: float) -> None:
    part = part[part["x"].abs() < 5.0]
    draw(ax, exact, color="black", linewidth=1.0, label="exact")
    areas: Look = {"s": 9.0 * part["volume"] / width, "linewidth": 0}
    areas["label"] = "random particles"
    ax.scatter(part["x"], part["y"], color=style.BLUE, alpha=0.7, **areas)
    ax.plot(part["x"], np.full(len(part), -0.012), "|", color=style.BLUE, markersize=5)
    ax.set(xlabel="$x$", ylabel="$Q_i / V_i$ at the end", ylim=(-0.025, 0.43))
    ax.legend(loc="upper left", fontsize=7, ncols=2)


def _mass(ax: Axes, part: pd.DataFrame) -> None:
    part = part[part["series"].isin(_KERNELS) & (part["x"] > 0.0)]
    for (kind, name), curve in part.groupby(["kind", "series"]):
        look = {**_LOOKS[kind], **_KERNELS[name], "markersize": 3.5}
        ax.plot(curve["x"], np.maximum(curve["y"], _FLOOR), **look)
    ax.set(yscale="log", ylim=(1e-19, 100.0), xlabel="time since the start")
    ax.set_ylabel(r"$|\sum Q(t) / \sum Q(0) - 1|$")
    inside = {"xycoords": "axes fraction", "color": "black"}
    note(ax, "dashed: skewed kernel", (0.03, 0.98), (0, 0), va="top", **inside)
    note(ax, "solid: symmetric kernel (20)", (0.03, 0.03), (0, 0), **inside)


def _accuracy(ax: Axes, part: pd.DataFrame) -> None:
    large = {"lattice": {"markersize": 8, **_HOLLOW}}
    for (kind, power), curve in part.groupby(["kind", "power"], sort=False):
        label = kind if power == 1.0 else rf"{kind}, $\epsilon \propto h^{{1/2}}$"
        look = {"linestyle": "-" if power == 1.0 else ":", "markersize": 4.5, **_LOOKS[kind]}
        draw(ax, curve.sort_values("x"), label=label, **look | large.get(kind, {}))
    log_log(ax, xlabel="particle spacing $h$")
    ax.set_ylabel("relative error of $f''$ by (26)")
    style.name_ticks(ax, sorted(part["x"].unique()))
    ax.minorticks_off()
    finest = part.loc[part.loc[part["kind"] == "lattice", "x"].idxmin()]
    style.slope_triangle(ax, 1.3 * finest["x"], 0.6 * finest["y"], 2.0)
