"""Loading in the plane: the markers of three loadings, and their errors."""

from typing import Any

import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import BLUE, ORANGE, RED, Figure, Look, axes_row, draw
from scenes.lewandowski.marker_style import EXACT

_LOOKS = {
    "decoupled": (RED, "o"),
    "decoupled, weighted": (ORANGE, "s"),
    "x first, then y": (BLUE, "^"),
}
_GREYS: Look = {
    "levels": [0.02, 0.1, 0.3, 0.6, 0.9, 1.2],
    "colors": ["0.95", "0.88", "0.8", "0.72", "0.64"],
}


def figure(series: pd.DataFrame, *, shown: dict[str, Any]) -> Figure:
    """Draw the markers of each loading on the density, and the errors against a."""
    figure, axes = axes_row([*_LOOKS, "errors"], height=3.1, width=2.75)
    density = pick(series, panel="density").pivot(index="y", columns="x", values="z")
    reach = shown["a"] + 2.4
    for ax, (name, (colour, _)) in zip(axes, _LOOKS.items(), strict=False):
        ax.contourf(density.columns, density.index, density, **_GREYS)
        part = pick(series, panel=name)
        ax.scatter(part["x"], part["y"], s=9.0 * part["z"], color=colour, linewidths=0.0)
        ax.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", xlabel="$x$")
        ax.grid(False)
    axes[0].set_ylabel("$y$")
    errors, ax = pick(series, panel="errors"), axes[3]
    draw(ax, pick(errors, series="exact"), **{**EXACT, "label": "$f$ and the product"})
    for name, (colour, marker) in _LOOKS.items():
        style = {"color": colour, "markerfacecolor": "white", "label": name}
        draw(ax, pick(errors, series=name), marker, **style)
    ax.set(xlabel="half the distance of the blobs, $a$", ylim=(0.0, 1.1))
    ax.set(ylabel="relative $L^1$ error")
    ax.legend(loc="lower right", bbox_to_anchor=(1.0, 0.1), fontsize=7)
    return figure
