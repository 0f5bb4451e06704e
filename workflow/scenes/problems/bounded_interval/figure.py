"""The first eigenvalue on five maps, what truncated schemes solve, and what ends do to a bump."""

import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import COLOURS, MARKERS, Axes, Figure

_ENDS = {"absorbing": "-", "reflecting": "--", "given": "-.", "no flux, final state": ":"}


def figure(series: pd.DataFrame, *, bump: dict[str, float]) -> Figure:
    """Draw (a) errors of the eigenvalue, (b) of truncated schemes, (c) profiles."""
    titles = [
        "first eigenvalue, absorbing ends",
        "truncated schemes: problem and deviation",
        f"a bump at $t = {bump['time']:g}$, and where FPSE ends",
    ]
    drawn, axes = style.axes_row(titles, height=3.7, width=4.0)
    _eigenvalues(axes[0], pick(series, panel="eigenvalue"))
    _truncated(axes[1], pick(series, panel="truncated"))
    _profiles(axes[2], pick(series, panel="profile"))
    given = f"given: {bump['outside']:g} outside"
    style.note(axes[2], given, (0.0, 0.02), (0, 0), ha="center")
    return drawn


def _eigenvalues(ax: Axes, part: pd.DataFrame) -> None:
    style.curves(ax, part)
    style.log_log(ax, xlabel="particles $N$", ylabel=r"relative error of $\lambda_1$")
    ax.set_ylim(top=300.0)
    style.name_ticks(ax, sorted(part["x"].astype(int).unique()))
    style.small_legend(ax, "upper right", ncols=2)


def _truncated(ax: Axes, part: pd.DataFrame) -> None:
    for name in part["series"].unique():
        points = pick(part, series=name).sort_values("x")
        label = f"{name}: {points['ends'].iloc[0]}"
        style.draw(ax, points, label=label, color=COLOURS[name], marker=MARKERS[name])
    style.log_log(ax, xlabel="particle spacing $h$", ylabel="relative deviation")
    for name, below, order in (("DD", 0.22, 1.0), ("KPSE", 0.35, 2.0)):
        finest = pick(part, series=name).sort_values("x").iloc[0]
        style.slope_triangle(ax, finest["x"], below * finest["y"], order)
    style.name_ticks(ax, (0.003, 0.01, 0.03))
    style.small_legend(ax, "upper left")
    ax.set_ylim(0.15 * part["y"].min(), 20.0 * part["y"].max())


def _profiles(ax: Axes, part: pd.DataFrame) -> None:
    for name, line in _ENDS.items():
        style.draw(ax, pick(part, series=name), linestyle=line, marker="", label=name)
    ax.set(xlabel="position $x$", ylabel="$u$", ylim=(0.0, 1.5 * part["y"].median() + 0.4))
    style.small_legend(ax, "upper left", ncols=2)
