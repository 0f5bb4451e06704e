"""The marker method before anything moves: shape functions and initial loading."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from fracstudy.style import COLOURS, axes_row

__all__ = ["SHAPE_COLOURS", "marker_loading", "marker_shapes"]

# One colour for each shape function in all figures of the marker method.
SHAPE_COLOURS = {
    "S1": "#999999",
    "S2": "#E69F00",
    "S3": "#CC79A7",
    "S4": "#D55E00",
    "S5": "#56B4E9",
    "S6": "#8A6D3B",
    "S7": "#0072B2",
    "S8": "#009E73",
}
_LOADINGS = {
    "uniform": ("uniform", "#0072B2", ":"),
    "equal": ("equal weight", "#D55E00", "--"),
}
_TITLES = {
    "Fig. 1": r"Fig. 1: $S_3$, $\varepsilon = %g$",
    "Fig. 2": r"Fig. 2: $S_4$, $\varepsilon = %g$",
    "Fig. 3": r"Fig. 3: $S_6$, $\varepsilon = %g$",
    "Fig. 4": r"Fig. 4: $S_4$, $\varepsilon = %g$",
}


def marker_shapes(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw (a) the shape functions and (b) their Fourier transforms, enlarged where they change sign."""
    figure, (shapes, transforms) = axes_row(2, height=3.9, width=4.4)
    for name, colour in SHAPE_COLOURS.items():
        width = 1.8 if name in ("S4", "S7", "S8") else 1.0
        for ax, panel in ((shapes, "shape"), (transforms, "transform")):
            curve = series[(series["panel"] == panel) & (series["series"] == name)]
            label = rf"$S_{name[1]}$"
            ax.plot(curve["x"], curve["y"], color=colour, linewidth=width, label=label)
    shapes.set(xlabel=r"$x / \varepsilon$", ylabel=r"shape function $\varepsilon S_\varepsilon$")
    transforms.axhline(0.0, color="0.3", linewidth=0.8)
    transforms.axhspan(-0.25, 0.0, color="#D55E00", alpha=0.07, linewidth=0)
    transforms.set(
        ylim=(-0.25, 0.4), xlim=(0.0, float(parameters["wavenumbers"])),
        xlabel=r"wavenumber $k = \varepsilon q$", ylabel=r"Fourier transform $\widehat{S}(k)$",
    )  # fmt: skip
    transforms.text(
        0.98, 0.03, "negative: perturbations grow", transform=transforms.transAxes, ha="right",
        color="#A04000", fontsize=8,
    )  # fmt: skip
    handles, labels = shapes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=8)
    return figure


def marker_loading(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw Figs. 1-4 at the x_0 shown, and below them the errors against x_0."""
    figure = Figure(figsize=(8.8, 5.6), layout="constrained")
    grid = figure.add_gridspec(2, 4, height_ratios=(1.0, 1.0))
    first = None
    for column, (name, title) in enumerate(_TITLES.items()):
        ax = figure.add_subplot(grid[0, column], sharey=first)
        first = first or ax
        panel = series[series["panel"] == name]
        exact = panel[panel["series"] == "exact"]
        ax.plot(exact["x"], exact["y"], color=COLOURS["exact"], linewidth=1.0, label="exact")
        for row, (loading, (label, colour, line)) in enumerate(_LOADINGS.items()):
            curve = panel[panel["series"] == loading]
            ax.plot(curve["x"], curve["y"], line, color=colour, linewidth=1.2, label=label)
            at = panel.loc[panel["series"] == f"{loading} markers", "x"]
            level = [-0.045 - 0.045 * row] * len(at)
            ax.plot(at, level, "|", color=colour, markersize=4.5, markeredgewidth=0.8)
        support = float(parameters["support"]) * (2.0 if name == "Fig. 4" else 1.0)
        ax.set_title(title % support, loc="left")
        ax.set(xlabel="$x$", ylim=(-0.13, 0.62))
        if column:
            ax.tick_params(labelleft=False)
    assert first is not None
    first.set_ylabel(r"$x \exp(-x^2)$ and $F$")
    for column, loading in ((0, "uniform"), (2, "equal")):
        ax = figure.add_subplot(grid[1, column : column + 2])
        for name, colour in zip(_TITLES, ("#CC79A7", "#D55E00", "#8A6D3B", "black"), strict=True):
            curve = series[
                (series["panel"] == "error") & (series["series"] == f"{name}, {loading}")
            ]
            line = "--" if name == "Fig. 4" else "-"
            shape = {"Fig. 1": "S_3", "Fig. 2": "S_4", "Fig. 3": "S_6", "Fig. 4": "S_4"}[name]
            wider = r", $2\varepsilon$" if name == "Fig. 4" else ""
            ax.plot(curve["x"], curve["y"], line, color=colour, label=f"{name}: ${shape}${wider}")
        ax.axvline(float(parameters["shown"]), color="0.5", linewidth=0.8, linestyle=":")
        ax.set(yscale="log", ylim=(5e-3, 0.3), xlabel="end of the interval $x_0$")
        ax.set_title(f"{_LOADINGS[loading][0]}", loc="left", color=_LOADINGS[loading][1])
        if column == 0:
            ax.set_ylabel("relative $L^2$ error")
            bottom = ax
    handles, labels = first.get_legend_handles_labels()
    more, names = bottom.get_legend_handles_labels()
    figure.legend([*handles, *more], [*labels, *names], loc="outside lower center", ncols=7)
    return figure
