"""Fig. 2: exact and computed solutions of the reference case, at the peak and at the boundary."""

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from fracstudy.style import COLOURS, MARKERS, axes_row, legend_below

_SCHEMES = {
    "DD": "DD",
    "FPSE": "FPSE",
    "KPSE": "KPSE",
    "GPSE": "GPSE",
    "FD": "FD",
    "DVM, M4'": "DVM, $M_4'$",
    "DVM, Lambda3": r"DVM, $\Lambda_3$",
}
# The window, the exterior and the title of each panel.
_PANELS = (
    (0, "truncated", "near the peak"),
    (1, "truncated", "at the boundary, truncated"),
    (1, "open", "at the boundary, open exterior"),
)
_EXACT: dict[str, Any] = {"color": "black", "linewidth": 3.5, "alpha": 0.25, "label": "exact"}


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """The two windows of the figure, and the second one with the open exterior."""
    figure, axes = axes_row(3, width=3.3, height=3.3)
    # In units of 1e-7 at the boundary, as the axis says.
    series = series.assign(y=series["y"] * series["panel"].map({0: 1.0, 1: 1e7}))
    for letter, ax, (window, exterior, title) in zip("abc", axes, _PANELS, strict=True):
        here = series[series["panel"] == window]
        exact = here[here["scheme"] == "exact"]
        ax.plot(exact["x"], exact["y"], **_EXACT)
        for k, (scheme, label) in enumerate(_SCHEMES.items()):
            points = here[(here["scheme"] == scheme) & (here["exterior"] == exterior)]
            if points.empty:
                continue
            name, every = scheme.split(",")[0], max(1, len(points) // 14)
            face = "white" if scheme == "DVM, Lambda3" else COLOURS[name]
            style: dict[str, Any] = {
                "color": COLOURS[name],
                "marker": MARKERS[name],
                "markerfacecolor": face,
            }
            shift = (k * every // len(_SCHEMES), every)
            ax.plot(points["x"], points["y"], markevery=shift, linewidth=0.9, label=label, **style)
        ax.set_title(f"({letter}) {title}", loc="left")
        ax.set_xlabel(r"position $x$")
        if window == 1:
            ax.set_ylim(0.0, 3.0 * exact["y"].max())
            ax.locator_params(axis="x", nbins=5)
    axes[0].set_ylabel(r"strength $u(x, t_f)$")
    axes[1].set_ylabel(r"$10^7\, u(x, t_f)$")
    legend_below(figure, axes[0], len(_SCHEMES) + 1)
    return figure
