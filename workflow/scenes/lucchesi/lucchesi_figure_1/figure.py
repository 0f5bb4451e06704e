"""The kernels of Fig. 1."""

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fracstudy.style import axes_row, entry, legend_below

# One colour a beta; no schemes are drawn here.
_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
_LINES = {("kappa", 2): "-", ("E", 2): "-", ("K", 2): "--", ("K", 4): ":"}
_NAMES = {
    "-": r"$\kappa^\beta$ in (a), $L_\alpha^0$ in (b)",
    "--": "$K$, order II",
    ":": "$K$, order IV",
}
_LOGARITHMIC: dict[str, Any] = {"xscale": "log", "yscale": "log", "xlabel": "distance $r$"}
_ARROW: dict[str, Any] = {"arrowstyle": "-", "color": "0.5", "linewidth": 0.8}


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw (a) kappa, (b) the Green's function and K, (c) K near the change of sign of order IV."""
    figure, (potential, tails, near) = axes_row(3, height=3.3, width=3.0)
    colours = dict(zip(sorted(series["beta"].unique()), _COLOURS, strict=False))
    shown = series[(series["panel"] == "kernel") | (series["x"] >= 1.0)]
    curves = shown.set_index(["panel", "kernel", "order"]).sort_index(kind="stable")

    def draw(ax: Axes, panel: str, *keys: tuple[str, int]) -> None:
        for key in keys:
            for beta, curve in curves.loc[(panel, *key)].groupby("beta"):
                ax.plot(curve["x"], curve["y"], _LINES[key], color=colours[beta])

    def name_slope(ax: Axes, name: str, label: str) -> None:
        """Name the power law above the uppermost tail."""
        tail = curves.loc["kernel", name, 2].query("x >= 10.0")
        point = tail.groupby("beta").first().sort_values("y").iloc[-1]
        offset: dict[str, Any] = {"xytext": (4, 6), "textcoords": "offset points"}
        ax.annotate(label, (point["x"], point["y"]), va="bottom", color="0.25", **offset)

    draw(potential, "kernel", ("kappa", 2))
    potential.set(ylabel=r"potential kernel $\kappa^\beta(r)$", **_LOGARITHMIC)
    name_slope(potential, "kappa", r"$r^{-\beta}$")
    draw(tails, "kernel", ("E", 2), ("K", 2))
    tails.set(ylabel=r"Green's function $L_\alpha^0$, kernel $K$", **_LOGARITHMIC)
    name_slope(tails, "E", r"$r^{-1-\alpha}$")

    draw(near, "near", ("K", 2), ("K", 4))
    near.axhline(0.0, color="0.4", linewidth=0.8)
    near.set(xlim=(1.0, 6.0), ylim=(-0.04, 0.15), xlabel="distance $r$", ylabel="kernel $K(r)$")
    lowest = curves.loc["near", "K", 4].sort_values("y").iloc[0]
    if lowest["y"] < 0.0:
        style: dict[str, Any] = {
            "va": "bottom",
            "color": colours[lowest["beta"]],
            "arrowprops": _ARROW,
        }
        place = (lowest["x"], lowest["y"])
        near.annotate("order IV is\nnegative here", place, xytext=(3.5, -0.036), **style)

    entries = [entry(rf"$\beta = {b:g}$", color=c) for b, c in colours.items()]
    entries += [entry(label, color="0.3", linestyle=line) for line, label in _NAMES.items()]
    legend_below(figure, entries)
    return figure
