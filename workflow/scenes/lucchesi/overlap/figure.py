"""Error (48) against the overlap epsilon / h."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fracstudy.style import COLOURS, MARKERS, axes_row, slope_triangle

__all__ = ["figure"]


def figure(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """The paper's truncated lattice beside the open exterior; shaded where the kernels do not overlap."""
    series = series[series["beta"] == parameters["beta"]]
    figure, axes = axes_row(2, height=3.6, sharex=True, sharey=True)
    names = {"truncated": "truncated (the paper's)", "open": "open exterior (ours)"}
    for letter, ax, (exterior, name) in zip("ab", axes, names.items(), strict=True):
        for (scheme, order), points in _lines(series[series["exterior"] == exterior]):
            ax.plot(points["x"], points["y"], **_look(scheme, order))
        ax.set(xscale="log", yscale="log", xlabel=r"overlap $\epsilon / h$")
        ax.set_title(f"({letter}) {name}", loc="left")
        low, high = series["x"].min() / 1.12, series["x"].max() * 1.12
        ax.axvspan(low, 1.0, color="0.92", zorder=0)
        ax.set_xlim(low, high)
        ticks = [s for s in (0.5, 1, 2, 4, 8) if low < s < high]
        ax.set_xticks(ticks, [f"{s:g}" for s in ticks])
        ax.minorticks_off()
        ax.annotate(
            r"$\epsilon < h$", (1.0, 0.0), xycoords=("data", "axes fraction"), xytext=(-4, 4),
            textcoords="offset points", ha="right", va="bottom", color="0.35",
        )  # fmt: skip
    axes[0].set_ylabel(r"relative error $\varepsilon_{D_\varepsilon}$, Eq. (48)")
    opened = series[series["exterior"] == "open"]
    # A triangle above the uppermost curve of order II, one below the lowest of order IV.
    for scheme, order, above in (("FPSE", 2, True), ("KPSE", 4, False)):
        points = opened[(opened["scheme"] == scheme) & (opened["order"] == order)]
        point = points.iloc[(points["x"] - 3.0).abs().argmin()]
        shift = 1.8 if above else 0.5
        slope_triangle(axes[1], point["x"], shift * point["y"], float(order), above)
    handles = [
        Line2D([], [], **_look(scheme, order), label=_label(scheme, order))
        for (scheme, order), _ in _lines(opened)
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    return figure


def _lines(part: pd.DataFrame) -> Iterable[tuple[Any, pd.DataFrame]]:
    return part.sort_values("x").groupby(["scheme", "order"])


def _label(scheme: str, order: int) -> str:
    return scheme if scheme == "GPSE" else f"{scheme} {'II' if order == 2 else 'IV'}"


def _look(scheme: str, order: int) -> dict[str, Any]:
    return {
        "color": COLOURS[scheme],
        "marker": MARKERS[scheme],
        "linestyle": "-" if order == 2 else "--",
        "markerfacecolor": COLOURS[scheme] if order == 2 else "white",
    }
