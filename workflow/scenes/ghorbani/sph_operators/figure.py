"""An SPH operator on the four functions: Figs. 3 to 9."""

import numpy as np
import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import Axes, Figure, Look, entry, legend_below
from scenes.ghorbani.operators import OPERATORS, SUMS, TITLES

_LEAST = 1e-9  # a smaller error, where a curve happens to cross zero, is not drawn
_HOLLOW: Look = {"marker": "o", "linestyle": "", "markerfacecolor": "none"}
_HOLLOW["color"] = SUMS["standard"][1]


def figure(series: pd.DataFrame, *, operator: str) -> Figure:
    """Draw, a column for each function, the operator and the absolute error (38) of the three sums."""
    names = list(dict.fromkeys(series["function"]))
    drawn = Figure(figsize=(2.5 * len(names), 4.9), layout="constrained")
    axes = drawn.subplots(2, len(names), sharex=True, squeeze=False, height_ratios=(1.0, 1.15))
    for (upper, lower), name in zip(axes.T, names, strict=True):
        curves = dict(tuple(pick(series, function=name).groupby("method")))
        standard = curves["standard"]
        finite = standard[np.isfinite(standard["exact"])]
        upper.plot(finite["x"], finite["exact"], color="black")
        some = standard.iloc[:: max(1, len(standard) // 40)]
        upper.plot(some["x"], some["sph"], markersize=3.0, markeredgewidth=0.8, **_HOLLOW)
        upper.set_title(TITLES[name])
        _keep_in_view(upper, finite["exact"].to_numpy())
        for method, (_, colour, _) in SUMS.items():
            curve = curves[method]
            error = curve["error"].where(curve["error"] > _LEAST)
            # Wide and below the others: where f'(0) = 0 the first two are the same.
            width = 2.4 if method == "standard" else 1.0
            lower.plot(curve["x"], error, color=colour, linewidth=width)
        lower.set(yscale="log", xlabel="$x$")
        lower.minorticks_off()
    axes[0, 0].set_ylabel(OPERATORS[operator].axis)
    axes[1, 0].set_ylabel("absolute error (38)")
    entries = [
        entry("closed form", color="black"),
        entry("SPH, standard", markersize=3.5, **_HOLLOW),
        *(entry(label, color=colour) for label, colour, _ in SUMS.values()),
    ]
    legend_below(drawn, entries)
    return drawn


def _keep_in_view(ax: Axes, exact: np.ndarray) -> None:
    """A derivative that is infinite at x = 0 would leave nothing of the rest: cut at the 99th percentile."""
    low, high = np.percentile(exact, [0.5, 99.5])
    room = 0.08 * (high - low)
    ax.set_ylim(low - room, high + room)
