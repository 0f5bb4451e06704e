"""Two panels of the error (48): the paper's truncated lattice beside the open exterior."""

from typing import Any

import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import ERROR, Axes, Figure, Look, axes_row, log_log, scheme_lines

_TITLES = {"truncated": "truncated (the paper's)", "open": "open exterior (ours)"}


def exterior_panels(series: pd.DataFrame, **options: Any) -> tuple[Figure, list[Axes]]:
    """Draw y against x, a line a scheme and order, one panel an exterior."""
    figure, axes = axes_row(list(_TITLES.values()), sharey=True, **options)
    for ax, exterior in zip(axes, _TITLES, strict=True):
        here = pick(series, exterior=exterior)
        scheme_lines(ax, here[here["scheme"] != "GPSE"])
        # On a truncated lattice it lies on KPSE of order IV.
        large: Look = {"markersize": 8.0, "markerfacecolor": "none", "zorder": 3}
        scheme_lines(ax, pick(here, scheme="GPSE"), **large)
        log_log(ax)
    axes[0].set_ylabel(ERROR)
    return figure, axes
