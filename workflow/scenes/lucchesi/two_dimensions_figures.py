"""The two-dimensional problem of Sec. 5: the density (Fig. 6), flux and rate (Fig. 7), profiles (Fig. 8)."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fracstudy.style import COLOURS, MARKERS, axes_row, slope_triangle

__all__ = ["planar_green", "planar_operators", "planar_profiles"]

_FLOOR = 2.0**-53  # where smaller deviations are drawn
_PLANE, _LINE = "#0072B2", "#D55E00"
_PALETTES = {"flux": "Oranges", "DD": "Blues", "FPSE": "Oranges"}
_DISK = 5.0


def planar_green(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw Phi_2 over Phi_2(0) beside Phi_1, near and far, and three other ways to compute it."""
    figure, (near, far, deviation) = axes_row(3, width=3.4, height=3.3)
    curves = {name: part.set_index("r")["y"] for name, part in series.groupby("series")}
    names = {2: r"$n = 2$: $\Phi_{2,\alpha}$", 1: r"$n = 1$: $L_\alpha^0$"}
    for dim, colour in ((2, _PLANE), (1, _LINE)):
        curve = curves[f"Phi_{dim}(r) / Phi_{dim}(0)"]
        near.plot(curve.index, curve, color=colour, linewidth=1.6, label=names[dim])
        far.plot(curve.index, curve, color=colour, linewidth=1.6)
    alpha = 1.0 + parameters["beta"]
    for dim, colour, text in ((2, _PLANE, r"$r^{-2-\alpha}$"), (1, _LINE, r"$r^{-1-\alpha}$")):
        curve = curves[f"Phi_{dim}(r) / Phi_{dim}(0)"]
        r = np.array([4.0, curve.index[-1]])
        tail = curve.iloc[-1] * (r / r[-1]) ** (-dim - alpha)
        far.plot(r, tail, color=colour, linewidth=0.9, linestyle=":")
        side = 1 if dim == 1 else -1
        far.annotate(
            text, (25.0, float(np.interp(25.0, curve.index, curve))), xytext=(5 * side, 4 * side),
            textcoords="offset points", color=colour, fontsize=9, ha="left" if dim == 1 else "right",
            va="bottom" if dim == 1 else "top",
        )  # fmt: skip
    near.set(xlim=(0.0, 6.0), ylim=(0.0, 1.04))
    near.legend(loc="upper right")
    far.set(xscale="log", yscale="log")
    styles = {
        "integral (58), deviation": ("#009E73", "-", "integral (58)"),
        "series, deviation": ("#CC79A7", "--", "series in $r^2$"),
        "asymptotics, deviation": ("#E69F00", "-.", r"series in $r^{-\alpha}$"),
    }
    for name, (colour, style, label) in styles.items():
        curve = curves[name].dropna().clip(lower=_FLOOR)
        deviation.plot(curve.index, curve, color=colour, linestyle=style, label=label)
    deviation.axhline(_FLOOR, color="0.5", linewidth=0.8, linestyle=":")
    deviation.set(xscale="log", yscale="log", ylim=(3e-17, 3.0))
    deviation.set_xlim(*parameters["reach"])
    deviation.legend(loc="upper left", fontsize=7.5)
    for ax in (near, far, deviation):
        ax.set_xlabel("distance $r$")
    for ax in (near, far):
        ax.set_ylabel(r"$\Phi_{n,\alpha}(r)\, /\, \Phi_{n,\alpha}(0)$")
    deviation.set_ylabel(r"relative deviation from our $\Phi_{2,\alpha}(r)$")
    return figure


