"""The limit over fractional order and overlap, and the growth per step, measured against predicted."""

from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd

from fracstudy.inputs import NUMERALS
from fracstudy.panels import pick
from fracstudy.style import COLOURS, Axes, Figure, Look, draw

_LEVELS = [0.5, 1.0, 2.0, 5.0, 10.0, 20.0]
_INTEGRATORS = {"euler": "D", "rk2": "o", "rk4": "^"}
_POINTS: Look = {"linestyle": "none", "markerfacecolor": "none", "markersize": 5.0}


def figure(series: pd.DataFrame) -> Figure:
    """Draw nine maps, a row a scheme and a column an order, and beside them the growth per step."""
    maps = pick(series, panel="map")
    names = list(dict.fromkeys(maps["series"]))
    schemes = list(dict.fromkeys(name.split()[0] for name in names))
    orders = list(dict.fromkeys(name.split()[1] for name in names))
    drawn = Figure(figsize=(11.0, 6.4), layout="constrained")
    left, right = drawn.subfigures(1, 2, width_ratios=(2.0, 1.0))
    axes = left.subplots(len(schemes), len(orders), sharex=True, sharey=True)
    colours = mpl.colors.LogNorm(0.2, 30.0)
    for row, scheme in zip(axes, schemes, strict=True):
        for ax, order in zip(row, orders, strict=True):
            shown = _map(ax, pick(maps, series=f"{scheme} {order}"), colours)
            ax.set_title(f"{scheme} {NUMERALS[int(order)]}", loc="left", color=COLOURS[scheme])
    for ax in axes[-1]:
        ax.set_xlabel(r"fractional order $\beta$")
    for ax in axes[:, 0]:
        ax.set_ylabel(r"overlap $\epsilon / h$")
    bar = left.colorbar(
        shown, ax=axes, shrink=0.7, label="limit $a$; grey: no step is stable", extend="both"
    )
    bar.set_ticks(_LEVELS, labels=[f"{level:g}" for level in _LEVELS])
    bar.minorticks_off()
    _growth(right.subplots(), pick(series, panel="growth"))
    return drawn


def _map(ax: Axes, points: pd.DataFrame, colours: Any) -> Any:
    grid = points.pivot_table(index="x", columns="beta", values="y")
    beta, overlap, limit = grid.columns.to_numpy(), grid.index.to_numpy(), grid.to_numpy()
    ax.set(xlim=(beta[0], beta[-1]), ylim=(overlap[0], overlap[-1]), facecolor="0.75")
    ax.grid(visible=False)
    field = beta, overlap, np.where(limit > 0.0, limit, np.nan)
    shading = "gouraud" if (limit > 0.0).all() else "nearest"
    how: Look = {"cmap": "viridis", "shading": shading, "rasterized": True}
    shown = ax.pcolormesh(*field, norm=colours, **how)
    if limit.shape[0] > 2 and limit.shape[1] > 2:
        lines = ax.contour(*field, levels=_LEVELS, colors="white", linewidths=0.7)
        for text in ax.clabel(lines, fmt="%g", fontsize=7):
            across, up = ax.transLimits.transform(text.get_position())
            text.set_visible(0.05 < across < 0.95 and 0.05 < up < 0.95)  # the frame would cut it
    return shown


def _growth(ax: Axes, points: pd.DataFrame) -> None:
    ends = [points["x"].min(), points["x"].max()]
    ax.plot(ends, ends, color="0.5", linewidth=0.9)
    ax.axvline(1.0, color="0.6", linewidth=0.8, linestyle=":")
    for integrator, part in points.groupby("series"):
        draw(ax, part, label=integrator, marker=_INTEGRATORS[integrator], **_POINTS)
    ax.set(xlabel=r"spectral radius of $p(A \Delta t)$", ylabel="measured growth per step")
    ax.legend(loc="upper left")
