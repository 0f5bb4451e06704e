"""Figs. 1-4: the initial loading."""

from itertools import chain

import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import BLUE, DOTTED, RED, Axes, Figure, draw, legend_below
from scenes.lewandowski.marker_style import EXACT, SHAPE_COLOURS

_LOADINGS = {"uniform": ("uniform", BLUE, ":"), "equal": ("equal weight", RED, "--")}
# Shape function, factor of the support parameter, colour and line of the errors.
_FIGURES = {
    "Fig. 1": ("S_3", 1.0, SHAPE_COLOURS["S3"], "-"),
    "Fig. 2": ("S_4", 1.0, SHAPE_COLOURS["S4"], "-"),
    "Fig. 3": ("S_6", 1.0, SHAPE_COLOURS["S6"], "-"),
    "Fig. 4": ("S_4", 2.0, "black", "--"),
}


def figure(series: pd.DataFrame, *, support: float, shown: float) -> Figure:
    """Draw Figs. 1-4 at the x_0 shown, and below them the errors against x_0."""
    figure = Figure(figsize=(8.8, 5.6), layout="constrained")
    grid = figure.add_gridspec(2, 4, height_ratios=(1.0, 1.0))
    upper: list[Axes] = []
    for column, (name, (shape, wider, _, _)) in enumerate(_FIGURES.items()):
        ax = figure.add_subplot(grid[0, column], sharey=upper[0] if upper else None)
        upper.append(ax)
        panel = pick(series, panel=name)
        draw(ax, pick(panel, series="exact"), **EXACT)
        for row, (loading, (label, colour, line)) in enumerate(_LOADINGS.items()):
            draw(ax, pick(panel, series=loading), line, color=colour, linewidth=1.2, label=label)
            at = pick(panel, series=f"{loading} markers")["x"]
            level = [-0.045 - 0.045 * row] * len(at)
            ax.plot(at, level, "|", color=colour, markersize=4.5, markeredgewidth=0.8)
        ax.set_title(rf"{name}: ${shape}$, $\varepsilon = {wider * support:g}$", loc="left")
        ax.set(xlabel="$x$", ylim=(-0.13, 0.62))
        ax.tick_params(labelleft=column == 0)
    upper[0].set_ylabel(r"$x \exp(-x^2)$ and $F$")
    for column, (loading, (title, colour, _)) in zip((0, 2), _LOADINGS.items(), strict=True):
        ax = figure.add_subplot(grid[1, column : column + 2])
        for name, (shape, wider, hue, line) in _FIGURES.items():
            label = f"{name}: ${shape}$" + (r", $2\varepsilon$" if wider == 2.0 else "")
            curve = pick(series, panel="error", series=f"{name}, {loading}")
            draw(ax, curve, line, color=hue, label=label)
        ax.axvline(shown, **DOTTED)
        ax.set(yscale="log", ylim=(5e-3, 0.3), xlabel="end of the interval $x_0$")
        ax.set_title(title, loc="left", color=colour)
        if column == 0:
            ax.set_ylabel("relative $L^2$ error")
    entries = (one.get_legend_handles_labels()[0] for one in (upper[0], ax))
    legend_below(figure, list(chain(*entries)), 7)
    return figure
