"""Figs. 8-10: F on the fixed grid."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from fracstudy.panels import pick
from scenes.lewandowski.marker_style import (
    EXACT,
    LOADING_LOOKS,
    SHAPE_COLOURS,
    draw,
    entry,
    shape_panels,
    strokes,
    symbol,
)

__all__ = ["figure"]


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw F: a column for each shape function, a row for each start, markers below."""
    shapes = list(series.loc[series["panel"] == "markers", "series"].unique())
    figure, panels, _ = shape_panels(shapes, tuple(LOADING_LOOKS), first=8)
    for ax, shape, loading in panels:
        here, colour = pick(series, series=shape, loading=loading), SHAPE_COLOURS[shape]
        draw(ax, pick(series, panel="field", series="exact"), **EXACT)
        draw(ax, pick(here, panel="field"), color=colour, linewidth=1.5)
        strokes(ax, pick(here, panel="markers")["x"], colour)
        ax.set(xlim=(-9.0, 9.0), ylim=(-0.045, 0.36))
    entries = [entry(f"$F$ with {symbol(s)}", color=SHAPE_COLOURS[s]) for s in shapes]
    ticks = entry("markers", color="0.4", marker="|", linestyle="")
    legend = [entry(**EXACT), *entries, ticks]
    figure.legend(handles=legend, loc="outside lower center", ncols=5)
    return figure
