"""The diffusion velocity method: paths and lattice, remeshing, stability."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullLocator

from fracstudy.style import COLOURS, MARKERS, axes_row, slope_triangle

__all__ = ["dvm_particles", "dvm_remeshing", "dvm_stability"]

_REMESHED = "#D55E00"
_ABOVE = 1.5  # the spacing that calls for remeshing, in units of h
_READINGS = {"M4'": ("#0072B2", "o"), "Lambda3": ("#D55E00", "s"), "none": ("#009E73", "^")}
_LABELS = {"M4'": "$M_4'$", "Lambda3": r"$\Lambda_3$", "none": "none"}


def _short(ax: Axes, text: str, place: tuple[float, float], colour: str, **options: Any) -> None:
    ax.annotate(text, place, color=colour, fontsize=8, **options)


def dvm_particles(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw (a) the paths of the particles, (b) the spacing against position, (c) the overlap against time."""
    figure, axes = axes_row(3, width=3.5, height=3.9)
    _paths(axes[0], series[series["panel"] == "path"])
    _spacings(axes[1], series[series["panel"] == "spacing"])
    _overlaps(axes[2], series[series["panel"] == "overlap"])
    return figure


def _paths(ax: Axes, series: pd.DataFrame) -> None:
    last = series["label"].max()
    for (name, particle), path in series.groupby(["series", "label"]):
        end = particle in (0, last)
        if name == "exact":
            ax.plot(path["x"], path["y"], color="0.15", linewidth=0.7, linestyle=(0, (4, 3)))
        else:
            ax.plot(
                path["x"], path["y"], color=_REMESHED if end else COLOURS["DVM"], alpha=1.0 if end else 0.55,
                linewidth=1.4 if end else 1.0,
            )  # fmt: skip
    ax.set(xlabel="position $x$", ylabel="time $t$")
    ax.set_title("(a) paths, no remeshing", loc="left")
    ax.margins(y=0.0)
    handles = [
        Line2D([], [], color=COLOURS["DVM"], label="particles"),
        Line2D([], [], color=_REMESHED, label="the last ones"),
        Line2D([], [], color="0.15", linewidth=0.7, linestyle="--", label=r"exact, $x\propto t^{1/\alpha}$"),
    ]  # fmt: skip
    ax.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=2)


def _spacings(ax: Axes, series: pd.DataFrame) -> None:
    free = series[series["series"] == "none"]
    times = sorted(free["label"].unique())
    exact = series[series["series"] == "exact"].set_index("label")
    shades = colormaps["viridis"](np.linspace(0.0, 0.85, len(times)))
    for time, shade in zip(times, shades, strict=True):
        line = free[free["label"] == time].sort_values("x")
        ax.plot(line["x"], line["y"], color=shade, label=f"$t = {time:g}$")
        stretched = exact.loc[time]
        ax.plot(
            [0.0, stretched["x"]], [stretched["y"]] * 2, color=shade, linewidth=0.7, linestyle=(0, (4, 3))
        )  # fmt: skip
    rest = series[~series["series"].isin(["none", "exact"])]
    ax.plot(
        rest["x"], rest["y"], color=_REMESHED, marker="o", markersize=2.5, linestyle="", alpha=0.5,
        markeredgewidth=0.0, label="remeshed, before",
    )  # fmt: skip
    ax.axhline(_ABOVE, color="0.5", linewidth=0.8, linestyle=":")
    _short(
        ax, "remesh above 1.5", (1.0, _ABOVE), "0.35", xycoords=("axes fraction", "data"),
        xytext=(0, -2), textcoords="offset points", ha="right", va="top",
    )  # fmt: skip
    ax.set(xlabel="position $x$", ylabel=r"spacing $\Delta x / h$")
    ax.set_title("(b) spacing", loc="left")
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=3, columnspacing=1.0)


