"""Flux and rates along y = 0 on the printed lattices, and how fast they converge."""

from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import Axes, Figure, axes_row, scheme_style, slope_triangle
from scenes.plane import spacing_axes

_RATE = r"$\Delta^\alpha u(r, t = {time:g})$"
# Panel, by quantity: its title, what is on the axis, the colours, and the place of the legend.
_PANELS: dict[str, tuple[str, str, str, Any]] = {
    "flux": ("radial flux, FPSE (19)", r"$Q_r^\beta(r, t = {time:g})$", "Oranges", "upper right"),
    "DD": ("diffusion rate, DD", _RATE, "Blues", "lower right"),
    "FPSE": ("diffusion rate, FPSE", _RATE, "Oranges", "lower right"),
}
# In the order of the table.
_ERRORS = (scheme_style("FPSE", 4, marker="v"), scheme_style("DD"), scheme_style("FPSE"))


def figure(
    series: pd.DataFrame, table: pd.DataFrame, *, time: float, particles: list[int], reach: float
) -> Figure:
    """Draw (a) the flux, (b), (c) the rate of DD and FPSE on the printed lattices, (d) their errors."""
    titles = [*(title for title, *_ in _PANELS.values()), "convergence"]
    figure, panels = axes_row(titles, width=4.3, height=3.3, rows=2)
    inside = series[series["r"] <= reach]
    for ax, (name, (_, label, palette, place)) in zip(panels, _PANELS.items(), strict=False):
        here = pick(inside, quantity=name)
        fine = pick(here, N=here["N"].max())
        ax.plot(fine["r"], fine["exact"], color="black", linewidth=1.0, label="exact")
        shades = mpl.colormaps[palette](np.linspace(0.4, 0.95, len(particles)))
        for count, colour, marker in zip(particles, shades, "^so", strict=False):
            part = pick(here, N=count)
            look = {"color": colour, "marker": marker, "markersize": 4, "linewidth": 0.9}
            look["markevery"] = max(1, len(part) // 14)
            ax.plot(part["r"], part["y"], label=f"$N = {count}$", **look)
        ax.set(xlabel="distance $r$ from the origin, $y = 0$", xlim=(0.0, reach))
        ax.set_ylabel(label.replace("{time:g}", f"{time:g}"))
        ax.legend(loc=place)
    _errors(panels[3], table)
    return figure


def _errors(ax: Axes, table: pd.DataFrame) -> None:
    column = next(name for name in table if name.startswith("largest error"))
    for (name, part), style in zip(table.groupby("quantity", sort=False), _ERRORS, strict=True):
        ax.plot(part["h"], part[column], label=name, **style)
    spacing_axes(ax, table["h"])
    ax.set_ylabel(r"largest error / largest value, $r \leq 5$")
    lowest = table.groupby("h")[column].min()
    slope_triangle(ax, 1.3 * lowest.index[0], 0.75 * lowest.iloc[0], 2.0)
    ax.legend(loc="upper left", fontsize=7.5)
