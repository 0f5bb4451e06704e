"""Why the scheme (29) is unstable."""

import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import RED, Axes, Figure, Look, axes_row, draw, entry, log_log, scheme_style

_SHADES = ("#F0A868", "#E58338", "#C65A11", "#8A3A05")  # one hue, light to dark
_PREDICTED: Look = {"color": "0.3", "linewidth": 0.8, "linestyle": ":"}
_POINTS: Look = {"markersize": 3.0, "linestyle": "none"}
_EIGENVALUES = {
    "DD": scheme_style("DD", label="DD", **_POINTS),
    "PSE29": scheme_style("PSE29", label="(29)", color=RED, markerfacecolor=RED, **_POINTS),
}


def figure(series: pd.DataFrame, *, shown_beta: float) -> Figure:
    """Draw (a) the kernel, (b) the eigenvalues beside those of DD, (c) runs that grow at the end of the lattice."""
    titles = ("kernel of (29)", rf"spectrum, $\beta = {shown_beta:g}$", "growth")
    figure, axes = axes_row(titles, width=3.4, height=3.6)
    _kernels(axes[0], pick(series, panel="kernel"))
    _spectrum(axes[1], pick(series, panel="spectrum"))
    _histories(axes[2], pick(series, panel="history"))
    return figure


def _kernels(ax: Axes, kernels: pd.DataFrame) -> None:
    groups = kernels.groupby("series", sort=False)
    for (beta, points), look in zip(groups, ("-", "--", ":"), strict=False):
        draw(ax, points, look, color="black", label=rf"$\beta = {float(beta):g}$")
    ax.axhline(0.0, color="0.5", linewidth=0.8)
    ax.set(xlabel=r"$r = |x| / \epsilon$", ylabel="kernel $G(r)$, Eq. (11)")
    ax.legend(loc="lower right")


def _spectrum(ax: Axes, spectrum: pd.DataFrame) -> None:
    for name, look in _EIGENVALUES.items():
        draw(ax, pick(spectrum, series=name).sort_values("x"), **look)
    low, high = spectrum["y"].min(), spectrum["y"].max()
    ax.axhline(0.0, color="0.5", linewidth=0.8)
    ax.axhspan(0.0, 1.15 * high, color=RED, alpha=0.12, linewidth=0)
    ax.annotate("growing", (0.03, 0.5 * high), color="0.25", va="center")
    ax.set(xlabel="rank / number of particles", ylim=(1.05 * low, 1.15 * high))
    ax.set_ylabel(r"eigenvalue $\lambda h^\alpha / \mathcal{D}$")
    ax.legend(loc="lower right")


def _histories(ax: Axes, history: pd.DataFrame) -> None:
    spacings = sorted(history["series"].unique(), key=float, reverse=True)
    for spacing, colour in zip(spacings, _SHADES, strict=False):
        points = pick(history, series=spacing).sort_values("x")
        elapsed = points["x"] - points["x"].iloc[0]
        ax.plot(elapsed, points["y"], color=colour)
        ax.plot(elapsed, points["predicted"], **_PREDICTED)
        end = (elapsed.iloc[-1], points["y"].iloc[-1])
        style.note(ax, f"{float(spacing):.3g}", end, (0, 3), ha="center", va="bottom", color=colour)
    highest = history["y"].max()
    log_log(ax, xlabel=r"time $t - t_0$", ylabel="$|u|$ at the end of the lattice")
    ax.set_xlim(left=3e-3 * history["x"].max())
    ax.set_ylim(highest * 1e-21, highest * 1e3)
    run = entry("run, spacing $h$", color=_SHADES[1])
    predicted = entry(r"$\propto e^{\lambda t}$", **_PREDICTED)
    ax.legend(handles=[run, predicted], loc="lower right")
