"""Fig. 2: exact and computed solutions of the reference case, at the peak and at the boundary."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from fracstudy.style import COLOURS, MARKERS, axes_row

__all__ = ["figure"]

_SCHEMES = ("DD", "FPSE", "KPSE", "GPSE", "FD", "DVM, M4'", "DVM, Lambda3")
_LABELS = {"DVM, M4'": "DVM, $M_4'$", "DVM, Lambda3": r"DVM, $\Lambda_3$"}


def figure(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """The two windows of the figure, and the second one with the open exterior."""
    figure, axes = axes_row(3, width=3.3, height=3.3)
    titles = ("near the peak", "at the boundary, truncated", "at the boundary, open exterior")
    panels = ((0, "truncated"), (1, "truncated"), (1, "open"))
    for letter, ax, title, (panel, exterior) in zip("abc", axes, titles, panels, strict=True):
        # In units of 1e-7 at the boundary, as the axis says.
        scale = 1.0 if panel == 0 else 1e7
        here = series[series["panel"] == panel].assign(y=lambda part, s=scale: s * part["y"])
        exact = here[here["scheme"] == "exact"]
        ax.plot(exact["x"], exact["y"], color="black", linewidth=3.5, alpha=0.25, label="exact")
        for k, scheme in enumerate(_SCHEMES):
            points = here[(here["scheme"] == scheme) & (here["exterior"] == exterior)]
            if points.empty:
                continue
            every = max(1, len(points) // 14)
            ax.plot(
                points["x"],
                points["y"],
                color=COLOURS[scheme.split(",")[0]],
                marker=MARKERS[scheme.split(",")[0]],
                markerfacecolor="white" if scheme == "DVM, Lambda3" else None,
                markevery=(k * every // len(_SCHEMES), every),
                linewidth=0.9,
                label=_LABELS.get(scheme, scheme),
            )
        ax.set_title(f"({letter}) {title}", loc="left")
        ax.set_xlabel(r"position $x$")
        if panel == 1:
            top = 3.0 * exact["y"].max()
            ax.set_ylim(0.0, top)
            ax.locator_params(axis="x", nbins=5)
    axes[0].set_ylabel(r"strength $u(x, t_f)$")
    axes[1].set_ylabel(r"$10^7\, u(x, t_f)$")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    return figure
