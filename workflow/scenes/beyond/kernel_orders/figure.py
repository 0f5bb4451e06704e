"""Error (48) against h for kernels of order 2 to 12, down to the floor."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fracstudy.style import COLOURS, MARKERS, axes_row, legend_below, slope_triangle

__all__ = ["figure"]

_SHADES = mpl.colormaps["viridis_r"]
_STYLES = ("-", "--", ":")


def figure(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw a panel a scheme: a shade an order, a line style an overlap, and GPSE in one step as the floor."""
    schemes = [scheme for scheme in ("DD", "FPSE", "KPSE") if scheme in set(series["scheme"])]
    figure, axes = axes_row(len(schemes), height=4.6, sharey=True)
    floor = series[series["scheme"] == "GPSE"].sort_values("h")
    orders = sorted(series.loc[series["scheme"] != "GPSE", "order"].unique())
    for ax, scheme in zip(axes, schemes, strict=True):
        _panel(ax, series[series["scheme"] == scheme], scheme, orders)
        ax.plot(
            floor["h"], floor["error"], color="0.35", marker=MARKERS["GPSE"], markersize=3.5,
            label="GPSE, one step",
        )  # fmt: skip
        ax.set(xscale="log", yscale="log", xlabel="particle spacing $h$")
        ax.set_title(scheme, loc="right", color=COLOURS[scheme])
    axes[0].set_ylabel(r"relative error $\varepsilon_{D_\varepsilon}$, Eq. (48)")
    legend_below(figure, axes[0], columns=5)
    return figure


def _panel(ax: Axes, part: pd.DataFrame, scheme: str, orders: list[int]) -> None:
    overlaps = sorted(part["overlap"].unique())
    for (order, overlap), points in part.groupby(["order", "overlap"]):
        place = orders.index(order) / max(len(orders) - 1, 1)
        points = points.sort_values("h")
        ax.plot(
            points["h"], points["error"], color=_SHADES(0.08 + 0.9 * place),
            linestyle=_STYLES[overlaps.index(overlap) % len(_STYLES)],
            marker=MARKERS[scheme], markersize=3.0, linewidth=1.2,
            label=rf"order {order}, $\epsilon / h = {overlap:g}$",
        )  # fmt: skip
    finest = part[(part["order"] == orders[0]) & (part["overlap"] == overlaps[0])]
    h, error = finest.sort_values("h").iloc[0][["h", "error"]]
    slope_triangle(ax, h, 2.5 * error, float(orders[0]), above=True)
