"""The random walk beside the particle schemes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fracstudy.style import COLOURS, MARKERS, axes_row, slope_triangle

__all__ = ["figure"]

_FEWER, _MORE = "#E69F00", "#0072B2"  # walkers
_STEPS = (("o", "#0072B2"), ("s", "#56B4E9"), ("D", "#CC79A7"))  # from the longest dt on


def figure(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw (a) the density of walkers and the exact one, (b) the error against the number of walkers."""
    figure, (density, error) = axes_row(2, height=4.0, width=4.4)
    _density(density, series[series["panel"] == "density"], parameters)
    _error(error, series[series["panel"] == "error"])
    for ax in (density, error):
        ax.legend(loc="upper left", bbox_to_anchor=(0.0, -0.16), ncols=2)
    return figure


def _density(ax: Axes, series: pd.DataFrame, parameters: dict[str, Any]) -> None:
    walks = series[series["series"] == "walk"]
    exact = series[series["series"] == "exact"]
    least = 0.3 * walks.loc[walks["y"] > 0.0, "y"].min()
    shown = sorted(parameters["shown"])
    styles = ((_FEWER, 3.0, -2), (_MORE, 2.0, -26))
    for n, (colour, size, drop) in zip(shown, styles, strict=True):
        part = walks[walks["walkers"] == n]
        ax.plot(
            part["x"], part["y"].where(part["y"] > 0.0), color=colour, marker="o", markersize=size,
            markeredgewidth=0.0, linestyle="", label=f"{_scientific(n)} walkers",
        )  # fmt: skip
        few = part["few_beyond"].iloc[0]
        ax.axvline(few, color=colour, linewidth=0.9, linestyle=":")
        ax.annotate(
            "fewer than\n10 a cell →", (few, 1.0), xycoords=("data", "axes fraction"), xytext=(3, drop),
            textcoords="offset points", va="top", color=colour, fontsize=7.5,
        )  # fmt: skip
    ax.plot(exact["x"], exact["y"], color=COLOURS["exact"], linewidth=1.0, label="exact, (36)")
    scheme = series[series["series"] == "KPSE"]
    ax.plot(
        scheme["x"], scheme["y"], color=COLOURS["KPSE"], marker=MARKERS["KPSE"], linestyle="",
        markerfacecolor="white", markersize=5, label="KPSE IV",
    )  # fmt: skip
    ax.set(xscale="log", yscale="log", ylim=(least, 4.0 * exact["y"].max()))
    ax.set(xlabel="distance $x$", ylabel=rf"density $u(x, t = {parameters['times'][-1]:g})$")


def _error(ax: Axes, series: pd.DataFrame) -> None:
    law = series[series["series"] == "expected"].sort_values("x")
    walks = series[series["series"] == "walk"]
    levels = series[series["series"].str.startswith("KPSE IV")].set_index("series")
    meet = levels.loc["KPSE IV, truncated"]
    first, last = law.iloc[0], law.iloc[-1]
    end = 200.0 * meet["x"]
    ax.plot(
        [first["x"], end], [first["y"], last["y"] * np.sqrt(last["x"] / end)], color="0.5",
        linewidth=0.9, linestyle="--", label=r"statistical, $\propto n^{-1/2}$",
    )  # fmt: skip
    for (dt, part), (marker, colour) in zip(
        sorted(walks.groupby("dt"), reverse=True), _STEPS, strict=False
    ):
        size = 4.0 + 2.5 * (marker != "o")
        ax.plot(
            part["x"], part["y"], color=colour, marker=marker, markersize=size, linestyle="",
            markerfacecolor=colour if marker == "o" else "none", label=rf"walk, $\Delta t = {dt:g}$",
        )  # fmt: skip
    ax.axhline(meet["y"], color=COLOURS["KPSE"], linewidth=1.3)
    ax.plot(
        meet["x"], meet["y"], color=COLOURS["KPSE"], marker="*", markersize=11, linestyle="",
        markerfacecolor="white",
    )  # fmt: skip
    opened = levels.loc["KPSE IV, open"]
    ax.annotate(
        f"{_scientific(meet['x'])} walkers", (meet["x"], meet["y"]), xytext=(4, 8),
        textcoords="offset points", color=COLOURS["KPSE"], fontsize=8,
    )  # fmt: skip
    ax.annotate(
        f"KPSE IV: {_scientific(meet['y'])}\n"
        f"(open exterior: {_scientific(opened['y'])},\nequalled by {_scientific(opened['x'])} walkers)",
        (first["x"], meet["y"]), xytext=(0, -4), textcoords="offset points", va="top",
        color=COLOURS["KPSE"], fontsize=7.5,
    )  # fmt: skip
    slope_triangle(ax, 3.0 * last["x"], 1.1 * last["y"], -0.5)
    ax.set(xscale="log", yscale="log", xlabel="number of walkers $n$")
    ax.set_ylabel(r"relative error $\varepsilon_{D_\varepsilon}$, Eq. (48)")


def _scientific(value: float) -> str:
    """A power of ten as such, other numbers with two digits."""
    mantissa, exponent = f"{value:.1e}".split("e")
    power = f"10^{{{int(exponent)}}}"
    return f"${power}$" if mantissa == "1.0" else rf"${mantissa} \times {power}$"
