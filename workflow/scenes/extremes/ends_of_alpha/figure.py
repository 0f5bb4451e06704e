"""Relative errors against the distance to the ends of alpha."""

import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import Figure, Look

_LINES: dict[str, Look] = {
    "limit": {"color": "0.45", "linestyle": "--", "label": r"Cauchy or Gauss instead of $\alpha$"},
    "evolve": {"color": style.RED, "marker": "s", "label": "evolve, against Cauchy or Gauss"},
    "density": {"color": style.BLUE, "marker": "o", "label": "density"},
    "rate": {"color": style.SKY, "marker": "v", "label": "rate of change"},
    "tail mass": {"color": style.GREEN, "marker": "^", "label": "tail mass"},
    "K": {"color": style.PINK, "marker": "D", "markersize": 3.5, "label": "kernel $K$"},
    "G": {"color": style.ORANGE, "marker": "P", "markersize": 4.5, "label": "kernel $G$"},
    "kappa": {"color": "black", "marker": "x", "markersize": 4.5, "label": r"potential $\kappa$"},
}


def figure(series: pd.DataFrame) -> Figure:
    """(a) alpha to 1, (b) alpha to 2: what the limits would leave, and what the functions leave."""
    ends = {"one": 1, "two": 2}
    titles = [rf"$\alpha \to {end}$" for end in ends.values()]
    drawn, axes = style.axes_row(titles, height=3.8, sharey=True)
    for ax, (panel, end) in zip(axes, ends.items(), strict=True):
        for name, line in _LINES.items():
            points = pick(series, panel=panel, series=name)
            if len(points):
                style.draw(ax, points, **{"markersize": 4.0, **line})
        style.log_log(ax, xlabel=rf"distance to the end, $|\alpha - {end}|$")
    axes[0].set_ylabel("relative error")
    style.guide(axes[1], (1e-15, 1e-3), (1e-15, 3e-16), 1.0, "slope 1")
    style.legend_below(drawn, axes[0], columns=4)
    return drawn
