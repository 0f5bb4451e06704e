"""The relative error of two evaluations of the fundamental solution."""

import numpy as np
import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import BLUE, RED, Figure, Look, axes_row, entry, legend_below, log_log

_FLOOR = 2.0**-54  # where errors of zero are drawn
_CURVES: dict[str, Look] = {
    "scipy": {"color": RED, "marker": "s", "label": "scipy.stats.levy_stable"},
    "ours": {"color": BLUE, "marker": "o", "label": "ours"},
}
_ROUND_OFF: Look = {"color": "0.5", "linestyle": ":", "label": "round-off, $2^{-53}$"}


def figure(series: pd.DataFrame, *, shown: list[float]) -> Figure:
    """Draw the error against x, a panel an alpha."""
    figure, axes = axes_row(len(shown), height=3.2, width=3.0, sharey=True)
    for letter, ax, alpha in zip("abcdefgh", axes, shown, strict=False):
        here = series[np.isclose(series["alpha"], alpha) & (series["x"] > 0.0)]
        for name, style in _CURVES.items():
            curve = pick(here, series=name)
            error = curve["y"].clip(lower=_FLOOR)
            ax.plot(curve["x"], error, linewidth=0.8, markersize=3.5, **style)
        ax.axhline(2.0**-53, linewidth=0.8, **_ROUND_OFF)
        log_log(ax, ylim=(2e-17, 1e-2), xlabel="distance $x$")
        ax.set_title(rf"({letter})  $\alpha = {alpha:g}$", loc="left")
    axes[0].set_ylabel(r"relative error of $L_\alpha^0(x)$")
    styles = (_CURVES["ours"], _CURVES["scipy"], _ROUND_OFF)
    legend_below(figure, [entry(**style) for style in styles])
    return figure
