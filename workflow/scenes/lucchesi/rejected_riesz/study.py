"""The cut-off Riesz potential, which the paper rejects without showing why, and the flux from it."""

from itertools import product

import numpy as np
import pandas as pd

from fracparticles.kernels.families import kernel
from fracparticles.lattice.fourier import valid_convolution
from fracparticles.schemes import riesz
from fracparticles.special.stable import green, green_flux, mean_radius
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.orders import orders_by
from fracstudy.panels import Panels

NEEDS = {"scheme": ["RIESZ", "KPSE"]}

_CUT_OFF, _MOLLIFIED = "error, cut-off", "error, mollified (KPSE)"
_SERIES = {_CUT_OFF: "RIESZ", _MOLLIFIED: "KPSE"}
_ORDER = "observed order, cut-off"


def study(
    inputs: Inputs,
    *,
    alpha: list[float],
    sum_half_width: float,
    sum_spacing: list[float],
    sum_overlap: float,
    time: float,
) -> Result:
    """The flux -v' of the potential cut off at epsilon, and of the mollified one, against Q = x u / (alpha t).

        Q_i = (1 / epsilon^alpha) sum_j V_j u_j r K(r),    r = (x_i - x_j) / epsilon,

    with K of (31), which is the flux (19), or K* of the cut-off potential. The transform of r K* differs from that of
    the exact flux by a part of the relative order (epsilon k)^(2-alpha). The errors are relative L1 errors over
    |x| <= 5 R_alpha.
    """
    panels, rows = Panels(), []
    for order, h in product(alpha, sum_spacing):
        fluxes = _fluxes(order, h, round(sum_half_width / h), sum_overlap, time)
        exact, size = fluxes["exact"], fluxes["exact"].abs().sum()
        error = {name: (fluxes[s] - exact).abs().sum() / size for name, s in _SERIES.items()}
        rows.append({"of": "flux", "alpha": order, "h": h, **error})
        for name, series in _SERIES.items():
            panels.add("flux", series, h, error[name], alpha=order)
        if order == max(alpha) and h == min(sum_spacing):
            shown = fluxes[(fluxes["x"] >= 0.0) & (fluxes["x"] <= 6.0)]
            shown = shown[:: max(1, len(shown) // 200)]
            for series in ("exact", *_SERIES.values()):
                panels.add("profile", series, shown["x"], shown[series], alpha=order)
    flux = pd.DataFrame(rows)
    runs = inputs.scalars.assign(alpha=1.0 + inputs.scalars["beta"])
    runs = runs.rename(columns={"particle_spacing": "h", "relative_l1_error": "y"})
    panels.add("solution", runs["scheme"], runs["h"], runs["y"], alpha=runs["alpha"])
    solution = runs.pivot(index=["alpha", "h"], columns="scheme", values="y").reset_index()
    solution = solution.rename(columns={series: name for name, series in _SERIES.items()})
    table, key = pd.concat([flux, solution.assign(of="solution (48)")]), ["of", "alpha", "h"]
    table = table.sort_values(key, ascending=[True, True, False], ignore_index=True)
    table["2 - α"] = 2.0 - table["alpha"]
    table[_ORDER] = orders_by(table, ["of", "alpha"], _CUT_OFF)
    findings = inputs.judged(_findings(table[table["of"] == "flux"]))
    columns = [*key, _CUT_OFF, _ORDER, "2 - α", _MOLLIFIED]
    return Result(table[columns], findings, panels.frame)


def _fluxes(alpha: float, h: float, n: int, overlap: float, time: float) -> pd.DataFrame:
    """Positions within 5 R_alpha, the exact flux, that of the cut-off potential, that of (19)."""
    x, r = np.arange(-n, n + 1) * h, np.arange(-2 * n, 2 * n + 1) / overlap
    u = np.asarray(green(x, time, alpha))
    scale = h / (overlap * h) ** alpha  # V_j / epsilon^alpha
    fluxes = {
        "x": x,
        "exact": green_flux(x, time, alpha),
        "RIESZ": scale * valid_convolution(u, r * riesz.kernel_star(r, alpha)),
        "KPSE": -scale * valid_convolution(u, np.asarray(kernel("F", r, alpha))),
    }
    return pd.DataFrame(fluxes)[np.abs(x) <= 5.0 * mean_radius(alpha)]


def _findings(flux: pd.DataFrame) -> list[Finding]:
    by_alpha = flux.set_index("alpha")
    finest = flux[flux["h"] == flux["h"].min()].set_index("alpha")
    by_lattice = flux.pivot(index="h", columns="alpha", values=_CUT_OFF)
    # The least over the lattices, by the larger of two neighbouring alpha.
    rise = (by_lattice / by_lattice.shift(axis="columns")).iloc[:, 1:].min()
    error, ratio = finest[_CUT_OFF], by_alpha[_CUT_OFF] / by_alpha[_MOLLIFIED]
    poor = {"ratio": ratio.groupby("alpha").min(), "error": error}
    poor |= {"order": finest[_ORDER], "h": flux["h"].min()}
    worst = measured("L-C16.worst_large_alpha", rise=rise, error=error)
    return [measured("L-C16.poor", **poor), worst]
