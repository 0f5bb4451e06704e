"""Why markers cluster, and the time step."""

from itertools import cycle

import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import RED, Axes, Figure, axes_row, draw, entry, legend_below, name_ticks, note
from scenes.lewandowski.marker_style import SHAPE_COLOURS, symbol

_HOLLOW = {"marker": "o", "markerfacecolor": "white", "linestyle": ""}


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw (a) rates of perturbations, predicted and measured; (b) the error against the time step."""
    figure, (rates, steps) = axes_row(2, height=3.9, width=4.4)
    shapes = list(table["S"].unique())
    _rates(rates, series, shapes)
    _steps(steps, pick(series, panel="step"), pick(series, panel="limit").set_index("series")["x"])
    legend = [
        entry(r"predicted, $-k^2 \widehat{S}(k)$", color="0.3"),
        entry("measured", color="0.3", **_HOLLOW),
        *(entry(symbol(s), color=SHAPE_COLOURS[s]) for s in shapes),
    ]
    legend_below(figure, legend, 5)
    return figure


def _rates(ax: Axes, series: pd.DataFrame, shapes: list[str]) -> None:
    lines = pick(series, panel="rate")
    draw(ax, pick(lines, series="exact"), color="black", linewidth=1.0)
    ax.text(1.85, -4.4, "exact\n$-k^2$", ha="right", va="center", fontsize=8)
    for name in shapes:
        draw(ax, pick(lines, series=name), color=SHAPE_COLOURS[name])
        points = pick(series, panel="measured", series=name)
        draw(ax, points, color=SHAPE_COLOURS[name], **_HOLLOW)
    end = lines["x"].max()
    ax.axhline(0.0, color="0.3", linewidth=0.8)
    ax.axhspan(0.0, 2.6, color=RED, alpha=0.07, linewidth=0)
    ax.text(end - 0.1, 2.5, "clusters grow", ha="right", va="top", fontsize=8, color="#A04000")
    ax.set(xlim=(0.0, end), ylim=(-5.2, 2.6), xlabel=r"wavenumber $k = \varepsilon q$")
    ax.set_ylabel(r"rate of perturbations $\times\ \varepsilon^2$")


def _steps(ax: Axes, errors: pd.DataFrame, limits: pd.Series) -> None:
    for (name, limit), side in zip(limits.items(), cycle((-1, 1)), strict=False):
        colour = SHAPE_COLOURS[name]
        draw(ax, pick(errors, series=name).dropna(), color=colour, marker="o", markersize=3.5)
        ax.axvline(limit, color=colour, linewidth=1.0, linestyle="--")
        place = {"xycoords": ("data", "axes fraction"), "ha": "right" if side < 0 else "left"}
        at, text = (limit, 1.0), rf"$\eta = {limit:.3f}$"
        note(ax, text, at, (3 * side, -2), va="top", color=colour, **place)
    ax.set(yscale="log", xlabel=r"time step $\Delta t / \varepsilon^2$")
    ax.set_ylabel(f"error norm $E({errors['t'].iloc[0]:g})$")
    name_ticks(ax, (0.02, 0.05, 0.1, 0.2), "y")
