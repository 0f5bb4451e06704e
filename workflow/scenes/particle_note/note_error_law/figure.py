"""The error law of the note, its two terms apart and together."""

import numpy as np
import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import BLUE, GREEN, ORANGE, RED, Axes, Figure, Look, draw, log_log, note
from scenes.particle_note.waves import LINES

_DERIVATIVES = {0: "*", 1: "s", 2: "o", 3: "^", 4: "D"}
_BY_SPACING = (BLUE, GREEN, ORANGE, RED)
_TICKS = {0.125: "1/8", 0.25: "1/4", 0.5: "1/2", 1.0: "1"}


def figure(series: pd.DataFrame) -> Figure:
    """(a) regularisation over its constant, (b) quadrature with its bound, (c) both against the radius."""
    drawn, axes = style.axes_row(3, height=3.7, width=3.2)
    _regularisation(axes[0], pick(series, panel="regularisation"))
    _quadrature(axes[1], pick(series, panel="quadrature"), pick(series, panel="bound"))
    _total(axes[2], pick(series, panel="total"))
    return drawn


def _regularisation(ax: Axes, part: pd.DataFrame) -> None:
    hollow: Look = {"markerfacecolor": "none", "linestyle": ""}
    for (r, beta), curve in part.sort_values("x").groupby(["r", "beta"]):
        look = {**hollow, "color": LINES[r]["color"], "marker": _DERIVATIVES[beta]}
        aside = 1.06 ** (beta - 2)  # they would lie on one another
        ax.plot(curve["x"] * aside, curve["y"], markeredgewidth=0.8, markersize=4.5, **look)
    radii = np.array(sorted(part["x"].unique()))
    for r in sorted(part["r"].unique()):
        ax.plot(radii, radii**r, linewidth=1.0, **LINES[r])
        at, beside = (radii[0], radii[0] ** r), {"ha": "right", "va": "center", "fontsize": 9}
        note(ax, rf"$\epsilon^{int(r)}$", at, (-22, 0), color=LINES[r]["color"], **beside)
    log_log(ax, xlabel=r"kernel radius $\epsilon$")
    ax.set_xlim(0.55 * radii[0], 1.25 * radii[-1])
    style.name_ticks(ax, radii)
    ax.minorticks_off()
    ax.set_ylabel(r"regularisation error $/\ (C_1\, \|f^{(\beta+r)}\|)$")
    marks = [
        style.entry(rf"$\beta$ = {int(b)}", color="0.3", marker=_DERIVATIVES[b], **hollow)
        for b in sorted(part["beta"].unique())
    ]
    ax.legend(handles=marks, loc="lower right", fontsize=7)


def _quadrature(ax: Axes, waves: pd.DataFrame, bounds: pd.DataFrame) -> None:
    colours = [line["color"] for line in LINES.values()]
    for (name, curve), colour in zip(waves.groupby("series", sort=False), colours, strict=False):
        draw(ax, curve, color=colour)
        bound = pick(bounds, series=name)
        draw(ax, bound, "--", color=colour, linewidth=0.8)
        if len(bound):
            (x, y), (right, top) = bound[["x", "y"]].to_numpy()[[-1, 0]]
            m = np.log(top / y) / np.log(right / x)
            note(ax, f"$m$ = {m:.0f}", (x, y), (-5, -2), ha="right", color=colour)
        else:
            low = curve[curve["y"] > 1e-9].sort_values("y").iloc[0]
            note(ax, "Gaussian", (low["x"], low["y"]), (8, -8), color=colour)
    least = waves["x"].min()
    log_log(ax, xlabel=r"$h / \epsilon$", ylim=(1e-11, 10.0))
    ax.set(xlim=(0.6 * least, 1.3), ylabel="quadrature error of $f''$")
    ticks = [t for t in _TICKS if t >= least]
    ax.set_xticks(ticks, [_TICKS[t] for t in ticks])
    ax.minorticks_off()


def _total(ax: Axes, part: pd.DataFrame) -> None:
    """Error against radius for several h; a mark where eps = h, and the kernel whose moments the lattice meets."""
    curves = dict(tuple(part.sort_values("x").groupby("series")))
    lattice = curves.pop("lattice")
    for name, colour in zip(sorted(curves, key=float), _BY_SPACING, strict=False):
        h, x, y = float(name), curves[name]["x"], curves[name]["y"]
        ax.plot(x, y, color=colour, label=f"$h$ = {h:g}")
        at = np.exp(np.interp(np.log(h), np.log(x), np.log(y)))
        ax.plot(h, at, "o", color=colour, markersize=5)
    draw(ax, lattice, "k*", markersize=7, label="moments met\non the lattice")
    log_log(ax, xlabel=r"kernel radius $\epsilon$  (dot: $\epsilon = h$)")
    ax.set(ylabel="error of $f''$, sum (21)", ylim=(1e-5, 4.0))
    style.slope_triangle(ax, 0.35, 0.2 * 0.125 * 0.35**2, 2.0)
    ax.legend(loc="lower right", fontsize=7)
