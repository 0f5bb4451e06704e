"""Errors of the forms on the line and in the plane, and the two equations."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fracstudy.panels import pick
from fracstudy.style import (
    COLOURS,
    MARKERS,
    axes_row,
    entry,
    guide,
    legend_below,
    log_log,
    name_ticks,
    note,
    panel_title,
    slope_triangle,
)

_SCHEMES = {"FPSE": "FPSE", "DD": "DD", "exchange": "KPSE"}


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw (a), (b) errors on the line and in the plane, (c) right-hand sides, (d) the distance of the equations."""
    drawn, axes = axes_row(4, height=3.9, width=3.4)
    for ax, letter, panel in zip(axes, "ab", ("line", "plane"), strict=False):
        _errors(ax, pick(series, panel=panel))
        panel_title(ax, letter, f"error, {panel}")
    axes[0].set_ylabel("error of $du/dt$ / its largest value")
    _right_hand_sides(axes[2], pick(series, panel="right-hand side"))
    _gap(axes[3], pick(series, panel="gap"))
    flux, mean = _FORMS
    legend_below(
        drawn,
        [entry(name, color=COLOURS[s], marker=MARKERS[s]) for name, s in _SCHEMES.items()]
        + [flux, mean],
        columns=5,
    )
    return drawn


_FORMS = (
    entry(r"$\mathrm{div}(D\,\mathrm{grad}^\beta u)$", color="0.2", marker=""),
    entry(
        r"$(D\,Lu + L(Du) - u\,LD)/2$, limit of the exchange",
        color="0.2",
        marker="",
        linestyle=":",
    ),
)


def _errors(ax: Axes, part: pd.DataFrame) -> None:
    for (form, equation, order), points in part.groupby(
        ["series", "equation", "order"], sort=False
    ):
        scheme = _SCHEMES[str(form)]
        style: dict[str, Any] = {"color": COLOURS[scheme], "marker": MARKERS[scheme]}
        dotted = form == "exchange" and not str(equation).startswith("div")
        ax.plot(points["x"], points["y"], linestyle=":" if dotted else "-", markersize=4.0, **style)
        if form == "FPSE":
            _slope(ax, points.sort_values("x"), float(order))
    ticks = sorted(part["x"].unique())
    log_log(ax, xlabel="particle spacing $h$", xlim=(0.6 * ticks[0], 1.3 * ticks[-1]))
    name_ticks(ax, ticks)


def _slope(ax: Axes, points: pd.DataFrame, order: float) -> None:
    """A triangle above the finest piece of a curve, if it is the steepest."""
    h, error = points["x"].to_numpy(), points["y"].to_numpy()
    slopes = np.diff(np.log(error)) / np.diff(np.log(h))
    if slopes.size and slopes.argmax() == 0:
        slope_triangle(ax, h[0], 1.8 * error[0], order, above=True)
    elif slopes.size:  # it ends at round-off
        note(ax, f"order {order:g}", (h[1], error[1]), (9, -3), ha="left")


def _right_hand_sides(ax: Axes, part: pd.DataFrame) -> None:
    for (name, points), line in zip(
        part.groupby("series", sort=False), ("-", ":", ""), strict=True
    ):
        exchange = name == "exchange"
        colour = COLOURS["KPSE"] if exchange else "0.2"
        marker = MARKERS["KPSE"] if exchange else ""
        ax.plot(
            points["x"], points["y"], linestyle=line, color=colour, marker=marker, markersize=3.5
        )
    ax.set(xlabel="position $x$", ylabel="$du/dt$", xlim=(-4.0, 4.0))
    panel_title(ax, "c", r"the two equations")


def _gap(ax: Axes, part: pd.DataFrame) -> None:
    ax.plot(part["x"], part["y"], color="0.2")
    end = part.iloc[-1]
    guide(ax, list(part["x"]), (end["x"], 0.5 * end["y"]), 1.0)
    log_log(ax, xlabel=r"$2 - \alpha$", ylabel="largest relative distance")
    panel_title(ax, "d", "distance between the two")
