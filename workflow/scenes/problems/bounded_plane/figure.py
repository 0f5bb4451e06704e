"""Eigenvalues of the disc and the square, decay in the disc, and the box of truncated schemes."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fracstudy.panels import pick
from fracstudy.style import COLOURS, MARKERS, axes_row, log_log, name_ticks, panel_title

_COLOURS = ("#0072B2", "#D55E00", "#009E73")
_MARKERS = "osD"


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw (a) disc, (b) square, (c) decay, (d) truncated schemes."""
    drawn, axes = axes_row(4, height=3.7, width=3.4)
    _errors(axes[0], pick(series, panel="disc"), "-")
    log_log(axes[0], xlabel="rings $N$", ylabel="error of the first eigenvalue, relative")
    name_ticks(axes[0], np.unique(pick(series, panel="disc")["x"]))
    panel_title(axes[0], "a", "disc, absorbing")
    _errors(axes[1], pick(series, panel="square, fitted"), "-")
    _errors(axes[1], pick(series, panel="square, plain"), "--", named=False)
    log_log(axes[1], xlabel="particles along a side $N$")
    name_ticks(axes[1], np.unique(pick(series, panel="square, plain")["x"]))
    panel_title(axes[1], "b", "square; dashed: plain lattice")
    decay = pick(series, panel="decay")
    axes[2].plot(decay["x"], decay["exact"], color="black", marker="", label="spectral method")
    axes[2].plot(decay["x"], decay["y"], "o", color=_COLOURS[0], label="rings of particles")
    axes[2].set(yscale="log", xlabel="time $t$", ylabel="$u(0, t)$")
    axes[2].legend(loc="lower left", fontsize=7)
    panel_title(axes[2], "c", "decay in the disc")
    truncated = pick(series, panel="truncated")
    for name, points in truncated.groupby("series", sort=False):
        style: dict[str, Any] = {"color": COLOURS[str(name)], "marker": MARKERS[str(name)]}
        axes[3].plot(points["x"], points["y"], label=str(name), **style)
        axes[3].axhline(points["exact"].iloc[0], color=COLOURS[str(name)], linestyle=":", marker="")
    axes[3].set(
        xlabel="$1/n$", ylabel="decay of the longest wave", xlim=(0.0, 1.15 * truncated["x"].max())
    )
    axes[3].set_ylim(0.0, 1.15 * truncated[["y", "exact"]].to_numpy().max())
    axes[3].legend(loc="center right", fontsize=7)
    panel_title(axes[3], "d", "truncated schemes")
    return drawn


def _errors(ax: Axes, part: pd.DataFrame, line: str, named: bool = True) -> None:
    groups = [points for _, points in part.groupby("series", sort=False)]
    for points, colour, marker in zip(groups, _COLOURS, _MARKERS, strict=False):
        label = rf"$\alpha$ = {float(points['series'].iloc[0]):g}" if named else None
        style: dict[str, Any] = {
            "color": colour,
            "marker": marker,
            "linestyle": line,
            "markersize": 4.0,
        }
        ax.plot(points["x"], points["y"], label=label, **style)
    if named:
        ax.legend(loc="lower left", fontsize=7)
