"""Markers per eps, the best eps, the parts of the error, and a field that turns negative."""

import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import RED, Axes, Figure, axes_row, draw, log_log, name_ticks, note
from scenes.lewandowski.marker_style import SHAPE_COLOURS, symbol
from scenes.lewandowski.square_profile import LOADINGS, SquareRuns

_MARKERS = {"S1": "s", "S2": "D", "S3": "v", "S4": "o", "S8": "^"}


def figure(series: pd.DataFrame, *, run: SquareRuns) -> Figure:
    """Draw (a) E by markers per eps, (b) the best eps, (c) the parts of the error, (d) F that turns negative."""
    titles = [
        "number of markers; grey: 10 to 15",
        "measured (points) and formula (lines)",
        "the parts of (17), from midpoints",
        "",
    ]
    figure, axes = axes_row(titles, width=4.4, height=3.3, rows=2)
    _numbers(axes[0], pick(series, panel="E"))
    axes[0].set_ylabel(f"error norm $E({SquareRuns.model_validate(run).t_final:g})$")
    _best(axes[1], pick(series, panel="best ε"))
    _parts(axes[2], pick(series, loading=LOADINGS["midpoints"]))
    _denominator(axes[3], pick(series, panel="denominator"))
    return figure


def _numbers(ax: Axes, series: pd.DataFrame) -> None:
    for name, part in series.groupby("series"):
        for loading, line, face in (("midpoints", "-", None), ("random", "--", "white")):
            style = {"color": SHAPE_COLOURS[name], "markersize": 4, "markerfacecolor": face}
            curve, label = pick(part, loading=LOADINGS[loading]), f"{symbol(name)}, {loading}"
            draw(ax, curve, f"o{line}", label=label, **style)
    ax.axvspan(10.0, 15.0, color="0.5", alpha=0.15, linewidth=0)
    log_log(ax, xlabel=r"markers per $\varepsilon$ at the end")
    name_ticks(ax, (0.02, 0.05, 0.1, 0.2), "y")
    ax.legend(loc="lower left")


def _best(ax: Axes, series: pd.DataFrame) -> None:
    for name, part in series.groupby("series"):
        style = {"color": SHAPE_COLOURS[name], "markerfacecolor": "none", "label": symbol(name)}
        part = part.sort_values("x")
        draw(ax, part, _MARKERS.get(name, "o"), **style)
        ax.plot(part["x"], part["predicted"], color=SHAPE_COLOURS[name], linewidth=1.0)
    log_log(ax, xlabel="distance of the markers $h$")
    name_ticks(ax, sorted(series["x"].unique()))
    name_ticks(ax, (0.1, 0.2, 0.5, 1.0), "y")
    ax.set_ylabel(r"best support parameter $\varepsilon$")
    ax.legend(loc="upper left", ncols=2)


def _parts(ax: Axes, series: pd.DataFrame) -> None:
    looks = {"position": ("-", r"position, $\hat e$ (18)")}
    looks["representation"] = (":", "representation")
    for name, part in series.groupby("series"):
        for what, (line, label) in looks.items():
            style = {"color": SHAPE_COLOURS[name], "markersize": 3.5}
            curve = pick(part, panel=f"{what} error")
            draw(ax, curve, f"o{line}", label=f"{symbol(name)}: {label}", **style)
    ax.set(yscale="log", xlabel="time $t$", ylabel="largest error")
    name_ticks(ax, (0.002, 0.005, 0.01, 0.02, 0.05), "y")
    ax.legend(loc="best")


def _denominator(ax: Axes, series: pd.DataFrame) -> None:
    if series.empty:
        ax.text(0.5, 0.5, "F stayed positive", transform=ax.transAxes, ha="center")
        return
    at = pick(series, series="markers")
    below, above = at[at["y"] <= 0.0], at[at["y"] > 0.0]
    draw(ax, pick(series, series="F"), color=SHAPE_COLOURS["S8"])
    draw(ax, above, "|", color="0.35", markersize=7)
    draw(ax, below, "X", color=RED, markersize=8)
    ax.axhline(0.0, color="0.3", linewidth=0.8)
    x, y = below[["x", "y"]].iloc[0]
    depth = f"{y:.2g}".replace("-", "−")
    centred = {"ha": "center", "va": "center", "color": RED}
    arrow = {"arrowstyle": "-", "color": RED}
    note(ax, f"F = {depth}\nat a marker", (x, y), (-62, -8), arrowprops=arrow, **centred)
    ax.set(xlabel="$x$", ylabel="$F$, the denominator of (7)")
    ax.set_yscale("symlog", linthresh=1e-3)
    ax.set_ylim(top=3.0 * series["y"].max())  # room for the strokes
    t = series["t"].iloc[0]
    ax.set_title(rf"(d) $S_8$ from random positions, $t \approx {t:.2f}$", loc="left")
