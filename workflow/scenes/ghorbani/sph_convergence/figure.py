"""The convergence of the SPH operators."""

import numpy as np
import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import Figure, Look, axes_row, draw, entry, legend_below, log_log
from scenes.ghorbani.operators import OPERATORS, SUMS, TITLES

_PANELS = (("rl_integral", "sin"), ("caputo", "cos"), ("rl_derivative", "sin"))
_FAINT: Look = {"color": SUMS["modified"][1], "alpha": 0.35}


def figure(series: pd.DataFrame) -> Figure:
    """Draw the error (39) of each operator's worst function against s; faint: the real part of the modified sum."""
    titles = [f"{OPERATORS[operator].axis}, {TITLES[name]}" for operator, name in _PANELS]
    drawn, axes = axes_row(titles, height=3.5, width=3.1, sharey=True)
    left = pick(series, side="left").set_index(["operator", "function"]).sort_index()
    for ax, (operator, name) in zip(axes, _PANELS, strict=True):
        shown = left.loc[(operator, name)]
        for (method, order), curve in shown.groupby(["method", "order"]):
            _, colour, marker = SUMS[method]
            line = "-" if order == "constant" else "--"
            draw(ax, curve, line, color=colour, marker=marker)
            if method == "modified":
                ax.plot(curve["x"], curve["real"], line, linewidth=1.0, **_FAINT)
        log_log(ax, xlabel="particle spacing $s$")
        ticks = sorted(shown["x"].unique())
        ax.set_xticks(ticks, [f"{s:.3g}" for s in ticks], rotation=30)
        ax.minorticks_off()
        top = pick(shown, method="standard", order="constant")
        y = float(np.interp(ticks[1], top["x"][::-1], top["y"][::-1]))
        style.slope_triangle(ax, ticks[1], 0.45 * y, 1.0)
    axes[0].set_ylabel("relative error $L_2$ (39)")
    entries = [entry(label, color=colour, marker=marker) for label, colour, marker in SUMS.values()]
    entries.append(entry(r"variable $\alpha(x)$", color="0.3", linestyle="--"))
    entries.append(entry("modified (20), real part of the sum", **_FAINT))
    legend_below(drawn, entries)
    return drawn
