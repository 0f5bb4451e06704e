"""Figs. 5-7: the support parameter."""

import numpy as np
import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import Axes, Figure, draw, entry, legend_below, name_ticks
from scenes.lewandowski.marker_style import EXACT, LOADING_LOOKS
from scenes.lewandowski.square_profile import SquareRuns

_TICKS = {"error": (0.02, 0.05, 0.1, 0.2, 0.5), "slope": (1, 2, 5, 10, 20, 50)}
_LABELS = {"error": "relative $L^2$ error", "slope": r"$\max|F_x| \,/\, \max|f_x|$"}


def figure(series: pd.DataFrame, *, shown: list[float], run: SquareRuns) -> Figure:
    """Draw Figs. 5-7 in the order of eps, and error and slope against eps."""
    figure = Figure(figsize=(8.8, 5.8), layout="constrained")
    grid = figure.add_gridspec(2, 6, height_ratios=(1.0, 1.0))
    fields = pick(series, panel="field")
    names = dict(zip(shown, ("Fig. 5", "Fig. 6", "Fig. 7"), strict=True))
    axes: list[Axes] = []
    for column, epsilon in enumerate(sorted(shown)):
        place = grid[0, 2 * column : 2 * column + 2]
        ax = figure.add_subplot(place, sharey=axes[0] if axes else None)
        axes.append(ax)
        draw(ax, pick(fields, series="exact"), **EXACT)
        here = fields[np.isclose(fields["support"], epsilon)]
        for loading in ("midpoints", "random"):
            colour = LOADING_LOOKS[loading][1]
            draw(ax, pick(here, series=loading), ":", color=colour, linewidth=1.5)
        ax.set_title(rf"{names[epsilon]}: $\varepsilon = {epsilon:g}$", loc="left")
        ax.set(xlabel="$x$", xlim=(-9.0, 9.0))
        ax.tick_params(labelleft=column == 0)
    axes[0].set_ylabel(rf"$F(x, t = {SquareRuns.model_validate(run).t_final:g})$")
    for column, (panel, label) in enumerate(_LABELS.items()):
        ax = figure.add_subplot(grid[1, 3 * column : 3 * column + 3])
        for loading, (_, colour, marker) in LOADING_LOOKS.items():
            draw(ax, pick(series, panel=panel, series=loading), color=colour, marker=marker)
        for epsilon in shown:
            ax.axvline(epsilon, color="0.6", linewidth=0.8, linestyle=":")
        if panel == "slope":
            ax.axhline(1.0, color="black", linewidth=1.0)
            ax.text(0.02, 1.0, "exact", transform=ax.get_yaxis_transform(), va="bottom", fontsize=8)
        ax.set(yscale="log", xlabel=r"support parameter $\varepsilon$", ylabel=label)
        name_ticks(ax, _TICKS[panel], "y")
    legend = [entry(t, color=colour, marker=mark) for t, colour, mark in LOADING_LOOKS.values()]
    legend_below(figure, [entry(**EXACT), *legend], 4)
    return figure