def _overlaps(ax: Axes, series: pd.DataFrame) -> None:
    for name, part in series.groupby("series"):
        part = part.sort_values("x")
        if name == "exact":
            ax.plot(
                part["x"], part["y"], color="0.15", linewidth=0.8, linestyle=(0, (4, 3)), zorder=3,
                label=r"exact, $2\,(t_0/t)^{1/\alpha}$",
            )  # fmt: skip
        elif name.startswith("none"):
            end = name.endswith("ends")
            ax.plot(
                part["x"], part["y"], color=COLOURS["DVM"], linewidth=1.0 if end else 2.2, alpha=1.0 if end else 0.6,
                label="not remeshed, ends" if end else "not remeshed, bulk",
            )  # fmt: skip
        else:
            ax.plot(
                part["x"], part["y"], color=_REMESHED, marker="o", markersize=2.5, linestyle="", alpha=0.5,
                markeredgewidth=0.0, label="remeshed, before, ends",
            )  # fmt: skip
    ax.axhline(1.0, color="0.5", linewidth=0.8, linestyle=":")
    _short(
        ax, "no overlap below 1", (0.2, 1.0), "0.35", xycoords=("axes fraction", "data"),
        xytext=(0, 2), textcoords="offset points", va="bottom",
    )  # fmt: skip
    ax.set(xlabel="time $t$", ylabel=r"overlap $\epsilon / \Delta x$", ylim=(0.0, 2.1))
    ax.set_title("(c) least overlap", loc="left")
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=2, columnspacing=1.0)


def dvm_remeshing(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw (a) the error against h, (b) the deviation along x, (c) the error in time against the step."""
    figure, axes = axes_row(3, width=3.5, height=3.9)
    _errors(axes[0], series[series["panel"] == "spacing"])
    _deviations(axes[1], series[series["panel"] == "profile"], float(parameters["shown"]))
    _steps(axes[2], series[series["panel"] == "time"])
    return figure


def _look(remeshing: str, kind: str = "field", order: int = 2) -> dict[str, Any]:
    colour, marker = _READINGS[remeshing]
    style = ":" if kind == "strengths" else "--" if order == 4 else "-"
    face = colour if kind == "field" and order == 2 else "none"
    return {"color": colour, "marker": marker, "linestyle": style, "markerfacecolor": face}


def _errors(ax: Axes, series: pd.DataFrame) -> None:
    for (kind, order, name), part in series.groupby(["kind", "order", "remeshing"]):
        if kind == "strengths" and order == 4:
            continue  # those of order II again
        part = part.sort_values("x")
        ax.plot(part["x"], part["y"], **_look(name, kind, order))
    ax.set(xscale="log", yscale="log", xlabel="particle spacing $h$")
    ax.set_ylabel(r"relative error $\varepsilon_{D_\varepsilon}$, Eq. (48)")
    ax.set_title("(a) error", loc="left")
    kinds: tuple[tuple[str, Any], ...] = (
        ("II, field (7)", "-"), ("II, strengths", ":"), ("IV, field (7)", "--"),
    )  # fmt: skip
    handles = [
        Line2D([], [], color=c, marker=m, label=f"{_LABELS[name]}", linestyle="none")
        for name, (c, m) in _READINGS.items()
    ] + [Line2D([], [], color="0.3", linestyle=style, label=label) for label, style in kinds]
    spacings = sorted(series["x"].unique())
    if len(spacings) > 1:
        x = spacings[-2]
        slope_triangle(ax, x, 0.2 * series.loc[series["x"] == x, "y"].min(), 2.0)
    _plain_ticks(ax, (0.01, 0.02, 0.05, 0.1, 0.2, 0.5))
    ax.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=2)


def _deviations(ax: Axes, series: pd.DataFrame, h: float) -> None:
    here = series[(series["order"] == 2) & (series["remeshing"] != "none")]
    for (kind, name), part in here.groupby(["kind", "remeshing"]):
        part = part.sort_values("x")
        look = _look(name, kind) | {"linestyle": "-" if kind == "field" else ":", "marker": ""}
        if kind == "strengths":
            look |= {"marker": ".", "markersize": 3.5, "linewidth": 0.8}
        label = f"{_LABELS[name]}, {'field (7)' if kind == 'field' else 'strengths'}"
        ax.plot(part["x"], 100.0 * part["y"], **look, label=label)
    ax.set_yscale("symlog", linthresh=0.1, linscale=0.6)
    ticks = (-10.0, -1.0, -0.1, 0.0, 0.1, 1.0, 10.0)
    ax.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    ax.set(xlabel="position $x$", ylabel="deviation from the exact solution, %")
    ax.set_title(rf"(b) near the peak, $h = {h:.3g}$", loc="left")
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=2)


def _steps(ax: Axes, series: pd.DataFrame) -> None:
    spacings = sorted(series["h"].unique(), reverse=True)
    for (h, name), part in series.groupby(["h", "remeshing"]):
        part = part.sort_values("x")
        look = _look(name) | {"linestyle": "-" if h == spacings[0] else ":"}
        if h != spacings[0]:
            look |= {"markerfacecolor": "none"}
        ax.plot(part["x"], part["y"], **look, label=rf"{_LABELS[name]}, $h = {h:.3g}$")
    ax.axhline(1e-3, color="0.5", linewidth=0.8, linestyle=":")
    _short(
        ax, "a thousandth", (1.0, 1e-3), "0.35", xycoords=("axes fraction", "data"), xytext=(0, 2),
        textcoords="offset points", ha="right", va="bottom",
    )  # fmt: skip
    ax.set(xscale="log", yscale="log", xlabel=r"time step $\Delta t$")
    ax.set_ylabel("change from the smallest step / error (48)")
    _plain_ticks(ax, tuple(sorted(series["x"].unique())))
    ax.set_title("(c) what the step adds", loc="left")
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=2)


def _plain_ticks(ax: Axes, ticks: tuple[float, ...]) -> None:
    """Those of the ticks of a logarithmic x axis that are in view, as plain numbers."""
    low, high = ax.get_xlim()
    shown = [tick for tick in ticks if low <= tick <= high]
    ax.set_xticks(shown, [f"{tick:g}" for tick in shown])
    ax.xaxis.set_minor_locator(NullLocator())


def dvm_stability(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw (a) the factor of a wave in a step and (b) the error of runs, against the step over DD's limit."""
    figure, (growth, error) = axes_row(2, width=4.5, height=3.9)
    _factors(growth, series[series["panel"] == "growth"])
    _run_errors(error, series[series["panel"] == "error"])
    for ax in (growth, error):
        right = ax.get_xlim()[1]
        ax.axvspan(1.0, right, color="0.95", zorder=0)
        ax.set_xlim(right=right)
        ax.axvline(1.0, color="0.5", linewidth=0.8)
        ax.set_xlabel(r"step over the limit of DD, $D\,\Delta t / (a\,h^\alpha)$")
        ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2)
    return figure


