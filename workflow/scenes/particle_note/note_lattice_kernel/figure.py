"""Fig. 2 of the note: the kernel (27) for a lattice, and other stencils."""

import pandas as pd

from fracstudy import style
from fracstudy.panels import pick
from fracstudy.style import Axes, Figure, Look, axes_row, draw, log_log, name_ticks, note
from scenes.particle_note.waves import LINES

_BLUE, _RED = LINES[2]["color"], LINES[4]["color"]
_LOOKS: dict[str, Look] = {
    "(27)": {"label": "(27)", **LINES[2]},
    "Gaussian (20)": {"label": "Gaussian (20)", **LINES[4]},
    "tent, M₂ = 2": {"label": "tent with $M_2$ = 2", "color": "0.55", "linestyle": ":"},
}
_ARROW = {"arrowstyle": "-", "color": _BLUE, "linewidth": 0.7, "shrinkB": 4}


def figure(series: pd.DataFrame, *, claimed_moment: list[int]) -> Figure:
    """(a) the kernel (27) and what the lattice sees, (b) its discrete moment, (c) other stencils."""
    drawn, (shape, moments, errors) = axes_row(3, height=3.2, width=3.2)
    curves = dict(tuple(series.groupby(["panel", "series"])))
    for name, look in _LOOKS.items():
        if name != "tent, M₂ = 2":
            draw(shape, curves["shape", name], **look)
        draw(moments, curves["moment", name], **look)
    seen = curves["points", "(27)"]
    draw(shape, seen, "o", color=_BLUE, markersize=6)
    for i, eta in zip(seen["x"], seen["y"], strict=True):
        if i >= 0 and eta > 0:
            note(shape, rf"$\eta({i:g}) = {eta:g}$", (i, eta), (13, 1), color=_BLUE)
    shape.annotate("Gaussian (20)", (-0.8, 1.6), xytext=(-2.9, 1.9), color=_RED, fontsize=8)
    shape.annotate("kernel (27)", (-1.0, 1.0), xytext=(-2.9, 0.85), color=_BLUE, fontsize=8)
    shape.set(xlabel="$z = x / \\epsilon$", ylabel=r"kernel $\eta(z)$", ylim=(-0.1, 2.45))

    widest = curves["moment", "(27)"]["x"].max()
    far = 0.5 * claimed_moment[0] / claimed_moment[1]
    moments.axhline(far, color=_BLUE, linewidth=0.7, linestyle=(0, (1, 3)))
    note(moments, "$M_2/2$ of (27)", (widest, far), (0, 3), ha="right", color=_BLUE)
    moments.plot(1.0, 1.0, "o", color=_BLUE, markersize=6)
    fits, look = r"(27) with $\epsilon = h$", {"color": _BLUE, "arrowprops": _ARROW}
    note(moments, fits, (1.0, 1.0), (2.0, 0.55), textcoords="data", **look)
    moments.set(xlabel=r"overlap $\epsilon / h$", xlim=(0.4, widest), ylim=(0.0, 1.8))
    moments.set_ylabel(r"what $f''$ is multiplied by, $\hat M_2/2$")
    moments.legend(loc="lower right", fontsize=7)
    _stencils(errors, pick(series, panel="error"))
    return drawn


def _stencils(ax: Axes, errors: pd.DataFrame) -> None:
    for r, curve in errors.groupby(errors["series"].astype(int)):
        curve = curve.sort_values("x")
        x, y = curve["x"].to_numpy(), curve["y"].to_numpy()
        ax.plot(x, y, marker="o", **LINES[r])
        colour = LINES[r]["color"]
        note(ax, f"$r$ = {r}", (x[-1], y[-1]), (5, 0), va="center", color=colour)
        if r in (2, 8):  # between the lines there is no room
            style.slope_triangle(ax, x[0] * 1.2, 0.3 * y[0] * 1.2**r, float(r))
    spacing = sorted(errors["x"].unique())
    log_log(ax, xlim=(0.85 * spacing[0], 1.6 * spacing[-1]))
    name_ticks(ax, spacing)
    ax.minorticks_off()
    ax.set(xlabel=r"particle spacing $h = \epsilon$", ylabel="largest error of $f''$")
