"""What the end of the lattice does to DPSE, and to the others."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from fracstudy.panels import pick
from fracstudy.style import axes_row, legend_below, log_log, panel_title, scheme_style

__all__ = ["figure"]

_SCALE = 1e4
_DISTANCE = r"distance from the end, $(D - x) / \epsilon$"
# FPSE lies on DPSE.
_OWN: dict[str, dict[str, Any]] = {"DPSE": {"linewidth": 4.0, "markersize": 8.0}}
_OWN["DD"] = {"linestyle": "--"}


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw (a) the solution next to the end, (b) the relative error against the distance from it."""
    figure, (end, relative) = axes_row(2, height=3.6)
    series = series.sort_values("x")
    for scheme in ("DPSE", "FPSE", "KPSE", "DD"):
        own = {"linewidth": 1.2, "markersize": 3.5, **_OWN.get(scheme, {})}
        style = scheme_style(scheme, label=scheme, **own)
        points = pick(series, series=scheme, panel="profile")
        end.plot(points["x"], _SCALE * points["y"], **style)
        points = pick(series, series=scheme, panel="relative")
        relative.plot(points["x"], points["y"], **style | {"marker": ""})
    exact = pick(series, series="KPSE", panel="profile")
    end.plot(exact["x"], _SCALE * exact["exact"], color="black", linestyle=":", label="exact")
    end.set(xlim=(15.0, -0.5), xlabel=_DISTANCE)
    end.set_ylabel(rf"solution $10^{{{np.log10(_SCALE):.0f}}} \, u(x, t_f)$")
    panel_title(end, "a", "at the end of the lattice")
    log_log(relative, xlabel=_DISTANCE)
    relative.invert_xaxis()
    relative.set_ylabel(r"$|u - u_{\mathrm{exact}}| \, / \, u_{\mathrm{exact}}$")
    panel_title(relative, "b", "relative error, from the centre to the end")
    legend_below(figure, end)
    return figure
