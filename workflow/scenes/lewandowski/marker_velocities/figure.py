"""Burgers, Korteweg-de Vries and a source by one marker solver."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from fracstudy.style import legend_below, slope_triangle

__all__ = ["figure"]

_BLUE, _RED, _GREEN, _PINK, _SKY, _ORANGE = (
    "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00",
)  # fmt: skip


def figure(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw (a) Burgers' equation, (b) a soliton, (c) a source, (d) the errors."""
    figure = Figure(figsize=(8.6, 6.8), layout="constrained")
    axes = figure.subplots(2, 2)
    _burgers(axes[0, 0], series[series["panel"] == "burgers"], parameters["burgers"])
    _kdv(axes[0, 1], series[series["panel"] == "kdv"])
    _source(axes[1, 0], series[series["panel"] == "source 0"], parameters["source"])
    _errors(axes[1, 1], series[series["panel"] == "errors"])
    legend_below(figure, axes[1, 1], columns=2)
    return figure


def _burgers(ax: Axes, series: pd.DataFrame, parameters: dict[str, Any]) -> None:
    for (t, part), colour in zip(series.groupby("t"), (_ORANGE, _GREEN, _BLUE), strict=False):
        exact = part[part["series"] == "exact"]
        dots = part[part["series"] == "markers"].sort_values("x")
        dots = dots.iloc[:: max(1, len(dots) // 40)]
        ax.plot(exact["x"], exact["y"], color="black", linewidth=0.9)
        ax.plot(dots["x"], dots["y"], "o", color=colour, markersize=3.5, markerfacecolor="white")
        peak = exact.loc[exact["y"].idxmax()]
        ax.annotate(
            f"$t = {t:g}$", (peak["x"], peak["y"]), xytext=(6, 2), textcoords="offset points",
            color=colour, fontsize=8,
        )  # fmt: skip
    ax.set(
        xlabel="$x$",
        ylabel="$F$ at the markers",
        xlim=(-1.5, 4.0),
        ylim=(0.0, 1.12 * series["y"].max()),
    )
    ax.set_title(f"(a) Burgers, $R = {parameters['shown']:g}$; lines: Cole-Hopf", loc="left")


def _kdv(ax: Axes, series: pd.DataFrame) -> None:
    exact, dots = (series[series["series"] == name] for name in ("exact", "markers"))
    for (t, part), line in zip(exact.groupby("t"), ("--", "-"), strict=True):
        ax.plot(part["x"], part["y"], line, color="black", linewidth=0.9)
        peak = part.loc[part["y"].idxmax()]
        ax.annotate(
            f"$t = {t:g}$", (peak["x"], peak["y"]), xytext=(0, 4), textcoords="offset points",
            ha="center", fontsize=8,
        )  # fmt: skip
    dots = dots.sort_values("x").iloc[:: max(1, len(dots) // 80)]
    ax.plot(dots["x"], dots["y"], "o", color=_BLUE, markersize=3.5, markerfacecolor="white")
    ax.set(xlabel="$x$", ylabel="$F$ at the markers", ylim=(0.0, 1.15 * series["y"].max()))
    ax.set_title("(b) KdV: a soliton on a background", loc="left")


def _source(ax: Axes, series: pd.DataFrame, parameters: dict[str, Any]) -> None:
    looks = {
        "initial": ("0.55", ":", "$f_0$"),
        "exact": ("black", "-", "exact"),
        "in the velocity": (_RED, "--", "source in the velocity"),
        "in the weights": (_BLUE, (0, (1, 1.5)), "source in the weights"),
    }
    for name, (colour, line, label) in looks.items():
        part = series[series["series"] == name]
        width = 2.6 if name == "in the weights" else 1.2
        ax.plot(part["x"], part["y"], color=colour, linestyle=line, linewidth=width, label=label)
    ax.set(xlabel="$x$", ylabel="$F$", ylim=(0.0, 1.5 * series["y"].max()))
    ax.legend(loc="upper left", ncols=2)
    q, t = parameters["q"]["0"], parameters["t_final"]
    ax.set_title(rf"(c) source $Q = {q:g}\,\exp(-x^2)$, $t = {t:g}$", loc="left")


def _errors(ax: Axes, series: pd.DataFrame) -> None:
    colours = iter((_ORANGE, _GREEN, _PINK, _SKY))
    sources = {
        "a source without total, in the velocity": (_RED, "^", "source, no total, in the velocity"),
        "a source without total, in the weights": (_BLUE, "^", "source, no total, in the weights"),
        "a source with a total, in the velocity": (
            _RED,
            "v",
            "source, with total, in the velocity",
        ),
        "a source with a total, in the weights": (_BLUE, "v", "source, with total, in the weights"),
    }
    for name, part in series.groupby("series", sort=False):
        if name in sources:
            colour, marker, label = sources[name]
        else:
            colour, marker, label = next(colours), "D" if name.startswith("KdV") else "o", name
        ax.plot(
            part["x"], part["y"], color=colour, marker=marker, label=label,
            linestyle="" if name.startswith("KdV") else "-",
        )  # fmt: skip
    ax.set(
        xscale="log", yscale="log", xlabel="number of markers $N$", ylabel="relative $L^1$ error"
    )
    counts = sorted(series.loc[~series["series"].str.startswith("KdV"), "x"].unique())
    ax.set_xticks(counts, [f"{n:g}" for n in counts])
    ax.xaxis.set_minor_formatter(NullFormatter())
    slope_triangle(ax, 140.0, 0.75 * series["y"].min(), -1.0)
    ax.set_title("(d) errors", loc="left")
