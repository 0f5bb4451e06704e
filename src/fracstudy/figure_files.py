"""The files of a figure: equal figures have equal bytes, whatever was drawn before."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogFormatterSciNotation, NullFormatter, NullLocator

from fracparticles.files import replacing

__all__ = ["save"]

_FORMATS: dict[str, dict[str, Any]] = {"svg": {"metadata": {"Date": None}}, "png": {"dpi": 160}}
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def save(figure: Figure, stem: str | Path, formats: Iterable[str] = _FORMATS) -> None:
    """Write <stem>.svg and <stem>.png, or one of them, each under a temporary name first."""
    stem = Path(stem)
    for ax in figure.axes:
        _plain_powers(ax.xaxis)
        _plain_powers(ax.yaxis)
    # The layout is found once, not once for each format.
    layout = figure.get_layout_engine()
    if layout is not None:
        with _without_minor_ticks(figure):
            layout.execute(figure)
        if figure.subfigs:
            _settle(figure)
        figure.set_layout_engine(None)  # the engine "none" would have the figure drawn twice
    for kind in formats:
        with replacing(stem.with_suffix(f".{kind}")) as temporary:
            figure.savefig(temporary, format=kind, **_FORMATS[kind])


@contextmanager
def _without_minor_ticks(figure: Figure) -> Iterator[None]:
    """Leave out, for a while, minor ticks without labels: the major ones are longer, and one by one they take long."""
    tickers = {axis.minor for ax in figure.axes for axis in (ax.xaxis, ax.yaxis)}
    bare = [
        (one, one.locator)
        for one in tickers
        if one.locator is not None and isinstance(one.formatter, NullFormatter)
    ]
    try:
        for ticker, _ in bare:
            ticker.locator = NullLocator()
        yield
    finally:
        for ticker, locator in bare:
            ticker.locator = locator


def _settle(figure: Figure) -> None:
    """Round the layout: depending on what was drawn before, its solver puts a corner at 0 or at -4e-16."""
    for part in figure.subfigs:
        part.bbox_relative.set_points(np.round(part.bbox_relative.get_points(), 12) + 0.0)
    for ax in figure.axes:
        ax.set_position(np.round(ax.get_position().bounds, 12) + 0.0)


def _plain_powers(axis: Axis) -> None:
    """Label a logarithmic axis of more than a decade with plain text, 10⁻⁴.

    The usual labels are formulas, and typesetting them takes longer than the rest of a figure.
    """
    low, high = sorted(axis.get_view_interval())
    if isinstance(axis.get_major_formatter(), LogFormatterSciNotation) and high > 10.0 * low > 0.0:
        axis.set_major_formatter(FuncFormatter(_power_of_ten))
        axis.set_minor_formatter(NullFormatter())


def _power_of_ten(value: float, _: int | None = None) -> str:
    exponent = round(np.log10(value))
    return f"10{str(exponent).translate(_SUPERSCRIPTS)}"
