"""How far the mass drifts."""

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from fracstudy.style import axes_row, legend_below, log_log

_LOOK: dict[str, dict[str, Any]] = {
    "float32": {"color": "#D55E00", "marker": "s"},
    "float64, step by step": {"color": "#0072B2", "marker": "o"},
    "float64, one series": {"color": "#009E73", "marker": "^"},
    "float64, compensated": {"color": "#CC79A7", "marker": "D"},
    "eps sqrt(n)": {"color": "0.5", "linestyle": ":"},
    "eps n N": {"color": "0.5", "linestyle": "--"},
}


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw the relative drift of the mass against the number of steps, between the two laws."""
    drawn, (ax,) = axes_row(1, height=3.8, width=5.4)
    for name, look in _LOOK.items():
        points = series[series["series"] == name]
        label = {"eps sqrt(n)": "ε √n", "eps n N": "ε n N"}.get(name, name)
        ax.plot(points["x"], points["y"], label=label, **look)
    log_log(ax, xlabel="number of steps, n", ylabel="relative drift of the mass")
    legend_below(drawn, ax, columns=3)
    return drawn
