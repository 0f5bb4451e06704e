"""How badly the cut-off potential approximates flux and solution."""

import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import UNDERLAID, Figure, Look, axes_row, draw, entry, scheme_style

_PROFILE: dict[str, Look] = {
    "exact": UNDERLAID,
    "KPSE": scheme_style("KPSE", linestyle="--", marker=""),
    "RIESZ": scheme_style("RIESZ", marker=""),
}
_LEGEND = [
    entry("exact", **UNDERLAID),
    entry(r"potential cut off at $\epsilon$", **scheme_style("RIESZ")),
    entry("mollified: flux (19), KPSE", **scheme_style("KPSE")),
    entry(r"numbers: $\alpha$", linestyle="none"),
]


def figure(series: pd.DataFrame) -> Figure:
    """Draw (a) the flux at the largest alpha, (b) the errors of the flux, (c) those of the solution."""
    profile = pick(series, panel="profile")
    titles = (rf"flux, $\alpha = {profile['alpha'].iloc[0]:g}$", "flux", "solution")
    figure, axes = axes_row(titles, width=3.4, height=3.6)
    for name, look in _PROFILE.items():
        draw(axes[0], pick(profile, series=name), **look)
    axes[0].set(xlabel=r"position $x$", ylabel=r"flux $Q(x)$")
    for ax, panel in zip(axes[1:], titles[1:], strict=True):
        here = pick(series, panel=panel).sort_values("x")
        for (name, alpha), points in here.groupby(["series", "alpha"]):
            look = scheme_style(name)
            draw(ax, points, **look)
            if name != "KPSE" or panel != "flux":  # much the same at every alpha
                at = (points["x"].iloc[0], points["y"].iloc[0])
                style.note(
                    ax, f"{alpha:g}", at, (-5, 0), ha="right", va="center", color=look["color"]
                )
        style.log_log(ax, xlabel=r"particle spacing $h = \epsilon / 2$")
        ax.set_ylabel(rf"relative $L_1$ error of the {panel}, $|x| \leq 5 R_\alpha$")
        ax.set_xlim(left=here["x"].min() / 1.8)
    style.legend_below(figure, _LEGEND)
    return figure
