"""Loading in the plane: the markers of three loadings, and their errors."""

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from fracstudy.panels import pick
from fracstudy.style import axes_row
from scenes.lewandowski.marker_style import EXACT, draw

_LOOKS = {
    "decoupled": ("#D55E00", "o"),
    "decoupled, weighted": ("#E69F00", "s"),
    "x first, then y": ("#0072B2", "^"),
}
_GREYS: dict[str, Any] = {
    "levels": [0.02, 0.1, 0.3, 0.6, 0.9, 1.2],
    "colors": ["0.95", "0.88", "0.8", "0.72", "0.64"],
}


def figure(series: pd.DataFrame, table: pd.DataFrame, *, shown: dict[str, Any]) -> Figure:
    """Draw the markers of each loading on the density, and the errors against a."""
    figure, axes = axes_row(4, height=3.1, width=2.75)
    density = pick(series, panel="density").pivot(index="y", columns="x", values="z")
    reach = shown["a"] + 2.4
    for letter, ax, (name, (colour, _)) in zip("abc", axes, _LOOKS.items(), strict=False):
        ax.contourf(density.columns, density.index, density, **_GREYS)
        part = pick(series, panel=name)
        ax.scatter(part["x"], part["y"], s=9.0 * part["z"], color=colour, linewidths=0.0)
        ax.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", xlabel="$x$")
        ax.set_title(f"({letter}) {name}", loc="left")
        ax.grid(False)
    axes[0].set_ylabel("$y$")
    errors, ax = pick(series, panel="errors"), axes[3]
    draw(ax, pick(errors, series="exact"), **{**EXACT, "label": "$f$ and the product"})
    for name, (colour, marker) in _LOOKS.items():
        style = {"color": colour, "markerfacecolor": "white", "label": name}
        draw(ax, pick(errors, series=name), marker, **style)
    ax.set(xlabel="half the distance of the blobs, $a$", ylim=(0.0, 1.1))
    ax.set(ylabel="relative $L^1$ error")
    ax.set_title("(d) errors", loc="left")
    ax.legend(loc="lower right", bbox_to_anchor=(1.0, 0.1), fontsize=7)
    return figure
