"""The true error of each run over the estimate that is the worst for its limit."""

import pandas as pd

from fracstudy.style import (
    BLUE,
    DOTTED,
    RED,
    Figure,
    Look,
    axes_row,
    border,
    draw,
    entry,
    legend_below,
    log_log,
    note,
)
from scenes.extremes.geometry.lattices import OF_A_FUNCTION

_SAID = {"warned": (RED, "warned"), "silent": (BLUE, "no warning")}
_WORDS = ("overlap", "too coarse", "too narrow", "off centre", "hidden", "graded")
_KINDS = dict(zip(_WORDS, "os^DPv", strict=True))
_POINT: Look = {"linestyle": "none", "markerfacecolor": "none", "markersize": 4.5}


def figure(series: pd.DataFrame) -> Figure:
    """One point a run: silent where no estimate is above its limit, and then right."""
    drawn, (ax,) = axes_row(1, height=4.0, width=6.0)
    for (kind, said), points in series.groupby(["panel", "series"]):
        draw(ax, points, color=_SAID[said][0], marker=_KINDS[kind], **_POINT)
    ax.axvline(1.0, **DOTTED)
    border(ax, OF_A_FUNCTION)
    log_log(ax, xlabel="largest estimate / its limit", ylabel="true relative error in the 1-norm")
    place: Look = {"xycoords": "axes fraction", "va": "top", "fontsize": 9}
    note(ax, "wrong without a warning: empty", (0.02, 0.98), (0, 0), **place)
    entries = [entry(name, color=colour, linewidth=2.0) for colour, name in _SAID.values()]
    shown = [kind for kind in _KINDS if kind in set(series["panel"])]
    entries += [entry(kind, marker=_KINDS[kind], color="0.3", **_POINT) for kind in shown]
    legend_below(drawn, entries, 4)
    return drawn
