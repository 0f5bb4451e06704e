"""The kernels of Fig. 1."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fracstudy.style import axes_row

__all__ = ["figure"]

# One colour a beta; no schemes are drawn here.
_COLOURS = ("#0072B2", "#D55E00", "#009E73")
_LINES = {("kappa", 2): "-", ("E", 2): "-", ("K", 2): "--", ("K", 4): ":"}


def figure(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw (a) kappa, (b) the Green's function and K, (c) K near the change of sign of order IV."""
    figure, (potential, tails, near) = axes_row(3, height=3.3, width=3.0)
    colours = dict(zip(sorted(parameters["beta"]), _COLOURS, strict=True))
    far = series[series["panel"] == "kernel"]
    _draw(potential, far, [("kappa", 2)], colours)
    potential.set(
        xscale="log",
        yscale="log",
        xlabel="distance $r$",
        ylabel=r"potential kernel $\kappa^\beta(r)$",
    )
    _slopes(potential, far, "kappa", r"$r^{-\beta}$", colours)

    _draw(tails, far, [("E", 2), ("K", 2)], colours)
    tails.set(
        xscale="log",
        yscale="log",
        xlabel="distance $r$",
        ylabel=r"Green's function $L_\alpha^0$, kernel $K$",
    )
    _slopes(tails, far, "E", r"$r^{-1-\alpha}$", colours)

    close = series[(series["panel"] == "near") & (series["x"] >= 1.0)]
    _draw(near, close, [("K", 2), ("K", 4)], colours)
    near.axhline(0.0, color="0.4", linewidth=0.8)
    near.set(xlim=(1.0, 6.0), ylim=(-0.04, 0.15), xlabel="distance $r$", ylabel="kernel $K(r)$")
    lowest = close[(close["kernel"] == "K") & (close["order"] == 4)].sort_values("y").iloc[0]
    if lowest["y"] < 0.0:
        near.annotate(
            "order IV is\nnegative here", (lowest["x"], lowest["y"]), xytext=(3.5, -0.036), va="bottom",
            color=colours[lowest["beta"]], arrowprops={"arrowstyle": "-", "color": "0.5", "linewidth": 0.8},
        )  # fmt: skip

    entries = [Line2D([], [], color=c, label=rf"$\beta = {b:g}$") for b, c in colours.items()]
    entries += [
        Line2D(
            [], [], color="0.3", linestyle="-", label=r"$\kappa^\beta$ in (a), $L_\alpha^0$ in (b)"
        ),
        Line2D([], [], color="0.3", linestyle="--", label="$K$, order II"),
        Line2D([], [], color="0.3", linestyle=":", label="$K$, order IV"),
    ]
    figure.legend(handles=entries, loc="outside lower center", ncols=len(entries))
    return figure


def _draw(
    ax: Axes, series: pd.DataFrame, shown: list[tuple[str, int]], colours: dict[float, str]
) -> None:
    for name, order in shown:
        curves = series[(series["kernel"] == name) & (series["order"] == order)]
        for beta, curve in curves.groupby("beta"):
            ax.plot(curve["x"], curve["y"], _LINES[name, order], color=colours[beta])


def _slopes(
    ax: Axes, series: pd.DataFrame, name: str, label: str, colours: dict[float, str]
) -> None:
    """Name the power law above the uppermost tail."""
    curves = series[(series["kernel"] == name) & (series["order"] == 2) & (series["x"] >= 10.0)]
    point = curves.groupby("beta").first().sort_values("y").iloc[-1]
    ax.annotate(
        label,
        (point["x"], point["y"]),
        xytext=(4, 6),
        textcoords="offset points",
        va="bottom",
        color="0.25",
    )
