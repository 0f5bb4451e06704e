"""Run time and memory against the number of particles."""

from collections.abc import Callable
from itertools import zip_longest
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.lines import Line2D

from fracstudy import style
from fracstudy.inputs import NUMERALS
from fracstudy.panels import pick
from fracstudy.style import Axes, Figure

_SHAPES = {1: "lines", 2: "squares", 3: "cubes"}
# The truncated points are hollow and larger, so that an open one that agrees fills it.
_FACES: dict[str, dict[str, Any]] = {
    "truncated": {"markersize": 7.0, "markerfacecolor": "none"},
    "open": {"markersize": 3.6},
}
_GREY = "0.35"
_SMALL = {"color": _GREY, "fontsize": 7.5}
_DASHES = (0, (4, 3))
_WAYS: dict[str, Any] = {
    "by FFT, one core": "-",
    "over all pairs, one core": ":",
    "extrapolated": _DASHES,
}
_MINUTE, _HOUR, _YEAR = 60.0, 3600.0, 365.25 * 86400.0  # seconds


def figure(series: pd.DataFrame) -> Figure:
    """Draw (a) the time of one application and (b) the peak memory, a column a dimension."""
    dims = sorted(series["dim"].unique())
    figure = Figure(figsize=(max(3.2 * len(dims), 4.6), 6.6), layout="constrained")
    axes = figure.subplots(2, len(dims), sharex=True, sharey="row", squeeze=False)
    for (above, below), dim in zip(axes.T, dims, strict=True):
        _application(above, pick(series, dim=dim, panel="application"))
        _memory(below, pick(series, dim=dim, panel="memory"))
        above.set_title(_SHAPES[dim])
        below.set_xlabel("number of particles $N$")
    for letter, ax in zip("ab", axes[:, 0], strict=True):
        ax.set_title(f"({letter})", loc="left")
    axes[0, 0].set_ylabel("time of one application / s")
    axes[1, 0].set_ylabel("peak memory of the process / byte")
    handles = _handles(series)
    style.legend_below(figure, handles, columns=len(handles) // 2)
    style.note_below(figure, series["note"].iloc[0])
    return figure


def _application(ax: Axes, points: pd.DataFrame) -> None:
    style.log_log(ax)
    for way, line in (("fast", "-"), ("naive", ":")):
        some = pick(points, series=way)
        if some.empty:
            continue
        _curves(ax, some, line)
        _name_end(ax, some, _durations)
        measured = some[~some["extrapolated"]]
        middle = measured[measured["x"] <= np.sqrt(measured["x"].min() * measured["x"].max())]
        corner = middle.loc[middle["x"].idxmax()]
        if way == "fast":
            style.slope_triangle(ax, corner["x"], 0.2 * corner["y"], 1.0)
        else:
            style.slope_triangle(ax, corner["x"], 4.0 * corner["y"], 2.0, above=True)


def _memory(ax: Axes, points: pd.DataFrame) -> None:
    style.log_log(ax)
    peak = pick(points, series="peak")
    _curves(ax, peak, "-")
    _name_end(ax, peak, _gigabytes)
    machine = points.loc[points["series"] == "machine", "y"].max()
    if len(peak) and np.isfinite(machine):
        ax.axhline(machine, color=_GREY, linewidth=0.8, linestyle="-.")
        text = f"memory of the machine, {machine / 2**30:.2g} GiB"
        style.note(ax, text, (peak["x"].min(), machine), (0, 3), **_SMALL)


def _curves(ax: Axes, points: pd.DataFrame, line: str) -> None:
    """What was measured, and a dashed line to what is extrapolated."""
    for kind, curve in points.groupby("kind", sort=False):
        curve = curve.sort_values("x")
        look = _look(kind, linestyle=line)
        style.draw(ax, curve[~curve["extrapolated"]], **look)
        style.draw(ax, curve.iloc[-2:], color=look["color"], linewidth=0.9, linestyle=_DASHES)


def _name_end(ax: Axes, points: pd.DataFrame, text: Callable[[float, float], str]) -> None:
    """Write the least and the greatest extrapolated value at their end."""
    x, y = points[points["extrapolated"]][["x", "y"]].to_numpy().T
    if y.size:
        style.note(ax, text(y.min(), y.max()), (x.max(), y.max()), (0, 5), ha="right", **_SMALL)


def _durations(least: float, greatest: float) -> str:
    for unit, name in ((_YEAR, "years"), (_HOUR, "h"), (_MINUTE, "min")):
        if greatest >= 1.5 * unit:
            return _range(least / unit, greatest / unit, name)
    return _range(least, greatest, "s")


def _gigabytes(least: float, greatest: float) -> str:
    return _range(1e-9 * least, 1e-9 * greatest, "GB")


def _range(least: float, greatest: float, unit: str) -> str:
    low, high = (f"{value:.{3 if value >= 99.5 else 2}g}" for value in (least, greatest))
    return f"{low} {unit}" if low == high else f"{low} to {high} {unit}"


def _look(kind: str, **more: Any) -> dict[str, Any]:
    scheme, _, exterior = kind.split("-")
    return style.scheme_style(scheme, **{**_FACES[exterior], **more})


def _handles(series: pd.DataFrame) -> list[Line2D]:
    """Kinds in the upper row, ways in the lower: a legend is filled column by column."""
    kinds = []
    for kind in series["kind"].unique():
        scheme, order, exterior = kind.split("-")
        name = f"{scheme} {NUMERALS[int(order)]}, {exterior}"
        kinds.append(style.entry(name, **_look(kind, linestyle="none")))
    ways = [style.entry(name, color=_GREY, linestyle=line) for name, line in _WAYS.items()]
    blank = style.entry(" ", linestyle="none")
    return [handle for column in zip_longest(kinds, ways, fillvalue=blank) for handle in column]
