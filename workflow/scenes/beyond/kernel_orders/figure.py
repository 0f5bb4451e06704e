"""Error (48) against h for kernels of order 2 to 12, down to the floor."""

import matplotlib as mpl
import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import Axes, Figure, Look, axes_row, legend_below, log_log, scheme_style

_SHADES = mpl.colormaps["viridis_r"]
_STYLES = ("-", "--", ":")
_FLOOR = scheme_style("GPSE", color="0.35", markersize=3.5, markerfacecolor="0.35")


def figure(series: pd.DataFrame) -> Figure:
    """Draw a panel a scheme: a shade an order, a line style an overlap, and GPSE in one step as the floor."""
    by_scheme = dict(tuple(series.sort_values("h").groupby("scheme")))
    floor = by_scheme.pop("GPSE", series.iloc[:0])
    drawn, axes = axes_row(len(by_scheme), height=4.6, sharey=True)
    orders = sorted({order for part in by_scheme.values() for order in part["order"]})
    for ax, (scheme, part) in zip(axes, by_scheme.items(), strict=True):
        _panel(ax, part, scheme, orders)
        ax.plot(floor["h"], floor["error"], label="GPSE, one step", **_FLOOR)
        log_log(ax, xlabel="particle spacing $h$")
        style.name_ticks(ax, sorted(part["h"].unique()), form=".2g")
        ax.set_title(scheme, loc="right", color=scheme_style(scheme)["color"])
    axes[0].set_ylabel(style.ERROR)
    legend_below(drawn, axes[0], columns=5)
    return drawn


def _panel(ax: Axes, part: pd.DataFrame, scheme: str, orders: list[int]) -> None:
    overlaps = sorted(part["overlap"].unique())
    marker = scheme_style(scheme)["marker"]
    look: Look = {"marker": marker, "markersize": 3.0, "linewidth": 1.2}
    for (order, overlap), points in part.groupby(["order", "overlap"]):
        colour = _SHADES(0.08 + 0.9 * orders.index(order) / max(len(orders) - 1, 1))
        line = _STYLES[overlaps.index(overlap) % len(_STYLES)]
        label = rf"order {order}, $\epsilon / h = {overlap:g}$"
        ax.plot(points["h"], points["error"], line, color=colour, label=label, **look)
    finest = pick(part, order=orders[0], overlap=overlaps[0])
    h, error = finest.iloc[0][["h", "error"]]
    style.slope_triangle(ax, h, 2.5 * error, float(orders[0]), above=True)
