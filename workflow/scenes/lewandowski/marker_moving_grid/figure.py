"""Figs. 11-13: F on the moving grid of the markers, and their spectrum."""

import numpy as np
import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import Axes, Figure, Look, draw, entry, legend_below, note
from scenes.lewandowski import marker_style as look

_REPRESENTED = {"color": "0.55", "linewidth": 0.9}


def figure(series: pd.DataFrame) -> Figure:
    """Draw F at the markers, f there, and f as the same markers represent it; below, the spectrum of the markers."""
    shapes = list(series.loc[series["panel"] == "field", "series"].unique())
    starts = ("midpoints", "random")
    figure, panels, spectra = look.shape_panels(shapes, starts, first=11, more=True)
    for ax, shape, loading in panels:
        here, colour = pick(series, series=shape, loading=loading), look.SHAPE_COLOURS[shape]
        at = pick(here, panel="field")
        draw(ax, pick(here, panel="exact"), **look.EXACT)
        draw(ax, pick(here, panel="representation"), **_REPRESENTED)
        dots = {"markersize": 4.5, "markeredgewidth": 0.0, "alpha": 0.8}
        draw(ax, at, ".", color=colour, **dots)
        look.strokes(ax, at["x"], colour)
        _clusters(ax, pick(here, panel="centres"), colour)
        ax.set(xlim=(-7.0, 7.0), ylim=(-0.045, 0.36))
    for ax, shape in zip(spectra, shapes, strict=True):
        _spectrum(ax, pick(series, series=shape), look.SHAPE_COLOURS[shape])
    spectra[0].set_ylabel("random: spectrum\nof the markers")
    legend = [
        entry("$F$ at the markers", color="0.3", marker=".", linestyle=""),
        entry(**look.EXACT),
        entry("exact, represented by these markers", **_REPRESENTED),
        entry("cluster", color="0.3", marker="v", linestyle="", markersize=4),
    ]
    legend_below(figure, legend, 4)
    return figure


def _clusters(ax: Axes, centres: pd.DataFrame, colour: str) -> None:
    """The clusters, and the distance between them, if there are three."""
    if len(centres) >= 3:
        ax.plot(centres["x"], np.full(len(centres), 0.335), "v", color=colour, markersize=3.5)
        text = rf"clusters ${np.median(np.diff(centres['y'])):.2f}\,\varepsilon$ apart"
        place = {"xycoords": "axes fraction", "ha": "center"}
        note(ax, text, (0.5, 1.0), (0, 2), color=colour, **place)


def _spectrum(ax: Axes, series: pd.DataFrame, colour: str) -> None:
    """The mean spectrum from random starts, and where perturbations grow fastest, if they do."""
    draw(ax, pick(series, panel="spectrum"), color=colour)
    ax.axhline(1.0, color="0.3", linewidth=0.8)
    fastest = float(pick(series, panel="fastest")["x"].iloc[0])
    small: Look = {"va": "top", "fontsize": 7.5, "color": "0.3"}
    if fastest > 0.0:
        ax.axvline(fastest, color="0.3", linewidth=0.9, linestyle="--")
        ax.text(fastest + 0.12, 220.0, "fastest growth", **small)
    else:
        ax.text(3.2, 220.0, "1: independent markers", **small)
    ax.set(yscale="log", xlim=(3.0, 12.0), ylim=(0.3, 300.0), xlabel=r"wavenumber $\varepsilon q$")
