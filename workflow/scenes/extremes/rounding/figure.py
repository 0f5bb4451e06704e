"""How far the mass drifts."""

import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import Figure, Look

_LOOK: dict[str, Look] = {
    "float32": {"color": style.RED, "marker": "s"},
    "float64, step by step": {"color": style.BLUE, "marker": "o"},
    "float64, one series": {"color": style.GREEN, "marker": "^"},
    "float64, compensated": {"color": style.PINK, "marker": "D"},
    "eps sqrt(n)": {"color": "0.5", "linestyle": ":", "label": "ε √n"},
    "eps n N": {"color": "0.5", "linestyle": "--", "label": "ε n N"},
}


def figure(series: pd.DataFrame) -> Figure:
    """Draw the relative drift of the mass against the number of steps, between the two laws."""
    drawn, (ax,) = style.axes_row(1, height=3.8, width=5.4)
    for name, look in _LOOK.items():
        style.draw(ax, pick(series, series=name), **{"label": name, **look})
    style.log_log(ax, xlabel="number of steps, n", ylabel="relative drift of the mass")
    style.legend_below(drawn, ax, columns=3)
    return drawn
