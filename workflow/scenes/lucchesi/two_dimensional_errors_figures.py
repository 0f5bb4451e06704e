"""Errors in two dimensions against the particle spacing: Fig. 9, and with kernels from tables."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fracstudy.style import COLOURS, MARKERS, axes_row, slope_triangle

__all__ = ["planar_errors", "planar_tables"]

_ERROR = r"relative error $\varepsilon_{D_\varepsilon}$, Eq. (59)"
_PAPER = ("DD", "FPSE")


def planar_errors(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw (a) the paper's schemes, strengths and field (7); (b) all schemes, truncated and open."""
    series = series[series["C"] == series["C"].min()]
    figure, (paper, ours) = axes_row(2, width=4.3, height=4.3)
    for scheme in _PAPER:
        part = _pick(series, scheme, "II", "truncated")
        _line(paper, part, part["error (59)"], scheme, "-", True, f"{scheme}, strengths")
        field = part.dropna(subset=["error of the field (7)"])
        _line(
            paper, field, field["error of the field (7)"], scheme, "--", False,
            f"{scheme}, field (7)",
        )  # fmt: skip
    printed = sorted(parameters["particles"])
    finest = series.loc[series["N"] == printed[-1], "h"].iloc[0]
    paper.axvspan(0.5 * series["h"].min(), finest / 1.3, color="0.95", zorder=0)
    paper.annotate(
        "finer than\nin the paper", (finest / 1.36, 0.98), xycoords=("data", "axes fraction"),
        ha="right", va="top", color="0.4", fontsize=7.5,
    )  # fmt: skip
    dd = _pick(series, "DD", "II", "truncated")
    slope_triangle(paper, 1.1 * finest, 0.4 * dd[dd["N"] == printed[-1]]["error (59)"].iloc[0], 2.0)
    h = sorted(dd["h"])
    paper.set_xlim(h[0] / 1.25, h[-1] * 1.25)
    _ticks(paper, h)
    for scheme in ("DD", "FPSE", "KPSE", "GPSE"):
        for order, style in (("II", "-"), ("IV", "--")):
            for exterior in ("truncated", "open"):
                part = _pick(series, scheme, order, exterior)
                if scheme in _PAPER and order == "II" and exterior == "truncated":
                    continue  # nearly the open ones, and shown in (a)
                _line(ours, part, part["error (59)"], scheme, style, exterior == "truncated")
    flat = _pick(series, "GPSE", "II", "truncated").iloc[0]
    ours.annotate(
        "KPSE and GPSE,\ntruncated", (flat["h"], flat["error (59)"]), xytext=(-6, 6), ha="left",
        textcoords="offset points", color="0.3", fontsize=7.5,
    )  # fmt: skip
    kpse = _pick(series, "KPSE", "IV", "open")
    middle = kpse.iloc[len(kpse) // 2]
    slope_triangle(ours, 1.1 * middle["h"], 0.25 * middle["error (59)"], 4.0)
    ours.set_xlim(series["h"].min() / 1.25, series["h"].max() * 1.25)
    _ticks(ours, sorted(series["h"].unique()))
    for ax, title in ((paper, "(a) DD and FPSE, truncated"), (ours, "(b) all schemes")):
        ax.set_title(title, loc="left")
        ax.set_xlabel("particle spacing $h$")
    paper.set_ylabel(_ERROR)
    paper.legend(loc="upper left", bbox_to_anchor=(-0.08, -0.17), ncols=2)
    entries = [
        Line2D([], [], color=COLOURS[name], marker=MARKERS[name], label=name)
        for name in ("DD", "FPSE", "KPSE", "GPSE")
    ]
    entries += [
        Line2D([], [], color="0.3", label="order II"),
        Line2D([], [], color="0.3", linestyle="--", label="order IV"),
        Line2D([], [], color="0.3", marker="o", linestyle="", label="truncated"),
        Line2D(
            [], [], color="0.3", marker="o", linestyle="", markerfacecolor="white", label="open"
        ),
    ]
    ours.legend(handles=entries, loc="upper left", bbox_to_anchor=(-0.08, -0.17), ncols=4)
    return figure


def planar_tables(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Draw the errors of DD and FPSE with exact kernels and with the two tables."""
    figure, axes = axes_row(2, height=3.9, sharey=True)
    steps = sorted(series["step"].unique())
    styles = {steps[0]: ("-", "exact kernels")}
    styles |= {
        step: (style, rf"table, step {step:g} $\epsilon$")
        for step, style in zip(steps[1:], ("--", ":"), strict=False)
    }
    for letter, ax, scheme in zip("ab", axes, _PAPER, strict=False):
        here = series[series["scheme"] == scheme]
        for step, (style, label) in styles.items():
            part = here[here["step"] == step].sort_values("h")
            _line(ax, part, part["y"], scheme, style, step == steps[0], label)
        spurious = here[here["step"] == steps[-1]].sort_values("h").dropna(subset=["spurious"])
        if len(spurious):
            ax.plot(
                spurious["h"], spurious["spurious"], color="0.45", linewidth=0.9,
                label="decay by the table of step 0.1",
            )  # fmt: skip
        ax.set_title(f"({letter}) {scheme}", loc="left")
        ax.set(xscale="log", yscale="log", xlabel="particle spacing $h$")
        _ticks(ax, sorted(here["h"].unique()))
        ax.legend(loc="upper left" if scheme == "FPSE" else "lower right", fontsize=7.5)
        ax.set_xlim(here["h"].min() / 1.25, here["h"].max() * 1.25)
    axes[0].set_ylabel(_ERROR)
    low = series[(series["scheme"] == "FPSE") & (series["step"] == 0.0)].sort_values("h")
    slope_triangle(axes[1], 1.2 * low["h"].iloc[0], 0.45 * low["y"].iloc[0], 2.0)
    return figure


def _pick(series: pd.DataFrame, scheme: str, order: str, exterior: str) -> pd.DataFrame:
    chosen = (series["scheme"] == scheme) & (series["order"] == order)
    return series[chosen & (series["exterior"] == exterior)].sort_values("h")


def _line(
    ax: Axes,
    part: pd.DataFrame,
    y: pd.Series,
    scheme: str,
    style: str,
    filled: bool,
    label: str | None = None,
) -> None:
    ax.plot(
        part["h"], y, color=COLOURS[scheme], marker=MARKERS[scheme], linestyle=style,
        markerfacecolor=COLOURS[scheme] if filled else "white", label=label,
    )  # fmt: skip
    ax.set(xscale="log", yscale="log")


def _ticks(ax: Axes, h: list[float]) -> None:
    ax.set_xticks(h, [f"{value:.3f}" for value in h])
    ax.minorticks_off()
