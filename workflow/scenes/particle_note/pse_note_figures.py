"""The lecture note "Particle Approximations": its two figures, and those of the statements that it makes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fracstudy.style import axes_row, slope_triangle

__all__ = [
    "note_conservation",
    "note_error_law",
    "note_kernels",
    "note_lattice_kernel",
    "note_particles",
]

_BLUE, _RED, _GREEN, _PINK, _SKY, _ORANGE = (
    "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00",
)  # fmt: skip
_ORDERS = {2: (_BLUE, "-"), 4: (_RED, "--"), 6: (_GREEN, "-."), 8: (_PINK, ":")}
_WAYS = {0: "*", 1: "s", 2: "o", 3: "^", 4: "D"}


def note_particles(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """Fig. 1: (a) point particles, (b) the Gaussians of the particles and their sum, (c) by overlap."""
    figure, (left, middle, right) = axes_row(3, height=3.1, width=3.2, sharey=True)
    points = series[series["panel"] == "points"]
    exact = series[series["panel"] == "exact"]
    smooth = series[series["panel"] == "smooth"]
    low, high = exact["x"].iloc[[0, -1]]
    points = points[points["x"].between(low, high)]
    shown, h = float(parameters["shown"]), float(parameters["spacing"])
    for ax in (left, middle, right):
        ax.plot(exact["x"], exact["y"], color="black", linewidth=1.0, label="$f(x)$")
        ax.set(xlabel="$x$", xlim=(low, high))
    left.vlines(points["x"], 0.0, points["y"], color=_BLUE, linewidth=1.0)
    left.plot(points["x"], points["y"], "o", color=_BLUE, markersize=4, label="$f(x_p)$")
    left.set(ylabel="$f$ and its approximations", ylim=(-0.05, 1.95))
    left.set_title("(a) point particles (8)", loc="left")
    epsilon = shown * h
    x = exact["x"].to_numpy()
    for place, f in zip(points["x"], points["y"], strict=True):
        own = h * f * np.exp(-((x - place) ** 2) / (2.0 * epsilon**2))
        middle.plot(x, own / (np.sqrt(2.0 * np.pi) * epsilon), color=_SKY, linewidth=0.8)
    total = smooth[smooth["overlap"] == shown]
    middle.plot(total["x"], total["y"], color=_RED, linewidth=1.8, label=r"sum (9)")
    printed = np.sqrt(epsilon) * total["y"]
    middle.plot(total["x"], printed, "--", color=_RED, linewidth=1.2, label="(10) as printed")
    middle.plot([], [], color=_SKY, linewidth=0.8, label="one particle each")
    middle.set_title(rf"(b) smooth particles, $\epsilon$ = {_times(shown)}$h$", loc="left")
    for (overlap, curve), colour in zip(
        smooth.groupby("overlap"), (_ORANGE, _GREEN, _RED, _PINK), strict=False
    ):
        name = rf"$\epsilon$ = {_times(float(overlap))}$h$"
        right.plot(curve["x"], curve["y"], color=colour, linewidth=1.1, label=name)
    right.set_title("(c) radii too small and too large", loc="left")
    for ax in (left, middle, right):
        ax.legend(loc="upper left", fontsize=7, ncols=2, columnspacing=1.0)
    return figure


def note_kernels(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """The kernels of some derivatives, each with accuracy 2, 4, 6, over their largest value."""
    chosen = parameters["shown"]
    figure, axes = axes_row(len(chosen), height=2.8, width=9.6 / len(chosen), sharey=True)
    for letter, ax, beta in zip("abcdefgh", axes, chosen, strict=False):
        for r, curve in series[series["beta"] == beta].groupby("r"):
            colour, line = _ORDERS[int(r)]
            scaled = curve["y"] / curve["y"].abs().max()
            ax.plot(curve["x"], scaled, line, color=colour, label=f"$r$ = {r}")
        ax.axhline(0.0, color="0.6", linewidth=0.6)
        shape = "symmetric" if beta % 2 == 0 else "antisymmetric"
        ax.set_title(rf"({letter}) $\beta$ = {beta}, {shape}", loc="left")
        ax.set(xlabel="$z$", xlim=(-4.0, 4.0))
    axes[0].set_ylabel(r"kernel $\eta(z)\, /\, \max|\eta|$")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    return figure


def note_lattice_kernel(
    series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]
) -> Figure:
    """Fig. 2: (a) the kernel (27) and what the lattice sees, (b) its discrete moment, (c) other stencils."""
    figure, (shape, moments, errors) = axes_row(3, height=3.2, width=3.2)
    looks = {
        "(27)": (_BLUE, "-"),
        "Gaussian (20)": (_RED, "--"),
        "tent, M₂ = 2": ("0.55", ":"),
    }
    for name, (colour, line) in looks.items():
        part = series[series["series"] == name]
        if name != "tent, M₂ = 2":
            curve = part[part["panel"] == "shape"]
            shape.plot(curve["x"], curve["y"], line, color=colour)
        curve = part[part["panel"] == "moment"]
        label = "tent with $M_2$ = 2" if name.startswith("tent") else name
        moments.plot(curve["x"], curve["y"], line, color=colour, label=label)
    seen = series[(series["panel"] == "points") & (series["series"] == "(27)")]
    shape.plot(seen["x"], seen["y"], "o", color=_BLUE, markersize=6)
    for i, eta in zip(seen["x"], seen["y"], strict=True):
        if i >= 0 and eta > 0:
            shape.annotate(
                rf"$\eta({i:g}) = {eta:g}$", (i, eta), xytext=(7, 2), textcoords="offset points",
                color=_BLUE, fontsize=8,
            )  # fmt: skip
    shape.annotate("Gaussian (20)", (-0.8, 1.6), xytext=(-2.9, 1.9), color=_RED, fontsize=8)
    shape.annotate("kernel (27)", (-1.0, 1.0), xytext=(-2.9, 0.85), color=_BLUE, fontsize=8)
    shape.set(xlabel="$z = x / \\epsilon$", ylabel=r"kernel $\eta(z)$", ylim=(-0.1, 2.45))
    overlap = series.loc[series["panel"] == "moment", "x"]
    numerator, denominator = parameters["claimed_moment"]
    far = 0.5 * numerator / denominator
    moments.axhline(far, color=_BLUE, linewidth=0.7, linestyle=(0, (1, 3)))
    moments.annotate(
        "$M_2/2$ of (27)", (overlap.max(), far), xytext=(0, 3), textcoords="offset points",
        ha="right", color=_BLUE, fontsize=8,
    )  # fmt: skip
    moments.plot(1.0, 1.0, "o", color=_BLUE, markersize=6)
    moments.annotate(
        r"(27) with $\epsilon = h$", (1.0, 1.0), xytext=(2.0, 0.55), color=_BLUE, fontsize=8,
        arrowprops={"arrowstyle": "-", "color": _BLUE, "linewidth": 0.7, "shrinkB": 4},
    )  # fmt: skip
    moments.set(
        xlabel=r"overlap $\epsilon / h$", ylabel=r"what $f''$ is multiplied by, $\hat M_2/2$"
    )
    moments.set(xlim=(0.4, overlap.max()), ylim=(0.0, 1.8))
    moments.legend(loc="lower right", fontsize=7)
    stencils = series[series["panel"] == "error"]
    for r, curve in stencils.groupby(stencils["series"].astype(int)):
        colour, line = _ORDERS[int(r)]
        curve = curve.sort_values("x")
        errors.plot(curve["x"], curve["y"], line, marker="o", color=colour)
        x, y = curve["x"].to_numpy(), curve["y"].to_numpy()
        errors.annotate(
            f"$r$ = {r}", (x[-1], y[-1]), xytext=(5, 0), textcoords="offset points", va="center",
            color=colour, fontsize=8,
        )  # fmt: skip
        if r in (2, 8):  # between the lines there is no room
            slope_triangle(errors, x[0] * 1.2, 0.3 * y[0] * 1.2**r, float(r))
    spacing = sorted(stencils["x"].unique())
    errors.set(xscale="log", yscale="log", xlim=(0.85 * spacing[0], 1.6 * spacing[-1]))
    errors.set_xticks(spacing, [f"{h:g}" for h in spacing])
    errors.minorticks_off()
    errors.set(xlabel=r"particle spacing $h = \epsilon$", ylabel="largest error of $f''$")
    return figure


def note_error_law(series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]) -> Figure:
    """(a) regularisation over its constant, (b) quadrature with its bound, (c) both against the radius."""
    figure, (first, second, both) = axes_row(3, height=3.7, width=3.2)
    part = series[series["panel"] == "regularisation"]
    for (r, beta), curve in part.groupby(["r", "beta"]):
        curve = curve.sort_values("x")
        colour, _ = _ORDERS[int(r)]
        first.plot(
            curve["x"], curve["y"], _WAYS[int(beta)], color=colour, markeredgewidth=0.8,
            markerfacecolor="none", markersize=4.0 + 1.3 * int(beta),
        )  # fmt: skip
    radii = np.array(sorted(part["x"].unique()))
    for r in sorted(part["r"].unique()):
        colour, line = _ORDERS[int(r)]
        first.plot(radii, radii**r, line, color=colour, linewidth=1.0)
        first.annotate(
            rf"$\epsilon^{int(r)}$", (radii[0], radii[0] ** r), xytext=(-9, 0),
            textcoords="offset points", ha="right", va="center", color=colour,
        )  # fmt: skip
    first.set(xscale="log", yscale="log", xlabel=r"kernel radius $\epsilon$")
    first.set(xlim=(0.6 * radii[0], 1.15 * radii[-1]))
    first.set_xticks(radii, [f"{e:g}" for e in radii])
    first.minorticks_off()
    first.set_ylabel(r"regularisation error $/\ (C_1\, \|f^{(\beta+r)}\|)$")
    marks = [
        Line2D([], [], color="0.3", marker=_WAYS[int(b)], linestyle="", markerfacecolor="none",
               label=rf"$\beta$ = {int(b)}")
        for b in sorted(part["beta"].unique())
    ]  # fmt: skip
    first.legend(handles=marks, loc="lower right", fontsize=7)

    looks = zip((_BLUE, _RED, _GREEN, _PINK), ("-", "--", "-.", ":"), strict=True)
    waves = series[series["panel"] == "quadrature"]
    for (name, curve), (colour, _) in zip(waves.groupby("series", sort=False), looks, strict=False):
        second.plot(curve["x"], curve["y"], color=colour)
        bound = series[(series["panel"] == "bound") & (series["series"] == name)]
        second.plot(bound["x"], bound["y"], "--", color=colour, linewidth=0.8)
        if len(bound):
            ends = bound.sort_values("x").iloc[[0, -1]]
            m = np.log(ends["y"].iloc[1] / ends["y"].iloc[0])
            m /= np.log(ends["x"].iloc[1] / ends["x"].iloc[0])
            second.annotate(
                f"$m$ = {m:.0f}", (ends["x"].iloc[0], ends["y"].iloc[0]), xytext=(-5, -2),
                textcoords="offset points", ha="right", color=colour, fontsize=8,
            )  # fmt: skip
        else:
            low = curve[curve["y"] > 1e-9].sort_values("y").iloc[0]
            second.annotate(
                "Gaussian", (low["x"], low["y"]), xytext=(8, -8), textcoords="offset points",
                color=colour, fontsize=8,
            )  # fmt: skip
    second.set(xscale="log", yscale="log", xlabel=r"$h / \epsilon$", ylim=(1e-11, 10.0))
    second.set_xlim(0.6 * waves["x"].min(), 1.3)
    second.set_ylabel("quadrature error of $f''$")
    ticks = [t for t in (0.125, 0.25, 0.5, 1.0) if t >= waves["x"].min()]
    second.set_xticks(ticks, [f"1/{1 / t:g}" if t < 1.0 else "1" for t in ticks])
    second.minorticks_off()

    _total(both, series[series["panel"] == "total"])
    return figure


def _total(ax: Axes, part: pd.DataFrame) -> None:
    """Error against radius for several h; a mark where eps = h, and the kernel whose moments the lattice meets."""
    names = sorted((s for s in part["series"].unique() if s != "lattice"), key=float)
    for name, colour in zip(names, (_BLUE, _GREEN, _ORANGE, _RED), strict=False):
        curve = part[part["series"] == name].sort_values("x")
        h = float(name)
        ax.plot(curve["x"], curve["y"], color=colour, label=f"$h$ = {h:g}")
        x, y = curve["x"].to_numpy(), curve["y"].to_numpy()
        at = np.exp(np.interp(np.log(h), np.log(x), np.log(y)))
        ax.plot(h, at, "o", color=colour, markersize=5)
    lattice = part[part["series"] == "lattice"].sort_values("x")
    ax.plot(lattice["x"], lattice["y"], "k*", markersize=7, label="moments met\non the lattice")
    ax.set(xscale="log", yscale="log", xlabel=r"kernel radius $\epsilon$  (dot: $\epsilon = h$)")
    ax.set(ylabel="error of $f''$, sum (21)", ylim=(1e-5, 4.0))
    slope_triangle(ax, 0.35, 0.2 * 0.125 * 0.35**2, 2.0)
    ax.legend(loc="lower right", fontsize=7)


def note_conservation(
    series: pd.DataFrame, table: pd.DataFrame, parameters: dict[str, Any]
) -> Figure:
    """(a) Strengths per volume on random particles, (b) total strength over time, (c) accuracy by arrangement."""
    figure, (solution, mass, errors) = axes_row(3, height=3.7, width=3.3)
    part = series[(series["panel"] == "solution") & (series["x"].abs() < 5.0)]
    exact = series[series["panel"] == "exact"]
    solution.plot(exact["x"], exact["y"], color="black", linewidth=1.0, label="exact")
    width = 2.0 * float(parameters["half_width"]) / float(parameters["particles"])
    solution.scatter(
        part["x"], part["y"], s=9.0 * part["volume"] / width, color=_BLUE, alpha=0.7, linewidth=0,
        label="random particles",
    )  # fmt: skip
    solution.plot(part["x"], np.full(len(part), -0.012), "|", color=_BLUE, markersize=5)
    solution.set(xlabel="$x$", ylabel="$Q_i / V_i$ at the end", ylim=(-0.025, 0.43))
    solution.legend(loc="upper left", fontsize=7, ncols=2)

    floor = 1e-17
    looks = {"lattice": (_GREEN, "s"), "mapped": (_PINK, "D"), "jittered": (_RED, "^")}
    looks |= {"random": (_BLUE, "o")}
    lines = {"Gaussian (20)": "-", "skewed (20)": "--"}
    for (kind, name), curve in series[series["panel"] == "mass"].groupby(["kind", "series"]):
        if name in lines:
            colour, marker = looks[str(kind)]
            later = curve[curve["x"] > 0.0]
            mass.plot(
                later["x"], np.maximum(later["y"], floor), lines[str(name)], marker=marker,
                color=colour, markersize=3.5, markerfacecolor="none" if name != "Gaussian (20)" else colour,
            )  # fmt: skip
    mass.set(yscale="log", ylim=(1e-19, 100.0), xlabel="time since the start")
    mass.set_ylabel(r"$|\sum Q(t) / \sum Q(0) - 1|$")
    mass.annotate(
        "dashed: skewed kernel", (0.03, 0.98), xycoords="axes fraction", va="top", fontsize=8
    )
    mass.annotate(
        "solid: symmetric kernel (20)", (0.03, 0.03), xycoords="axes fraction", fontsize=8
    )

    operator = series[series["panel"] == "operator"]
    for kind, power in (("lattice", 1.0), ("mapped", 1.0), ("jittered", 1.0), ("jittered", 0.5)):
        colour, marker = looks[kind]
        curve = operator[(operator["kind"] == kind) & (operator["power"] == power)].sort_values("x")
        errors.plot(
            curve["x"], curve["y"], "-" if power == 1.0 else ":", marker=marker, color=colour,
            markersize=8 if kind == "lattice" else 4.5,
            markerfacecolor="none" if kind == "lattice" else colour,
            label=kind if power == 1.0 else rf"{kind}, $\epsilon \propto h^{{1/2}}$",
        )  # fmt: skip
    errors.set(xscale="log", yscale="log", xlabel="particle spacing $h$")
    errors.set_ylabel("relative error of $f''$ by (26)")
    spacing = sorted(series.loc[series["panel"] == "operator", "x"].unique())
    errors.set_xticks(spacing, [f"{h:g}" for h in spacing])
    errors.minorticks_off()
    lattice = series[(series["panel"] == "operator") & (series["kind"] == "lattice")]
    finest = lattice.sort_values("x").iloc[0]
    slope_triangle(errors, 1.3 * finest["x"], 0.6 * finest["y"], 2.0)
    handles, labels = errors.get_legend_handles_labels()
    handles.append(Line2D([], [], color=_BLUE, marker="o"))
    figure.legend(handles, [*labels, "random"], loc="outside lower center", ncols=5)
    return figure


def _times(factor: float) -> str:
    return "" if factor == 1.0 else f"{factor:g} "
