"""Error (59) against the particle spacing: the paper's runs, and all schemes."""

from itertools import product

import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import COLOURS, Figure, Look, entry, note, scheme_style, slope_triangle
from scenes.plane import spacing_axes

_PAPER = ("DD", "FPSE")
_SCHEMES = ("DD", "FPSE", "KPSE", "GPSE")
_HOLLOW: Look = {"markerfacecolor": "white"}
_LEGEND: Look = {"loc": "upper left", "bbox_to_anchor": (-0.08, -0.17)}
_POINT: Look = {"color": "0.3", "marker": "o", "linestyle": ""}
_FINER: Look = {"xycoords": ("data", "axes fraction"), "ha": "right", "va": "top"}
_FINER |= {"color": "0.4", "fontsize": 7.5}
_KEY = [
    *style.legend_entries((name, None) for name in _SCHEMES),
    entry("order II", color="0.3"),
    entry("order IV", color="0.3", linestyle="--"),
    entry("truncated", **_POINT),
    entry("open", **_POINT, **_HOLLOW),
]


def figure(series: pd.DataFrame, *, particles: list[int]) -> Figure:
    """Draw (a) the paper's schemes, strengths and field (7); (b) all schemes, truncated and open."""
    series = pick(series, C=series["C"].min()).sort_values("h")
    groups = dict(iter(series.groupby(["scheme", "order", "exterior"])))
    titles = ("DD and FPSE, truncated", "all schemes")
    figure, (paper, ours) = style.axes_row(titles, width=4.3, height=4.3)
    for scheme in _PAPER:
        part = groups[scheme, "II", "truncated"]
        look = scheme_style(scheme)
        paper.plot(part["h"], part["error (59)"], label=f"{scheme}, strengths", **look)
        part = part.dropna(subset=["error of the field (7)"])
        look |= {"linestyle": "--", **_HOLLOW}
        paper.plot(part["h"], part["error of the field (7)"], label=f"{scheme}, field (7)", **look)
    dd = groups["DD", "II", "truncated"]
    for h, error in pick(dd, N=max(particles))[["h", "error (59)"]].to_numpy():
        paper.axvspan(0.5 * series["h"].min(), h / 1.3, color="0.95", zorder=0)
        note(paper, "finer than\nin the paper", (h / 1.36, 0.98), (0, 0), **_FINER)
        slope_triangle(paper, 1.1 * h, 0.4 * error, 2.0)
    spacing_axes(paper, dd["h"])

    for scheme, order, exterior in product(_SCHEMES, ("II", "IV"), ("truncated", "open")):
        key = (scheme, order, exterior)
        in_paper = scheme in _PAPER and key[1:] == ("II", "truncated")  # nearly the open ones
        if key in groups and not in_paper:
            filled = {"markerfacecolor": COLOURS[scheme]} if exterior == "truncated" else _HOLLOW
            part = groups[key]
            ours.plot(part["h"], part["error (59)"], **scheme_style(scheme, order, **filled))
    if ("GPSE", "II", "truncated") in groups:
        at = tuple(groups["GPSE", "II", "truncated"].iloc[0][["h", "error (59)"]])
        note(ours, "KPSE and GPSE,\ntruncated", at, (-6, 6), ha="left", fontsize=7.5)
    if ("KPSE", "IV", "open") in groups:
        kpse = groups["KPSE", "IV", "open"]
        h, error = kpse.iloc[len(kpse) // 2][["h", "error (59)"]]
        slope_triangle(ours, 1.1 * h, 0.25 * error, 4.0)
    spacing_axes(ours, series["h"])
    paper.set_ylabel(r"relative error $\varepsilon_{D_\varepsilon}$, Eq. (59)")
    paper.legend(ncols=2, **_LEGEND)
    ours.legend(handles=_KEY, ncols=4, **_LEGEND)
    return figure
