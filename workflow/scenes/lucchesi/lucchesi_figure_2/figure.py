"""Fig. 2: exact and computed solutions of the reference case, at the peak and at the boundary."""

import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import UNDERLAID, Figure, axes_row, draw, legend_below, scheme_style

_SCHEMES = {
    "DD": "DD",
    "FPSE": "FPSE",
    "KPSE": "KPSE",
    "GPSE": "GPSE",
    "FD": "FD",
    "DVM, M4'": "DVM, $M_4'$",
    "DVM, Lambda3": r"DVM, $\Lambda_3$",
}
# The window and the exterior of each panel, by its title.
_PANELS = {
    "near the peak": (0, "truncated"),
    "at the boundary, truncated": (1, "truncated"),
    "at the boundary, open exterior": (1, "open"),
}


def figure(series: pd.DataFrame) -> Figure:
    """The two windows of the figure, and the second one with the open exterior."""
    figure, axes = axes_row(list(_PANELS), width=3.3, height=3.3)
    # In units of 1e-7 at the boundary, as the axis says.
    series = series.assign(y=series["y"] * series["panel"].map({0: 1.0, 1: 1e7}))
    for ax, (window, exterior) in zip(axes, _PANELS.values(), strict=True):
        here = pick(series, panel=window)
        exact = pick(here, scheme="exact")
        draw(ax, exact, label="exact", **UNDERLAID)
        for k, (scheme, label) in enumerate(_SCHEMES.items()):
            points = pick(here, scheme=scheme, exterior=exterior)
            if points.empty:
                continue
            every = max(1, len(points) // 14)
            look = scheme_style(scheme.split(",")[0], 4 if scheme == "DVM, Lambda3" else 2)
            look |= {"markevery": (k * every // len(_SCHEMES), every), "linestyle": "-"}
            draw(ax, points, linewidth=0.9, label=label, **look)
        ax.set_xlabel(r"position $x$")
        if window == 1:
            ax.set_ylim(0.0, 3.0 * exact["y"].max())
            ax.locator_params(axis="x", nbins=5)
    axes[0].set_ylabel(r"strength $u(x, t_f)$")
    axes[1].set_ylabel(r"$10^7\, u(x, t_f)$")
    legend_below(figure, axes[0], len(_SCHEMES) + 1)
    return figure
