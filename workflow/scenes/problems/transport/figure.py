"""A solution that stays stable, errors of two ways of transport, and a blob that turns."""

from typing import Any

import numpy as np
import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import BLUE, GREEN, ORANGE, PINK, RED, SKY, Axes, Figure

_TIMES = (SKY, GREEN, ORANGE, RED)
_DASHED = {"linestyle": "--"}
_WAYS: dict[str, dict[str, Any]] = {
    "lattice, order 4": {"color": SKY, "marker": "^"},
    "lattice, order 8": {"color": GREEN, "marker": "D"},
    "lattice, order 12": {"color": BLUE, "marker": "o"},
    "particles, Lambda3": {
        "label": r"particles, $\Lambda_3$",
        "color": RED,
        "marker": "s",
        **_DASHED,
    },
    "particles, Lambda6,4": {
        "label": r"particles, $\Lambda_{6,4}$",
        "color": ORANGE,
        "marker": "P",
        **_DASHED,
    },
    "particles, M4'": {"label": "particles, $M_4'$", "color": PINK, "marker": "v", **_DASHED},
}
_TITLES = ("linear field $a = -x$", "uniform field, error", "linear field, error", "rotation")
_LEVELS = (0.03, 0.05)


def figure(series: pd.DataFrame) -> Figure:
    """Draw (a) the linear field, (b), (c) errors against the spacing, (d) contours of the blob."""
    drawn, axes = style.axes_row(_TITLES, height=3.7, width=3.3)
    _linear(axes[0], pick(series, panel="linear field"))
    for ax, field in zip(axes[1:3], ("uniform", "linear"), strict=True):
        part = pick(series, panel=f"error, {field}")
        for way, points in part.groupby("series", sort=False):
            style.draw(ax, points, **{"label": way, **_WAYS[str(way)]})
        style.log_log(ax, xlabel="particle spacing $h$", ylim=(3e-11, 1.0))
        style.name_ticks(ax, sorted(part["x"].unique()))
    axes[1].set_ylabel("error / largest $u$")
    _rotation(axes[3], pick(series, panel="rotation"))
    style.legend_below(drawn, axes[1], columns=6)
    return drawn


def _linear(ax: Axes, part: pd.DataFrame) -> None:
    style.draw(ax, pick(part, series="start"), color="0.5", linestyle=":", marker="")
    names = [name for name in part["series"].unique() if name.startswith("exact")]
    for name, colour in zip(names, _TIMES, strict=False):
        exact, ours = pick(part, series=name), pick(part, series=name.replace("exact", "ours"))
        style.draw(ax, exact, color=colour, marker="", label=name.removeprefix("exact, "))
        some = ours.iloc[:: max(1, len(ours) // 24)]
        style.draw(ax, some, "o", color=colour, markersize=3.0)
    ax.set(xlabel="position $x$", ylabel="$u(x, t)$", xlim=(-6.0, 6.0), ylim=(0.0, None))
    style.small_legend(ax, "upper right")


def _rotation(ax: Axes, part: pd.DataFrame) -> None:
    for k, colour in zip(sorted(part["series"].unique(), key=int), _TIMES[1:], strict=False):
        field = pick(part, series=k).pivot(index="x", columns="y", values="value")
        x, y = field.index.to_numpy(), field.columns.to_numpy()
        ax.contour(x, y, field.to_numpy().T, levels=_LEVELS, colors=colour, linewidths=1.0)
    angle = np.linspace(0.0, 2.0 * np.pi, 200)
    ax.plot(1.5 * np.cos(angle), 1.5 * np.sin(angle), color="0.6", linestyle=":", marker="")
    ax.set(xlabel="$x$", ylabel="$y$", xlim=(-2.2, 3.4), ylim=(-1.6, 4.0), aspect="equal")
    ax.grid(visible=False)
