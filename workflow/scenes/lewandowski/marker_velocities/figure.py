"""Burgers, Korteweg-de Vries and a source by one marker solver."""

from typing import Any

import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import Axes, Figure, Look, axes_row, draw, legend_below, log_log, note
from scenes.lewandowski.marker_style import HOLLOW

_DOTTED: Look = {"linestyle": (0, (1, 1.5)), "linewidth": 2.6}
_PROFILES: dict[str, tuple[str, Look]] = {
    "initial": ("$f_0$", {"color": "0.55", "linestyle": ":"}),
    "exact": ("exact", {"color": "black"}),
    "in the velocity": ("source in the velocity", {"color": style.RED, "linestyle": "--"}),
    "in the weights": ("source in the weights", {"color": style.BLUE, **_DOTTED}),
}


def figure(series: pd.DataFrame, *, burgers: dict[str, Any], source: dict[str, Any]) -> Figure:
    """Draw (a) Burgers' equation, (b) a soliton, (c) a source, (d) the errors."""
    profile, t = rf"{source['q']['0']:g}\,\exp(-x^2)", source["t_final"]
    titles = [
        f"Burgers, $R = {burgers['shown']:g}$; lines: Cole-Hopf",
        "KdV: a soliton on a background",
        rf"source $Q = {profile}$, $t = {t:g}$",
        "errors",
    ]
    figure, axes = axes_row(titles, width=4.3, height=3.4, rows=2)
    _burgers(axes[0], pick(series, panel="burgers"))
    _kdv(axes[1], pick(series, panel="kdv"))
    _source(axes[2], pick(series, panel="source 0"))
    _errors(axes[3], pick(series, panel="errors"))
    legend_below(figure, axes[3], columns=2)
    return figure


def _burgers(ax: Axes, series: pd.DataFrame) -> None:
    colours = (style.ORANGE, style.GREEN, style.BLUE)
    for (t, part), colour in zip(series.groupby("t"), colours, strict=False):
        exact, dots = pick(part, series="exact"), pick(part, series="markers").sort_values("x")
        draw(ax, exact, color="black", linewidth=0.9)
        draw(ax, dots.iloc[:: max(1, len(dots) // 40)], color=colour, **HOLLOW)
        note(ax, f"$t = {t:g}$", _peak(exact), (6, 2), color=colour)
    ax.set(xlim=(-1.5, 4.0), ylim=(0.0, 1.12 * series["y"].max()))
    ax.set(xlabel="$x$", ylabel="$F$ at the markers")


def _kdv(ax: Axes, series: pd.DataFrame) -> None:
    exact = pick(series, series="exact")
    for (t, part), line in zip(exact.groupby("t"), ("--", "-"), strict=True):
        draw(ax, part, line, color="black", linewidth=0.9)
        note(ax, f"$t = {t:g}$", _peak(part), (0, 4), ha="center")
    dots = pick(series, series="markers").sort_values("x")
    draw(ax, dots.iloc[:: max(1, len(dots) // 80)], color=style.BLUE, **HOLLOW)
    ax.set(xlabel="$x$", ylabel="$F$ at the markers", ylim=(0.0, 1.15 * series["y"].max()))


def _peak(curve: pd.DataFrame) -> tuple[float, float]:
    x, y = curve.loc[curve["y"].idxmax(), ["x", "y"]]
    return x, y


def _source(ax: Axes, series: pd.DataFrame) -> None:
    for name, (label, look) in _PROFILES.items():
        draw(ax, pick(series, series=name), label=label, **{"linewidth": 1.2, **look})
    ax.set(xlabel="$x$", ylabel="$F$", ylim=(0.0, 1.5 * series["y"].max()))
    ax.legend(loc="upper left", ncols=2)


def _errors(ax: Axes, series: pd.DataFrame) -> None:
    colours = iter((style.ORANGE, style.GREEN, style.PINK, style.SKY))
    for name, part in series.groupby("series", sort=False):
        if name.startswith("a source"):
            colour = style.RED if "velocity" in name else style.BLUE
            marker, line = ("^", "--") if "without" in name else ("s", "-")
            total, way = name.removeprefix("a source ").split(", ")
            label = f"source, {total.replace(' a', '').replace('without', 'no')}, {way}"
        else:
            soliton = name.startswith("KdV")
            colour, label = next(colours), rf"{name}, three $\epsilon$" if soliton else name
            marker, line = ("D", "") if soliton else ("o", "-")
        draw(ax, part, color=colour, marker=marker, linestyle=line, label=label)
    log_log(ax, xlabel="number of markers $N$", ylabel="relative $L^1$ error")
    style.name_ticks(ax, sorted(series.loc[~series["series"].str.startswith("KdV"), "x"].unique()))
    style.slope_triangle(ax, 140.0, 0.75 * series["y"].min(), -1.0)
