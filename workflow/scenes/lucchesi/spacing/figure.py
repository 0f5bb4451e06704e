"""Figs. 3b, 4b, 5b: error (48) against the particle spacing h."""

import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import COLOURS, Figure, Look, draw, entry, scheme_legend, slope_triangle
from scenes.lucchesi.exteriors import exterior_panels

_RING: Look = {"linestyle": "none", "marker": "o", "markersize": 9}
_RING |= {"markerfacecolor": "none", "alpha": 0.6, "color": COLOURS["KPSE"]}


def figure(series: pd.DataFrame) -> Figure:
    """Draw the errors with slope triangles, and rings where the integration is exact in time."""
    exact = series["integrator"] == "exponential"
    rings, series = series[exact].sort_values(["order", "x"]), series[~exact]
    figure, axes = exterior_panels(series)
    for ax, exterior, lowest in zip(axes, ("truncated", "open"), ("DD", "KPSE"), strict=True):
        here = pick(series, exterior=exterior).sort_values("x")
        # A triangle above the uppermost curve of order II, one below the lowest of order IV.
        for scheme, order, shift in (("FPSE", 2, 3.0), (lowest, 4, 0.2)):
            points = pick(here, scheme=scheme, order=order)
            for _, middle in points.iloc[len(points) // 2 :].head(1).iterrows():
                slope_triangle(ax, middle["x"], shift * middle["y"], order, above=order == 2)
        ax.set(xlabel=r"particle spacing $h$", xlim=(here["x"].min() / 1.3, here["x"].max() * 1.3))
    draw(axes[0], rings, **_RING)
    scheme_legend(figure, series, [entry("KPSE, exact in time", **_RING)])
    return figure
