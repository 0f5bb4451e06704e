"""The self-similar profile over many decades of time, from the same kind of particles."""

import numpy as np
import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import Figure

_LOOKS = ((style.BLUE, "o"), (style.RED, "s"), (style.GREEN, "^"), (style.PINK, "D"))


def figure(series: pd.DataFrame, *, betas: list[float]) -> Figure:
    """(a) the profile, scaled; (b) the error relative to its peak."""
    alpha = 1.0 + (betas[0] if len(betas) == 1 else betas[1])
    of_profile = rf"line: exact; markers: graded particles, $\alpha = {alpha:g}$"
    titles = (of_profile, "error of the graded particles")
    drawn, (profile, error) = style.axes_row(titles, height=3.6)
    seen, distance = series[series["x"] > 1e-2], r"scaled distance $|x|\, t^{-1/\alpha}$"
    profiles = pick(seen, panel="profile").groupby("series")
    for (ratio, points), (colour, marker) in zip(profiles, _LOOKS, strict=False):
        profile.plot(points["x"], points["exact"], color="black", linewidth=0.8)
        look = {"color": colour, "markevery": 4, "markersize": 3.5}
        label = rf"$t_f / t_0 = 10^{{{np.log10(ratio):.0f}}}$"
        style.draw(profile, points, marker, label=label, **look)
        style.draw(error, pick(seen, panel="error", series=ratio), color=colour, linewidth=0.9)
    style.log_log(profile, xlabel=distance, ylabel=r"scaled strength $t^{1/\alpha} u$")
    profile.set_ylim(1e-12, 1.0)
    style.log_log(error, xlabel=distance, ylabel="error / peak")
    fall, near = -1.0 - alpha, 30.0
    style.guide(profile, (near, 3000.0), (near, near**fall), fall, rf"slope ${fall:g}$")
    style.legend_below(drawn, profile)
    return drawn
