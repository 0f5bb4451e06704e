"""The change of the total strength over time."""

import numpy as np
import pandas as pd

from fracstudy.style import Figure, Look, axes_row, border, draw, log_log, name_ticks, scheme_style

_FLOOR = float(np.finfo(float).eps) / 2.0  # a change of zero is drawn here
_OUTFLOW: Look = {"color": "black", "linewidth": 4.0, "alpha": 0.25}
_RINGS: Look = {"markerfacecolor": "none", "linestyle": "none"}
_SIZES = {"DD": 9.0, "FPSE": 7.0, "KPSE": 5.0}  # of the rings
_FREE: Look = {"markerfacecolor": "none", "linestyle": "--"}  # not remeshed


def figure(series: pd.DataFrame) -> Figure:
    """|M / M0 - 1|: round-off below, what leaves the lattice above."""
    figure, (ax,) = axes_row(1, width=6.4, height=4.2)
    series = series.sort_values("x").assign(y=series["y"].clip(lower=_FLOOR))
    moving = series["scheme"] == "DVM"
    for of_dvm, line, more in ((False, "-", ""), (True, ":", ", DVM's $D$")):
        outflow = series[moving == of_dvm].groupby("x")["outflow"].first()
        ax.plot(outflow.index, outflow, line, label=f"exact outflow{more}", **_OUTFLOW)
    groups = dict(iter(series.groupby(["exterior", "scheme"])))
    for (exterior, scheme), points in groups.items():
        if exterior == "truncated":
            draw(ax, points, **scheme_style(scheme, label=scheme))
    for scheme, size in _SIZES.items():
        if ("open", scheme) in groups:
            look = scheme_style(scheme, markersize=size, **_RINGS)
            draw(ax, groups["open", scheme], label=f"{scheme}, open exterior", **look)
    for exterior in series.loc[moving, "exterior"].sort_index().unique():
        points = groups[exterior, "DVM"]
        if len(points) > 1:  # the table has the others
            name = exterior.replace("M4'", "$M_4'$").replace("remeshing none", "no remeshing")
            look = scheme_style("DVM", **_FREE if exterior == "remeshing none" else {})
            draw(ax, points, label=f"DVM, {name}", **look)
    # Below what lies on the line, and on the floor.
    border(ax, 2.0 * _FLOOR, "one unit in the last place", shift=(0, -12), va="top")
    log_log(ax, xlabel=r"time $t_f - t_0$", ylim=(_FLOOR / 10.0, 0.1))
    ax.set_ylabel(r"change of the total strength, $|M(t_f) / M(t_0) - 1|$")
    ax.set_xlim(right=1.6 * series["x"].max())
    name_ticks(ax, sorted(series["x"].unique()))
    ax.minorticks_off()
    figure.legend(loc="outside right center")
    return figure
