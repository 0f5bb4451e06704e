"""Errors on a cube, against h and against the work."""

import pandas as pd
from matplotlib.lines import Line2D

from fracstudy import style
from fracstudy.inputs import NUMERALS
from fracstudy.panels import pick
from fracstudy.style import COLOURS, Axes, Figure, Look, axes_row, entry, legend_below, log_log

# The truncated points are hollow and larger, so that an open one that agrees fills it.
_SIZES = {"truncated": 7.0, "open": 3.6}
_NAMES = {"truncated": "truncated", "open": "open exterior"}
_TRIANGLES = (("FPSE", 2, "truncated", 1.9), ("KPSE", 4, "open", 0.45))
_SMALL: Look = {"xycoords": ("data", "axes fraction"), "ha": "center", "fontsize": 7.5}
_SMALL["color"] = COLOURS["GPSE"]
_ARROW = {"arrowstyle": "-|>", "color": COLOURS["GPSE"], "shrinkB": 0.0}


def figure(series: pd.DataFrame) -> Figure:
    """Draw (a) the error against h, (b) the error against the floating-point operations of the run."""
    figure, axes = axes_row(2, height=4.6, width=4.4, sharey=True)
    series = series.sort_values("h")
    # GPSE with the open exterior has errors so small that the rest would be crowded: they are named instead.
    small = (series["scheme"] == "GPSE") & (series["exterior"] == "open")
    errors = series.loc[~small, "error"]
    curves = series[~small].groupby(["scheme", "order", "exterior"])
    for ax, x in zip(axes, ("h", "work"), strict=True):
        for key, points in curves:
            ax.plot(points[x], points["error"], **_look(*key))
        log_log(ax, ylim=(0.05 * errors.min(), 2.5 * errors.max()))
        _name_below(ax, series[small], x)
    _sizes(axes[0], series)
    for scheme, order, exterior, shift in _TRIANGLES:
        points = pick(series, scheme=scheme, order=order, exterior=exterior)
        if len(points) > 1:
            h, error = points.iloc[0][["h", "error"]]
            style.slope_triangle(axes[0], h, shift * error, order, above=order == 2)
    axes[0].set_ylabel(r"relative error in the ball $|x| \leq 5$, Eq. (59)")
    axes[1].set_xlabel("floating-point operations of the run")
    legend_below(figure, _entries(series), columns=5)
    return figure


def _look(scheme: str, order: int, exterior: str) -> Look:
    face = "none" if exterior == "truncated" else COLOURS[scheme]
    return style.scheme_style(scheme, order, markersize=_SIZES[exterior], markerfacecolor=face)


def _name_below(ax: Axes, points: pd.DataFrame, x: str) -> None:
    """Write errors below the axes at their places, each with an arrow down."""
    for place, error in zip(points[x], points["error"], strict=True):
        mantissa, exponent = f"{error:.0e}".split("e")
        text = rf"${mantissa} \cdot 10^{{{int(exponent)}}}$"
        arrow = {"xytext": (place, 0.07), "textcoords": _SMALL["xycoords"], "arrowprops": _ARROW}
        ax.annotate(text, (place, 0.0), **_SMALL, **arrow)
    if len(points):
        middle = (points[x].min() * points[x].max()) ** 0.5
        ax.annotate("GPSE, open", (middle, 0.13), **_SMALL)


def _sizes(ax: Axes, series: pd.DataFrame) -> None:
    """Name the spacings by the particles in each direction."""
    ticks = series.groupby("N")["h"].first()
    ax.set_xticks(ticks, [f"{h:.2g}\n{n}³" for n, h in ticks.items()])
    ax.minorticks_off()
    ax.set_xlim(0.8 * ticks.min(), 1.25 * ticks.max())
    ax.set_xlabel("particle spacing $h$, and number of particles")


def _entries(series: pd.DataFrame) -> list[Line2D]:
    entries = []
    groups = series.groupby(["scheme", "order"]).groups
    for scheme, order in sorted(groups, key=lambda group: (group[0] == "GPSE", group)):
        name = scheme if scheme == "GPSE" else f"{scheme} {NUMERALS[order]}"
        entries.append(entry(name, **_look(scheme, order, "open") | {"markersize": 4.5}))
    if len(entries) % 2:
        entries.append(entry(" ", linestyle="none"))  # columns of two
    point = {"color": "0.3", "marker": "o", "linestyle": "none"}
    for exterior, face in (("truncated", "none"), ("open", "0.3")):
        size = _SIZES[exterior]
        entries.append(entry(_NAMES[exterior], markersize=size, markerfacecolor=face, **point))
    return entries
