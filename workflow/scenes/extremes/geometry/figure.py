"""The true error of each run over the estimate that is the worst for its limit."""

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from fracstudy.style import axes_row, entry, legend_below, log_log, note
from scenes.extremes.geometry.lattices import OF_A_FUNCTION

_SAID = {"warned": "#D55E00", "silent": "#0072B2"}
_NAMES = {"warned": "warned", "silent": "no warning"}
_WORDS = ("overlap", "too coarse", "too narrow", "off centre", "hidden", "graded")
_KINDS = dict(zip(_WORDS, "os^DPv", strict=True))


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """One point a run: silent where no estimate is above its limit, and then right."""
    drawn, (ax,) = axes_row(1, height=4.0, width=6.0)
    for (kind, said), points in series.groupby(["panel", "series"]):
        look: dict[str, Any] = {"color": _SAID[said], "marker": _KINDS[kind], "markersize": 4.5}
        ax.plot(points["x"], points["y"], linestyle="none", markerfacecolor="none", **look)
    ax.axvline(1.0, color="0.5", linewidth=0.8, linestyle=":")
    ax.axhline(OF_A_FUNCTION, color="0.5", linewidth=0.8, linestyle=":")
    log_log(ax, xlabel="largest estimate / its limit", ylabel="true relative error in the 1-norm")
    place = {"xycoords": "axes fraction", "va": "top", "fontsize": 9}
    note(ax, "wrong without a warning: empty", (0.02, 0.98), (0, 0), **place)
    entries = [entry(_NAMES[said], color=colour, linewidth=2.0) for said, colour in _SAID.items()]
    shown = [kind for kind in _KINDS if kind in set(series["panel"])]
    grey: dict[str, Any] = {"color": "0.3", "linestyle": "none", "markerfacecolor": "none"}
    entries += [entry(kind, marker=_KINDS[kind], markersize=4.5, **grey) for kind in shown]
    legend_below(drawn, entries, 4)
    return drawn
