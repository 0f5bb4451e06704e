"""Error against run time, and the time that it takes to reach an error."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from fracstudy.style import COLOURS, MARKERS, axes_row, legend_below, note_below

__all__ = ["time_to_accuracy", "work_precision"]

# The peers have muted colours and hollow markers, the limit is black.
_PEERS = {
    "huang-oberman": ("Huang-Oberman", "#8A6D3B", "s"),
    "duo-wyk-zhang": ("Duo-van Wyk-Zhang", "#A0522D", "v"),
    "fractional-centred": ("fractional centred", "#666666", "^"),
    "sinc-lattice": ("sinc lattice", "#B22222", "o"),
    "mapped-fourier": ("mapped Fourier", "#4B5D8C", "D"),
    "exact-symbol": ("exact symbol, periodic (limit)", "#000000", "*"),
    "random walk": ("random walk", "#E69F00", "X"),
}
_OURS = ("DD", "FPSE", "KPSE", "GPSE", "DVM")
_PAPERS = ("DD", "FPSE", "KPSE", "FD")
_FRONT: dict[str, Any] = {"color": "0.82", "linewidth": 7.0, "solid_capstyle": "round", "zorder": 0}
_FLOOR = 1e-13
_TIMES = {"solve_time": "time of a solve / s", "total_time": "time of set-up and solve / s"}


def work_precision(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw the front of each method and of all, a column a beta: above the solve alone, below with its set-up."""
    betas = sorted(series["beta"].unique())
    figure = Figure(
        figsize=(4.4 * len(betas) if len(betas) > 1 else 7.4, 8.6), layout="constrained"
    )
    grid = figure.subplots(2, len(betas), sharey=True, squeeze=False)
    for column, beta in enumerate(betas):
        part = series[series["beta"] == beta]
        done = part[~part["failed"].astype(bool)]
        for ax, time in zip(grid[:, column], _TIMES, strict=True):
            _panel(ax, done, time)
        grid[0, column].set_title(rf"$\beta = {beta:g}$", loc="left")
        failed = len(part) - len(done)
        if failed:
            grid[0, column].set_title(
                f"{failed} of {len(part)} trials failed", loc="right", fontsize=7, color="0.35"
            )
    for ax in grid[:, 0]:
        ax.set_ylabel(parameters["ylabel"])
    legend_below(figure, grid[0, -1], columns=5 if len(betas) > 1 else 3)
    note_below(figure, f"{series['note'].iloc[0]}; dotted: papers' way, extrapolated")
    return figure


def _panel(ax: Axes, part: pd.DataFrame, time: str) -> None:
    front = part[part[f"on front of {time}"].astype(bool)].sort_values(time)
    ax.step(front[time], front["error"], where="post", label="Pareto front", **_FRONT)
    for points, look in _lines(part, time):
        shown = points[points["error"] > _FLOOR]
        if len(shown):
            ax.plot(shown[time], shown["error"], **look)
    ax.set(xscale="log", yscale="log", ylim=(_FLOOR, 2.0), xlabel=_TIMES[time])
    ax.xaxis.set_major_locator(LogLocator(numticks=20))
    ax.grid(visible=True, which="major", color="0.92", linewidth=0.6)


def _lines(part: pd.DataFrame, time: str) -> Iterator[tuple[pd.DataFrame, dict[str, Any]]]:
    """The front of each family with its look: ours, the papers' way, the peers."""
    for family in _OURS:
        own = part[(part["family"] == family) & (part["group"] == "ours")]
        yield _front(own, time), _solid(family)
    for family in _PAPERS:
        own = part[(part["family"] == family) & (part["group"] == "papers")]
        look = {**_solid(family), "linestyle": ":", "markerfacecolor": "none"}
        yield _front(own, time), {**look, "label": f"{family}, naive sums, RK2 steps"}
    for family, (label, colour, marker) in _PEERS.items():
        look = {"color": colour, "marker": marker, "markerfacecolor": "none", "linestyle": "--"}
        yield _front(part[part["family"] == family], time), {**look, **_THIN, "label": label}


_THIN = {"linewidth": 1.0, "markersize": 4.0}


def _solid(family: str) -> dict[str, Any]:
    return {
        "color": COLOURS[family],
        "marker": MARKERS[family],
        "markersize": 4.0,
        "linewidth": 1.4,
        "label": family,
    }


def _front(points: pd.DataFrame, time: str) -> pd.DataFrame:
    """The points of a method that none of its others is better than in both."""
    ordered = points.sort_values([time, "error"])
    return ordered[ordered["error"] < ordered["error"].cummin().shift(fill_value=np.inf)]


def time_to_accuracy(
    series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]
) -> Figure:
    """Draw, one panel an error, a bar a method: its least time, and the ratio to the fastest."""
    errors = sorted(series["error"].unique(), reverse=True)
    figure, axes = axes_row(len(errors), height=5.2, width=4.6)
    for ax, error in zip(axes, errors, strict=True):
        part = series[series["error"] == error].copy()
        part["name"] = [
            _PEERS.get(family, (f"{family}, naive" if group == "papers" else family,))[0]
            for family, group in zip(part["family"], part["group"], strict=True)
        ]
        _bars(ax, part.sort_values("solve_time", ascending=False, na_position="first"))
        ax.set_title(f"error {error:.0e}".replace("e-0", "e-"), loc="right")
        ax.set_xlabel("least time of a solve / s")
    note_below(
        figure,
        f"numbers: times the fastest; hatched: extrapolated; {series['note'].iloc[0]}",
    )
    return figure


def _bars(ax: Axes, part: pd.DataFrame) -> None:
    places = np.arange(len(part))
    least = part["solve_time"].min()
    start = 10.0 ** np.floor(np.log10(least) - 0.3)
    ax.set_xscale("log")
    ax.set_xlim(start, 3e2 * part["solve_time"].max())
    for place, (_, row) in zip(places, part.iterrows(), strict=True):
        time = row["solve_time"]
        if not np.isfinite(time):
            ax.annotate(" not reached", (start, place), va="center", fontsize=7.5, color="0.4")
            continue
        colour = _PEERS[row["family"]][1] if row["family"] in _PEERS else COLOURS[row["family"]]
        ours = row["group"] != "peers" and row["group"] != "limit"
        ax.barh(
            place, time - start, left=start, height=0.66, color=colour if ours else "white",
            edgecolor="white" if row["extrapolated"] else colour,
            hatch="////" if row["extrapolated"] else None, linewidth=1.0,
        )  # fmt: skip
        ax.annotate(
            f" {_times(time / least)}", (time, place), va="center", fontsize=7.5, color="0.2"
        )
    ax.set_ylim(-0.7, len(part) - 0.3)
    ax.set_yticks(places, part["name"], fontsize=8)
    ax.grid(visible=False, axis="y")
    ax.xaxis.set_major_locator(LogLocator(numticks=8))
    ax.xaxis.set_minor_locator(NullLocator())
    ax.tick_params(axis="y", length=0)


def _times(ratio: float) -> str:
    if ratio < 1e4:
        return f"{ratio:.3g}"
    mantissa, exponent = f"{ratio:.0e}".split("e")
    return rf"${mantissa} \cdot 10^{{{int(exponent)}}}$"
