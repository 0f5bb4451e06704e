"""Error in time against the time step."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fracparticles.figures.style import COLOURS, MARKERS, axes_row

__all__ = ["time_order"]

_INTEGRATORS = {"euler": ("RK1", ":", 1), "rk2": ("RK2", "-", 2), "rk4": ("RK4 (ours)", "--", 4)}


def time_order(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """One panel a beta; thin lines have the slope of the integrator's order."""
    betas = sorted(series["beta"].unique())
    figure, axes = axes_row(
        len(betas), width=4.6 if len(betas) == 1 else 3.3, height=3.6, sharey=True
    )
    for letter, ax, beta in zip("abc", axes, betas, strict=False):
        here = series[series["beta"] == beta].sort_values("x")
        for (scheme, integrator), points in here.groupby(["scheme", "integrator"]):
            ax.plot(points["x"], points["y"], **_look(scheme, integrator))
        ax.set(xscale="log", yscale="log", xlabel=r"time step $\Delta t$")
        ax.set_title(rf"({letter}) $\beta = {beta:g}$", loc="left")
        steps = np.sort(here["x"].unique())[::2]
        ax.set_xticks(steps, [f"1/{round(1.0 / dt)}" for dt in steps])
        ax.minorticks_off()
        for integrator, (_, _, order) in _INTEGRATORS.items():
            points = here[here["integrator"] == integrator]
            top = points.groupby("x")["y"].max()
            _guide(ax, top.index.to_numpy(), 2.5 * top.to_numpy(), order)
    axes[0].set_ylabel("relative error in time,\nagainst the exponential")
    handles = [
        Line2D([], [], color=COLOURS[s], marker=MARKERS[s], linestyle="none", label=s)
        for s in sorted(series["scheme"].unique())
    ] + [
        Line2D([], [], color="0.3", linestyle=style, label=name)
        for name, style, _ in _INTEGRATORS.values()
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    return figure


def _guide(ax, x: np.ndarray, y: np.ndarray, order: int) -> None:
    """A thin line of that slope above the two largest steps."""
    x, y = x[-2:], y[-1]
    ax.plot(x, y * (x / x[-1]) ** order, color="0.45", linewidth=0.8)
    ax.annotate(
        rf"$\Delta t^{order}$" if order > 1 else r"$\Delta t$",
        (np.sqrt(x[0] * x[1]), y * 2.0 ** (-0.5 * order)),
        xytext=(-3, 3),
        textcoords="offset points",
        ha="right",
        va="bottom",
        color="0.3",
        fontsize=8,
    )


def _look(scheme: str, integrator: str) -> dict[str, Any]:
    return {
        "color": COLOURS[scheme],
        "marker": MARKERS[scheme],
        "linestyle": _INTEGRATORS[integrator][1],
    }
