"""Error in time against the time step."""

from typing import Any

import numpy as np
import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import Figure, Look, axes_row, draw, entry, legend_below, log_log, scheme_style

_SIZES = (8.0, 5.5, 3.5)
_INTEGRATORS: dict[str, tuple[str, Any, int]] = {
    "euler": ("RK1", ":", 1),
    "rk2": ("RK2", "-", 2),
    "rk4": ("RK4 (ours)", "--", 4),
}


def figure(series: pd.DataFrame) -> Figure:
    """One panel a beta. The schemes lie on each other: hollow markers of three sizes."""
    betas, schemes = sorted(series["beta"].unique()), sorted(series["scheme"].unique())
    looks: dict[str, Look] = {
        scheme: scheme_style(scheme, markersize=size, markerfacecolor="none")
        for scheme, size in zip(schemes, _SIZES, strict=False)
    }
    titles, width = [rf"$\beta = {beta:g}$" for beta in betas], 4.6 if len(betas) == 1 else 3.3
    figure, axes = axes_row(titles, width=width, height=3.6, sharey=True)
    for ax, beta in zip(axes, betas, strict=True):
        here = pick(series, beta=beta).sort_values("x")
        for (scheme, integrator), points in here.groupby(["scheme", "integrator"]):
            draw(ax, points, **looks[scheme] | {"linestyle": _INTEGRATORS[integrator][1]})
        log_log(ax, xlabel=r"time step $\Delta t$")
        steps = np.sort(here["x"].unique())[::2]
        ax.set_xticks(steps, [f"1/{round(1.0 / dt)}" for dt in steps])
        ax.minorticks_off()
        for integrator, part in here.groupby("integrator"):
            lowest, order = part.groupby("x")["y"].min(), _INTEGRATORS[integrator][2]
            middle = len(lowest) // 2
            style.slope_triangle(ax, lowest.index[middle], 0.3 * lowest.iloc[middle], float(order))
    axes[0].set_ylabel("relative error in time,\nagainst the exponential")
    handles = [entry(s, **{**look, "linestyle": "none"}) for s, look in looks.items()]
    handles += [entry(name, color="0.3", linestyle=line) for name, line, _ in _INTEGRATORS.values()]
    legend_below(figure, handles)
    return figure
