"""How the figures of the marker method look."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fracstudy.style import COLOURS, panel_title

# One colour for each shape function in all figures of the marker method.
SHAPE_COLOURS = {
    "S1": "#999999",
    "S2": "#E69F00",
    "S3": "#CC79A7",
    "S4": "#D55E00",
    "S5": "#56B4E9",
    "S6": "#8A6D3B",
    "S7": "#0072B2",
    "S8": "#009E73",
}
# Label, colour and marker of where the markers of the square profile start.
LOADING_LOOKS = {
    "midpoints": ("midpoints of [−1, 1]", "#0072B2", "o"),
    "random": ("random in [−1, 1]", "#D55E00", "s"),
    "wide": ("uniform in [−L, L]", "#E69F00", "^"),
}
EXACT: dict[str, Any] = {"color": COLOURS["exact"], "linewidth": 1.0, "label": "exact"}
HOLLOW: dict[str, Any] = {
    "marker": "o",
    "linestyle": "",
    "markersize": 3.5,
    "markerfacecolor": "white",
}


def symbol(shape: str) -> str:
    """Return the symbol of a shape function."""
    return f"$S_{shape[1]}$"


def draw(ax: Axes, frame: pd.DataFrame, *line: str, **style: Any) -> None:
    """Draw y against x."""
    ax.plot(frame["x"], frame["y"], *line, **style)


def strokes(ax: Axes, x: pd.Series, colour: str) -> None:
    """Draw the markers as strokes below the axis."""
    level = np.full(len(x), -0.025)
    ax.plot(x, level, "|", color=colour, markersize=6, markeredgewidth=0.6, alpha=0.8)


def four_panels(width: float, height: float, *titles: str) -> tuple[Figure, list[Axes]]:
    """Return a figure with two rows of two panels, lettered."""
    figure = Figure(figsize=(width, height), layout="constrained")
    axes = list(figure.subplots(2, 2).ravel())
    for letter, ax, title in zip("abcd", axes, titles, strict=True):
        panel_title(ax, letter, title)
    return figure, axes


def shape_panels(
    shapes: list[str], loadings: tuple[str, ...], first: int, more: bool = False
) -> tuple[Figure, list[tuple[Axes, str, str]], list[Axes]]:
    """Return a row of panels a start, a column a shape function, from Fig. `first`; with `more` one row below."""
    rows = len(loadings) + more
    figure = Figure(figsize=(8.8, 2.05 * rows + 0.5), layout="constrained")
    grid = figure.subplots(rows, len(shapes), sharey="row", squeeze=False)
    for column, shape in enumerate(shapes):
        grid[0, column].set_title(f"Fig. {first + column}: {symbol(shape)}", loc="left")
        grid[len(loadings) - 1, column].set_xlabel("$x$")
        for ax in grid[: len(loadings) - 1, column]:
            ax.tick_params(labelbottom=False)
    for row, loading in enumerate(loadings):
        grid[row, 0].set_ylabel(f"{LOADING_LOOKS[loading][0]}\n$F$")
    panels = [
        (grid[row, column], shape, loading)
        for row, loading in enumerate(loadings)
        for column, shape in enumerate(shapes)
    ]
    return figure, panels, list(grid[len(loadings)]) if more else []
