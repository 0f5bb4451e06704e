"""The stability of DVM and GPSE against the limit of DD."""

import numpy as np
import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import COLOURS, ERROR, Axes, Figure, Look, axes_row, log_log, scheme_style

_STOPPED = 3.0  # where the marks of runs that stop are drawn
_LOOKS: dict[str, Look] = {
    "DVM, no remeshing": scheme_style("DVM", markerfacecolor="none", linestyle="--"),
    "DVM, M4'": scheme_style("DVM"),
    "GPSE, open exterior": scheme_style("GPSE"),
}
_CROSS: Look = {"marker": "x", "linestyle": "", "markersize": 6, "markeredgewidth": 1.5}


def figure(series: pd.DataFrame) -> Figure:
    """Draw (a) the factor of a wave in a step and (b) the error of runs, against the step over DD's limit."""
    titles = ("growth of the worst wave", "error of runs")
    drawn, (growth, error) = axes_row(titles, width=4.5, height=3.9)
    _factors(growth, pick(series, panel="growth"))
    _errors(error, pick(series, panel="error"))
    for ax in (growth, error):
        right = ax.get_xlim()[1]
        ax.axvspan(1.0, right, color="0.95", zorder=0)
        ax.set_xlim(right=right)
        ax.axvline(1.0, color="0.5", linewidth=0.8)
        ax.set_xlabel(r"step over the limit of DD, $D\,\Delta t / (a\,h^\alpha)$")
        style.legend_under(ax)
    return drawn


def _factors(ax: Axes, series: pd.DataFrame) -> None:
    waves = pick(series, run="DVM").sort_values("factor")
    largest = waves["factor"].max()
    hollow: Look = {"color": COLOURS["DVM"], "linestyle": "", "markerfacecolor": "none"}
    fine = np.linspace(0.0, largest, 200)
    z = -2.0 * fine
    predicted = r"$1 + z + z^2/2$, $z = \Delta t\,A_\mathrm{DD}$"
    for order, name, marker, size in ((2, "II", "p", 6), (4, "IV", "h", 9)):
        part, label = pick(waves, order=order), f"DVM {name}, measured"
        look = {"marker": marker, "markersize": size, "label": label, **hollow}
        ax.plot(part["factor"], part["measured"], **look)
        if order == 2:
            ax.plot(fine, 1.0 + z + 0.5 * z * z, color=COLOURS["DD"], label=predicted)
    part = pick(series, run="GPSE").query("factor <= 1.05 * @largest")
    ax.plot(part["factor"], part["predicted"], color=COLOURS["GPSE"], label="GPSE, short waves")
    style.border(ax, 1.0)
    ax.set(xlim=(0.0, 1.03 * largest), ylim=(0.0, None), ylabel="factor of a wave in a step")


def _errors(ax: Axes, series: pd.DataFrame) -> None:
    for name, part in series.groupby("run"):
        part = part.sort_values("factor")
        label = name.replace("M4'", "$M_4'$")
        ax.plot(part["factor"], part["error"], label=label, **_LOOKS[name])
        stopped = part.loc[part["stopped"].notna(), "factor"]
        if len(stopped):
            marks, label = [_STOPPED] * len(stopped), "stopped: $u$ changes sign"
            ax.plot(stopped, marks, color=_LOOKS[name]["color"], label=label, **_CROSS)
    log_log(ax)
    style.name_ticks(ax, (0.25, 0.5, 1.0, 2.0, 4.0), inside=True)
    ax.set_ylabel(ERROR)
