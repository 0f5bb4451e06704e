"""Diffusion of the square profile by markers: Figs. 5-16, the growth of clusters, and the claims on accuracy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullLocator

from fracstudy.style import COLOURS, axes_row
from scenes.lewandowski.marker_initial_figures import SHAPE_COLOURS

__all__ = [
    "marker_claims",
    "marker_error_norm",
    "marker_fixed_grid",
    "marker_growth",
    "marker_moving_grid",
    "marker_square",
]

_LOADINGS = {
    "midpoints": ("midpoints of [−1, 1]", "#0072B2", "o"),
    "random": ("random in [−1, 1]", "#D55E00", "s"),
    "wide": ("uniform in [−L, L]", "#E69F00", "^"),
}
_SHAPES = ("S4", "S7", "S8")
_MARKERS = {"S1": "s", "S2": "D", "S3": "v", "S4": "o", "S8": "^"}


def marker_square(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw Figs. 5-7 in the order of eps, and error and slope against eps."""
    figure = Figure(figsize=(8.8, 5.8), layout="constrained")
    grid = figure.add_gridspec(2, 6, height_ratios=(1.0, 1.0))
    fields = series[series["panel"] == "field"]
    exact = fields[fields["series"] == "exact"]
    shown = sorted(map(float, parameters["shown"]))
    names = dict(zip(map(float, parameters["shown"]), ("Fig. 5", "Fig. 6", "Fig. 7"), strict=True))
    first = None
    for column, epsilon in enumerate(shown):
        ax = figure.add_subplot(grid[0, 2 * column : 2 * column + 2], sharey=first)
        first = first or ax
        ax.plot(exact["x"], exact["y"], color=COLOURS["exact"], linewidth=1.0, label="exact")
        for loading in ("midpoints", "random"):
            _, colour, _ = _LOADINGS[loading]
            curve = fields[(fields["series"] == loading) & np.isclose(fields["support"], epsilon)]
            ax.plot(curve["x"], curve["y"], ":", color=colour, linewidth=1.5)
        ax.set_title(rf"{names[epsilon]}: $\varepsilon = {epsilon:g}$", loc="left")
        ax.set(xlabel="$x$", xlim=(-9.0, 9.0))
        if column:
            ax.tick_params(labelleft=False)
    assert first is not None
    first.set_ylabel(rf"$F(x, t = {parameters['t_final']:g})$")
    labels = (("error", "relative $L^2$ error"), ("slope", r"$\max|F_x| \,/\, \max|f_x|$"))
    for column, (panel, label) in enumerate(labels):
        ax = figure.add_subplot(grid[1, 3 * column : 3 * column + 3])
        for loading, (_, colour, marker) in _LOADINGS.items():
            curve = series[(series["panel"] == panel) & (series["series"] == loading)]
            ax.plot(curve["x"], curve["y"], color=colour, marker=marker)
        for epsilon in shown:
            ax.axvline(epsilon, color="0.6", linewidth=0.8, linestyle=":")
        if panel == "slope":
            ax.axhline(1.0, color="black", linewidth=1.0)
            ax.text(0.02, 1.0, "exact", transform=ax.get_yaxis_transform(), va="bottom", fontsize=8)
        ax.set(yscale="log", xlabel=r"support parameter $\varepsilon$", ylabel=label)
        _decimals(ax, (0.02, 0.05, 0.1, 0.2, 0.5) if panel == "error" else (1, 2, 5, 10, 20, 50))
    entries = [Line2D([], [], color="black", linewidth=1.0, label="exact")]
    entries += [
        Line2D([], [], color=colour, marker=marker, label=label)
        for label, colour, marker in _LOADINGS.values()
    ]
    figure.legend(handles=entries, loc="outside lower center", ncols=4)
    return figure


