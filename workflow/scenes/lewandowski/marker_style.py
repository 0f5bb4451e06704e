"""How the figures of the marker method look."""

import numpy as np
import pandas as pd

from fracstudy.style import BLUE, COLOURS, GREEN, ORANGE, PINK, RED, SKY, Axes, Figure, Look

# One colour for each shape function in all figures of the marker method.
SHAPE_COLOURS = {
    "S1": "#999999",
    "S2": ORANGE,
    "S3": PINK,
    "S4": RED,
    "S5": SKY,
    "S6": "#8A6D3B",
    "S7": BLUE,
    "S8": GREEN,
}
# Label, colour and marker of where the markers of the square profile start.
LOADING_LOOKS = {
    "midpoints": ("midpoints of [−1, 1]", BLUE, "o"),
    "random": ("random in [−1, 1]", RED, "s"),
    "wide": ("uniform in [−L, L]", ORANGE, "^"),
}
EXACT: Look = {"color": COLOURS["exact"], "linewidth": 1.0, "label": "exact"}
HOLLOW: Look = {"marker": "o", "linestyle": "", "markersize": 3.5, "markerfacecolor": "white"}


def symbol(shape: str) -> str:
    """Return the symbol of a shape function."""
    return f"$S_{shape[1]}$"


def strokes(ax: Axes, x: pd.Series, colour: str) -> None:
    """Draw the markers as strokes below the axis."""
    level = np.full(len(x), -0.025)
    ax.plot(x, level, "|", color=colour, markersize=6, markeredgewidth=0.6, alpha=0.8)


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
