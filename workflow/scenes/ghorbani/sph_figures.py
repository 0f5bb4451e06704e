"""The SPH approximation of fractional operators: Figs. 2 to 9, and its convergence."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fracstudy.style import axes_row, slope_triangle

__all__ = ["sph_convergence", "sph_operator", "sph_spline"]

_METHODS = {
    "standard": ("standard (17)", "#D55E00", "o"),
    "halved": ("half volumes at the ends", "#0072B2", "s"),
    "modified": ("modified (20)", "#009E73", "^"),
}
_TITLES = {"sin": r"$\sin \pi x$", "cos": r"$\cos \pi x$", "exp": r"$\exp x$", "cubic": "$(x-1)^3$"}
_AXES = {
    "caputo": r"Caputo derivative ${}^{C}D^{\alpha} f$",
    "rl_derivative": r"RL derivative ${}^{RL}D^{\alpha} f$",
    "rl_integral": r"RL integral $I^{\alpha} f$",
}
_LEAST = 1e-9  # a smaller error, where a curve happens to cross zero, is not drawn


def sph_spline(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw (a) the spline, its gradient and its integral; (b) its two sums over equally spaced particles."""
    figure, (kernel, sums) = axes_row(2, height=3.0, width=3.8)
    curves = {
        "W": (r"$hW$", "#0072B2", (0.75, 0.42)),
        "dW": (r"$h^2\,\nabla W$", "#D55E00", (-1.75, 0.52)),
        "integral": (r"$\widetilde{W}$", "#009E73", (0.95, 0.82)),
    }
    drawn = series[series["panel"] == "kernel"]
    for name, (label, colour, place) in curves.items():
        curve = drawn[drawn["curve"] == name]
        kernel.plot(curve["x"], curve["y"], color=colour)
        kernel.text(*place, label, color=colour)
    kernel.set(xlabel="distance $x / h$", ylabel="cubic spline (22)", xlim=(-2.5, 2.5))

    labels = {
        "sum": (r"$\sum s\,W_{ij}$", "#0072B2"),
        "L": (r"$L_i$ of (19)", "#D55E00"),
    }
    drawn = series[series["panel"] == "sums"]
    for name, (label, colour) in labels.items():
        curve = drawn[drawn["curve"] == name]
        sums.plot(curve["x"], curve["y"], color=colour, label=label)
    ratio = float(parameters["smoothing_ratio"])
    sums.axhline(1.0, color="0.4", linewidth=0.8)
    sums.axvline(ratio, color="0.4", linewidth=0.8, linestyle=":")
    sums.annotate(
        f"$h = {ratio:g}\\,s$", (ratio, 0.0), xycoords=("data", "axes fraction"), xytext=(4, 6),
        textcoords="offset points", color="0.25", fontsize=8,
    )  # fmt: skip
    sums.set(xlabel="smoothing ratio $h / s$", ylabel="sum over the particles", ylim=(0.9, 1.1))
    sums.legend(loc="upper right")
    return figure


def sph_operator(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw, a column for each function, the operator and the absolute error (38) of the three sums."""
    names = list(dict.fromkeys(series["function"]))
    figure = Figure(figsize=(2.5 * len(names), 4.9), layout="constrained")
    axes = np.atleast_2d(
        figure.subplots(2, len(names), sharex=True, gridspec_kw={"height_ratios": (1.0, 1.15)})
    )
    for column, name in enumerate(names):
        upper, lower = axes[0, column], axes[1, column]
        curves = dict(tuple(series[series["function"] == name].groupby("method")))
        standard = curves["standard"]
        drawn = np.isfinite(standard["exact"])
        upper.plot(standard["x"][drawn], standard["exact"][drawn], color="black")
        some = standard.iloc[:: max(1, len(standard) // 40)]
        upper.plot(
            some["x"], some["sph"], "o", color=_METHODS["standard"][1], markersize=3.0,
            markerfacecolor="none", markeredgewidth=0.8,
        )  # fmt: skip
        upper.set_title(_TITLES[name])
        _keep_in_view(upper, standard["exact"].to_numpy())
        for method, (_, colour, _marker) in _METHODS.items():
            curve = curves[method]
            error = curve["error"].where(curve["error"] > _LEAST)
            # Wide and below the others: where f'(0) = 0 the first two are the same.
            width = 2.4 if method == "standard" else 1.0
            lower.plot(curve["x"], error, color=colour, linewidth=width)
        lower.set(yscale="log", xlabel="$x$")
        lower.minorticks_off()
    axes[0, 0].set_ylabel(_AXES[parameters["operator"]])
    axes[1, 0].set_ylabel("absolute error (38)")
    entries = [
        Line2D([], [], color="black", label="closed form"),
        Line2D(
            [], [], color=_METHODS["standard"][1], marker="o", linestyle="", markersize=3.5,
            markerfacecolor="none", label="SPH, standard",
        ),
        *(Line2D([], [], color=colour, label=label) for label, colour, _ in _METHODS.values()),
    ]  # fmt: skip
    figure.legend(handles=entries, loc="outside lower center", ncols=len(entries))
    return figure


def sph_convergence(
    series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]
) -> Figure:
    """Draw the error (39) of each operator's worst function against s; faint: its real part."""
    figure, axes = axes_row(3, height=3.5, width=3.1, sharey=True)
    panels = (("rl_integral", "sin"), ("caputo", "cos"), ("rl_derivative", "sin"))
    left = series[series["side"] == "left"]
    for ax, (operator, name) in zip(axes, panels, strict=True):
        shown = left[(left["operator"] == operator) & (left["function"] == name)]
        for (method, order), curve in shown.groupby(["method", "order"]):
            _, colour, marker = _METHODS[method]
            line = "-" if order == "constant" else "--"
            ax.plot(curve["x"], curve["y"], line, color=colour, marker=marker)
            if method == "modified":
                ax.plot(curve["x"], curve["real"], line, color=colour, alpha=0.35, linewidth=1.0)
        ax.set(xscale="log", yscale="log", xlabel="particle spacing $s$")
        ax.set_title(f"{ax.get_title(loc='left')} {_AXES[operator]}, {_TITLES[name]}", loc="left")
        ticks = sorted(shown["x"].unique())
        ax.set_xticks(ticks, [f"{s:.3g}" for s in ticks], rotation=30)
        ax.minorticks_off()
        x = ticks[1]
        top = shown[(shown["method"] == "standard") & (shown["order"] == "constant")]
        slope_triangle(ax, x, 0.45 * float(np.interp(x, top["x"][::-1], top["y"][::-1])), 1.0)
    axes[0].set_ylabel("relative error $L_2$ (39)")
    entries = [
        *(
            Line2D([], [], color=colour, marker=marker, label=label)
            for label, colour, marker in _METHODS.values()
        ),
        Line2D([], [], color="0.3", linestyle="--", label=r"variable $\alpha(x)$"),
        Line2D([], [], color=_METHODS["modified"][1], alpha=0.35, label="its real part"),
    ]
    figure.legend(handles=entries, loc="outside lower center", ncols=len(entries))
    return figure


def _keep_in_view(ax: Axes, exact: np.ndarray) -> None:
    """A derivative that is infinite at x = 0 would leave nothing of the rest: cut at the 99th percentile."""
    finite = exact[np.isfinite(exact)]
    low, high = np.percentile(finite, [0.5, 99.5])
    room = 0.08 * (high - low)
    ax.set_ylim(low - room, high + room)
