"""One style for all figures: Okabe-Ito colours, one marker a scheme, direct labels."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogFormatterSciNotation, NullFormatter

from fracparticles.files import replacing

__all__ = ["COLOURS", "MARKERS", "axes_row", "legend_below", "note_below", "save", "slope_triangle"]

mpl.use("Agg")
mpl.style.use(Path(__file__).with_name("fracstudy.mplstyle"))

# Okabe & Ito (2008), one colour and one marker for each scheme, everywhere; DVM's is not theirs.
COLOURS = {
    "DD": "#0072B2",
    "FPSE": "#D55E00",
    "KPSE": "#009E73",
    "GPSE": "#CC79A7",
    "DVM": "#7F3C8D",  # their yellow is too pale for lines
    "FD": "#56B4E9",
    "DPSE": "#E69F00",
    "PSE29": "#999999",
    "RIESZ": "#8A6D3B",
    "exact": "#000000",
}
MARKERS = {
    "DD": "o",
    "FPSE": "s",
    "KPSE": "^",
    "GPSE": "D",
    "DVM": "p",
    "FD": "v",
    "DPSE": "P",
    "PSE29": "X",
    "RIESZ": "*",
    "exact": "",
}

_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def axes_row(
    panels: int = 1, height: float = 3.4, width: float = 4.2, **options: Any
) -> tuple[Figure, list[Axes]]:
    """Return a figure with a row of panels, lettered (a), (b), ... if there is more than one."""
    figure = Figure(figsize=(width * panels, height), layout="constrained")
    axes = list(np.atleast_1d(figure.subplots(1, panels, **options)))
    if panels > 1:
        for letter, ax in zip("abcdefgh", axes, strict=False):
            ax.set_title(f"({letter})", loc="left")
    return figure, axes


def legend_below(figure: Figure, ax: Axes, columns: int = 4) -> None:
    """Put one frameless legend, with the entries of `ax`, below the panels."""
    handles, labels = ax.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=columns)


def note_below(figure: Figure, note: str) -> None:
    """Write what was timed, and on what machine, in small print: above the legend, or below the panels without one."""
    if not figure.legends:
        figure.supxlabel(note, fontsize=7, color="0.4")
        return
    legend = figure.legends[-1]
    legend.set_title(note)
    legend.get_title().set(fontsize=7, color="0.4")


def slope_triangle(ax: Axes, x: float, y: float, slope: float, above: bool = False) -> None:
    """Draw a triangle of that slope on log-log axes beside the point (x, y) of a rising curve.

    Below the curve the right angle is at the lower right, above it at the upper left; `x` is the left corner.
    """
    right, top = 2.0 * x, y * 2.0**slope
    corner = (x, top) if above else (right, y)
    ax.plot([x, right, corner[0], x], [y, top, corner[1], y], color="0.35", linewidth=0.8)
    ax.annotate(
        f"{slope:g}",
        (corner[0], np.sqrt(y * top)),
        xytext=(-4 if above else 4, 0),
        textcoords="offset points",
        ha="right" if above else "left",
        va="center",
        color="0.25",
        fontsize=8,
    )


def save(figure: Figure, stem: str | Path) -> None:
    """Write <stem>.svg and <stem>.png, each under a temporary name first."""
    stem = Path(stem)
    for ax in figure.axes:
        _plain_powers(ax.xaxis)
        _plain_powers(ax.yaxis)
    # The layout is found once, not once for each format.
    layout = figure.get_layout_engine()
    if layout is not None:
        layout.execute(figure)
        figure.set_layout_engine("none")
    for suffix, options in ((".svg", {"metadata": {"Date": None}}), (".png", {"dpi": 160})):
        with replacing(stem.with_suffix(suffix)) as temporary:
            figure.savefig(temporary, format=suffix[1:], **options)


def _plain_powers(axis: Axis) -> None:
    """Label a logarithmic axis of more than a decade with plain text, 10⁻⁴.

    The usual labels are formulas, and to typeset them takes longer than all else in a figure.
    """
    low, high = sorted(axis.get_view_interval())
    if isinstance(axis.get_major_formatter(), LogFormatterSciNotation) and high > 10.0 * low > 0.0:
        axis.set_major_formatter(FuncFormatter(_power_of_ten))
        axis.set_minor_formatter(NullFormatter())


def _power_of_ten(value: float, _: int | None = None) -> str:
    exponent = round(np.log10(value))
    return f"10{str(exponent).translate(_SUPERSCRIPTS)}"
