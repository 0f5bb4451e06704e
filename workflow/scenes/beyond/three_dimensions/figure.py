"""Errors on a cube, against h and against the work."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fracstudy.style import COLOURS, MARKERS, axes_row, slope_triangle

__all__ = ["figure"]

_NAMES = {2: "II", 4: "IV"}
# The truncated points are hollow and larger, so that an open one that agrees fills it.
_FACES = {"truncated": (7.0, "none"), "open": (3.6, None)}


def figure(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw (a) the error against h, (b) the error against the floating-point operations of the run."""
    figure, (against_h, against_work) = axes_row(2, height=4.6, width=4.4, sharey=True)
    # GPSE with the open exterior has errors so small that the rest would be crowded: they are named instead.
    small = (series["scheme"] == "GPSE") & (series["exterior"] == "open")
    shown = series[~small]
    for ax, x in ((against_h, "h"), (against_work, "work")):
        _lines(ax, shown, x)
        ax.set(xscale="log", yscale="log")
        ax.set_ylim(0.05 * shown["error"].min(), 2.5 * shown["error"].max())
        _name_below(ax, series[small], x)
    _sizes(against_h, series)
    for scheme, order, exterior, shift in (
        ("FPSE", 2, "truncated", 1.9),
        ("KPSE", 4, "open", 0.45),
    ):
        points = _select(series, scheme, order, exterior).sort_values("h")
        if len(points) > 1:
            h, error = points.iloc[0][["h", "error"]]
            slope_triangle(against_h, h, shift * error, order, above=order == 2)
    against_h.set_ylabel(r"relative error in the ball $|x| \leq 5$, Eq. (59)")
    against_work.set_xlabel("floating-point operations of the run")
    figure.legend(handles=_handles(series), loc="outside lower center", ncols=5)
    return figure


def _lines(ax: Axes, series: pd.DataFrame, x: str) -> None:
    for (scheme, order, exterior), points in _groups(series):
        points = points.sort_values("h")
        ax.plot(points[x], points["error"], **_look(scheme, order, exterior))


def _name_below(ax: Axes, points: pd.DataFrame, x: str) -> None:
    """Write errors below the axes at their places, each with an arrow down."""
    at_bottom = ("data", "axes fraction")
    for place, error in zip(points[x], points["error"], strict=True):
        ax.annotate(
            _scientific(error),
            (place, 0.0),
            xycoords=at_bottom,
            xytext=(place, 0.07),
            textcoords=at_bottom,
            ha="center",
            fontsize=7.5,
            color=COLOURS["GPSE"],
            arrowprops={"arrowstyle": "-|>", "color": COLOURS["GPSE"], "shrinkB": 0.0},
        )
    if len(points):
        middle = (points[x].min() * points[x].max()) ** 0.5
        ax.annotate(
            "GPSE, open", (middle, 0.13), xycoords=at_bottom, ha="center", fontsize=7.5,
            color=COLOURS["GPSE"],
        )  # fmt: skip


def _sizes(ax: Axes, series: pd.DataFrame) -> None:
    """Name the spacings by the particles in each direction."""
    ticks = series.groupby("N")["h"].first()
    ax.set_xticks(ticks, [f"{h:.2g}\n{n}³" for n, h in ticks.items()])
    ax.minorticks_off()
    ax.set_xlim(0.8 * ticks.min(), 1.25 * ticks.max())
    ax.set_xlabel("particle spacing $h$, and number of particles")


def _select(series: pd.DataFrame, scheme: str, order: int, exterior: str) -> pd.DataFrame:
    return series[
        (series["scheme"] == scheme) & (series["order"] == order) & (series["exterior"] == exterior)
    ]


def _groups(series: pd.DataFrame) -> Iterable[tuple[Any, pd.DataFrame]]:
    return series.groupby(["scheme", "order", "exterior"])


def _look(scheme: str, order: int, exterior: str) -> dict[str, Any]:
    size, face = _FACES[exterior]
    return {
        "color": COLOURS[scheme],
        "marker": MARKERS[scheme],
        "markersize": size,
        "markerfacecolor": face or COLOURS[scheme],
        "linestyle": "-" if order == 2 else "--",
    }


def _handles(series: pd.DataFrame) -> list[Line2D]:
    handles = []
    groups = series.groupby(["scheme", "order"]).groups
    for scheme, order in sorted(groups, key=lambda group: (group[0] == "GPSE", group)):
        name = scheme if scheme == "GPSE" else f"{scheme} {_NAMES[order]}"
        look = {**_look(scheme, order, "open"), "markersize": 4.5}
        handles.append(Line2D([], [], **look, label=name))
    if len(handles) % 2:
        handles.append(Line2D([], [], linestyle="none", label=" "))  # columns of two
    for exterior, name in (("truncated", "truncated"), ("open", "open exterior")):
        size, face = _FACES[exterior]
        handles.append(
            Line2D(
                [], [], color="0.3", marker="o", linestyle="none", markersize=size,
                markerfacecolor=face or "0.3", label=name,
            )
        )  # fmt: skip
    return handles


def _scientific(value: float) -> str:
    mantissa, exponent = f"{value:.0e}".split("e")
    return rf"${mantissa} \cdot 10^{{{int(exponent)}}}$"
