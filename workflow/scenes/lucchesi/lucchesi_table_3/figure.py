"""The stability limit against beta and the symbols behind it (Table 3)."""

import numpy as np
import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import COLOURS, MARKERS, Figure, Look, axes_row, draw, entry, legend_below

_LINES: Look = {"II": "-", "IV": "--"}
_ABOVE = {"FPSE": 0.45, "DD": 0.2, "KPSE": 0.2}  # where the name of a scheme stands over its curve
_PRINTED: Look = {"linestyle": "", "markerfacecolor": "white"}


def figure(series: pd.DataFrame, *, beta: list[float]) -> Figure:
    """Draw (a) the limit a against beta with the printed values, (b) the symbols at the middle beta."""
    figure, (left, right) = axes_row(2, height=3.6)
    panels = dict(list(series.groupby("panel")))
    curves, symbols = panels["limit"], panels["symbol"]
    for (scheme, order), curve in curves.groupby(["scheme", "order"]):
        draw(left, curve, _LINES[order], color=COLOURS[scheme])
    for scheme, points in panels.get("printed", series[:0]).groupby("scheme"):
        draw(left, points, **style.scheme_style(scheme, markersize=6, **_PRINTED))
    for scheme, above in _ABOVE.items():
        curve = pick(curves, scheme=scheme, order="II")
        y = float(np.interp(0.3, curve["x"], curve["y"]))
        left.text(0.3, y + above, scheme, color=COLOURS[scheme], ha="center", va="bottom")
    left.set(xlim=(0.0, 1.0), ylim=(0.0, None))
    left.set_xlabel(r"fractional order of the flux $\beta = \alpha - 1$")
    left.set_ylabel(r"stability limit $a = \mathcal{D}\,\Delta t / h^\alpha$")

    exact = pick(symbols, scheme="exact")
    symbols = symbols[symbols["scheme"] != "exact"]
    top = 1.25 * symbols["y"].max()
    draw(right, exact, color=COLOURS["exact"], linewidth=1.0)
    for (scheme, order), curve in symbols.groupby(["scheme", "order"]):
        draw(right, curve, _LINES[order], color=COLOURS[scheme])
        highest, colour = curve.loc[curve["y"].idxmax()], COLOURS[scheme]
        right.plot(highest["x"], highest["y"], MARKERS[scheme], clip_on=False, color=colour)
    edge = exact[exact["y"] <= top].iloc[-1]
    place = (edge["x"], edge["y"])
    style.note(
        right, r"exact, $\theta^\alpha$", place, (5, -4), va="top", color=None, fontsize=None
    )
    right.set(xlim=(0.0, np.pi), ylim=(0.0, top), xlabel=r"wavenumber $\theta = k h$")
    right.set_ylabel(r"symbol $-A(\theta)\, h^\alpha / \mathcal{D}$")
    right.set_xticks(np.pi * np.linspace(0.0, 1.0, 5), ["0", "π/4", "π/2", "3π/4", "π"])
    middle = sorted(beta)[len(beta) // 2]
    right.set_title(rf"(b)  $\beta = {middle:g}$; markers: the maximum, $2 / a$", loc="left")

    handles = [entry(s, color=COLOURS[s]) for s in sorted(_ABOVE)]
    handles += [entry(f"order {p}", color="0.3", linestyle=line) for p, line in _LINES.items()]
    handles.append(entry("printed, Table 3", color="0.3", marker="o", **_PRINTED))
    legend_below(figure, handles)
    return figure
