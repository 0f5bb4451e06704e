"""Figs. 14-16: the error norm."""

import numpy as np
import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import Axes, Figure, axes_row, draw, entry, legend_below, name_ticks, note
from scenes.lewandowski.marker_style import LOADING_LOOKS, symbol


def figure(series: pd.DataFrame) -> Figure:
    """Draw E(t) for each shape function, all starts; for S7 also with the printed constant."""
    shapes = list(series.loc[series["panel"] == "E", "series"].unique())
    figure, axes = axes_row(len(shapes), height=3.7, width=3.0, sharey=True)
    later = series[series["x"] > 0.0]
    for number, (ax, shape) in enumerate(zip(axes, shapes, strict=True), start=14):
        here = pick(later, panel="E", series=shape)
        for loading, (_, colour, _) in LOADING_LOOKS.items():
            width, opacity = (0.8, 0.6) if loading == "random" else (1.7, 1.0)
            for _, curve in pick(here, loading=loading).groupby("seed"):
                draw(ax, curve, color=colour, linewidth=width, alpha=opacity)
        ax.set(xlabel="time $t$", yscale="log", xlim=(0.0, None), ylim=(0.01, 0.4))
        ax.set_title(f"Fig. {number}: {symbol(shape)}", loc="left")
        name_ticks(ax, (0.01, 0.02, 0.05, 0.1, 0.2, 0.4), "y")
        printed = pick(later, panel="printed", series=shape)
        if len(printed):
            draw(ax, printed, "--", color="black", linewidth=1.2)
            note(ax, r"printed $\alpha$", printed[["x", "y"]].iloc[-1], (-2, -9), ha="right")
    _exponential(axes[-1], pick(series, panel="E", series="S8", loading="midpoints"))
    axes[0].set_ylabel("error norm $E(t)$")
    legend = [entry(label, color=colour) for label, colour, _ in LOADING_LOOKS.values()]
    legend_below(figure, legend, 3)
    return figure


def _exponential(ax: Axes, quiet: pd.DataFrame) -> None:
    """The best exponential from t = 1 on."""
    late = quiet[quiet["x"] >= 1.0]
    if len(late) > 1:
        line = np.exp(np.polyval(np.polyfit(late["x"], np.log(late["y"]), 1), quiet["x"]))
        ax.plot(quiet["x"], line, "--", color="0.35", linewidth=0.9)
        end = (quiet["x"].iloc[-1], line[-1])
        note(ax, "exponential fit", end, (0, -4), ha="right", va="top", color="0.25")
