"""The self-similar profile over many decades of time, from the same kind of particles."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from fracstudy.panels import pick
from fracstudy.style import axes_row, guide, legend_below, log_log, panel_title

_LOOKS = (("#0072B2", "o"), ("#D55E00", "s"), ("#009E73", "^"), ("#CC79A7", "D"))


def figure(series: pd.DataFrame, table: pd.DataFrame, *, betas: list[float]) -> Figure:
    """(a) the profile, scaled; (b) the error relative to its peak."""
    drawn, (profile, error) = axes_row(2, height=3.6)
    alpha = 1.0 + (betas[0] if len(betas) == 1 else betas[1])
    seen, distance = series[series["x"] > 1e-2], r"scaled distance $|x|\, t^{-1/\alpha}$"
    profiles = pick(seen, panel="profile").groupby("series")
    for (ratio, points), (colour, marker) in zip(profiles, _LOOKS, strict=False):
        profile.plot(points["x"], points["exact"], color="#000000", linewidth=0.8)
        look: dict[str, Any] = {"color": colour, "marker": marker, "linestyle": "none"}
        label = rf"$t_f / t_0 = 10^{{{np.log10(ratio):.0f}}}$"
        profile.plot(points["x"], points["y"], label=label, markevery=4, markersize=3.5, **look)
        misses = pick(seen, panel="error", series=ratio)
        error.plot(misses["x"], misses["y"], color=colour, linewidth=0.9)
    strength = r"scaled strength $t^{1/\alpha} u$"
    log_log(profile, xlabel=distance, ylabel=strength, ylim=(1e-12, 1.0))
    log_log(error, xlabel=distance, ylabel="error / peak")
    guide(profile, (30.0, 3000.0), (30.0, 30.0 ** (-1.0 - alpha)), -1.0 - alpha)
    panel_title(profile, "a", rf"line: exact; markers: graded particles, $\alpha = {alpha:g}$")
    panel_title(error, "b", "error of the graded particles")
    legend_below(drawn, profile)
    return drawn
