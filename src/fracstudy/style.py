"""One style for all figures: Okabe-Ito colours, one marker for each scheme, direct labels."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from string import ascii_lowercase
from typing import Any

import matplotlib as mpl
import matplotlib.style
import numpy as np
import pandas as pd
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from fracparticles.schemes import ALL_SCHEMES
from fracstudy.inputs import NUMERALS

__all__ = [
    "ALONG",
    "BLUE",
    "COLOURS",
    "DOTTED",
    "ERROR",
    "GREEN",
    "MARKERS",
    "ORANGE",
    "PINK",
    "RED",
    "SKY",
    "UNDERLAID",
    "Axes",
    "Figure",
    "Look",
    "axes_row",
    "border",
    "curves",
    "draw",
    "entry",
    "finest_slope",
    "guide",
    "legend_below",
    "legend_entries",
    "legend_under",
    "log_log",
    "name_ticks",
    "note",
    "note_below",
    "plain_times",
    "scheme_legend",
    "scheme_lines",
    "scheme_style",
    "slope_triangle",
    "small_legend",
]

mpl.use("Agg")
mpl.style.use(Path(__file__).with_name("fracstudy.mplstyle"))

Look = dict[str, Any]
"""The style of a line, a point or a text: keywords of matplotlib."""

# Okabe & Ito (2008); one colour and one marker for each scheme, everywhere.
BLUE, RED, GREEN = "#0072B2", "#D55E00", "#009E73"
PINK, SKY, ORANGE = "#CC79A7", "#56B4E9", "#E69F00"
COLOURS = {name: scheme.colour for name, scheme in ALL_SCHEMES.items()} | {"exact": "#000000"}
MARKERS = {name: scheme.marker for name, scheme in ALL_SCHEMES.items()} | {"exact": ""}

DOTTED: Look = {"color": "0.5", "linewidth": 0.8, "linestyle": ":"}
"""A value that means something: a limit, a border, an order."""
UNDERLAID: Look = {"color": "black", "linewidth": 3.5, "alpha": 0.25}
"""The exact solution, below what is computed."""
ERROR = r"relative error $\varepsilon_{D_\varepsilon}$, Eq. (48)"

ALONG: Look = {"xycoords": ("axes fraction", "data")}
"""The place of a text: the share of the width of the panel, and the value of y."""

_CURVES = "osD^vPX"


def axes_row(
    panels: int | Sequence[str] = 1,
    height: float = 3.4,
    width: float = 4.2,
    rows: int = 1,
    **options: Any,
) -> tuple[Figure, list[Axes]]:
    """Return a figure with one or more rows of panels, and the panels, lettered (a), (b), ... if there are several.

    `panels` is their number, or the title of each. `height` and `width` of a panel are in inches.
    """
    titles = [""] * panels if isinstance(panels, int) else panels
    columns = len(titles) // rows
    figure = Figure(figsize=(width * columns, height * rows), layout="constrained")
    axes = list(np.ravel(figure.subplots(rows, columns, **options)))
    for letter, ax, title in zip(ascii_lowercase, axes, titles, strict=False):
        if len(axes) > 1 or title:
            ax.set_title(f"({letter}) {title}".strip(), loc="left")
    return figure, axes


def draw(ax: Axes, points: pd.DataFrame, *line: str, **style: Any) -> None:
    """Draw y against x."""
    ax.plot(points["x"], points["y"], *line, **style)


def curves(
    ax: Axes, points: pd.DataFrame, *line: str, name: str | None = "{}", **style: Any
) -> None:
    """Draw a curve for each series, in order, each with its own colour and marker; `name` is the form of its label."""
    for k, (series, own) in enumerate(points.groupby("series", sort=False)):
        label = name and name.format(series)
        draw(ax, own, *line, **{"color": f"C{k}", "marker": _CURVES[k], "label": label, **style})


def log_log(ax: Axes, **more: Any) -> None:
    """Make both axes logarithmic, and set other properties that are given: labels, limits."""
    ax.set(xscale="log", yscale="log", **more)


def name_ticks(
    ax: Axes, values: Iterable[float], axis: str = "x", form: str = "g", inside: bool = False
) -> None:
    """Put ticks only at these values of an axis, as plain numbers; with `inside` only at those within the panel."""
    low, high = sorted(getattr(ax, f"get_{axis}lim")())
    named = {v: f"{v:{form}}" for v in values if not inside or low <= v <= high}
    ax.set(**{f"{axis}ticks": list(named), f"{axis}ticklabels": list(named.values())})
    getattr(ax, f"{axis}axis").minorticks_off()


def plain_times(ax: Axes) -> None:
    """Label a logarithmic axis of times by plain numbers: powers of ten, 0.1, 1, 10; on a short axis 2 and 5, too."""
    low, high = ax.get_xlim()
    ax.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 20 * low else (1,), numticks=8))
    ax.xaxis.set_major_formatter(FuncFormatter(lambda time, _: f"{time:g}"))
    ax.xaxis.set_minor_formatter(NullFormatter())


def note(ax: Axes, text: str, at: tuple[Any, Any], shift: tuple[float, float], **more: Any) -> None:
    """Write a text in small print, `shift` points from a place."""
    style = {"color": "0.3", "fontsize": 8, "textcoords": "offset points", **more}
    ax.annotate(text, at, xytext=shift, **style)


def border(ax: Axes, value: float, text: str = "", along: float = 1.0, **more: Any) -> None:
    """Draw a dotted line at a value of y, with its name above in small print; the name ends at `along` the panel."""
    ax.axhline(value, **DOTTED)
    if text:
        shift, style = more.pop("shift", (0, 2)), {**ALONG, "ha": "right", "color": "0.35", **more}
        note(ax, text, (along, value), shift, **style)


def scheme_style(scheme: str, order: int | str | None = None, **more: Any) -> dict[str, Any]:
    """Return the line of a scheme: its colour and marker; solid and filled for order 2 or none, dashed and open beyond.

    Parameters
    ----------
    scheme : str
        A scheme, or "exact".
    order : int or str, optional
        2, 4, ..., or as the paper writes them.
    **more
        Other properties of the line, or other values of these.
    """
    colour, low = COLOURS[scheme], order in (None, 2, "II")
    line = {"linestyle": "-" if low else "--", "markerfacecolor": colour if low else "white"}
    return {"color": colour, "marker": MARKERS[scheme], **line, **more}


def scheme_lines(ax: Axes, frame: pd.DataFrame, x: str = "x", y: str = "y", **more: Any) -> None:
    """Draw one column against another, with a line in `scheme_style` for each scheme and order."""
    for (scheme, order), points in frame.sort_values(x).groupby(["scheme", "order"]):
        ax.plot(points[x], points[y], **scheme_style(scheme, order, **more))


def entry(label: str, **style: Any) -> Line2D:
    """Return an entry of a legend."""
    return Line2D([], [], label=label, **style)


def legend_entries(pairs: pd.DataFrame | Iterable[tuple[str, int | str | None]]) -> list[Line2D]:
    """Return an entry for each scheme and order; those of a frame are in its columns `scheme` and `order`.

    The order is not named if it is None, nor for GPSE, which has none.
    """
    if isinstance(pairs, pd.DataFrame):
        pairs = sorted(pairs.groupby(["scheme", "order"]).groups)
    entries = []
    for scheme, order in pairs:
        words = [scheme]
        if order is not None and scheme != "GPSE":
            words.append(order if isinstance(order, str) else NUMERALS[order])
        entries.append(entry(" ".join(words), **scheme_style(scheme, order)))
    return entries


def scheme_legend(
    figure: Figure,
    pairs: pd.DataFrame | Iterable[tuple[str, int | str | None]],
    extra: Iterable[Line2D] = (),
) -> None:
    """Put a legend of schemes and orders, see `legend_entries`, and of extra entries below the panels."""
    legend_below(figure, [*legend_entries(pairs), *extra])


def small_legend(ax: Axes, place: Any, **more: Any) -> None:
    """Put a legend in small print at a place within the panel."""
    ax.legend(loc=place, **{"fontsize": 7, **more})


def legend_below(
    figure: Figure, entries: Axes | Sequence[Artist], columns: int | None = None
) -> None:
    """Put one frameless legend below the panels, of the entries given or those of a panel; all in a row by default."""
    handles = entries.get_legend_handles_labels()[0] if isinstance(entries, Axes) else list(entries)
    ncols = len(handles) if columns is None else columns
    figure.legend(handles=handles, loc="outside lower center", ncols=ncols)


def legend_under(ax: Axes, columns: int = 2, **more: Any) -> None:
    """Put a legend below one panel of several."""
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=columns, **more)


def note_below(figure: Figure, text: str) -> None:
    """Write a note, such as the machine, in small print: above the legend, or below the panels without one."""
    if not figure.legends:
        figure.supxlabel(text, fontsize=7, color="0.4")
        return
    legend = figure.legends[-1]
    legend.set_title(text)
    legend.get_title().set(fontsize=7, color="0.4")


def slope_triangle(ax: Axes, x: float, y: float, slope: float, above: bool = False) -> None:
    """Draw a triangle of a slope on log-log axes beside the point (x, y) of a rising curve.

    A triangle below the curve has its right angle at the lower right, one above it at the upper left. `x` is the left
    corner.
    """
    right, top = 2.0 * x, y * 2.0**slope
    corner = (x, top) if above else (right, y)
    ax.plot([x, right, corner[0], x], [y, top, corner[1], y], color="0.35", linewidth=0.8)
    ax.annotate(
        f"{slope:g}".replace("-", "−"),
        (corner[0], np.sqrt(y * top)),
        xytext=(-4 if above else 4, 0),
        textcoords="offset points",
        ha="right" if above else "left",
        va="center",
        color="0.25",
        fontsize=8,
    )


def finest_slope(ax: Axes, errors: pd.DataFrame, order: float) -> bool:
    """Draw the triangle of an order above the finest piece of a curve, if this is the steepest: it is at no floor."""
    h, error = errors.sort_values("x")[["x", "y"]].to_numpy().T
    slopes = np.diff(np.log(error)) / np.diff(np.log(h))
    steepest = slopes.size > 0 and slopes.argmax() == 0
    if steepest:
        slope_triangle(ax, h[0], 1.8 * error[0], order, above=True)
    return bool(steepest)


def guide(
    ax: Axes, x: Sequence[float], through: tuple[float, float], slope: float, label: str = ""
) -> None:
    """Draw a dotted line of a slope on log-log axes between two `x`, through a point, with a label at its upper end."""
    ends = np.array([min(x), max(x)])
    y = through[1] * (ends / through[0]) ** slope
    ax.plot(ends, y, color="0.45", linewidth=0.9, linestyle=":")
    upper = int(np.argmax(y))
    note(ax, label, (ends[upper], y[upper]), (0, 4), ha=("left", "right")[upper])