def _factors(ax: Axes, series: pd.DataFrame) -> None:
    waves = series[series["run"] == "DVM"]
    for order, marker in ((2, "p"), (4, "h")):
        part = waves[waves["order"] == order].sort_values("factor")
        top = part["factor"].max()
        fine = np.linspace(0.0, top, 200)
        name = {2: "II", 4: "IV"}[order]
        ax.plot(
            part["factor"], part["measured"], color=COLOURS["DVM"], marker=marker, linestyle="",
            markerfacecolor="none", markersize=6 if order == 2 else 9, label=f"DVM {name}, measured",
        )  # fmt: skip
        if order == 2:
            z = -2.0 * fine
            ax.plot(
                fine, 1.0 + z + 0.5 * z * z, color=COLOURS["DD"],
                label=r"$1 + z + z^2/2$, $z = \Delta t\,A_\mathrm{DD}$",
            )  # fmt: skip
    part = series[(series["run"] == "GPSE") & (series["factor"] <= 1.05 * waves["factor"].max())]
    ax.plot(part["factor"], part["predicted"], color=COLOURS["GPSE"], label="GPSE, short waves")
    ax.axhline(1.0, color="0.5", linewidth=0.8, linestyle=":")
    ax.set(xlim=(0.0, 1.03 * waves["factor"].max()), ylim=(0.0, None))
    ax.set_ylabel("factor of a wave in a step")
    ax.set_title("(a) growth of the worst wave", loc="left")


def _run_errors(ax: Axes, series: pd.DataFrame) -> None:
    top = 3.0
    styles = {"DVM, no remeshing": ("DVM", "none"), "DVM, M4'": ("DVM", COLOURS["DVM"])}
    for name, part in series.groupby("run"):
        scheme, face = styles.get(str(name), ("GPSE", COLOURS["GPSE"]))
        part = part.sort_values("factor")
        look: dict[str, Any] = {
            "color": COLOURS[scheme],
            "marker": MARKERS[scheme],
            "markerfacecolor": face,
        }
        label = str(name).replace("M4'", "$M_4'$")
        line = "-" if face != "none" else "--"
        ax.plot(part["factor"], part["error"], **look, linestyle=line, label=label)
        stopped = part[part["stopped"].notna()]
        if len(stopped):
            ax.plot(
                stopped["factor"], [top] * len(stopped), color=COLOURS[scheme], marker="x", linestyle="",
                markersize=6, markeredgewidth=1.5, label="stopped: $u$ changes sign",
            )  # fmt: skip
    ax.set(xscale="log", yscale="log")
    _plain_ticks(ax, (0.25, 0.5, 1.0, 2.0, 4.0))
    ax.set_ylabel(r"relative error $\varepsilon_{D_\varepsilon}$, Eq. (48)")
    ax.set_title("(b) error of runs", loc="left")
