"""Maps of the solution and of its relative error in two dimensions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.colors import BoundaryNorm, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Circle

import fracstudy.style  # noqa: F401  (the style, set on import)

__all__ = ["figure"]

_DISK = 5.0
_MAPS = {"u": "viridis", "error": "magma"}
_ERRORS = 10.0 ** np.arange(-4.0, 1.1, 0.5)  # two steps of colour a decade
_NAMES = {"u": r"strength $u(\mathbf{x}, t_f)$", "error": r"relative error $|u\,/\,G - 1|$"}
_BARS: dict[str, dict[str, Any]] = {
    "u": {"shrink": 0.9, "aspect": 18, "extend": "min"},
    "error": {"shrink": 0.6, "aspect": 36},
}
_ORDERS = {2: "II", 4: "IV"}


def figure(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw the maps, truncated above and open below; one colour scale for each quantity."""
    maps = parameters["maps"]
    exteriors = {"truncated": "truncated", "open": "open exterior"}
    figure = Figure(figsize=(2.45 * len(maps), 5.9), layout="constrained")
    axes = figure.subplots(2, len(maps), sharex=True, sharey=True)
    norms = {name: _norm(series[series["quantity"] == name], name) for name in _MAPS}
    for row, (exterior, title) in enumerate(exteriors.items()):
        for panel, (scheme, order, what) in enumerate(maps):
            ax = axes[row, panel]
            part = series[(series["panel"] == panel) & (series["exterior"] == exterior)]
            x, field = _whole(part)
            colours = ax.pcolormesh(
                x,
                x,
                field.T,
                norm=norms[what],
                cmap=_MAPS[what],
                shading="nearest",
                rasterized=True,
            )
            # What is not positive has no place on a logarithmic scale.
            ax.set_facecolor("#D55E00")
            light = what == "u"
            ax.add_patch(
                Circle((0.0, 0.0), _DISK, fill=False, color="white" if light else "0.9", linewidth=0.9,
                       linestyle="--")
            )  # fmt: skip
            ax.set_aspect("equal")
            ax.grid(visible=False)
            ax.set_xticks([-_DISK, 0.0, _DISK], ["−5", "0", "5"])
            ax.set_yticks([-_DISK, 0.0, _DISK], ["−5", "0", "5"])
            letter = "abcdefgh"[row * len(maps) + panel]
            name = f"{'$u$' if light else 'error'}, {scheme} {_ORDERS[order]}"
            ax.set_title(f"({letter}) {name},\n{title}", loc="left", fontsize=8.5)
            if row == 1:
                ax.set_xlabel("$x$")
            if panel == 0:
                ax.set_ylabel("$y$")
            if row == 1 and (panel == 0 or (what == "error" and maps[panel - 1][2] == "u")):
                last = len(maps) if what == "error" else 1
                bar = figure.colorbar(
                    colours, ax=list(axes[:, panel:last].ravel()), location="bottom",
                    label=_NAMES[what], pad=0.02, **_BARS[what],
                )  # fmt: skip
                if what == "error":
                    decades = [float(error) for error in _ERRORS[::2]]
                    bar.set_ticks(decades, labels=[f"$10^{{{np.log10(e):.0f}}}$" for e in decades])
    return figure


def _norm(part: pd.DataFrame, name: str) -> Normalize:
    """Steps for the errors; a continuous scale for u, over what the open exterior has."""
    if name == "error":
        return BoundaryNorm(_ERRORS, 256, extend="both")
    opened = part[part["exterior"] == "open"]["value"]
    return LogNorm(opened.min(), opened.max())


def _whole(part: pd.DataFrame) -> tuple[np.ndarray, np.ndarray]:
    """The quadrant x, y >= 0 and its mirror images; what is not positive is masked."""
    quadrant = part.pivot_table(index="x", columns="y", values="value").to_numpy()
    half = np.concatenate([quadrant[:0:-1], quadrant])
    field = np.concatenate([half[:, :0:-1], half], axis=1)
    x = np.sort(part["x"].unique())
    return np.concatenate([-x[:0:-1], x]), np.ma.masked_less_equal(field, 0.0)
