"""Operator applications and error over the stiffness, for each way of the time integration."""

import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.probe import EPS
from fracstudy.style import Figure, Look

_LARGE: Look = {"markersize": 8.0, "markerfacecolor": "none"}
_LOOK: dict[str, Look] = {
    "rk2, stepping": {"color": style.RED, "marker": "s"},
    "stabilised": {"color": style.PINK, "marker": "D"},
    "rk2, series": {"color": style.GREEN, "marker": "^", **_LARGE},
    "exponential": {"color": style.BLUE, "marker": "o", "markersize": 3.5},
}
_LABELS = {"applications": "operator applications", "error": "relative error"}


def figure(series: pd.DataFrame) -> Figure:
    """Draw (a) applications and (b) errors of KPSE; ways that take too many applications have no error."""
    drawn, axes = style.axes_row(("work", "error"), height=3.6)
    for ax, (panel, label) in zip(axes, _LABELS.items(), strict=True):
        for way, look in _LOOK.items():
            style.draw(ax, pick(series, panel=panel, series=way), label=way, **look)
        style.log_log(ax, xlabel=r"stiffness $T\,|\lambda|$", ylabel=label)
    least, most = series["x"].min(), series["x"].max()
    bound = least, 64.0 * EPS * least
    style.guide(axes[1], (least, most), bound, 1.0, r"$64\,T\,|\lambda|\,\epsilon$")
    style.legend_below(drawn, axes[0])
    return drawn
