"""Errors of the forms on the line and in the plane, and the two equations."""

import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import COLOURS, MARKERS, Axes, Figure

_TITLES = ("error, line", "error, plane", "the two equations", "distance between the two")
_MEAN = r"$(D\,Lu + L(Du) - u\,LD)/2$, limit of the exchange"
_FORMS = (
    style.entry(r"$\mathrm{div}(D\,\mathrm{grad}^\beta u)$", color="0.2", marker=""),
    style.entry(_MEAN, color="0.2", marker="", linestyle=":"),
)
_SCHEMES = {"FPSE": "FPSE", "DD": "DD", "exchange": "KPSE"}


def figure(series: pd.DataFrame) -> Figure:
    """Draw (a), (b) errors on the line and in the plane, (c) right-hand sides, (d) the distance of the equations."""
    drawn, axes = style.axes_row(_TITLES, height=3.9, width=3.4)
    for ax, panel in zip(axes, ("line", "plane"), strict=False):
        _errors(ax, pick(series, panel=panel))
        ax.set_ylabel("error of $du/dt$ / its largest value")
    _right_hand_sides(axes[2], pick(series, panel="right-hand side"))
    _gap(axes[3], pick(series, panel="gap"))
    schemes = [
        style.entry(name, color=COLOURS[s], marker=MARKERS[s]) for name, s in _SCHEMES.items()
    ]
    style.legend_below(drawn, [*schemes, *_FORMS], columns=5)
    return drawn


def _errors(ax: Axes, part: pd.DataFrame) -> None:
    kinds = part.groupby(["series", "equation", "order"], sort=False)
    for (form, equation, order), points in kinds:
        scheme = _SCHEMES[str(form)]
        dotted = form == "exchange" and not str(equation).startswith("div")
        look = {"color": COLOURS[scheme], "marker": MARKERS[scheme], "markersize": 4.0}
        style.draw(ax, points, linestyle=":" if dotted else "-", **look)
        if form == "FPSE" and not style.finest_slope(ax, points, float(order)) and len(points) > 1:
            h, error = points.sort_values("x")[["x", "y"]].to_numpy()[1]
            style.note(ax, f"order {order:g}", (h, error), (9, -3), ha="left")
    ticks = sorted(part["x"].unique())
    style.log_log(ax, xlabel="particle spacing $h$", xlim=(0.6 * ticks[0], 1.3 * ticks[-1]))
    style.name_ticks(ax, ticks[::-2])


def _right_hand_sides(ax: Axes, part: pd.DataFrame) -> None:
    looks = (
        {"linestyle": "-"},
        {"linestyle": ":"},
        style.scheme_style("KPSE", linestyle="", markersize=3.5),
    )
    for (_, points), look in zip(part.groupby("series", sort=False), looks, strict=True):
        style.draw(ax, points, **{"color": "0.2", "marker": "", **look})
    ax.set(xlabel="position $x$", ylabel="$du/dt$", xlim=(-4.0, 4.0))


def _gap(ax: Axes, part: pd.DataFrame) -> None:
    style.draw(ax, part, color="0.2")
    end = part.iloc[-1]
    style.guide(ax, list(part["x"]), (end["x"], 0.15 * end["y"]), 1.0, "slope 1")
    style.log_log(ax, xlabel=r"$2 - \alpha$", ylabel="largest relative distance")
