"""The solution along two lines, and its error, truncated and open."""

import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import UNDERLAID, Axes, Figure, Look, entry, legend_below, note, scheme_style
from scenes.plane import DISC

_NOTE: Look = {"xycoords": ("data", "axes fraction"), "ha": "right", "va": "top"}
_OPEN = {"linestyle": "--", "marker": ""}


def figure(series: pd.DataFrame) -> Figure:
    """Draw u along the two lines (above) and its relative error (below), truncated and open."""
    figure = Figure(figsize=(8.6, 6.4), layout="constrained")
    rows = figure.subplots(2, 2, sharex="col", height_ratios=(1.0, 1.0))
    lowest, highest = 0.25 * series["exact"].min(), 3.0 * series["exact"].max()
    for letter, column, line in zip("ab", rows.T, ("y = 0", "y = x"), strict=True):
        here = pick(series, line=line)
        edge = here["r"].max()
        _profiles(column[0], pick(here, exterior="truncated"), lowest)
        _errors(column[1], here)
        column[0].set_title(f"({letter}) along ${line}$", loc="left")
        for ax in column:
            ax.axvline(edge, color="0.6", linewidth=0.8)
            ax.axvline(DISC, color="0.6", linewidth=0.8, linestyle=":")
            ax.set_xlim(0.0, 1.02 * edge)
        column[0].set(yscale="log", ylim=(lowest, highest))
        column[1].set(yscale="log", ylim=(1e-5, 60.0), xlabel="distance $r$ from the origin")
    rows[0, 0].set_ylabel(r"strength $u(r, t_f)$")
    rows[1, 0].set_ylabel(r"relative error $|u\,/\,G - 1|$")
    edge = pick(series, line="y = 0")["r"].max()
    for text, r in (("edge of\nthe square", edge), ("disc of (59)", DISC)):
        note(rows[0, 0], text, (r, 1.0), (-4, -4), color="0.4", fontsize=7.5, **_NOTE)
    schemes = list(dict.fromkeys(series["scheme"]))
    entries = [entry("exact", **UNDERLAID)]
    entries += [entry(f"{name}, truncated", **scheme_style(name)) for name in schemes]
    entries += [entry(f"{name}, open", **scheme_style(name, **_OPEN)) for name in schemes]
    legend_below(figure, entries)
    return figure


def _profiles(ax: Axes, here: pd.DataFrame, lowest: float) -> None:
    exact = pick(here, scheme=here["scheme"].iloc[0])
    ax.plot(exact["r"], exact["exact"], **UNDERLAID)
    for k, (scheme, part) in enumerate(here.groupby("scheme", sort=False)):
        every = max(1, len(part) // 12)
        look = scheme_style(scheme, markevery=(k * every // 3, every), linewidth=0.9)
        ax.plot(part["r"], part["u"].where(part["u"] > lowest), **look)


def _errors(ax: Axes, here: pd.DataFrame) -> None:
    for (scheme, exterior), part in here.groupby(["scheme", "exterior"], sort=False):
        more: Look = {"linewidth": 1.2, "markevery": max(1, len(part) // 9)}
        if exterior == "open":
            more = {**_OPEN, "linewidth": 0.9}
        ax.plot(part["r"], part["error"].abs(), **scheme_style(scheme, **more))
