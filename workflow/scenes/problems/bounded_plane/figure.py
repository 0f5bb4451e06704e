"""Eigenvalues of the disc and the square, decay in the disc, and the box of truncated schemes."""

import numpy as np
import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import BLUE, COLOURS, MARKERS, Figure

_TITLES = (
    "disc, absorbing",
    "square; dashed: plain lattice",
    "decay in the disc",
    "truncated schemes",
)


def figure(series: pd.DataFrame) -> Figure:
    """Draw (a) disc, (b) square, (c) decay, (d) truncated schemes."""
    drawn, axes = style.axes_row(_TITLES, height=3.7, width=3.4)
    fitted, plain = (pick(series, panel=f"square, {kind}") for kind in ("fitted", "plain"))
    for ax, part in zip(axes, (pick(series, panel="disc"), fitted), strict=False):
        style.curves(ax, part, name=r"$\alpha$ = {}", markersize=4.0)
        style.log_log(ax)
        style.name_ticks(ax, np.unique(part["x"]))
        style.small_legend(ax, "lower left")
    style.curves(axes[1], plain, name=None, linestyle="--", markersize=4.0)
    error = "error of the first eigenvalue, relative"
    axes[0].set(xlabel="rings $N$", ylabel=error)
    axes[1].set(xlabel="particles along a side $N$", ylabel=error)
    decay = pick(series, panel="decay")
    axes[2].plot(decay["x"], decay["exact"], color="black", marker="", label="spectral method")
    style.draw(axes[2], decay, "o", color=BLUE, label="rings of particles")
    axes[2].set(yscale="log", xlabel="time $t$", ylabel="$u(0, t)$")
    style.small_legend(axes[2], "lower left")
    truncated = pick(series, panel="truncated")
    for name, points in truncated.groupby("series", sort=False):
        colour = COLOURS[str(name)]
        style.draw(axes[3], points, label=str(name), color=colour, marker=MARKERS[str(name)])
        exact, kind = points["exact"].iloc[0], "absorbing" if name == "DD" else "reflecting"
        axes[3].axhline(exact, color=colour, linestyle=":", marker="")
        look: style.Look = {"ha": "right", "color": colour, **style.ALONG}
        style.note(axes[3], f"{kind} square", (1.0, exact), (0, 3), **look)
    axes[3].set(xlabel="$1/n$", ylabel="decay of the longest wave")
    axes[3].set_xlim(0.0, 1.15 * truncated["x"].max())
    axes[3].set_ylim(0.0, 1.15 * truncated[["y", "exact"]].to_numpy().max())
    style.small_legend(axes[3], "center right")
    return drawn
