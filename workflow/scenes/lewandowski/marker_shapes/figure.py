"""The shape functions and their Fourier transforms."""

import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import RED, Figure, Look, axes_row, draw, legend_below, note
from scenes.lewandowski.marker_style import SHAPE_COLOURS, symbol
from scenes.lewandowski.square_profile import SHAPES


def figure(series: pd.DataFrame, *, wavenumbers: float) -> Figure:
    """Draw (a) the shape functions and (b) their Fourier transforms, enlarged where they change sign."""
    figure, (shapes, transforms) = axes_row(2, height=3.9, width=4.4)
    for name, colour in SHAPE_COLOURS.items():
        style = {"color": colour, "linewidth": 1.8 if name in SHAPES else 1.0}
        for ax, panel in ((shapes, "shape"), (transforms, "transform")):
            draw(ax, pick(series, panel=panel, series=name), label=symbol(name), **style)
    shapes.set(xlabel=r"$x / \varepsilon$", ylabel=r"shape function $\varepsilon S_\varepsilon$")
    transforms.axhline(0.0, color="0.3", linewidth=0.8)
    transforms.axhspan(-0.25, 0.0, color=RED, alpha=0.07, linewidth=0)
    transforms.set(xlim=(0.0, wavenumbers), ylim=(-0.25, 0.4))
    transforms.set_xlabel(r"wavenumber $k = \varepsilon q$")
    transforms.set_ylabel(r"Fourier transform $\widehat{S}(k)$")
    place: Look = {"xycoords": "axes fraction", "ha": "right"}
    note(transforms, "negative: perturbations grow", (0.98, 0.03), (0, 0), color="#A04000", **place)
    legend_below(figure, shapes, columns=8)
    return figure
