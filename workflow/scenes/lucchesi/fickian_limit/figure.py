"""The Fickian limit of the single expression (35)."""

from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import Figure, axes_row, draw, entry, legend_below, log_log, name_ticks, note

_LINES = {2: ("-", "order II"), 4: ("--", "order IV")}


def figure(series: pd.DataFrame) -> Figure:
    """Draw (a) K for alpha towards 2 and Phi, (b) the error of (35), (c) the second moment up to r."""
    figure, (kernels, errors, moments) = axes_row(3, height=3.4, width=3.1)
    *below, limit = sorted(series["alpha"].unique())
    shades = mpl.colormaps["viridis"](np.linspace(0.88, 0.25, len(below)))
    looks = zip(shades, "os^Dv" * len(below), strict=False)
    styles: dict[float, dict[str, Any]] = {
        alpha: {"color": shade, "marker": marker}
        for alpha, (shade, marker) in zip(below, looks, strict=False)
    }
    styles[limit] = {"color": "black", "marker": "*"}
    for alpha, look in styles.items():
        here = pick(series, alpha=alpha)
        draw(kernels, pick(here, panel="kernel"), color=look["color"])
        draw(moments, pick(here, panel="moment"), markersize=3.5, **look)
        for order, (line, _) in _LINES.items():
            draw(errors, pick(here, panel="error", series=order), line, markersize=3.5, **look)
    log_log(kernels, xlabel="distance $r$", xlim=(0.1, 100.0), ylim=(1e-10, 5.0))
    kernels.set_ylabel(r"kernel $K(r)$, and $\Phi(r)$ at $\alpha = 2$")
    moments.set(xscale="log", xlabel="distance $r$", ylabel=r"second moment up to $r$")
    moments.set_ylim(bottom=0.0)
    log_log(errors, xlabel="particle spacing $h$", ylabel="relative error (48)")
    shown = pick(series, panel="error")
    for order, (_, label) in _LINES.items():
        points = pick(shown, alpha=limit, series=order).sort_values("x")[["x", "y"]].to_numpy()
        if len(points) > 1:
            x, y = points[-2]
            style.slope_triangle(errors, 1.2 * x, 0.4 * y, order)
            note(errors, label, tuple(points[1]), (0, 7), ha="right", color="0.25")
    name_ticks(errors, sorted(shown["x"].unique()))
    errors.minorticks_off()
    legend_below(figure, [entry(rf"$\alpha = {a:g}$", **look) for a, look in styles.items()])
    return figure
