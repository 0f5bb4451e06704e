"""The kernels of Fig. 1."""

import pandas as pd

from fracstudy import style
from fracstudy.style import Axes, Figure, Look, axes_row, draw, entry, legend_below, log_log, note

# One colour a beta; no schemes are drawn here.
_COLOURS = (style.BLUE, style.RED, style.GREEN, style.PINK, style.ORANGE, style.SKY)
_LINES = {("kappa", 2): "-", ("E", 2): "-", ("K", 2): "--", ("K", 4): ":"}
_NAMES = {
    "-": r"$\kappa^\beta$ in (a), $L_\alpha^0$ in (b)",
    "--": "$K$, order II",
    ":": "$K$, order IV",
}
_ARROW: Look = {"arrowstyle": "-", "color": "0.5", "linewidth": 0.8}


def figure(series: pd.DataFrame) -> Figure:
    """Draw (a) kappa, (b) the Green's function and K, (c) K near the change of sign of order IV."""
    figure, (potential, tails, near) = axes_row(3, height=3.3, width=3.0)
    colours = dict(zip(sorted(series["beta"].unique()), _COLOURS, strict=False))
    shown = series[(series["panel"] == "kernel") | (series["x"] >= 1.0)]
    curves = shown.set_index(["panel", "kernel", "order"]).sort_index(kind="stable")

    def draw_all(ax: Axes, panel: str, *keys: tuple[str, int]) -> None:
        for key in keys:
            for beta, curve in curves.loc[(panel, *key)].groupby("beta"):
                draw(ax, curve, _LINES[key], color=colours[beta])

    def name_slope(ax: Axes, name: str, label: str) -> None:
        """Name the power law above the uppermost tail."""
        tail = curves.loc["kernel", name, 2].query("x >= 10.0")
        point = tail.groupby("beta").first().sort_values("y").iloc[-1]
        note(ax, label, (point["x"], point["y"]), (4, 6), va="bottom", color="0.25", fontsize=None)

    draw_all(potential, "kernel", ("kappa", 2))
    log_log(potential, ylabel=r"potential kernel $\kappa^\beta(r)$", xlabel="distance $r$")
    name_slope(potential, "kappa", r"$r^{-\beta}$")
    draw_all(tails, "kernel", ("E", 2), ("K", 2))
    log_log(tails, ylabel=r"Green's function $L_\alpha^0$, kernel $K$", xlabel="distance $r$")
    name_slope(tails, "E", r"$r^{-1-\alpha}$")

    draw_all(near, "near", ("K", 2), ("K", 4))
    near.axhline(0.0, color="0.4", linewidth=0.8)
    near.set(xlim=(1.0, 6.0), ylim=(-0.04, 0.15), xlabel="distance $r$", ylabel="kernel $K(r)$")
    lowest = curves.loc["near", "K", 4].sort_values("y").iloc[0]
    if lowest["y"] < 0.0:
        text, at = "order IV is\nnegative here", (lowest["x"], lowest["y"])
        look: Look = {"va": "bottom", "color": colours[lowest["beta"]]}
        near.annotate(text, at, xytext=(3.5, -0.036), arrowprops=_ARROW, **look)

    entries = [entry(rf"$\beta = {b:g}$", color=c) for b, c in colours.items()]
    entries += [entry(label, color="0.3", linestyle=line) for line, label in _NAMES.items()]
    legend_below(figure, entries)
    return figure