def marker_fixed_grid(
    series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]
) -> Figure:
    """Draw F on the fixed grid: a column for each shape function, a row for each loading, markers below."""
    figure, axes, _ = _panels(8, ("midpoints", "random", "wide"))
    fields, markers = (series[series["panel"] == panel] for panel in ("field", "markers"))
    exact = fields[fields["series"] == "exact"]
    for ax, shape, loading in axes:
        ax.plot(exact["x"], exact["y"], color=COLOURS["exact"], linewidth=1.0)
        curve, at = (
            p[(p["series"] == shape) & (p["loading"] == loading)] for p in (fields, markers)
        )
        colour = SHAPE_COLOURS[shape]
        ax.plot(curve["x"], curve["y"], color=colour, linewidth=1.5)
        _ticks(ax, at["x"], colour)
        ax.set(xlim=(-9.0, 9.0), ylim=(-0.045, 0.36))
    entries = [Line2D([], [], color="black", linewidth=1.0, label="exact")]
    entries += [
        Line2D([], [], color=SHAPE_COLOURS[s], label=f"$F$ with $S_{s[1]}$") for s in _SHAPES
    ]
    entries.append(Line2D([], [], color="0.4", marker="|", linestyle="", label="markers"))
    figure.legend(handles=entries, loc="outside lower center", ncols=5)
    return figure


def marker_moving_grid(
    series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]
) -> Figure:
    """Draw F at the markers, f there, and f as the same markers represent it; below, the spectrum of the markers."""
    figure, axes, spectra = _panels(11, ("midpoints", "random"), more=True)
    for ax, shape, loading in axes:
        here = series[(series["series"] == shape) & (series["loading"] == loading)]
        parts = dict(tuple(here.groupby("panel")))
        colour = SHAPE_COLOURS[shape]
        ax.plot(parts["exact"]["x"], parts["exact"]["y"], color=COLOURS["exact"], linewidth=1.0)
        shown = parts["representation"]
        ax.plot(shown["x"], shown["y"], color="0.55", linewidth=0.9)
        at = parts["field"]
        ax.plot(
            at["x"], at["y"], ".", color=colour, markersize=4.5, markeredgewidth=0.0, alpha=0.8,
        )  # fmt: skip
        _ticks(ax, at["x"], colour)
        centres = here.loc[here["panel"] == "centres", "x"].to_numpy()
        if centres.size >= 3:
            for centre in centres:
                ax.plot(centre, 0.335, "v", color=colour, markersize=3.5)
            distance = np.median(np.diff(centres)) / float(parameters["support"])
            ax.annotate(
                rf"clusters ${distance:.2f}\,\varepsilon$ apart", (0.5, 1.0), xycoords="axes fraction",
                xytext=(0, 2), textcoords="offset points", ha="center", fontsize=8, color=colour,
            )  # fmt: skip
        ax.set(xlim=(-7.0, 7.0), ylim=(-0.045, 0.36))
    for ax, shape in zip(spectra, _SHAPES, strict=True):
        _spectrum(ax, series, shape)
    entries = [
        Line2D([], [], color="0.3", marker=".", linestyle="", label="$F$ at the markers"),
        Line2D([], [], color="black", linewidth=1.0, label="exact"),
        Line2D([], [], color="0.55", linewidth=0.9, label="exact, represented by these markers"),
        Line2D([], [], color="0.3", marker="v", linestyle="", markersize=4, label="cluster"),
    ]
    figure.legend(handles=entries, loc="outside lower center", ncols=4)
    return figure


