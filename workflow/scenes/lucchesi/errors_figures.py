"""Errors on log-log axes: against the truncation factor C and against the particle spacing h."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fracstudy.style import COLOURS, MARKERS, axes_row, slope_triangle

__all__ = ["spacing", "truncation", "truncation_overview"]

_ERROR = r"relative error $\varepsilon_{D_\varepsilon}$, Eq. (48)"
_LINES: dict[int, Any] = {2: "-", 4: "--"}


def truncation(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Figs. 3a, 4a, 5a: the paper's truncated lattice beside the open exterior."""
    figure, axes = axes_row(2, sharey=True)
    names = {"truncated": "truncated (the paper's)", "open": "open exterior (ours)"}
    for ax, exterior in zip(axes, names, strict=True):
        _lines(ax, series[series["exterior"] == exterior])
        ax.set_title(f"({'ab'[list(names).index(exterior)]}) {names[exterior]}", loc="left")
        ax.set_xlabel(r"truncation factor $C = D / (t_f^{1/\alpha} R_\alpha)$")
        ticks = sorted(series["x"].unique())
        ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        ax.minorticks_off()
    axes[0].set_ylabel(_ERROR)
    alpha = 1.0 + parameters["beta"]
    truncated = series[(series["exterior"] == "truncated") & (series["scheme"] == "GPSE")]
    low = truncated.sort_values("x").iloc[len(truncated) // 2]
    _guide(axes[0], truncated["x"], low["x"], low["y"], -alpha, r"$C^{-\alpha}$")
    _legend(figure, series)
    return figure


def spacing(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Figs. 3b, 4b, 5b: the paper's truncated lattice beside the open exterior."""
    stepped = series[series["integrator"] != "exponential"]
    figure, axes = axes_row(2, sharey=True)
    names = {"truncated": "truncated (the paper's)", "open": "open exterior (ours)"}
    for letter, ax, exterior in zip("ab", axes, names, strict=False):
        part = stepped[stepped["exterior"] == exterior]
        _lines(ax, part)
        ax.set_title(f"({letter}) {names[exterior]}", loc="left")
        ax.set_xlabel(r"particle spacing $h$")
        x = part["x"].max()
        lowest = "KPSE" if exterior == "open" else "DD"
        for scheme, order, shift in (("FPSE", 2, 3.0), (lowest, 4, 0.2)):
            points = part[(part["scheme"] == scheme) & (part["order"] == order)].sort_values("x")
            middle = points.iloc[len(points) // 2]
            slope_triangle(ax, middle["x"], shift * middle["y"], order, above=order == 2)
        ax.set_xlim(part["x"].min() / 1.3, x * 1.3)
    exact = series[series["integrator"] == "exponential"]
    for order in (2, 4):
        points = exact[exact["order"] == order].sort_values("x")
        axes[0].plot(
            points["x"],
            points["y"],
            linestyle="none",
            marker="o",
            markersize=9,
            markerfacecolor="none",
            color=COLOURS["KPSE"],
            alpha=0.6,
            label="KPSE, exact in time" if order == 2 else None,
        )
    axes[0].set_ylabel(_ERROR)
    extra = Line2D(
        [], [], linestyle="none", marker="o", markersize=9, markerfacecolor="none",
        color=COLOURS["KPSE"], alpha=0.6, label="KPSE, exact in time",
    )  # fmt: skip
    _legend(figure, stepped, [extra])
    return figure


def truncation_overview(
    series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]
) -> Figure:
    """Sec. 4.2: the truncation errors of KPSE and GPSE on the closed form, one panel a beta."""
    betas = sorted(series["beta"].unique())
    figure, axes = axes_row(len(betas), width=3.2, height=3.2, sharey=True)
    for letter, ax, beta in zip("abc", axes, betas, strict=False):
        here = series[series["beta"] == beta]
        predicted = here[(here["variable"] == "predicted") & (here["scheme"] == "GPSE")]
        predicted = predicted.sort_values("C")
        ax.plot(
            predicted["C"], predicted["value"], color="0.6", linewidth=4, solid_capstyle="round"
        )
        for scheme, order in (("KPSE", "II"), ("KPSE", "IV"), ("GPSE", "II")):
            for variable, filled in (("truncated", True), ("open", False)):
                points = here[
                    (here["scheme"] == scheme)
                    & (here["order"] == order)
                    & (here["variable"] == variable)
                ].sort_values("C")
                ax.plot(
                    points["C"],
                    points["value"],
                    color=COLOURS[scheme],
                    marker=MARKERS[scheme],
                    markerfacecolor=COLOURS[scheme] if filled else "none",
                    linestyle="--" if order == "IV" else "-",
                )
        ax.set(xscale="log", yscale="log", xlabel=r"$C$")
        ax.set_title(rf"({letter}) $\beta = {beta:g}$", loc="left")
        ticks = sorted(here["C"].unique())[::2]
        ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        ax.minorticks_off()
    axes[0].set_ylabel(_ERROR)
    figure.legend(
        handles=[
            Line2D([], [], color=COLOURS["KPSE"], marker=MARKERS["KPSE"], label="KPSE II"),
            Line2D([], [], color=COLOURS["KPSE"], marker=MARKERS["KPSE"], ls="--", label="KPSE IV"),
            Line2D([], [], color=COLOURS["GPSE"], marker=MARKERS["GPSE"], label="GPSE"),
            Line2D([], [], color="0.3", marker="o", ls="none", label="truncated"),
            Line2D(
                [], [], color="0.3", marker="o", ls="none", markerfacecolor="none",
                label="open exterior",
            ),
            Line2D([], [], color="0.6", linewidth=4, label=r"predicted, $\propto C^{-\alpha}$"),
        ],
        loc="outside lower center",
        ncols=6,
    )  # fmt: skip
    return figure


def _lines(ax: Axes, part: pd.DataFrame) -> None:
    for (scheme, order), points in part.groupby(["scheme", "order"]):
        points = points.sort_values("x")
        ax.plot(
            points["x"],
            points["y"],
            color=COLOURS[scheme],
            marker=MARKERS[scheme],
            linestyle=_LINES[order],
            markerfacecolor=COLOURS[scheme] if order == 2 else "white",
        )
    ax.set(xscale="log", yscale="log")


def _guide(ax: Axes, x: pd.Series, x0: float, y0: float, slope: float, label: str) -> None:
    """A thin line of that slope above the point (x0, y0), its label at the right end."""
    xs = np.array([x.min(), x.max()])
    ys = 4.0 * y0 * (xs / x0) ** slope
    ax.plot(xs, ys, color="0.45", linewidth=0.9, linestyle=":")
    ax.annotate(
        label,
        (xs[1], ys[1]),
        xytext=(0, 4),
        textcoords="offset points",
        ha="right",
        color="0.3",
        fontsize=8,
    )


def _legend(figure: Figure, series: pd.DataFrame, extra: list[Line2D] | None = None) -> None:
    pairs = sorted(series.groupby(["scheme", "order"]).groups)
    handles = [
        Line2D(
            [],
            [],
            color=COLOURS[scheme],
            marker=MARKERS[scheme],
            linestyle=_LINES[order],
            markerfacecolor=COLOURS[scheme] if order == 2 else "white",
            label=scheme if scheme == "GPSE" else f"{scheme} {'II' if order == 2 else 'IV'}",
        )
        for scheme, order in pairs
    ]
    handles += extra or []
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
