"""The reduced Green's function: its two representations (Figs A.10-A.12) and the accuracy of ours."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fracstudy.style import COLOURS, axes_row

__all__ = ["expansions", "fundamental_solution"]

_MARKERS = ("o", "s", "^", "D", "v")
_FLOOR = 2.0**-54  # where errors of zero are drawn
_CEILING = 1e6  # above both panels, below where the axes would overflow
_OURS, _SCIPY = "#0072B2", "#D55E00"


def expansions(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw the function, partial sums of (A.1) as lines and of (A.2) as symbols, and their errors."""
    figure, (left, right) = axes_row(2, height=3.7)
    exact = series[series["series"] == "exact"].set_index("x")["y"]
    left.plot(exact.index, exact, color=COLOURS["exact"], linewidth=3.0, alpha=0.25)
    entries = [
        Line2D([], [], color=COLOURS["exact"], linewidth=3.0, alpha=0.25, label=r"$L_\alpha^0$")
    ]
    for name, palette in (("series", "Blues"), ("asymptotic", "Oranges")):
        curves = series[series["series"] == name].groupby("terms")
        shades = mpl.colormaps[palette](np.linspace(0.45, 0.95, len(curves)))
        for (terms, curve), colour, marker in zip(curves, shades, _MARKERS, strict=False):
            x, y = curve["x"].to_numpy(), curve["y"].to_numpy()
            error = np.abs(y / exact.to_numpy() - 1.0)
            if name == "series":
                style: dict[str, Any] = {"color": colour}
                label = f"(A.1), K = {terms}"
            else:
                style = {
                    "color": colour, "linestyle": "", "marker": marker, "markersize": 4, "markerfacecolor": "white",
                    "markevery": 7,
                }  # fmt: skip
                label = f"(A.2), A = {terms}"
            left.plot(x, np.where((y > 0.0) & (y < _CEILING), y, np.nan), **style)
            right.plot(x, np.clip(error, _FLOOR, _CEILING), **style)
            entries.append(Line2D([], [], label=label, **{**style, "markevery": None}))
    right.axhline(1e-3, color="0.5", linewidth=0.8, linestyle=":")
    left.set(
        xscale="log", yscale="log", ylim=(0.3 * exact.min(), 8.0 * exact.max()), xlim=(0.1, 30.0)
    )
    right.set(xscale="log", yscale="log", ylim=(1e-16, 10.0), xlim=(0.1, 30.0))
    left.set(xlabel="distance $x$", ylabel=r"reduced Green's function $L_\alpha^0(x)$")
    right.set(xlabel="distance $x$", ylabel="relative error of the partial sum")
    left.set_title(rf"(a)  $\alpha = {parameters['alpha']:g}$", loc="left")
    figure.legend(handles=entries, loc="outside lower center", ncols=5)
    return figure


def fundamental_solution(
    series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]
) -> Figure:
    """Draw the relative error against x of our evaluation and of scipy's, a panel an alpha."""
    alphas = list(parameters["shown"])
    figure, axes = axes_row(len(alphas), height=3.2, width=3.0, sharey=True)
    for letter, ax, alpha in zip("abcdefgh", axes, alphas, strict=False):
        mine = series[(np.isclose(series["alpha"], alpha)) & (series["x"] > 0.0)]
        for name, colour, marker in (("scipy", _SCIPY, "s"), ("ours", _OURS, "o")):
            curve = mine[mine["series"] == name]
            ax.plot(
                curve["x"],
                curve["y"].clip(lower=_FLOOR),
                marker=marker,
                color=colour,
                linewidth=0.8,
                markersize=3.5,
            )
        ax.axhline(2.0**-53, color="0.5", linewidth=0.8, linestyle=":")
        ax.set(xscale="log", yscale="log", ylim=(2e-17, 1e-2), xlabel="distance $x$")
        ax.set_title(rf"({letter})  $\alpha = {alpha:g}$", loc="left")
    axes[0].set_ylabel(r"relative error of $L_\alpha^0(x)$")
    entries = [
        Line2D([], [], color=_OURS, marker="o", label="ours"),
        Line2D([], [], color=_SCIPY, marker="s", label="scipy.stats.levy_stable"),
        Line2D([], [], color="0.5", linestyle=":", label="round-off, $2^{-53}$"),
    ]
    figure.legend(handles=entries, loc="outside lower center", ncols=3)
    return figure
