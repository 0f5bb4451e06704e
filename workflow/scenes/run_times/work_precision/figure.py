"""Error against run time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from fracstudy.style import legend_below, log_log, note_below, scheme_style
from scenes.run_times.contests import LOOKS, front

__all__ = ["figure"]

_OURS = ("DD", "FPSE", "KPSE", "GPSE", "DVM")
_PAPERS = ("DD", "FPSE", "KPSE", "FD")
_FRONT: dict[str, Any] = {"color": "0.82", "linewidth": 7.0, "solid_capstyle": "round", "zorder": 0}
_THICK: dict[str, Any] = {"markersize": 4.0, "linewidth": 1.4}
_HOLLOW: dict[str, Any] = {"markerfacecolor": "none", "markersize": 4.0}
_FLOOR = 1e-13
_TIMES = {"solve_time": "time of a solve / s", "total_time": "time of set-up and solve / s"}


def figure(series: pd.DataFrame, table: pd.DataFrame, *, ylabel: str) -> Figure:
    """Draw the front of each contender and of all, a column a beta: above the solve alone, below with its set-up."""
    betas = sorted(series["beta"].unique())
    width = 4.4 * len(betas) if len(betas) > 1 else 7.4
    figure = Figure(figsize=(width, 8.6), layout="constrained")
    grid = figure.subplots(2, len(betas), sharey=True, squeeze=False)
    for (above, below), beta in zip(grid.T, betas, strict=True):
        part = series[series["beta"] == beta]
        done = part[~part["failed"].astype(bool)]
        for ax, time in zip((above, below), _TIMES, strict=True):
            _panel(ax, done, time)
        above.set_title(rf"$\beta = {beta:g}$", loc="left")
        failed = len(part) - len(done)
        if failed:
            text = f"{failed} of {len(part)} trials failed"
            above.set_title(text, loc="right", fontsize=7, color="0.35")
    for ax in grid[:, 0]:
        ax.set_ylabel(ylabel)
    legend_below(figure, grid[0, -1], columns=5 if len(betas) > 1 else 3)
    note_below(figure, f"{series['note'].iloc[0]}; dotted: papers' way, extrapolated")
    return figure


def _panel(ax: Axes, part: pd.DataFrame, time: str) -> None:
    whole = part[part[f"on front of {time}"].astype(bool)].sort_values(time)
    ax.step(whole[time], whole["error"], where="post", label="Pareto front", **_FRONT)
    for points, style in _lines(part):
        shown = points[front(points, time) & (points["error"] > _FLOOR)].sort_values(time)
        if len(shown):
            ax.plot(shown[time], shown["error"], **style)
    log_log(ax, ylim=(_FLOOR, 2.0), xlabel=_TIMES[time])
    ax.xaxis.set_major_locator(LogLocator(numticks=20))
    ax.grid(visible=True, which="major", color="0.92", linewidth=0.6)


def _lines(part: pd.DataFrame) -> Iterator[tuple[pd.DataFrame, dict[str, Any]]]:
    """The trials of each contender and its look: ours, the papers' way, the peers."""
    of = dict(tuple(part.groupby(["contender", "group"])))
    none = part.iloc[:0]
    for scheme in _OURS:
        yield of.get((scheme, "ours"), none), scheme_style(scheme, label=scheme, **_THICK)
    for scheme in _PAPERS:
        more = {**_THICK, **_HOLLOW, "linestyle": ":", "label": f"{scheme}, naive sums, RK2 steps"}
        yield of.get((scheme, "papers"), none), scheme_style(scheme, **more)
    for contender, look in LOOKS.items():
        more = {**_HOLLOW, "linestyle": "--", "linewidth": 1.0}
        yield part[part["contender"] == contender], {**look, **more}
