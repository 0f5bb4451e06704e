"""How badly the cut-off potential approximates flux and solution."""

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from fracstudy.panels import pick
from fracstudy.style import axes_row, entry, legend_below, log_log, note, panel_title, scheme_style

_EXACT: dict[str, Any] = {"color": "black", "linewidth": 3.5, "alpha": 0.25}
_PROFILE: dict[str, dict[str, Any]] = {
    "exact": _EXACT,
    "KPSE": scheme_style("KPSE", linestyle="--", marker=""),
    "RIESZ": scheme_style("RIESZ", marker=""),
}
_LEGEND = [
    entry("exact", **_EXACT),
    entry(r"potential cut off at $\epsilon$", **scheme_style("RIESZ")),
    entry("mollified: flux (19), KPSE", **scheme_style("KPSE")),
    entry(r"numbers: $\alpha$", linestyle="none"),
]


def figure(series: pd.DataFrame, table: pd.DataFrame) -> Figure:
    """Draw (a) the flux at the largest alpha, (b) the errors of the flux, (c) those of the solution."""
    figure, axes = axes_row(3, width=3.4, height=3.6)
    profile = series[series["panel"] == "profile"]
    for name, style in _PROFILE.items():
        points = profile[profile["series"] == name]
        axes[0].plot(points["x"], points["y"], **style)
    axes[0].set(xlabel=r"position $x$", ylabel=r"flux $Q(x)$")
    panel_title(axes[0], "a", rf"flux, $\alpha = {profile['alpha'].iloc[0]:g}$")
    for letter, ax, panel in zip("bc", axes[1:], ("flux", "solution"), strict=True):
        here = pick(series, panel=panel).sort_values("x")
        for (name, alpha), points in here.groupby(["series", "alpha"]):
            style = scheme_style(name)
            ax.plot(points["x"], points["y"], **style)
            if name != "KPSE" or panel != "flux":  # much the same at every alpha
                at = (points["x"].iloc[0], points["y"].iloc[0])
                note(ax, f"{alpha:g}", at, (-5, 0), ha="right", va="center", color=style["color"])
        log_log(ax, xlabel=r"particle spacing $h = \epsilon / 2$")
        ax.set_xlim(left=here["x"].min() / 1.8)
        panel_title(ax, letter, panel)
    axes[1].set_ylabel(r"relative $L_1$ error, $|x| \leq 5 R_\alpha$")
    legend_below(figure, _LEGEND)
    return figure
