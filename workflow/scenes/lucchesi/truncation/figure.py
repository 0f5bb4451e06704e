"""Figs. 3a, 4a, 5a: error (48) against the truncation factor C."""

import pandas as pd

from fracstudy.style import Figure, guide, name_ticks, scheme_legend
from scenes.lucchesi.exteriors import exterior_panels


def figure(series: pd.DataFrame) -> Figure:
    """Draw the errors; a dotted guide falls like C^-alpha."""
    figure, axes = exterior_panels(series)
    for ax in axes:
        ax.set_xlabel(r"truncation factor $C = D / (t_f^{1/\alpha} R_\alpha)$")
        name_ticks(ax, sorted(series["x"].unique()))
    # Above GPSE, whose step has no other error; without it, above the largest of the others.
    truncated = series[series["exterior"] == "truncated"].sort_values("x")
    gpse = truncated[truncated["scheme"] == "GPSE"]
    points = truncated.loc[truncated.groupby("x")["y"].idxmax()] if gpse.empty else gpse
    middle = points.iloc[len(points) // 2]
    through = (middle["x"], 4.0 * middle["y"])
    guide(axes[0], points["x"], through, -(1.0 + middle["beta"]), r"$C^{-\alpha}$")
    axes[0].set_ylim(top=30.0 * points["y"].max())  # room for its label
    scheme_legend(figure, series)
    return figure
