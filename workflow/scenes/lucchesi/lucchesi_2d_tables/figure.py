"""The errors of DD and FPSE with exact kernels and with kernels from tables."""

import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import COLOURS, Figure, axes_row, scheme_style, slope_triangle
from scenes.plane import spacing_axes

_LEGENDS = {"DD": "lower right", "FPSE": "upper left"}


def figure(series: pd.DataFrame) -> Figure:
    """Draw a panel for each scheme, with a line for each step of the table."""
    figure, axes = axes_row(list(_LEGENDS), height=3.9, sharey=True)
    series, last = series.sort_values("h"), series["step"].max()
    for ax, (scheme, place) in zip(axes, _LEGENDS.items(), strict=True):
        here = pick(series, scheme=scheme)
        for (step, part), line in zip(here.groupby("step"), ("-", "--", ":"), strict=False):
            label = rf"table, step {step:g} $\epsilon$" if step else "exact kernels"
            face = "white" if step else COLOURS[scheme]
            style = scheme_style(scheme, linestyle=line, markerfacecolor=face)
            ax.plot(part["h"], part["y"], label=label, **style)
        part = pick(here, step=last).dropna(subset=["spurious"])
        if len(part):
            label = f"decay by the table of step {last:g}"
            ax.plot(part["h"], part["spurious"], color="0.45", linewidth=0.9, label=label)
        spacing_axes(ax, here["h"])
        ax.legend(**{"loc": place, "fontsize": 7.5})
    axes[0].set_ylabel(r"relative error $\varepsilon_{D_\varepsilon}$, Eq. (59)")
    exact = pick(series, scheme="FPSE", step=0.0).iloc[0]
    slope_triangle(axes[1], 1.2 * exact["h"], 0.45 * exact["y"], 2.0)
    return figure
