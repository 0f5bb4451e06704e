"""Errors on the interval and in the plane, and a bump that is carried."""

import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import BLUE, RED, Figure

_TITLES = ("interval", "disc and square", "carried by $a = 4(1 - x^2)$")


def figure(series: pd.DataFrame, *, drawn: float) -> Figure:
    """Draw (a) interval, (b) disc and square, (c) profiles."""
    figure, (line, plane, profile) = style.axes_row(_TITLES, height=3.7, width=4.0)
    errors = pick(series, alpha=drawn)
    style.curves(line, pick(errors, panel="interval"))
    first = pick(errors, panel="interval", series="D(x, t)").sort_values("x").iloc[0]
    style.slope_triangle(line, 1.1 * first["x"], 2e-3 * first["y"], drawn - 8.0)
    for domain, dashes in (("disc", "-"), ("square", "--")):
        style.curves(plane, pick(errors, panel=domain), name=f"{domain}: {{}}", linestyle=dashes)
    error = "mean error at $t = 1$, relative"
    style.log_log(line, xlabel="particles $N$", ylabel=error)
    style.log_log(plane, xlabel="rings, particles along a side $N$", ylabel=error)
    style.small_legend(line, "upper right")
    style.small_legend(plane, "lower left")
    for ax, domains in ((line, ["interval"]), (plane, ["disc", "square"])):
        counts = series.loc[series["panel"].isin(domains), "x"]
        style.name_ticks(ax, sorted(counts.astype(int).unique()))
    for (exterior, d), points in pick(series, panel="profile").groupby(["series", "alpha"]):
        colour = RED if exterior == "reflecting" else BLUE
        look = {"color": colour, "linestyle": "-" if d == 1.0 else "--", "marker": ""}
        style.draw(profile, points, label=f"{exterior}, $D$ = {d:g}", **look)
    profile.set(xlabel="position $x$", ylabel="$u$")
    style.small_legend(profile, "upper left")
    return figure
