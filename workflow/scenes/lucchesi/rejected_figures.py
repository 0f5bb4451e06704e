"""What is wrong with the three rejected variants."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fracstudy.style import COLOURS, MARKERS, axes_row

__all__ = ["rejected_29", "rejected_dpse", "rejected_riesz"]

_SCALE = 1e4
_EIGENVALUES = {"DD": COLOURS["DD"], "PSE29": "#D55E00"}
_SHADES = ("#F0A868", "#E58338", "#C65A11", "#8A3A05")  # one hue, light to dark


def rejected_dpse(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """The solution next to the end of the lattice, and the relative error against the distance from it."""
    figure, axes = axes_row(2, height=3.6)
    for scheme in ("DPSE", "FPSE", "KPSE", "DD"):
        here = series[series["scheme"] == scheme].sort_values("x")
        wide = scheme == "DPSE"  # FPSE lies on it
        for ax, panel in zip(axes, ("profile", "relative"), strict=True):
            points = here[here["panel"] == panel]
            ax.plot(
                points["x"],
                points["y"] * (_SCALE if panel == "profile" else 1.0),
                color=COLOURS[scheme],
                linewidth=4.0 if wide else 1.2,
                linestyle="--" if scheme == "DD" else "-",
                marker=MARKERS[scheme] if panel == "profile" else "",
                markersize=8.0 if wide else 3.5,
                label=scheme,
            )
    profile = series[(series["panel"] == "profile") & (series["scheme"] == "KPSE")].sort_values("x")
    axes[0].plot(
        profile["x"], _SCALE * profile["exact"], color="black", linestyle=":", label="exact"
    )
    axes[0].set(xlim=(15.0, -0.5), xlabel=r"distance from the end, $(D - x) / \epsilon$")
    axes[0].set_ylabel(rf"solution $10^{{{np.log10(_SCALE):.0f}}} \, u(x, t_f)$")
    axes[0].set_title("(a) at the end of the lattice", loc="left")
    axes[1].set(xscale="log", yscale="log", xlabel=r"distance from the end, $(D - x) / \epsilon$")
    axes[1].invert_xaxis()
    axes[1].set_ylabel(r"$|u - u_{\mathrm{exact}}| \, / \, u_{\mathrm{exact}}$")
    axes[1].set_title("(b) relative error, from the centre to the end", loc="left")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    return figure


def rejected_29(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """The kernel, the eigenvalues beside those of DD, and the growth of runs at the end of the lattice."""
    figure, axes = axes_row(3, width=3.4, height=3.6)
    kernel, spectrum, history = (
        series[series["panel"] == panel] for panel in ("kernel", "spectrum", "history")
    )
    for (beta, points), style in zip(
        kernel.groupby("series", sort=False), ("-", "--", ":"), strict=False
    ):
        axes[0].plot(
            points["x"],
            points["y"],
            color="black",
            linestyle=style,
            label=rf"$\beta = {float(beta):g}$",
        )
    axes[0].axhline(0.0, color="0.5", linewidth=0.8)
    axes[0].set(xlabel=r"$r = |x| / \epsilon$", ylabel="kernel $G(r)$, Eq. (11)")
    axes[0].legend(loc="lower right")
    axes[0].set_title("(a) kernel of (29)", loc="left")

    for name, label in (("DD", "DD"), ("PSE29", "(29)")):
        points = spectrum[spectrum["series"] == name].sort_values("x")
        axes[1].plot(
            points["x"],
            points["y"],
            color=_EIGENVALUES[name],
            marker=MARKERS[name],
            markersize=3.0,
            linestyle="none",
            label=label,
        )
    axes[1].axhline(0.0, color="0.5", linewidth=0.8)
    axes[1].axhspan(0.0, 1.15 * spectrum["y"].max(), color="#D55E00", alpha=0.12, linewidth=0)
    axes[1].set_ylim(1.05 * spectrum["y"].min(), 1.15 * spectrum["y"].max())
    axes[1].annotate("growing", (0.03, 0.5 * spectrum["y"].max()), color="0.25", va="center")
    axes[1].set(
        xlabel="rank / number of particles", ylabel=r"eigenvalue $\lambda h^\alpha / \mathcal{D}$"
    )
    axes[1].legend(loc="lower right")
    axes[1].set_title(rf"(b) spectrum, $\beta = {parameters['beta']:g}$", loc="left")

    spacings = sorted(history["series"].unique(), key=float, reverse=True)
    for spacing, colour in zip(spacings, _SHADES, strict=False):
        points = history[history["series"] == spacing].sort_values("x")
        elapsed = points["x"] - points["x"].iloc[0]
        axes[2].plot(elapsed, points["y"], color=colour)
        axes[2].plot(elapsed, points["predicted"], color="0.3", linewidth=0.8, linestyle=":")
        axes[2].annotate(
            f"{float(spacing):.3g}",
            (elapsed.iloc[-1], points["y"].iloc[-1]),
            xytext=(0, 3),
            textcoords="offset points",
            ha="center",
            va="bottom",
            color=colour,
            fontsize=8,
        )
    axes[2].set(
        xscale="log",
        yscale="log",
        xlabel=r"time $t - t_0$",
        ylabel="$|u|$ at the end of the lattice",
    )
    axes[2].set_xlim(left=3e-3 * history["x"].max())
    axes[2].set_ylim(history["y"].max() * 1e-21, history["y"].max() * 1e3)
    axes[2].legend(
        handles=[
            Line2D([], [], color=_SHADES[1], label="run, spacing $h$"),
            Line2D(
                [], [], color="0.3", linewidth=0.8, linestyle=":", label=r"$\propto e^{\lambda t}$"
            ),
        ],
        loc="lower right",
    )
    axes[2].set_title("(c) growth", loc="left")
    return figure


def rejected_riesz(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """The flux at the largest alpha, and the errors of flux and solution against the spacing."""
    figure, axes = axes_row(3, width=3.4, height=3.6)
    profile = series[series["panel"] == "profile"]
    for name, look in (
        ("exact", {"color": "black", "linewidth": 3.5, "alpha": 0.25}),
        ("KPSE", {"color": COLOURS["KPSE"], "linestyle": "--"}),
        ("RIESZ", {"color": COLOURS["RIESZ"]}),
    ):
        points = profile[profile["series"] == name]
        axes[0].plot(points["x"], points["y"], **look)
    axes[0].set(xlabel=r"position $x$", ylabel=r"flux $Q(x)$")
    axes[0].set_title(rf"(a) flux, $\alpha = {profile['alpha'].iloc[0]:g}$", loc="left")
    for ax, panel, title in (
        (axes[1], "flux", "(b) flux"),
        (axes[2], "solution", "(c) solution"),
    ):
        here = series[series["panel"] == panel]
        for (name, alpha), points in here.groupby(["series", "alpha"]):
            points = points.sort_values("x")
            ax.plot(points["x"], points["y"], color=COLOURS[name], marker=MARKERS[name])
            if name == "KPSE" and panel == "flux":
                continue  # much the same at every alpha
            ax.annotate(
                f"{alpha:g}",
                (points["x"].iloc[0], points["y"].iloc[0]),
                xytext=(-5, 0),
                textcoords="offset points",
                ha="right",
                va="center",
                color=COLOURS[name],
                fontsize=8,
            )
        ax.set(xscale="log", yscale="log", xlabel=r"particle spacing $h = \epsilon / 2$")
        ax.set_xlim(left=here["x"].min() / 1.8)
        ax.set_title(title, loc="left")
    axes[1].set_ylabel(r"relative $L_1$ error, $|x| \leq 5 R_\alpha$")
    figure.legend(
        handles=[
            Line2D([], [], color="black", linewidth=3.5, alpha=0.25, label="exact"),
            Line2D(
                [],
                [],
                color=COLOURS["RIESZ"],
                marker=MARKERS["RIESZ"],
                label="potential cut off at $\\epsilon$",
            ),
            Line2D(
                [],
                [],
                color=COLOURS["KPSE"],
                marker=MARKERS["KPSE"],
                label="mollified: flux (19), KPSE",
            ),
            Line2D([], [], linestyle="none", label=r"numbers: $\alpha$"),
        ],
        loc="outside lower center",
        ncols=4,
    )
    return figure
