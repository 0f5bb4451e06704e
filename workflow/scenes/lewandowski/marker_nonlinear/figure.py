"""Nonlinear diffusion by markers, Figs. 17 and 18, with the limit of the step and the equation's own solution."""

import numpy as np
import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import BLUE, GREEN, ORANGE, PINK, RED, Axes, Figure, Look, draw, log_log, note
from scenes.lewandowski.marker_style import HOLLOW

_SMALL: Look = {"fontsize": 7.5}


def figure(series: pd.DataFrame, *, dt: float, scan_until: float) -> Figure:
    """Draw (a) the profiles, (b) the step, (c) where the solution vanishes, (d) how the steady state is met."""
    titles = [
        "Figs. 17 and 18",
        f"the limit of the step, $t = {scan_until:g}$",
        "the flank: the equation loses $f > 0$",
        "a power of $t$",
    ]
    figure, axes = style.axes_row(titles, width=4.3, height=3.3, rows=2)
    _profiles(axes[0], pick(series, panel="profile"))
    _steps(axes[1], pick(series, panel="step"), dt)
    _lost(axes[2], pick(series, panel="lost"))
    _approach(axes[3], pick(series, panel="approach"))
    return figure


def _profiles(ax: Axes, series: pd.DataFrame) -> None:
    steady = {"color": "black", "linewidth": 1.2, "label": r"steady state $f_\infty$ (24)"}
    draw(ax, pick(series, series="steady"), **steady)
    looks = {
        "initial": ("^", ORANGE, "none", 3, "markers at $t = 0$"),
        "printed": ("x", RED, RED, 1, r"midpoint rule, $\Delta t$ as printed"),
        "stable": ("^", BLUE, "white", 3, "RKC2"),
    }
    for name, (marker, colour, face, every, label) in looks.items():
        part = pick(series, series=name).sort_values("x")
        part = part[part["x"].abs() < 3.0].iloc[::every]
        when = "" if name == "initial" else rf", $t = {part['t'].iloc[0]:.3g}$"
        look = {"color": colour, "markerfacecolor": face, "markeredgewidth": 0.8}
        size = 3.2 if name == "printed" else 4.2
        draw(ax, part, marker, label=label + when, markersize=size, **look)
    ax.set(xlabel="$x$", ylabel="$F$ at the markers", xlim=(-3.0, 3.0), ylim=(-0.1, 1.75))
    ax.legend(loc="upper left", **_SMALL)


def _steps(ax: Axes, series: pd.DataFrame, printed: float) -> None:
    scan, stable = (pick(series, series=name).sort_values("x") for name in ("midpoint", "RKC2"))
    draw(ax, scan, color=RED, linewidth=0.9)
    for stopped, part in scan.groupby(scan["stopped"].astype(bool)):
        label = "midpoint rule, stopped" if stopped else "midpoint rule"
        draw(ax, part, "x" if stopped else "o", color=RED, label=label)
    draw(ax, stable, "s", color=BLUE, markerfacecolor="white", markersize=6, label="RKC2")
    limit = float(pick(series, series="limit")["x"].iloc[0])
    log_log(ax, ylim=(0.3 * stable["y"].min(), 4.0 * scan["y"].max()))
    beside = {"xycoords": ("data", "axes fraction"), "ha": "right", "va": "top", "color": "0.3"}
    for place, text in ((limit, r"$\eta\epsilon^2 e / D_0$"), (printed, "printed")):
        ax.axvline(place, color="0.4", linewidth=0.9, linestyle="--")
        note(ax, text, (place, 1.0), (-4, -4), **beside)
    style.name_ticks(ax, (0.0025, 0.003, 0.004, 0.006, 0.01), inside=True)
    ax.set(xlabel=r"time step $\Delta t$", ylabel=r"max $|F - f_\infty|$ in the core / peak")
    ax.legend(loc="center left", bbox_to_anchor=(0.4, 0.5), **_SMALL)


def _lost(ax: Axes, series: pd.DataFrame) -> None:
    zero = pick(series, series="zero").iloc[0]
    here = series[series["x"].between(0.9, 2.6)]
    lines, markers, steady = (pick(here, series=s) for s in ("lines", "markers", "steady"))
    for (t, line), colour in zip(lines.groupby("t"), (GREEN, BLUE, PINK), strict=False):
        draw(ax, line, color=colour, label=f"$t = {t:g}$")
        draw(ax, markers[np.isclose(markers["t"], t)], color=colour, **HOLLOW)
    draw(ax, steady, "--", color="black", linewidth=0.9, label=r"$f_\infty$")
    ax.axhline(0.0, color="0.5", linewidth=0.7)
    ax.plot(zero["x"], 0.0, "v", color=RED, markersize=6, clip_on=False)
    text, at = f"$f = 0$ at $t = {zero['t']:.3f}$:\nno solution beyond", (zero["x"], 0.0)
    note(ax, text, at, (-4, -7), va="top", ha="center", color=RED)
    ax.plot([], [], color="0.3", label="markers", **HOLLOW)
    ax.set(xlabel="$x$", ylabel="$f$ without markers, $F$", xlim=(0.95, 2.5), ylim=(-0.045, 0.16))
    ax.legend(loc="upper right")


def _approach(ax: Axes, series: pd.DataFrame) -> None:
    core, excess = (pick(series, series=name).sort_values("x") for name in ("core", "excess"))
    draw(ax, excess, "s-", color=GREEN, markersize=4)
    draw(ax, core, "o-", color=BLUE, markersize=4)
    log_log(ax, xlabel="time $t$", ylabel="deviation from the steady state")
    ax.set_ylim(0.6 * core["y"].min(), 2.0 * excess["y"].max())
    above, below = (part[["x", "y"]].iloc[len(part) // 2] for part in (excess, core))
    note(ax, "mass in the flanks,\nminus that of $f_\\infty$", above, (0, 12), color=GREEN)
    text, look = r"max $|F - f_\infty|$ in the core", {"ha": "right", "va": "top"}
    note(ax, text, below, (-6, -12), color=BLUE, **look)
    style.slope_triangle(ax, 0.3 * excess["x"].iloc[-1], 0.62 * excess["y"].iloc[-2], -0.25)
