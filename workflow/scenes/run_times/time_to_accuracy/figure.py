"""The time that it takes to reach an error."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from fracstudy.style import COLOURS, axes_row, note_below
from scenes.run_times.contests import LOOKS

__all__ = ["figure"]

_TEXT: dict[str, Any] = {"va": "center", "fontsize": 7.5}


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw, one panel an error, a bar a contender: its least time, and the ratio to the fastest."""
    errors = sorted(series["error"].unique(), reverse=True)
    figure, axes = axes_row(len(errors), height=5.2, width=4.6)
    for ax, error in zip(axes, errors, strict=True):
        part = series[series["error"] == error]
        _bars(ax, part.sort_values("solve_time", ascending=False, na_position="first"))
        ax.set_title(f"error {error:.0e}".replace("e-0", "e-"), loc="right")
        ax.set_xlabel("least time of a solve / s")
    note = f"numbers: times the fastest; hatched: extrapolated; {series['note'].iloc[0]}"
    note_below(figure, note)
    return figure


def _bars(ax: Axes, part: pd.DataFrame) -> None:
    least = part["solve_time"].min()
    start = 10.0 ** np.floor(np.log10(least) - 0.3)
    ax.set(xscale="log", xlim=(start, 3e2 * part["solve_time"].max()))
    for place, bar in enumerate(part.itertuples()):
        if not np.isfinite(bar.solve_time):
            ax.annotate(" not reached", (start, place), color="0.4", **_TEXT)
            continue
        rival = bar.contender in LOOKS
        colour = LOOKS[bar.contender]["color"] if rival else COLOURS[bar.contender]
        filled = bar.group not in ("peers", "limit")
        style: dict[str, Any] = {
            "color": colour if filled else "white",
            "edgecolor": colour,
            "linewidth": 1.0,
        }
        if bar.extrapolated > 1.0:
            style |= {"edgecolor": "white", "hatch": "////"}
        ax.barh(place, bar.solve_time - start, left=start, height=0.66, **style)
        times = f" {_times(bar.solve_time / least)}"
        ax.annotate(times, (bar.solve_time, place), color="0.2", **_TEXT)
    names = [_name(bar.contender, bar.group) for bar in part.itertuples()]
    ax.set_ylim(-0.7, len(part) - 0.3)
    ax.set_yticks(np.arange(len(part)), names, fontsize=8)
    ax.grid(visible=False, axis="y")
    ax.xaxis.set_major_locator(LogLocator(numticks=8))
    ax.xaxis.set_minor_locator(NullLocator())
    ax.tick_params(axis="y", length=0)


def _name(contender: str, group: str) -> str:
    if contender in LOOKS:
        return str(LOOKS[contender]["label"])
    return f"{contender}, naive" if group == "papers" else contender


def _times(ratio: float) -> str:
    if ratio < 1e3:
        return f"{ratio:.3g}"
    mantissa, exponent = f"{ratio:.0e}".split("e")
    return rf"${mantissa} \cdot 10^{{{int(exponent)}}}$"