def planar_operators(
    series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]
) -> Figure:
    """Draw (a) the flux, (b), (c) the rate of DD and FPSE on the printed lattices, (d) their errors."""
    figure = Figure(figsize=(8.6, 6.6), layout="constrained")
    panels = figure.subplots(2, 2).ravel()
    titles = ("radial flux, FPSE (19)", "diffusion rate, DD", "diffusion rate, FPSE")
    labels = (
        r"$Q_r^\beta(r, t = 0.5)$", r"$\Delta^\alpha u(r, t = 0.5)$", r"$\Delta^\alpha u(r, t = 0.5)$"
    )  # fmt: skip
    reach = parameters["reach"]
    for letter, ax, name, title, label in zip(
        "abc", panels, ("flux", "DD", "FPSE"), titles, labels, strict=False
    ):
        here = series[(series["quantity"] == name) & (series["r"] <= reach)]
        fine = here[here["N"] == here["N"].max()]
        ax.plot(fine["r"], fine["exact"], color="black", linewidth=1.0, label="exact")
        counts = parameters["particles"]
        shades = mpl.colormaps[_PALETTES[name]](np.linspace(0.4, 0.95, len(counts)))
        for count, colour, marker in zip(counts, shades, ("^", "s", "o"), strict=False):
            part = here[here["N"] == count]
            every = max(1, len(part) // 14)
            ax.plot(
                part["r"], part["y"], color=colour, marker=marker, markersize=4,
                markevery=every, linewidth=0.9, label=f"$N = {count}$",
            )  # fmt: skip
        ax.set(xlabel="distance $r$ from the origin, $y = 0$", ylabel=label, xlim=(0.0, reach))
        ax.set_title(f"({letter}) {title}", loc="left")
        ax.legend(loc="upper right" if name == "flux" else "lower right")
    _operator_errors(panels[3], table)
    return figure


def _operator_errors(ax: Axes, table: pd.DataFrame) -> None:
    styles = (("v", COLOURS["FPSE"], "--"), ("o", COLOURS["DD"], "-"), ("s", COLOURS["FPSE"], "-"))
    column = next(name for name in table if name.startswith("largest error"))
    for (name, part), (marker, colour, style) in zip(
        table.groupby("quantity", sort=False), styles, strict=True
    ):
        ax.plot(
            part["h"], part[column], color=colour, marker=marker, linestyle=style, label=name,
            markerfacecolor="white" if style == "--" else colour,
        )  # fmt: skip
    ax.set(xscale="log", yscale="log", xlabel="particle spacing $h$")
    ax.set_xlim(table["h"].min() / 1.25, table["h"].max() * 1.25)
    counts = table.groupby("N")["h"].first()
    ax.set_xticks(counts, [f"{h:.3f}" for h in counts])
    ax.minorticks_off()
    ax.set_ylabel(r"largest error / largest value, $r \leq 5$")
    ax.set_title("(d) convergence", loc="left")
    lowest = table.groupby("h")[column].min()
    slope_triangle(ax, 1.3 * lowest.index[0], 0.75 * lowest.iloc[0], 2.0)
    ax.legend(loc="upper left", fontsize=7.5)


def planar_profiles(
    series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]
) -> Figure:
    """Draw u along the two lines (above) and its relative error (below), truncated and open."""
    figure = Figure(figsize=(8.6, 6.4), layout="constrained")
    rows = figure.subplots(2, 2, sharex="col", height_ratios=(1.0, 1.0))
    lowest = 0.25 * series["exact"].min()
    for letter, column, line in zip("ab", rows.T, ("y = 0", "y = x"), strict=True):
        here = series[series["line"] == line]
        _profile(column[0], here[here["exterior"] == "truncated"], lowest)
        _profile_errors(column[1], here)
        column[0].set_title(f"({letter}) along ${line}$", loc="left")
        column[1].set_xlabel(r"distance $r$ from the origin")
        for ax in column:
            ax.axvline(here["r"].max(), color="0.6", linewidth=0.8)
            ax.axvline(_DISK, color="0.6", linewidth=0.8, linestyle=":")
            ax.set_xlim(0.0, 1.02 * here["r"].max())
        column[0].set_ylim(lowest, 3.0 * series["exact"].max())
        column[1].set_ylim(1e-5, 60.0)
    rows[0, 0].set_ylabel(r"strength $u(r, t_f)$")
    rows[1, 0].set_ylabel(r"relative error $|u\,/\,G - 1|$")
    rows[0, 0].annotate(
        "edge of\nthe square", (series[series["line"] == "y = 0"]["r"].max(), 1.0),
        xycoords=("data", "axes fraction"), xytext=(-4, -4), textcoords="offset points", ha="right",
        va="top", color="0.4", fontsize=7.5,
    )  # fmt: skip
    rows[0, 0].annotate(
        "disk of (59)", (_DISK, 1.0), xycoords=("data", "axes fraction"), xytext=(-4, -4),
        textcoords="offset points", ha="right", va="top", color="0.4", fontsize=7.5,
    )  # fmt: skip
    schemes = list(dict.fromkeys(series["scheme"]))
    handles = [Line2D([], [], color="black", linewidth=3.5, alpha=0.25, label="exact")]
    handles += [
        Line2D([], [], color=COLOURS[name], marker=MARKERS[name], label=f"{name}, truncated")
        for name in schemes
    ]
    handles += [
        Line2D([], [], color=COLOURS[name], linestyle="--", label=f"{name}, open")
        for name in schemes
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    return figure


def _profile(ax: Axes, here: pd.DataFrame, lowest: float) -> None:
    exact = here[here["scheme"] == here["scheme"].iloc[0]]
    ax.plot(exact["r"], exact["exact"], color="black", linewidth=3.5, alpha=0.25)
    for k, (scheme, part) in enumerate(here.groupby("scheme", sort=False)):
        every = max(1, len(part) // 12)
        ax.plot(
            part["r"], part["u"].where(part["u"] > lowest), color=COLOURS[scheme],
            marker=MARKERS[scheme], markevery=(k * every // 3, every), linewidth=0.9,
        )  # fmt: skip
    ax.set(yscale="log")


def _profile_errors(ax: Axes, here: pd.DataFrame) -> None:
    for (scheme, exterior), part in here.groupby(["scheme", "exterior"], sort=False):
        truncated = exterior == "truncated"
        every = max(1, len(part) // 9)
        ax.plot(
            part["r"], part["error"].abs(), color=COLOURS[scheme], linewidth=1.2 if truncated else 0.9,
            linestyle="-" if truncated else "--", marker=MARKERS[scheme] if truncated else "",
            markevery=every,
        )  # fmt: skip
    ax.set(yscale="log")
