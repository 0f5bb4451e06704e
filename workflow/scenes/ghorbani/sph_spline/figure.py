"""The cubic spline of Fig. 2, and its sums over the particles."""

import pandas as pd

from fracstudy.style import BLUE, GREEN, RED, Figure, axes_row, draw, note

# Label, colour and, in the first panel, place of the label.
_KERNEL = {
    "W": (r"$hW$", BLUE, (0.75, 0.42)),
    "dW": (r"$h^2\,\nabla W$", RED, (-1.75, 0.52)),
    "integral": (r"$\widetilde{W}$", GREEN, (0.95, 0.82)),
}
_SUMS = {"sum": (r"$\sum s\,W_{ij}$", BLUE), "L": (r"$L_i$ of (19)", RED)}


def figure(series: pd.DataFrame, *, smoothing_ratio: float) -> Figure:
    """Draw (a) the spline, its gradient and its integral; (b) its two sums over equally spaced particles."""
    drawn, (kernel, sums) = axes_row(2, height=3.0, width=3.8)
    curves = dict(tuple(series.groupby("curve")))
    for name, (label, colour, place) in _KERNEL.items():
        draw(kernel, curves[name], color=colour)
        kernel.text(*place, label, color=colour)
    kernel.set(xlabel="distance $x / h$", ylabel="cubic spline (22)", xlim=(-2.5, 2.5))
    for name, (label, colour) in _SUMS.items():
        draw(sums, curves[name], color=colour, label=label)
    sums.axhline(1.0, color="0.4", linewidth=0.8)
    sums.axvline(smoothing_ratio, color="0.4", linewidth=0.8, linestyle=":")
    chosen = f"$h = {smoothing_ratio:g}\\,s$"
    note(sums, chosen, (smoothing_ratio, 0.0), (4, 6), xycoords=("data", "axes fraction"))
    sums.set(xlabel="smoothing ratio $h / s$", ylabel="sum over the particles", ylim=(0.9, 1.1))
    sums.legend(loc="upper right")
    return drawn
