"""Error of the time integration against run time."""

from typing import Any

import pandas as pd
from matplotlib.ticker import LogLocator

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import BLUE, GREEN, ORANGE, RED, SKY, Axes, Figure

# Colours of Okabe & Ito again: no scheme has a curve here, one panel is one operator.
_LINES: dict[str, dict[str, Any]] = {
    "RK1": {"color": SKY, "marker": "o"},
    "RK2": {"color": BLUE, "marker": "s"},
    "RK4": {"color": GREEN, "marker": "^"},
    "RKC2": {"color": ORANGE, "marker": "D"},
}
_ORDERS = {"RK1": 1.0, "RK2": 2.0, "RK4": 4.0}
_POINTS: dict[str, dict[str, Any]] = {
    "expm_multiply": {"color": RED, "marker": "P", "markersize": 9.0},
    "Chebyshev series": {"color": "#000000", "marker": "*", "markersize": 12.0},
}


def figure(series: pd.DataFrame) -> Figure:
    """One panel an operator; a line an integrator that takes steps, a large marker one that takes none."""
    operators = list(series["operator"].unique())
    width = 3.3 if len(operators) > 1 else 5.0
    figure, axes = style.axes_row(operators, height=4.2, width=width, sharex=True, sharey=True)
    for ax, operator in zip(axes, operators, strict=True):
        _panel(ax, pick(series, operator=operator))
    _slopes(axes[0], pick(series, operator=operators[0]))
    axes[0].set_ylabel("relative error of the time integration,\n" + r"against $e^{A T} u(0)$")
    style.legend_below(figure, axes[0], columns=6 if len(operators) > 1 else 3)
    style.note_below(figure, f"timed: the solve, with the operator made; {series['note'].iloc[0]}")
    return figure


def _panel(ax: Axes, runs: pd.DataFrame) -> None:
    for integrator, look in _LINES.items():
        line = pick(runs, integrator=integrator).sort_values("steps")
        ax.plot(1e3 * line["solve_time"], line["error"], label=integrator, **look)
    for integrator, look in _POINTS.items():
        for run in pick(runs, integrator=integrator).itertuples():
            time = 1e3 * run.solve_time
            # What of the lines lies on its left is faster.
            ax.axvline(time, color=look["color"], linewidth=0.7, linestyle=":", zorder=1)
            ax.plot(time, run.error, label=integrator, linestyle="none", **look)
            text = {"va": "center", "fontsize": 7, "color": look["color"]}
            style.note(ax, f"{run.applications}\napplications", (time, run.error), (8, 0), **text)
    style.log_log(ax, xlabel="time of a solve / ms")
    style.plain_times(ax)
    ax.yaxis.set_major_locator(LogLocator(base=100.0, numticks=20))
    ax.minorticks_off()


def _slopes(ax: Axes, runs: pd.DataFrame) -> None:
    """Above the middle of each line the slope of its order: the time is in proportion to the number of steps."""
    for integrator, order in _ORDERS.items():
        line = pick(runs, integrator=integrator).sort_values("steps")
        if len(line) > 1:
            middle = line.iloc[len(line) // 2]
            style.slope_triangle(ax, 1e3 * middle["solve_time"], 2.0 * middle["error"], -order)
