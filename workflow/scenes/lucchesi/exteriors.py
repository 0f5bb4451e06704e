"""Two panels of the error (48): the paper's truncated lattice beside the open exterior."""

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fracstudy.style import axes_row, log_log, panel_title, scheme_lines

ERROR = r"relative error $\varepsilon_{D_\varepsilon}$, Eq. (48)"
_TITLES = {"truncated": "truncated (the paper's)", "open": "open exterior (ours)"}


def exterior_panels(series: pd.DataFrame, **options: Any) -> tuple[Figure, list[Axes]]:
    """Draw y against x, a line a scheme and order, one panel an exterior."""
    figure, axes = axes_row(2, sharey=True, **options)
    for letter, ax, (exterior, title) in zip("ab", axes, _TITLES.items(), strict=True):
        here, green = series["exterior"] == exterior, series["scheme"] == "GPSE"
        scheme_lines(ax, series[here & ~green])
        # On a truncated lattice it lies on KPSE of order IV.
        scheme_lines(ax, series[here & green], markersize=8.0, markerfacecolor="none", zorder=3)
        log_log(ax)
        panel_title(ax, letter, title)
    axes[0].set_ylabel(ERROR)
    return figure, axes
