"""The Fickian limit of the single expression (35)."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fracstudy.style import axes_row, slope_triangle

__all__ = ["figure"]

_MARKERS = ("o", "s", "^", "D", "v")
_LINES = {2: "-", 4: "--"}


def figure(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw (a) K for alpha towards 2 and Phi, (b) the error of (35), (c) the second moment up to r."""
    figure, (kernels, errors, moments) = axes_row(3, height=3.4, width=3.1)
    alphas = sorted(series["alpha"].unique())
    shades = mpl.colormaps["viridis"](np.linspace(0.88, 0.25, len(alphas) - 1))
    styles = {
        alpha: {"color": shade, "marker": marker}
        for alpha, shade, marker in zip(alphas[:-1], shades, _MARKERS, strict=False)
    }
    styles[alphas[-1]] = {"color": "black", "marker": "*"}

    for alpha, curve in series[series["panel"] == "kernel"].groupby("alpha"):
        kernels.plot(curve["x"], curve["y"], color=styles[alpha]["color"])
    kernels.set(xscale="log", yscale="log", xlim=(0.1, 100.0), ylim=(1e-10, 5.0))
    kernels.set(xlabel="distance $r$", ylabel=r"kernel $K(r)$, and $\Phi(r)$ at $\alpha = 2$")

    shown = series[series["panel"] == "error"]
    for (alpha, order), curve in shown.groupby(["alpha", "order"]):
        errors.plot(curve["x"], curve["y"], _LINES[order], markersize=3.5, **styles[alpha])
    errors.set(
        xscale="log", yscale="log", xlabel="particle spacing $h$", ylabel="relative error (48)"
    )
    limit = shown[shown["alpha"] == alphas[-1]].sort_values("x")
    for order, label in ((2, "order II"), (4, "order IV")):
        curve = limit[limit["order"] == order]
        x, y = curve["x"].to_numpy(), curve["y"].to_numpy()
        slope_triangle(errors, 1.2 * x[-2], 0.4 * y[-2], order)
        errors.annotate(
            label, (x[1], y[1]), xytext=(0, 7), textcoords="offset points", ha="right",
            color="0.25", fontsize=8,
        )  # fmt: skip
    ticks = sorted(shown["x"].unique())
    errors.set_xticks(ticks, [f"{h:g}" for h in ticks])
    errors.minorticks_off()

    for alpha, curve in series[series["panel"] == "moment"].groupby("alpha"):
        moments.plot(curve["x"], curve["y"], markersize=3.5, **styles[alpha])
    moments.set(xscale="log", ylim=(0.0, None))
    moments.set(xlabel="distance $r$", ylabel=r"second moment up to $r$")

    entries = [
        Line2D([], [], label=rf"$\alpha = {alpha:g}$", **style) for alpha, style in styles.items()
    ]
    figure.legend(handles=entries, loc="outside lower center", ncols=len(entries))
    return figure
