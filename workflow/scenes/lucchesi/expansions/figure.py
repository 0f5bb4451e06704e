"""Figs A.10-A.12: the reduced Green's function and its two representations."""

import matplotlib as mpl
import numpy as np
import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import COLOURS, Figure, Look, axes_row, border, entry, legend_below, log_log

_FLOOR = 2.0**-54  # where errors of zero are drawn
_CEILING = 1e6  # above both panels, below where the axes would overflow
_SUMS = {"series": ("Blues", "(A.1), K"), "asymptotic": ("Oranges", "(A.2), A")}
_EXACT: Look = {"color": COLOURS["exact"], "linewidth": 3.0, "alpha": 0.25}
_SYMBOLS: Look = {"linestyle": "", "markersize": 4, "markerfacecolor": "white"}


def figure(series: pd.DataFrame, *, alpha: float) -> Figure:
    """Draw the function, partial sums of (A.1) as lines and of (A.2) as symbols, and their errors."""
    figure, (left, right) = axes_row(2, height=3.7)
    exact = pick(series, series="exact").set_index("x")["y"]
    left.plot(exact.index, exact, **_EXACT)
    entries = [entry(r"$L_\alpha^0$", **_EXACT)]
    for name, (palette, symbol) in _SUMS.items():
        curves = pick(series, series=name).groupby("terms")
        shades = mpl.colormaps[palette](np.linspace(0.45, 0.95, len(curves)))
        for (terms, curve), colour, marker in zip(curves, shades, "os^Dv", strict=False):
            y = curve["y"].to_numpy()
            error = np.abs(y / exact.to_numpy() - 1.0)
            symbols = {} if name == "series" else {**_SYMBOLS, "marker": marker}
            style: Look = {"color": colour, **symbols}
            every: Look = {"markevery": 7} if symbols else {}
            inside = np.where((y > 0.0) & (y < _CEILING), y, np.nan)
            left.plot(curve["x"], inside, **style, **every)
            right.plot(curve["x"], np.clip(error, _FLOOR, _CEILING), **style, **every)
            entries.append(entry(f"{symbol} = {terms}", **style))
    border(right, 1e-3)
    for ax in (left, right):
        log_log(ax, xlim=(0.1, 30.0), xlabel="distance $x$")
    left.set_ylim(0.3 * exact.min(), 8.0 * exact.max())
    left.set_ylabel(r"reduced Green's function $L_\alpha^0(x)$")
    right.set(ylim=(1e-16, 10.0), ylabel="relative error of the partial sum")
    left.set_title(rf"(a)  $\alpha = {alpha:g}$", loc="left")
    legend_below(figure, entries, 5)
    return figure
