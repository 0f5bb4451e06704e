"""Fig. 1 of the note: a function by point particles and by smooth ones."""

import numpy as np
import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import BLUE, GREEN, ORANGE, PINK, RED, SKY, Figure, Look, axes_row, draw

_ONE: Look = {"color": SKY, "linewidth": 0.8}


def figure(series: pd.DataFrame, *, spacing: float, shown: float) -> Figure:
    """(a) point particles, (b) the Gaussians of the particles and their sum, (c) by overlap."""
    titles = [
        "point particles (8)",
        f"smooth particles, {_radius(shown)}",
        "radii too small and too large",
    ]
    drawn, axes = axes_row(titles, height=3.1, width=3.2, sharey=True)
    left, middle, right = axes
    points, exact, smooth = (pick(series, panel=name) for name in ("points", "exact", "smooth"))
    x = exact["x"].to_numpy()
    points = points[points["x"].between(x[0], x[-1])]
    for ax in axes:
        ax.plot(x, exact["y"], color="black", linewidth=1.0, label="$f(x)$")
        ax.set(xlabel="$x$", xlim=(x[0], x[-1]))
    left.vlines(points["x"], 0.0, points["y"], color=BLUE, linewidth=1.0)
    draw(left, points, "o", color=BLUE, markersize=4, label="$f(x_p)$")
    left.set(ylabel="$f$ and its approximations", ylim=(-0.05, 1.95))

    epsilon = shown * spacing
    for place, f in zip(points["x"], points["y"], strict=True):
        own = spacing * f * np.exp(-((x - place) ** 2) / (2.0 * epsilon**2))
        middle.plot(x, own / (np.sqrt(2.0 * np.pi) * epsilon), **_ONE)
    total = pick(smooth, overlap=shown)["y"]
    middle.plot(x, total, color=RED, linewidth=1.8, label=r"sum (9)")
    printed = np.sqrt(epsilon) * total
    middle.plot(x, printed, "--", color=RED, linewidth=1.2, label="(10) as printed")
    middle.plot([], [], label="one particle each", **_ONE)

    colours = (ORANGE, GREEN, RED, PINK)
    for (overlap, curve), colour in zip(smooth.groupby("overlap"), colours, strict=False):
        right.plot(x, curve["y"], color=colour, linewidth=1.1, label=_radius(float(overlap)))
    for ax in axes:
        ax.legend(loc="upper left", fontsize=7, ncols=2, columnspacing=1.0)
    return drawn


def _radius(overlap: float) -> str:
    return rf"$\epsilon$ = {'' if overlap == 1.0 else f'{overlap:g} '}$h$"
