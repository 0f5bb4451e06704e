"""Kernels from moment conditions."""

import pandas as pd

from fracstudy.panels import pick
from fracstudy.style import Figure, axes_row, legend_below
from scenes.particle_note.waves import LINES


def figure(series: pd.DataFrame, *, shown: list[int]) -> Figure:
    """The kernels of some derivatives, with each accuracy, over their largest value."""
    parity = ("symmetric", "antisymmetric")
    titles = [rf"$\beta$ = {beta}, {parity[beta % 2]}" for beta in shown]
    drawn, axes = axes_row(titles, height=2.8, width=9.6 / len(shown), sharey=True)
    for ax, beta in zip(axes, shown, strict=True):
        for r, curve in pick(series, beta=beta).groupby("r"):
            scaled = curve["y"] / curve["y"].abs().max()
            ax.plot(curve["x"], scaled, label=f"$r$ = {r}", **LINES[r])
        ax.axhline(0.0, color="0.6", linewidth=0.6)
        ax.set(xlabel="$z$", xlim=(-4.0, 4.0))
    axes[0].set_ylabel(r"kernel $\eta(z)\, /\, \max|\eta|$")
    legend_below(drawn, axes[0])
    return drawn
