"""The random walk beside the particle schemes."""

import numpy as np
import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import BLUE, COLOURS, ERROR, ORANGE, Axes, Figure, Look, draw, log_log, note

_GREEN = COLOURS["KPSE"]
_WALKERS = ((ORANGE, 3.0, -2), (BLUE, 2.0, -26))  # colour, size of a dot, drop of the note
# From the longest dt on.
_STEPS: tuple[Look, ...] = (
    {"color": BLUE, "marker": "o", "markersize": 4.0, "markerfacecolor": BLUE},
    {"color": style.SKY, "marker": "s", "markersize": 6.5, "markerfacecolor": "none"},
    {"color": style.PINK, "marker": "D", "markersize": 6.5, "markerfacecolor": "none"},
)
_SOLUTION: Look = {"color": _GREEN, "linestyle": "", "markerfacecolor": "white"}


def figure(series: pd.DataFrame, table: pd.DataFrame, *, shown: list[int]) -> Figure:
    """Draw (a) the density of walkers and the exact one, (b) the error against the number of walkers."""
    drawn, (density, error) = style.axes_row(2, height=4.0, width=4.4)
    _density(density, pick(series, panel="density"), sorted(shown))
    density.set_ylabel(rf"density $u(x, t = {table['t'].max():g})$")
    _error(error, pick(series, panel="error"))
    for ax in (density, error):
        ax.legend(loc="upper left", bbox_to_anchor=(0.0, -0.16), ncols=2)
    return drawn


def _density(ax: Axes, series: pd.DataFrame, shown: list[int]) -> None:
    walks, exact, scheme = (pick(series, series=name) for name in ("walk", "exact", "KPSE"))
    least = 0.3 * walks.loc[walks["y"] > 0.0, "y"].min()
    dots: Look = {"marker": "o", "markeredgewidth": 0.0, "linestyle": ""}
    for n, (colour, size, drop) in zip(shown, _WALKERS, strict=True):
        part = pick(walks, walkers=n)
        label, y = f"{_scientific(n)} walkers", part["y"].where(part["y"] > 0.0)
        ax.plot(part["x"], y, color=colour, markersize=size, label=label, **dots)
        few = part["few_beyond"].iloc[0]
        ax.axvline(few, color=colour, linewidth=0.9, linestyle=":")
        look = {"xycoords": ("data", "axes fraction"), "va": "top", "fontsize": 7.5}
        note(ax, "fewer than\n10 a cell →", (few, 1.0), (3, drop), color=colour, **look)
    draw(ax, exact, color=COLOURS["exact"], linewidth=1.0, label="exact, (36)")
    draw(ax, scheme, label="KPSE IV", **style.scheme_style("KPSE", markersize=5, **_SOLUTION))
    log_log(ax, xlabel="distance $x$", ylim=(least, 4.0 * exact["y"].max()))


def _error(ax: Axes, series: pd.DataFrame) -> None:
    law, walks = pick(series, series="expected").sort_values("x"), pick(series, series="walk")
    levels = series[series["series"].str.startswith("KPSE IV")].set_index("series")
    meet, opened = levels.loc["KPSE IV, truncated"], levels.loc["KPSE IV, open"]
    first, last = law.iloc[0], law.iloc[-1]
    end = 200.0 * meet["x"]
    x, y = [first["x"], end], [first["y"], last["y"] * np.sqrt(last["x"] / end)]
    dashed: Look = {"color": "0.5", "linewidth": 0.9, "linestyle": "--"}
    ax.plot(x, y, label=r"statistical, $\propto n^{-1/2}$", **dashed)
    for (dt, part), look in zip(sorted(walks.groupby("dt"), reverse=True), _STEPS, strict=False):
        label = rf"walk, $\Delta t = {dt:g}$"
        draw(ax, part, linestyle="", label=label, **look)
    ax.axhline(meet["y"], color=_GREEN, linewidth=1.3)
    ax.plot(meet["x"], meet["y"], marker="*", markersize=11, **_SOLUTION)
    star, edge = (meet["x"], meet["y"]), (first["x"], meet["y"])
    note(ax, f"{_scientific(meet['x'])} walkers", star, (4, 8), color=_GREEN)
    text = (
        f"KPSE IV: {_scientific(meet['y'])}\n(open exterior: {_scientific(opened['y'])},\n"
        f"equalled by {_scientific(opened['x'])} walkers)"
    )
    note(ax, text, edge, (0, -4), va="top", color=_GREEN, fontsize=7.5)
    style.slope_triangle(ax, 3.0 * last["x"], 1.1 * last["y"], -0.5)
    log_log(ax, xlabel="number of walkers $n$")
    ax.set_ylabel(ERROR)


def _scientific(value: float) -> str:
    """A power of ten as such, other numbers with two digits."""
    mantissa, exponent = f"{value:.1e}".split("e")
    power = f"10^{{{int(exponent)}}}"
    return f"${power}$" if mantissa == "1.0" else rf"${mantissa} \times {power}$"
