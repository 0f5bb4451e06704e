"""Relative errors against the distance to the ends of alpha."""

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from fracstudy.style import axes_row, guide, legend_below, log_log, panel_title

_EVOLVE = "evolve, against Cauchy or Gauss"
_LINES: dict[str, dict[str, Any]] = {
    "limit": {"color": "0.45", "linestyle": "--", "label": r"Cauchy or Gauss instead of $\alpha$"},
    "evolve": {"color": "#D55E00", "marker": "s", "markersize": 4.0, "label": _EVOLVE},
    "density": {"color": "#0072B2", "marker": "o", "markersize": 4.0, "label": "density"},
    "rate": {"color": "#56B4E9", "marker": "v", "markersize": 4.0, "label": "rate of change"},
    "tail mass": {"color": "#009E73", "marker": "^", "markersize": 4.0, "label": "tail mass"},
    "K": {"color": "#CC79A7", "marker": "D", "markersize": 3.5, "label": "kernel $K$"},
    "G": {"color": "#E69F00", "marker": "P", "markersize": 4.5, "label": "kernel $G$"},
    "kappa": {"color": "#000000", "marker": "x", "markersize": 4.5, "label": r"potential $\kappa$"},
}


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """(a) alpha to 1, (b) alpha to 2: what the limits would leave, and what the functions leave."""
    drawn, axes = axes_row(2, height=3.8, sharey=True)
    for ax, panel, letter, end in zip(axes, ("one", "two"), "ab", (1, 2), strict=True):
        points = dict(tuple(series[series["panel"] == panel].groupby("series")))
        for name, line in _LINES.items():
            if name in points:
                ax.plot(points[name]["x"], points[name]["y"], **line)
        log_log(ax, xlabel=rf"distance to the end, $|\alpha - {end}|$")
        panel_title(ax, letter, rf"$\alpha \to {end}$")
    axes[0].set_ylabel("relative error")
    guide(axes[1], (1e-15, 1e-3), (1e-15, 3e-16), 1.0, "slope 1")
    legend_below(drawn, axes[0], columns=4)
    return drawn
