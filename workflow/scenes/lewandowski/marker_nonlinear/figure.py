"""Nonlinear diffusion by markers, Figs. 17 and 18, with the limit of the step and the equation's own solution."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from fracstudy.style import slope_triangle

__all__ = ["figure"]

_BLUE, _RED, _GREEN, _PINK, _ORANGE = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00"


def figure(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw (a) the profiles, (b) the step, (c) where the solution vanishes, (d) how the steady state is met."""
    figure = Figure(figsize=(8.6, 6.6), layout="constrained")
    axes = figure.subplots(2, 2)
    _profiles(axes[0, 0], series[series["panel"] == "profile"])
    _steps(axes[0, 1], series[series["panel"] == "step"], parameters)
    _lost(axes[1, 0], series[series["panel"] == "lost"])
    _approach(axes[1, 1], series[series["panel"] == "approach"])
    return figure


def _profiles(ax: Axes, series: pd.DataFrame) -> None:
    steady = series[series["series"] == "steady"]
    ax.plot(
        steady["x"],
        steady["y"],
        color="black",
        linewidth=1.2,
        label=r"steady state $f_\infty$ (24)",
    )
    looks = {
        "initial": ("^", _ORANGE, "none", 3, "markers at $t = 0$"),
        "printed": ("x", _RED, _RED, 1, r"midpoint rule, $\Delta t$ as printed"),
        "stable": ("^", _BLUE, "white", 3, "RKC2"),
    }
    for name, (marker, colour, face, every, label) in looks.items():
        part = series[series["series"] == name].sort_values("x")
        part = part[part["x"].abs() < 3.0].iloc[::every]
        when = "" if name == "initial" else rf", $t = {part['t'].iloc[0]:.3g}$"
        ax.plot(
            part["x"], part["y"], marker, color=colour, markerfacecolor=face, label=label + when,
            markersize=3.2 if name == "printed" else 4.2, markeredgewidth=0.8,
        )  # fmt: skip
    ax.set(xlabel="$x$", ylabel="$F$ at the markers", xlim=(-3.0, 3.0), ylim=(-0.1, 2.55))
    ax.legend(loc="upper left", fontsize=7.5)
    ax.set_title("(a) Figs. 17 and 18", loc="left")


def _steps(ax: Axes, series: pd.DataFrame, parameters: dict[str, Any]) -> None:
    scan = series[series["series"] == "midpoint"].sort_values("x")
    ax.plot(scan["x"], scan["y"], color=_RED, linewidth=0.9)
    for stopped, part in scan.groupby(scan["stopped"].astype(bool)):
        ax.plot(
            part["x"], part["y"], "x" if stopped else "o", color=_RED, linestyle="",
            label="midpoint rule, stopped" if stopped else "midpoint rule",
        )  # fmt: skip
    stable = series[series["series"] == "RKC2"]
    ax.plot(
        stable["x"], stable["y"], "s", color=_BLUE, markerfacecolor="white", markersize=6,
        linestyle="", label="RKC2",
    )  # fmt: skip
    limit = float(series.loc[series["series"] == "limit", "x"].iloc[0])
    printed = float(parameters["dt"])
    ax.set(xscale="log", yscale="log", ylim=(0.3 * stable["y"].min(), 4.0 * scan["y"].max()))
    for place, text, side in ((limit, r"$\eta\epsilon^2 e / D_0$", -1), (printed, "printed", -1)):
        ax.axvline(place, color="0.4", linewidth=0.9, linestyle="--")
        ax.annotate(
            text, (place, 1.0), xycoords=("data", "axes fraction"), xytext=(4 * side, -4),
            textcoords="offset points", ha="right", va="top", fontsize=8, color="0.3",
        )  # fmt: skip
    ticks = [
        t
        for t in (0.0025, 0.003, 0.004, 0.006, 0.01, 0.02)
        if 0.99 * scan["x"].min() <= t <= 1.01 * scan["x"].max()
    ]
    ax.set_xticks(ticks, [f"{t:g}" for t in ticks])
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.set_xlabel(r"time step $\Delta t$")
    ax.set_ylabel(r"max $|F - f_\infty|$ in the core / peak")
    ax.legend(loc="center left", bbox_to_anchor=(0.4, 0.5), fontsize=7.5)
    until = float(parameters["scan_until"])
    ax.set_title(f"(b) the limit of the step, $t = {until:g}$", loc="left")


def _lost(ax: Axes, series: pd.DataFrame) -> None:
    times = sorted(series.loc[series["series"] == "lines", "t"].unique())
    colours = (_GREEN, _BLUE, _PINK)
    for t, colour in zip(times, colours, strict=False):
        line = series[(series["series"] == "lines") & (series["t"] == t)]
        line = line[line["x"].between(0.9, 2.6)]
        ax.plot(line["x"], line["y"], color=colour, label=f"$t = {t:g}$")
        dots = series[(series["series"] == "markers") & (np.isclose(series["t"], t))]
        dots = dots[dots["x"].between(0.9, 2.6)]
        ax.plot(dots["x"], dots["y"], "o", color=colour, markersize=3.5, markerfacecolor="white")
    steady = series[(series["series"] == "steady") & series["x"].between(0.9, 2.6)]
    ax.plot(
        steady["x"], steady["y"], color="black", linestyle="--", linewidth=0.9, label=r"$f_\infty$"
    )
    zero = series[series["series"] == "zero"].iloc[0]
    ax.axhline(0.0, color="0.5", linewidth=0.7)
    ax.plot(zero["x"], 0.0, "v", color=_RED, markersize=6, clip_on=False)
    ax.annotate(
        f"$f = 0$ at $t = {zero['t']:.3f}$:\nno solution beyond", (zero["x"], 0.0), xytext=(-4, -7),
        textcoords="offset points", va="top", ha="center", color=_RED, fontsize=8,
    )  # fmt: skip
    ax.plot([], [], "o", color="0.3", markersize=3.5, markerfacecolor="white", label="markers")
    ax.set(xlabel="$x$", ylabel="$f$ without markers, $F$", xlim=(0.95, 2.5), ylim=(-0.045, 0.16))
    ax.legend(loc="upper right")
    ax.set_title("(c) the flank: the equation loses $f > 0$", loc="left")


def _approach(ax: Axes, series: pd.DataFrame) -> None:
    core = series[series["series"] == "core"].sort_values("x")
    excess = series[series["series"] == "excess"].sort_values("x")
    ax.plot(excess["x"], excess["y"], "s-", color=_GREEN, markersize=4)
    ax.plot(core["x"], core["y"], "o-", color=_BLUE, markersize=4)
    ax.set(xscale="log", yscale="log", xlabel="time $t$", ylabel="what is left")
    ax.set_ylim(0.6 * core["y"].min(), 2.0 * excess["y"].max())
    middle = excess.iloc[len(excess) // 2]
    ax.annotate(
        "in the flanks, less that of $f_\\infty$", (middle["x"], middle["y"]), xytext=(0, 12),
        textcoords="offset points", color=_GREEN, fontsize=8,
    )  # fmt: skip
    low = core.iloc[len(core) // 2]
    ax.annotate(
        r"max $|F - f_\infty|$ in the core", (low["x"], low["y"]), xytext=(-6, -12),
        textcoords="offset points", ha="right", va="top", color=_BLUE, fontsize=8,
    )  # fmt: skip
    last = excess.iloc[-1]
    slope_triangle(ax, 0.3 * last["x"], 0.62 * excess["y"].iloc[-2], -0.25)
    ax.set_title("(d) a power of $t$", loc="left")
