"""Error against run time: the front of each contender, a row for each problem, a column for each beta."""

from collections.abc import Mapping
from typing import Any

import pandas as pd
from matplotlib.ticker import LogLocator

from fracstudy.panels import pick
from fracstudy.race.contender import Contender
from fracstudy.race.contenders import CONTENDERS
from fracstudy.race.problems import PROBLEMS
from fracstudy.style import Axes, Figure, legend_below, log_log, note_below
from scenes.run_times.contests import TIMES, front

_FRONT: dict[str, Any] = {"color": "0.85", "linewidth": 7.0, "solid_capstyle": "round", "zorder": 0}
_HOLLOW: dict[str, Any] = {"markerfacecolor": "none", "linestyle": "--", "linewidth": 1.0}
_FLOOR = 1e-13


def figure(series: pd.DataFrame, *, time: str, ylabel: str) -> Figure:
    """Draw the least time to each error: filled markers ours and the papers' schemes, hollow ones peers."""
    there = {name: one for name, one in CONTENDERS.items() if (series["contender"] == name).any()}
    problems, betas = series["problem"].unique(), sorted(series["beta"].unique())
    wide = len(betas) > 1
    rows, columns = (len(problems), len(betas)) if wide else (1, len(problems))
    figure = Figure(figsize=(3.2 * columns, 2.3 * rows + 1.4), layout="constrained")
    grid = figure.subplots(rows, columns, sharey=True, squeeze=False)
    for k, problem in enumerate(problems):
        for m, beta in enumerate(betas):
            ax = grid[k, m] if wide else grid[0, k]
            part = pick(series, problem=problem, beta=beta)
            _panel(ax, part[~part["failed"].astype(bool)], there)
            ax.set_title(PROBLEMS[problem].title, loc="left", fontsize=9)
            ax.set_title(rf"$\beta = {beta:g}$", loc="right", fontsize=9)
    for ax in grid[:, 0]:
        ax.set_ylabel(ylabel)
    for ax in grid[-1]:
        ax.set_xlabel(TIMES[time])
    legend_below(figure, grid[0, 0], columns=4)
    note_below(figure, series["note"].iloc[0])
    return figure


def _panel(ax: Axes, part: pd.DataFrame, contenders: Mapping[str, type[Contender]]) -> None:
    whole = part[part["front"].astype(bool)].sort_values("time")
    ax.step(whole["time"], whole["error"], where="post", label="all: Pareto front", **_FRONT)
    for name, contender in contenders.items():
        own = pick(part, contender=name)
        shown = own[front(own, "time") & (own["error"] > _FLOOR)].sort_values("time")
        look: dict[str, Any] = {"color": contender.colour, "marker": contender.marker}
        look |= _HOLLOW if contender.group in ("peers", "papers") else {"linewidth": 1.4}
        ax.plot(shown["time"], shown["error"], label=contender.label, markersize=4.0, **look)
    log_log(ax, ylim=(_FLOOR, 2.0), xlabel="")
    ax.xaxis.set_major_locator(LogLocator(numticks=8))
    ax.grid(visible=True, which="major", color="0.92", linewidth=0.6)
