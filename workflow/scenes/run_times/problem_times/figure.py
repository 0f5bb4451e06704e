"""Error against run time: a panel a problem, a line a contender."""

from typing import Any

import pandas as pd
from matplotlib.ticker import LogLocator

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import PINK, SKY, Figure

_COLUMNS = 3
_FLOOR = 1e-14  # errors below are drawn there
_TITLES = {
    "variable diffusivity": r"$\partial_x(D(x)\,\mathrm{grad}^\beta u) + f$",
    "Ornstein-Uhlenbeck": "velocity $-x$",
    "eigenvalue": "first eigenvalue, $(-1, 1)$",
    "Getoor": r"$(-\Delta)^{\alpha/2} u = 1$, $(-1, 1)$",
    "widths 0.01 and 1": "widths 0.01 and 1",
    "widths 0.0001 and 1": "widths 0.0001 and 1",
    "drawn together, 0.01": "velocity $-x$, widths 0.01 and 1",
    "drawn together, 0.0001": "velocity $-x$, 0.0001 and 1",
    "competing, 0.01": "$f(x, t, u)$, widths 0.01 and 1",
    "competing, 0.0001": "$f(x, t, u)$, 0.0001 and 1",
    "carried round": "rotation in the plane",
}
# Okabe & Ito: schemes as everywhere, other methods of ours in theirs, peers hollow.
_LOOKS: dict[str, dict[str, Any]] = {
    "FPSE 12": style.scheme_style("FPSE"),
    "FPSE 4": style.scheme_style("FPSE", linestyle=":"),
    "DD 12": style.scheme_style("DD"),
    "DD 4": style.scheme_style("DD", linestyle=":"),
    "graded particles": {"color": SKY, "marker": "h"},
    "adaptive particles": {"color": PINK, "marker": "P"},
    "evolve, one lattice": {"color": "#000000", "marker": "*"},
    "evolve, two lattices": {"color": "#000000", "marker": "X", "linestyle": ":"},
    "Fourier, circle": {"color": "#666666", "marker": "o"},
    "rational functions": {"color": "#2E6E6E", "marker": "p"},
    "differences": {"color": "#A0522D", "marker": "v"},
    "differences, upwind": {"color": "#A0522D", "marker": "<"},
    "elements, equal": {"color": "#8A6D3B", "marker": "s"},
    "elements, graded": {"color": "#8A6D3B", "marker": "D"},
    "Jacobi polynomials": {"color": "#E69F00", "marker": "^"},
}


def figure(series: pd.DataFrame) -> Figure:
    """Draw the front of each contender; hollow with dashes are peers."""
    problems = list(series["problem"].unique())
    rows = -(-len(problems) // _COLUMNS)
    blank = [""] * (rows * _COLUMNS - len(problems))
    titles = [_TITLES[problem] for problem in problems] + blank
    drawn, axes = style.axes_row(titles, 3.1 + 1.2 / rows, 3.4, rows, sharey="row")
    for ax, problem in zip(axes, problems, strict=False):
        part = pick(series, problem=problem)
        for name, points in part[part["front"].astype(bool)].groupby("contender", sort=False):
            line = points.sort_values("time")
            ax.plot(1e3 * line["time"], line["error"].clip(lower=_FLOOR), **_look(points, name))
        style.log_log(ax, xlabel="set-up and solve / ms")
        ax.yaxis.set_major_locator(LogLocator(base=100.0, numticks=20))
        style.plain_times(ax)
    for ax in axes[::_COLUMNS]:
        ax.set_ylabel("relative error")
    for ax in axes[len(problems) :]:
        ax.set_visible(False)
    there = {name: pick(series, contender=name) for name in _LOOKS}
    entries = [
        style.entry(name, **_look(own, name)) for name, own in there.items() if not own.empty
    ]
    style.legend_below(drawn, entries, columns=5)
    style.note_below(drawn, str(series["note"].iloc[0]))
    return drawn


def _look(points: pd.DataFrame, name: Any) -> dict[str, Any]:
    look = {"markersize": 5.0, **_LOOKS[name]}
    if (points["group"] == "peer").all():
        look |= {"linestyle": "--", "markerfacecolor": "none", "linewidth": 1.0}
    return look
