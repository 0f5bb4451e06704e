"""Shares of the parts of set-up and solve."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from fracstudy.style import legend_below, note, note_below, panel_title
from scenes.run_times.contests import duration

# Colours of Okabe & Ito, in which no scheme has a bar here; what is not taken apart further is grey.
_COLOURS = {
    "kernel values": "#0072B2",
    "far field": "#009E73",
    "range of the symbol": "#E69F00",
    "time series": "#CC79A7",
    "plans and the rest": "#BBBBBB",
    "lattice sums": "#D55E00",
    "rest of the solve": "#DDDDDD",
}
_DARK = ("#0072B2", "#009E73", "#D55E00")  # of these, on which white is read better than black
_WRITTEN = 0.08  # shares from here on are written into the bar
_PANELS = ("set-up", "solve")


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw (a) the set-up and (b) the solve, a bar of shares a case, its whole time at the end."""
    cases = series.drop_duplicates("case")
    figure = Figure(figsize=(8.6, 1.5 + 0.42 * len(cases)), layout="constrained")
    axes = figure.subplots(1, len(_PANELS), sharey=True)
    for letter, ax, panel in zip("ab", axes, _PANELS, strict=True):
        _bars(ax, series[series["panel"] == panel])
        panel_title(ax, letter, panel)
    axes[0].set_yticks(np.arange(len(cases)), [_name(case) for case in cases.itertuples()])
    axes[0].set_ylim(len(cases) - 0.5, -0.5)  # the first on top
    drawn = series.loc[series["share"] > 0.0, "part"].unique()
    handles = [Patch(color=_COLOURS[part], label=part) for part in _COLOURS if part in drawn]
    legend_below(figure, handles, columns=4)
    note_below(figure, f"set-up: nothing kept from before; {series['note'].iloc[0]}")
    return figure


def _bars(ax: Axes, parts: pd.DataFrame) -> None:
    for place, (_, bar) in enumerate(parts.groupby("case", sort=False)):
        start = 0.0
        for part, share in zip(bar["part"], bar["share"], strict=True):
            colour = _COLOURS[part]
            ax.barh(place, share, left=start, height=0.62, color=colour, edgecolor="white")
            if share >= _WRITTEN:
                text = "white" if colour in _DARK else "black"
                style: dict[str, Any] = {
                    "ha": "center",
                    "va": "center",
                    "fontsize": 7,
                    "color": text,
                }
                ax.annotate(f"{100.0 * share:.0f}", (start + 0.5 * share, place), **style)
            start += share
        note(ax, duration(bar["total"].iloc[0]), (1.0, place), (4, 0), va="center", color="black")
    ax.set(xlim=(0.0, 1.0), xlabel="share / %")
    ax.set_xticks(np.linspace(0.0, 1.0, 5), [f"{share}" for share in range(0, 101, 25)])
    ax.tick_params(axis="y", length=0)
    ax.grid(visible=False)
    ax.spines["left"].set_visible(False)


def _name(case: Any) -> str:
    applied = "application" if case.applications == 1 else "applications"
    return f"{case.case}\nN = {case.particles}, {case.applications} {applied}"
