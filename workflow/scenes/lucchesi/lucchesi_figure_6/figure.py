"""Phi_2 over Phi_2(0) beside Phi_1, near and far, and three other ways to compute it."""

import numpy as np
import pandas as pd

from fracstudy.style import BLUE, GREEN, ORANGE, PINK, RED, Figure, axes_row, border, log_log, note

_FLOOR = 2.0**-53  # where smaller deviations are drawn
# By dimension: colour, name, and the power of the tail, with the side of the curve that it is named on.
_DENSITIES = {
    2: (BLUE, r"$n = 2$: $\Phi_{2,\alpha}$", r"$r^{-2-\alpha}$", (-5, -4), "right", "top"),
    1: (RED, r"$n = 1$: $L_\alpha^0$", r"$r^{-1-\alpha}$", (5, 4), "left", "bottom"),
}
_RATIO = r"$\Phi_{n,\alpha}(r)\, /\, \Phi_{n,\alpha}(0)$"
_WAYS = {
    "integral (58), deviation": (GREEN, "-", "integral (58)"),
    "series, deviation": (PINK, "--", "series in $r^2$"),
    "asymptotics, deviation": (ORANGE, "-.", r"series in $r^{-\alpha}$"),
}


def figure(series: pd.DataFrame, *, beta: float, reach: list[float]) -> Figure:
    """Draw the densities (a) near the origin and (b) far from it, and (c) the deviations."""
    figure, (near, far, deviation) = axes_row(3, width=3.4, height=3.3)
    curves = {name: part.set_index("r")["y"] for name, part in series.groupby("series")}
    for dim, (colour, name, power, shift, ha, va) in _DENSITIES.items():
        curve = curves[f"Phi_{dim}(r) / Phi_{dim}(0)"]
        for ax in (near, far):
            ax.plot(curve.index, curve, color=colour, linewidth=1.6, label=name)
        r = np.array([4.0, curve.index[-1]])
        tail = curve.iloc[-1] * (r / r[-1]) ** (-dim - (1.0 + beta))
        far.plot(r, tail, color=colour, linewidth=0.9, linestyle=":")
        at = (25.0, float(np.interp(25.0, curve.index, curve)))
        note(far, power, at, shift, color=colour, fontsize=9, ha=ha, va=va)
    near.set(xlim=(0.0, 6.0), ylim=(0.0, 1.04))
    near.legend(loc="upper right")
    log_log(far)
    for name, (colour, style, label) in _WAYS.items():
        curve = curves[name].dropna().clip(lower=_FLOOR)
        deviation.plot(curve.index, curve, color=colour, linestyle=style, label=label)
    border(deviation, _FLOOR)
    log_log(deviation, xlim=reach, ylim=(3e-17, 3.0))
    deviation.set_ylabel(r"relative deviation from our $\Phi_{2,\alpha}(r)$")
    deviation.legend(loc="upper left", fontsize=7.5)
    for ax in (near, far, deviation):
        ax.set_xlabel("distance $r$")
    near.set_ylabel(_RATIO)
    far.set_ylabel(_RATIO)
    return figure