def marker_error_norm(
    series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]
) -> Figure:
    """Draw E(t) for each shape function, all starts; for S7 also with the printed constant."""
    figure, axes = axes_row(3, height=3.7, width=3.0, sharey=True)
    for number, (ax, shape) in enumerate(zip(axes, _SHAPES, strict=True), start=14):
        here = series[(series["panel"] == "E") & (series["series"] == shape)]
        for loading, (_, colour, _marker) in _LOADINGS.items():
            for _, curve in here[here["loading"] == loading].groupby("seed"):
                width, opacity = (0.8, 0.6) if loading == "random" else (1.7, 1.0)
                curve = curve[curve["x"] > 0.0]
                ax.plot(curve["x"], curve["y"], color=colour, linewidth=width, alpha=opacity)
        ax.set(xlabel="time $t$", yscale="log", xlim=(0.0, None))
        ax.set_title(f"Fig. {number}: $S_{shape[1]}$", loc="left")
        ax.set_ylim(0.01, 0.4)
        _decimals(ax, (0.01, 0.02, 0.05, 0.1, 0.2, 0.4))
    printed = series[(series["panel"] == "printed") & (series["x"] > 0.0)]
    axes[1].plot(printed["x"], printed["y"], color="black", linewidth=1.2, linestyle="--")
    axes[1].annotate(
        r"printed $\alpha$", (printed["x"].iloc[-1], printed["y"].iloc[-1]), xytext=(-2, -9),
        textcoords="offset points", ha="right", fontsize=8,
    )  # fmt: skip
    quiet = series[
        (series["panel"] == "E") & (series["series"] == "S8") & (series["loading"] == "midpoints")
    ]
    late = quiet[quiet["x"] >= 1.0]
    if len(late) > 1:
        line = np.polyval(np.polyfit(late["x"], np.log(late["y"]), 1), quiet["x"])
        axes[2].plot(quiet["x"], np.exp(line), color="0.35", linewidth=0.9, linestyle="--")
        axes[2].annotate(
            "exponential fit", (quiet["x"].iloc[-1], np.exp(line[-1])), xytext=(0, -4),
            textcoords="offset points", ha="right", va="top", fontsize=8, color="0.25",
        )  # fmt: skip
    axes[0].set_ylabel("error norm $E(t)$")
    entries = [Line2D([], [], color=colour, label=label) for label, colour, _ in _LOADINGS.values()]
    figure.legend(handles=entries, loc="outside lower center", ncols=3)
    return figure


