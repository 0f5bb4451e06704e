"""Figs. 8-10: F on the fixed grid."""

import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import Figure, draw, entry, legend_below
from scenes.lewandowski import marker_style as look


def figure(series: pd.DataFrame) -> Figure:
    """Draw F: a column for each shape function, a row for each start, markers below."""
    shapes = list(series.loc[series["panel"] == "markers", "series"].unique())
    figure, panels, _ = look.shape_panels(shapes, tuple(look.LOADING_LOOKS), first=8)
    for ax, shape, loading in panels:
        here, colour = pick(series, series=shape, loading=loading), look.SHAPE_COLOURS[shape]
        draw(ax, pick(series, panel="field", series="exact"), **look.EXACT)
        draw(ax, pick(here, panel="field"), color=colour, linewidth=1.5)
        look.strokes(ax, pick(here, panel="markers")["x"], colour)
        ax.set(xlim=(-9.0, 9.0), ylim=(-0.045, 0.36))
    entries = [entry(f"$F$ with {look.symbol(s)}", color=look.SHAPE_COLOURS[s]) for s in shapes]
    ticks = entry("markers", color="0.4", marker="|", linestyle="")
    legend = [entry(**look.EXACT), *entries, ticks]
    legend_below(figure, legend, 5)
    return figure
