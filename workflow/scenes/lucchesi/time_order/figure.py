"""Error in time against the time step."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fracstudy.style import COLOURS, MARKERS, axes_row, slope_triangle

__all__ = ["figure"]

_SIZES = {"DD": 8.0, "FPSE": 5.5, "KPSE": 3.5}
_INTEGRATORS: dict[str, tuple[str, Any, int]] = {
    "euler": ("RK1", ":", 1),
    "rk2": ("RK2", "-", 2),
    "rk4": ("RK4 (ours)", "--", 4),
}


def figure(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """One panel a beta. The schemes lie on each other: hollow markers of three sizes."""
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
            lowest = here[here["integrator"] == integrator].groupby("x")["y"].min()
            middle = len(lowest) // 2
            slope_triangle(ax, lowest.index[middle], 0.3 * lowest.iloc[middle], float(order))
    axes[0].set_ylabel("relative error in time,\nagainst the exponential")
    handles = [
        Line2D([], [], **{**_look(s, "euler"), "linestyle": "none"}, label=s)
        for s in sorted(series["scheme"].unique())
    ] + [
        Line2D([], [], color="0.3", linestyle=style, label=name)
        for name, style, _ in _INTEGRATORS.values()
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    return figure


def _look(scheme: str, integrator: str) -> dict[str, Any]:
    return {
        "color": COLOURS[scheme],
        "marker": MARKERS[scheme],
        "markersize": _SIZES[scheme],
        "markerfacecolor": "none",
        "linestyle": _INTEGRATORS[integrator][1],
    }
