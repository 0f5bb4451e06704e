"""What the end of the lattice does to DPSE, and to the others."""

import numpy as np
import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import Axes, Figure, Look, axes_row, draw, legend_below, log_log, scheme_style

_SCALE = 1e4
_DISTANCE = r"distance from the end, $(D - x) / \epsilon$"
# FPSE lies on DPSE.
_OWN: dict[str, Look] = {"DPSE": {"linewidth": 4.0, "markersize": 8.0}}
_OWN["DD"] = {"linestyle": "--"}


def figure(series: pd.DataFrame) -> Figure:
    """Draw (a) the solution next to the end, (b) the relative error against the distance from it."""
    titles = ("at the end of the lattice", "relative error, from the centre to the end")
    figure, (end, relative) = axes_row(titles, height=3.6)
    series = series.sort_values("x")
    for scheme in ("DPSE", "FPSE", "KPSE", "DD"):
        own = {"linewidth": 1.2, "markersize": 3.5, **_OWN.get(scheme, {})}
        style = scheme_style(scheme, label=scheme, **own)
        points = pick(series, series=scheme, panel="profile")
        end.plot(points["x"], _SCALE * points["y"], **style)
        draw(relative, pick(series, series=scheme, panel="relative"), **style | {"marker": ""})
    exact = pick(series, series="KPSE", panel="profile")
    end.plot(exact["x"], _SCALE * exact["exact"], color="black", linestyle=":", label="exact")
    end.set(xlim=(15.0, -0.5), xlabel=_DISTANCE)
    end.set_ylabel(rf"solution $10^{{{np.log10(_SCALE):.0f}}} \, u(x, t_f)$")
    _enlarged(end, series)
    log_log(relative, xlabel=_DISTANCE)
    relative.invert_xaxis()
    relative.set_ylabel(r"$|u - u_{\mathrm{exact}}| \, / \, u_{\mathrm{exact}}$")
    legend_below(figure, end)
    return figure


def _enlarged(ax: Axes, series: pd.DataFrame) -> None:
    """What lies at zero there: KPSE, DD and the solution, on a scale of their own."""
    inset = ax.inset_axes((0.14, 0.62, 0.5, 0.34))
    for scheme in ("KPSE", "DD"):
        points = pick(series, series=scheme, panel="profile")
        points = points[points["x"] < 15.0]
        style = scheme_style(scheme, linewidth=1.0, markersize=2.5, **_OWN.get(scheme, {}))
        draw(inset, points, **style)
        inset.plot(points["x"], points["exact"], color="black", linestyle=":")
    inset.set(xlim=(15.0, -0.5))
    inset.ticklabel_format(axis="y", style="sci", scilimits=(0, 0), useMathText=True)
    inset.tick_params(labelsize=6)
    inset.yaxis.get_offset_text().set_fontsize(6)
