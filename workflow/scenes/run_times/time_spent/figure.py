"""Shares of the parts of set-up and solve."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.patches import Patch

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import BLUE, GREEN, ORANGE, PINK, RED, Axes, Figure
from scenes.run_times.contests import duration

# Colours of Okabe & Ito, in which no scheme has a bar here; what is not taken apart further is grey.
_COLOURS = {
    "kernel values": BLUE,
    "far field": GREEN,
    "range of the symbol": ORANGE,
    "time series": PINK,
    "plans and the rest": "#BBBBBB",
    "lattice sums": RED,
    "rest of the solve": "#DDDDDD",
}
_DARK = (BLUE, GREEN, RED)  # of these, on which white is read better than black
_WRITTEN = 0.08  # shares from here on are written into the bar
_PANELS = ("set-up", "solve")


def figure(series: pd.DataFrame) -> Figure:
    """Draw (a) the set-up and (b) the solve, a bar of shares a case, its whole time at the end."""
    cases = series.drop_duplicates("case")
    figure, axes = style.axes_row(_PANELS, 1.5 + 0.42 * len(cases), 4.3, sharey=True)
    for ax, panel in zip(axes, _PANELS, strict=True):
        _bars(ax, pick(series, panel=panel))
    axes[0].set_yticks(np.arange(len(cases)), [_name(case) for case in cases.itertuples()])
    axes[0].set_ylim(len(cases) - 0.5, -0.5)  # the first on top
    drawn = series.loc[series["share"] > 0.0, "part"].unique()
    handles = [Patch(color=_COLOURS[part], label=part) for part in _COLOURS if part in drawn]
    style.legend_below(figure, handles, columns=4)
    style.note_below(figure, f"set-up: nothing kept from before; {series['note'].iloc[0]}")
    return figure


def _bars(ax: Axes, parts: pd.DataFrame) -> None:
    for place, (_, bar) in enumerate(parts.groupby("case", sort=False)):
        start = 0.0
        for part, share in zip(bar["part"], bar["share"], strict=True):
            colour = _COLOURS[part]
            ax.barh(place, share, left=start, height=0.62, color=colour, edgecolor="white")
            if share >= _WRITTEN:
                text = "white" if colour in _DARK else "black"
                look: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 7}
                middle = (start + 0.5 * share, place)
                ax.annotate(f"{100.0 * share:.0f}", middle, color=text, **look)
            start += share
        style.note(
            ax, duration(bar["total"].iloc[0]), (1.0, place), (4, 0), va="center", color="black"
        )
    ax.set(xlim=(0.0, 1.0), xlabel="share / %")
    ax.set_xticks(np.linspace(0.0, 1.0, 5), [f"{share}" for share in range(0, 101, 25)])
    ax.tick_params(axis="y", length=0)
    ax.grid(visible=False)
    ax.spines["left"].set_visible(False)


def _name(case: Any) -> str:
    applied = "application" if case.applications == 1 else "applications"
    return f"{case.case}\nN = {case.particles}, {case.applications} {applied}"
