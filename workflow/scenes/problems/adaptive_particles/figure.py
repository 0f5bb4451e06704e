"""Error against particles, in time, and where the particles are."""

import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import Figure, axes_row, curves, log_log, name_ticks, small_legend


def figure(series: pd.DataFrame) -> Figure:
    """Draw (a) errors against particles, (b) errors in time, (c) volumes."""
    count, time, spacing = (pick(series, panel=panel) for panel in ("count", "time", "spacing"))
    titles = [
        f"error and particles at $t = {time['x'].min():g}$",
        "error over time, particles placed anew",
        "volumes of the particles",
    ]
    drawn, axes = axes_row(titles, height=3.6, width=4.0)
    for ax, part, xlabel in zip(axes, (count, time), ("particles", "time $t$"), strict=False):
        curves(ax, part)
        log_log(ax, xlabel=xlabel, ylabel=r"error $\sum V |u - u_\mathrm{exact}|$")
    name_ticks(axes[0], (100, 1000, 10000, 100000))
    axes[0].set_ylim(top=1e3 * count["y"].max())
    axes[1].set_ylim(0.3 * time["y"].min(), 10.0 * time["y"].max())
    curves(axes[2], spacing, marker=".", linewidth=0.8)
    axes[2].set(xlabel="position $x$", ylabel="volume $V_i$", yscale="log")
    for ax, place, columns in zip(
        axes, ("upper left", "upper left", "lower right"), (1, 3, 1), strict=True
    ):
        small_legend(ax, place, ncols=columns)
    return drawn
