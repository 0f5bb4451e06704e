"""Maps of the solution and of its relative error in two dimensions."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, LogNorm, Normalize
from matplotlib.patches import Circle

from fracstudy.inputs import ORDERS
from fracstudy.panels import pick
from fracstudy.style import Axes, Figure, Look
from scenes.plane import DISC

_EXTERIORS = {"truncated": "truncated", "open": "open exterior"}
_ERRORS = 10.0 ** np.arange(-4.0, 1.1, 0.5)  # two steps of colour a decade
_COLOURS: dict[str, dict[str, str]] = {  # of the maps, and of the disc of (59)
    "u": {"cmap": "viridis", "disc": "white"},
    "error": {"cmap": "magma", "disc": "0.9"},
}
_BARS: dict[str, Look] = {
    "u": {"label": r"strength $u(\mathbf{x}, t_f)$", "shrink": 0.9, "aspect": 18, "extend": "min"},
    "error": {"label": r"relative error $|u\,/\,G - 1|$", "shrink": 0.6, "aspect": 36},
}


def figure(series: pd.DataFrame, *, maps: list[list[Any]]) -> Figure:
    """Draw the maps, truncated above and open below; one colour scale for each quantity."""
    figure = Figure(figsize=(2.45 * len(maps), 5.9), layout="constrained")
    axes = figure.subplots(2, len(maps), sharex=True, sharey=True)
    opened = pick(series, exterior="open", quantity="u")["value"]
    norms: dict[str, Normalize] = {"u": LogNorm(opened.min(), opened.max())}
    norms["error"] = BoundaryNorm(_ERRORS, 256, extend="both")
    letters = iter("abcdefgh")
    for row, (exterior, title) in zip(axes, _EXTERIORS.items(), strict=True):
        for panel, (ax, (scheme, order, what)) in enumerate(zip(row, maps, strict=True)):
            _map(ax, pick(series, panel=panel, exterior=exterior), norms[what], what)
            name = f"{'$u$' if what == 'u' else 'error'}, {scheme} {ORDERS[order]}"
            ax.set_title(f"({next(letters)}) {name},\n{title}", loc="left", fontsize=8.5)
        row[0].set_ylabel("$y$")
    for ax in axes[1]:
        ax.set_xlabel("$x$")
    quantities = [what for *_, what in maps]
    for what, options in _BARS.items():
        shown = [panel for panel, quantity in enumerate(quantities) if quantity == what]
        if shown:
            colours = ScalarMappable(norms[what], _COLOURS[what]["cmap"])
            below = list(axes[:, shown].ravel())
            bar = figure.colorbar(colours, ax=below, location="bottom", pad=0.02, **options)
            if what == "error":
                decades = [float(error) for error in _ERRORS[::2]]
                bar.set_ticks(decades, labels=[f"$10^{{{np.log10(e):.0f}}}$" for e in decades])
    return figure


def _map(ax: Axes, part: pd.DataFrame, norm: Normalize, what: str) -> None:
    colours, ticks = _COLOURS[what], [-DISC, 0.0, DISC]
    x, field = _whole(part)
    look: Look = {"norm": norm, "cmap": colours["cmap"], "shading": "nearest"}
    ax.pcolormesh(x, x, field.T, rasterized=True, **look)
    # What is not positive has no place on a logarithmic scale.
    ax.set_facecolor("#D55E00")
    disc = {"fill": False, "color": colours["disc"], "linewidth": 0.9, "linestyle": "--"}
    ax.add_patch(Circle((0.0, 0.0), DISC, **disc))
    ax.set_aspect("equal")
    ax.grid(visible=False)
    labels = [f"{tick:g}".replace("-", "−") for tick in ticks]
    ax.set(xticks=ticks, xticklabels=labels, yticks=ticks, yticklabels=labels)


def _whole(part: pd.DataFrame) -> tuple[np.ndarray, np.ndarray]:
    """The quadrant x, y >= 0 and its mirror images; what is not positive is masked."""
    quadrant = part.pivot(index="x", columns="y", values="value").to_numpy()
    half = np.concatenate([quadrant[:0:-1], quadrant])
    field = np.concatenate([half[:, :0:-1], half], axis=1)
    x = np.sort(part["x"].unique())
    return np.concatenate([-x[:0:-1], x]), np.ma.masked_less_equal(field, 0.0)
