"""Radial flux and diffusion rate of the initial condition in two dimensions, Fig. 7."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from fracparticles.lattice.sums import BOX_SUMMATIONS
from fracparticles.run.case import Case
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.fpse import flux_weights
from fracparticles.special.stable import green, green_flux, green_rate
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.orders import orders_by
from fracstudy.panels import Panels
from scenes.plane import DISC

_ERROR, _ORDER = "largest error / largest value, r <= 5", "observed order"
_QUANTITIES = {"flux": "flux (19), FPSE"} | {s: f"diffusion rate, {s}" for s in ("DD", "FPSE")}


def flux_along_axis(case: Case, u: np.ndarray) -> np.ndarray:
    """Return Q . e_x of (19) at the particles with y = 0.

    Q_i = -(1 / epsilon^beta) sum_j V_j u_j F_epsilon(x_i - x_j).
    """
    offsets = np.arange(2 * case.n + 1.0)
    r = np.hypot(offsets[:, None], offsets[None, :])
    radial = flux_weights(r, case.setting)
    along_x = radial * offsets[:, None] / np.where(r > 0.0, r, 1.0)
    count = offsets.size
    sums = BOX_SUMMATIONS["fft"]([along_x], [0], count, count)
    return case.particle_spacing**-case.beta * sums(u)[0][:, case.n]


def study(
    inputs: Inputs,
    *,
    beta: float,
    truncation: float,
    time: float,
    particles: list[int],
    finer: list[int],
) -> Result:
    """Errors of the flux and the rate of G(., t_0) along y = 0, on the printed lattices and finer ones."""
    alpha = 1.0 + beta
    common = {"beta": beta, "dim": 2, "truncation": truncation, "integrator": "exponential"}
    # The half-width does not depend on the spacing asked for.
    width = 2.0 * Case(scheme="DD", spacing=1.0, **common).reach
    panels = Panels()
    for count in (*particles, *finer):
        cases = [Case(scheme=s, spacing=width / (count - 1), **common) for s in ("DD", "FPSE")]
        case, kept = cases[1], cases[1].x >= 0.0
        u, r = np.asarray(green(case.radius, time, alpha, 2)), case.x[kept]
        flux, rate = green_flux(r, time, alpha, 2), green_rate(r, time, alpha, 2)
        found = {"flux": (flux_along_axis(case, u), flux)}
        found |= {one.scheme: (_rate_along_axis(one, u), rate) for one in cases}
        for name, (profile, exact) in found.items():
            where = {"quantity": name, "N": count, "h": case.particle_spacing}
            panels.add(**where, x=r, y=profile[kept], exact=exact)
    series = panels.frame.rename(columns={"x": "r"})
    table = _table(series)
    shown = (series["r"] <= DISC) & (series["N"] <= max(particles))
    drawn = series[shown | (series["N"] == series["N"].max())]
    return Result(table, inputs.judged(_findings(table, particles)), drawn)


def _rate_along_axis(case: Case, u: np.ndarray) -> np.ndarray:
    rate = SCHEMES[case.scheme].operator(case.setting).apply(u.reshape(-1))
    return rate.reshape(case.shape)[:, case.n]


def _table(series: pd.DataFrame) -> pd.DataFrame:
    rows = []
    for name, words in _QUANTITIES.items():
        for count, part in series[series["quantity"] == name].groupby("N"):
            inside = part["r"] <= DISC
            error = (part["y"] - part["exact"]).abs() / part["exact"].abs().max()
            row = {
                "quantity": words,
                "N": count,
                "h": part["h"].iloc[0],
                _ERROR: error[inside].max(),
                "at r": part.loc[error[inside].idxmax(), "r"],
                "ratio for 3 < r < 5": error[inside & (part["r"] > 3.0)].max(),
                "ratio for r > 5": error[~inside].max(),
            }
            rows.append(row)
    table = pd.DataFrame(rows)
    return table.assign(**{_ORDER: orders_by(table, "quantity", _ERROR)})


def _findings(table: pd.DataFrame, printed: list[int]) -> Iterator[Finding]:
    names = {words: name for name, words in _QUANTITIES.items()}
    table = table.assign(quantity=table["quantity"].map(names))
    by_count = table.pivot(index="N", columns="quantity")
    error, order = by_count[_ERROR].loc[printed], by_count[_ORDER]
    # The error over that of the lattice before, by quantity and N.
    fall = (error / error.shift()).iloc[1:].unstack()
    last, beyond = order.loc[printed[-1]], order[order.index > printed[-1]].iloc[0]
    errors = {f"N = {n}": error["flux"][n] for n in printed}
    yield measured("L-F7.flux_converges", ratio=fall["flux"], error=errors)
    of_rates = error.loc[printed[-1]].drop("flux")
    yield measured("L-F7.rate_converges", ratio=fall[["DD", "FPSE"]], error=of_rates)
    away = {"difference": (last - 2.0).abs(), "beyond": (beyond - 2.0).abs()}
    yield measured("L-F7.second_order", **away, order=last, finer=beyond)