def marker_growth(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw (a) rates of perturbations, predicted and measured; (b) the error against the time step."""
    figure, (rates, steps) = axes_row(2, height=3.9, width=4.4)
    exact = series[(series["panel"] == "rate") & (series["series"] == "exact")]
    rates.plot(exact["x"], exact["y"], color="black", linewidth=1.0)
    rates.text(1.85, -4.4, "exact\n$-k^2$", ha="right", va="center", fontsize=8)
    for name in parameters["lattices"]:
        colour, label = SHAPE_COLOURS[name], f"$S_{name[1]}$"
        curve = series[(series["panel"] == "rate") & (series["series"] == name)]
        points = series[(series["panel"] == "measured") & (series["series"] == name)]
        rates.plot(curve["x"], curve["y"], color=colour, label=label)
        rates.plot(points["x"], points["y"], "o", color=colour, markerfacecolor="white")
    rates.axhline(0.0, color="0.3", linewidth=0.8)
    rates.axhspan(0.0, 2.6, color="#D55E00", alpha=0.07, linewidth=0)
    rates.text(12.9, 2.5, "clusters grow", ha="right", va="top", fontsize=8, color="#A04000")
    rates.set(
        ylim=(-5.2, 2.6), xlim=(0.0, float(parameters["wavenumbers"])),
        xlabel=r"wavenumber $k = \varepsilon q$",
        ylabel=r"rate of perturbations $\times\ \varepsilon^2$",
    )  # fmt: skip
    entries = [
        Line2D([], [], color="0.3", label=r"predicted, $-k^2 \widehat{S}(k)$"),
        Line2D([], [], color="0.3", marker="o", markerfacecolor="white", linestyle="", label="measured"),
        *(Line2D([], [], color=SHAPE_COLOURS[s], label=f"$S_{s[1]}$") for s in parameters["lattices"]),
    ]  # fmt: skip
    for name in parameters["limits"]["shapes"]:
        colour = SHAPE_COLOURS[name]
        curve = series[(series["panel"] == "step") & (series["series"] == name)].dropna(
            subset=["y"]
        )
        limit = series[(series["panel"] == "limit") & (series["series"] == name)]["x"].iloc[0]
        steps.plot(curve["x"], curve["y"], color=colour, marker="o", markersize=3.5)
        steps.axvline(limit, color=colour, linewidth=1.0, linestyle="--")
        steps.annotate(
            rf"$\eta = {limit:.3f}$", (limit, 1.0), xycoords=("data", "axes fraction"),
            xytext=(-3 if name == "S4" else 3, -2), textcoords="offset points", va="top",
            ha="right" if name == "S4" else "left", fontsize=8, color=colour,
        )  # fmt: skip
    steps.set(
        yscale="log", xlabel=r"time step $\Delta t / \varepsilon^2$",
        ylabel=f"error norm $E({parameters['t_final']:g})$",
    )  # fmt: skip
    _decimals(steps, (0.02, 0.05, 0.1, 0.2))
    figure.legend(handles=entries, loc="outside lower center", ncols=5)
    return figure


def marker_claims(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw (a) E by markers per eps, (b) the best eps, (c) the parts of the error, (d) F that turns negative."""
    figure = Figure(figsize=(8.8, 6.6), layout="constrained")
    (numbers, best), (parts, denominator) = figure.subplots(2, 2)
    _numbers(numbers, series, parameters)
    _best(best, series, parameters)
    _parts(parts, series, parameters)
    _denominator(denominator, series)
    for letter, ax in zip("abcd", (numbers, best, parts, denominator), strict=True):
        ax.set_title(f"({letter}) {ax.get_title()}", loc="left")
        ax.set_title("")
    return figure


def _numbers(ax: Axes, series: pd.DataFrame, parameters: dict[str, Any]) -> None:
    for name in parameters["shapes"]:
        for loading, line, face in (("midpoints", "-", None), ("random", "--", "white")):
            curve = series[
                (series["panel"] == "numbers") & (series["series"] == name) & (series["loading"] == loading)
            ]  # fmt: skip
            ax.plot(
                curve["x"], curve["y"], line, color=SHAPE_COLOURS[name], marker="o", markersize=4,
                markerfacecolor=face, label=f"$S_{name[1]}$, {loading}",
            )  # fmt: skip
    ax.axvspan(10.0, 15.0, color="0.5", alpha=0.15, linewidth=0)
    ax.set(xscale="log", yscale="log", xlabel=r"markers per $\varepsilon$ at the end")
    _decimals(ax, (0.02, 0.05, 0.1, 0.2))
    ax.set_ylabel(f"error norm $E({parameters['t_final']:g})$")
    ax.set_title("number of markers; grey: 10 to 15")
    ax.legend(loc="lower left")


def _best(ax: Axes, series: pd.DataFrame, parameters: dict[str, Any]) -> None:
    for name in parameters["law"]:
        ours, formula = (
            series[(series["panel"] == panel) & (series["series"] == name)].sort_values("x")
            for panel in ("optimum", "formula")
        )
        colour = SHAPE_COLOURS[name]
        ax.plot(
            ours["x"], ours["y"], _MARKERS.get(name, "o"), color=colour, markerfacecolor="none",
            label=f"$S_{name[1]}$",
        )  # fmt: skip
        if formula["y"].notna().all():
            ax.plot(formula["x"], formula["y"], color=colour, linewidth=1.0)
    ax.set(xscale="log", yscale="log", xlabel="distance of the markers $h$")
    ax.set_ylabel(r"best support parameter $\varepsilon$")
    ticks = sorted(map(float, parameters["spacings"]))
    ax.set_xticks(ticks, [f"{h:g}" for h in ticks])
    ax.minorticks_off()
    _decimals(ax, (0.1, 0.2, 0.5, 1.0))
    ax.set_title("measured (points) and formula (lines)")
    ax.legend(loc="upper left", ncols=2)


def _parts(ax: Axes, series: pd.DataFrame, parameters: dict[str, Any]) -> None:
    for name in parameters["shapes"]:
        for panel, line, label in (
            ("position", "-", r"position, $\hat e$ (18)"),
            ("representation", ":", "representation"),
        ):
            curve = series[
                (series["panel"] == panel) & (series["series"] == name) & (series["loading"] == "midpoints")
            ]  # fmt: skip
            ax.plot(
                curve["x"], curve["y"], line, color=SHAPE_COLOURS[name], marker="o", markersize=3.5,
                label=f"$S_{name[1]}$: {label}",
            )  # fmt: skip
    ax.set(yscale="log", xlabel="time $t$", ylabel="largest error")
    _decimals(ax, (0.002, 0.005, 0.01, 0.02, 0.05))
    ax.set_title("the parts of (17), from midpoints")
    ax.legend(loc="best")


def _denominator(ax: Axes, series: pd.DataFrame) -> None:
    found = series[series["panel"] == "denominator"]
    if found.empty:
        ax.text(0.5, 0.5, "F stayed positive", transform=ax.transAxes, ha="center")
        return
    field, at = (found[found["series"] == name] for name in ("F", "markers"))
    colour = SHAPE_COLOURS["S8"]
    ax.plot(field["x"], field["y"], color=colour)
    negative = at["y"] <= 0.0
    ax.plot(at["x"][~negative], at["y"][~negative], "|", color="0.35", markersize=7)
    ax.plot(at["x"][negative], at["y"][negative], "X", color="#D55E00", markersize=8)
    ax.axhline(0.0, color="0.3", linewidth=0.8)
    x, y = at["x"][negative].iloc[0], at["y"][negative].iloc[0]
    depth = f"{y:.2g}".replace("-", "−")
    ax.annotate(
        f"F = {depth}\nat a marker", (x, y), xytext=(-62, -8), textcoords="offset points", ha="center",
        va="center", color="#D55E00", fontsize=8,
        arrowprops={"arrowstyle": "-", "color": "#D55E00"},
    )  # fmt: skip
    ax.set(xlabel="$x$", ylabel="$F$, the denominator of (7)")
    ax.set_yscale("symlog", linthresh=1e-3)
    ax.set_title(rf"$S_8$ from random positions, $t \approx {found['t'].iloc[0]:.2f}$")


def _spectrum(ax: Axes, series: pd.DataFrame, shape: str) -> None:
    """The mean spectrum of the markers from random starts, and where the transform is negative."""
    found = series[(series["panel"] == "spectrum") & (series["series"] == shape)]
    fastest = series[(series["panel"] == "fastest") & (series["series"] == shape)].iloc[0]
    ax.plot(found["x"], found["y"], color=SHAPE_COLOURS[shape])
    ax.axhline(1.0, color="0.3", linewidth=0.8)
    if fastest["y"] > 0.0:
        ax.axvline(fastest["y"], color="0.3", linewidth=0.9, linestyle="--")
        ax.text(fastest["y"] + 0.12, 220.0, "fastest growth", va="top", fontsize=7.5, color="0.3")
    else:
        ax.text(3.2, 220.0, "1: independent markers", va="top", fontsize=7.5, color="0.3")
    ax.set(yscale="log", xlim=(3.0, 12.0), ylim=(0.3, 300.0), xlabel=r"wavenumber $\varepsilon q$")


def _panels(
    first: int, loadings: tuple[str, ...], more: bool = False
) -> tuple[Figure, list[tuple[Axes, str, str]], list[Axes]]:
    """A row for each loading, a column for each shape function; with `more` a row below for their spectra."""
    rows = len(loadings) + more
    figure = Figure(figsize=(8.8, 2.05 * rows + 0.5), layout="constrained")
    grid = figure.subplots(rows, len(_SHAPES), sharey="row")
    axes = []
    for row, loading in enumerate(loadings):
        for column, shape in enumerate(_SHAPES):
            ax = grid[row, column]
            axes.append((ax, shape, loading))
            if row == 0:
                ax.set_title(f"Fig. {first + column}: $S_{shape[1]}$", loc="left")
            if row == len(loadings) - 1:
                ax.set_xlabel("$x$")
            else:
                ax.tick_params(labelbottom=False)
        grid[row, 0].set_ylabel(f"{_LOADINGS[loading][0]}\n$F$")
    spectra = list(grid[-1]) if more else []
    if more:
        spectra[0].set_ylabel("random: spectrum\nof the markers")
    return figure, axes, spectra


def _decimals(ax: Axes, values: tuple[float, ...]) -> None:
    """Plain numbers on a logarithmic axis of about a decade."""
    ax.set_yticks(values, [f"{value:g}" for value in values])
    ax.yaxis.set_minor_locator(NullLocator())


def _ticks(ax: Axes, x: pd.Series, colour: str) -> None:
    """The markers as strokes below the axis."""
    ax.plot(
        x, np.full(len(x), -0.025), "|", color=colour, markersize=6, markeredgewidth=0.6, alpha=0.8
    )
