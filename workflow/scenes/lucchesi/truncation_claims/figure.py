"""Sec. 4.2: the truncation errors of KPSE and GPSE on the closed form."""

import pandas as pd

from fracstudy import style
from fracstudy.style import COLOURS, ERROR, Figure, Look, axes_row, entry, scheme_style

_SHOWN = {"KPSE II": ("KPSE", "II"), "KPSE IV": ("KPSE", "IV"), "GPSE": ("GPSE", "II")}
_PREDICTED: Look = {"color": "0.6", "linewidth": 4}
_EITHER: Look = {"color": "0.3", "marker": "o", "linestyle": "none"}


def figure(series: pd.DataFrame) -> Figure:
    """Draw one panel a beta: filled markers for the truncated lattice, open ones for the open exterior."""
    betas = sorted(series["beta"].unique())
    titles = [rf"$\beta = {beta:g}$" for beta in betas]
    figure, axes = axes_row(titles, width=3.2, height=3.2, sharey=True)
    key = ["beta", "variable", "scheme", "order"]
    curves = series.sort_values("C").set_index(key)[["C", "value"]].sort_index(kind="stable")
    for ax, beta in zip(axes, betas, strict=True):
        here = curves.loc[beta]
        ax.plot(*here.loc["predicted", "GPSE"].T.to_numpy(), solid_capstyle="round", **_PREDICTED)
        for scheme, order in _SHOWN.values():
            for variable, face in (("truncated", COLOURS[scheme]), ("open", "none")):
                points = here.loc[variable, scheme, order].T.to_numpy()
                ax.plot(*points, **scheme_style(scheme, order, markerfacecolor=face))
        style.log_log(ax, xlabel="truncation factor $C$")
        style.name_ticks(ax, sorted(here["C"].unique())[::2])
    axes[0].set_ylabel(ERROR)
    filled = {name: {"markerfacecolor": COLOURS[scheme]} for name, (scheme, _) in _SHOWN.items()}
    handles = [entry(name, **scheme_style(*of, **filled[name])) for name, of in _SHOWN.items()]
    handles += [
        entry("truncated", **_EITHER),
        entry("open exterior", markerfacecolor="none", **_EITHER),
        entry(r"predicted, $\propto C^{-\alpha}$", **_PREDICTED),
    ]
    style.legend_below(figure, handles)
    return figure
