"""Error (48) against the overlap epsilon / h."""

import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import Figure, Look, name_ticks, note, scheme_legend, slope_triangle
from scenes.lucchesi.exteriors import exterior_panels

_INSIDE: Look = {"xycoords": ("data", "axes fraction"), "ha": "right", "va": "bottom"}


def figure(series: pd.DataFrame, *, shown_beta: float) -> Figure:
    """The paper's truncated lattice beside the open exterior; shaded where the kernels do not overlap."""
    series = pick(series, beta=shown_beta)
    figure, axes = exterior_panels(series, height=3.6, sharex=True)
    low, high = series["x"].min() / 1.12, series["x"].max() * 1.12
    for ax in axes:
        ax.axvspan(low, 1.0, color="0.92", zorder=0)
        ax.set(xlabel=r"overlap $\epsilon / h$", xlim=(low, high))
        name_ticks(ax, [s for s in (0.5, 1, 2, 4, 8) if low < s < high])
        note(ax, r"$\epsilon < h$", (1.0, 0.0), (-4, 4), color="0.35", fontsize=None, **_INSIDE)
    opened = pick(series, exterior="open")
    # A triangle above the uppermost curve of order II, one below the lowest of order IV.
    for scheme, order, shift in (("FPSE", 2, 1.8), ("KPSE", 4, 0.5)):
        points = pick(opened, scheme=scheme, order=order)
        point = points.iloc[(points["x"] - 3.0).abs().argmin()]
        slope_triangle(axes[1], point["x"], shift * point["y"], float(order), order == 2)
    scheme_legend(figure, opened)
    return figure
