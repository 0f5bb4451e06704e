"""Radial flux and diffusion rate of the initial condition in two dimensions, Fig. 7."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from fracparticles.lattice.sums import BOX_SUMMATIONS
from fracparticles.run.case import Case
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.fpse import flux_weights
from fracparticles.special.stable import green, green_flux, green_rate
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from fracstudy.orders import orders_by
from scenes.plane import DISK

__all__ = ["flux_along_axis", "study"]

_SECOND = 0.25  # how far from 2 an observed order may be
_ERROR, _ORDER = "largest error for r <= 5 / largest value", "observed order"
_QUANTITIES = {
    "flux": "flux (19), FPSE",
    "DD": "diffusion rate, DD",
    "FPSE": "diffusion rate, FPSE",
}


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
    parts = []
    for count in (*particles, *finer):
        cases = [
            Case(scheme=scheme, spacing=width / (count - 1), **common) for scheme in ("DD", "FPSE")
        ]
        case, kept = cases[1], cases[1].x >= 0.0
        u, r = np.asarray(green(case.radius, time, alpha, 2)), case.x[kept]
        flux, rate = green_flux(r, time, alpha, 2), green_rate(r, time, alpha, 2)
        found = {"flux": (flux_along_axis(case, u), flux)}
        found |= {one.scheme: (_rate_along_axis(one, u), rate) for one in cases}
        where: dict[str, Any] = {"N": count, "h": case.particle_spacing, "r": r}
        for name, (profile, exact) in found.items():
            curve = {"quantity": name, **where, "y": profile[kept], "exact": exact}
            parts.append(pd.DataFrame(curve))
    series = pd.concat(parts, ignore_index=True)
    table = _table(series)
    shown = (series["r"] <= DISK) & (series["N"] <= max(particles))
    drawn = series[shown | (series["N"] == series["N"].max())]
    return Result(table, inputs.judged(_findings(table, particles)), drawn)


def _rate_along_axis(case: Case, u: np.ndarray) -> np.ndarray:
    rate = SCHEMES[case.scheme].operator(case.setting).apply(u.reshape(-1))
    return rate.reshape(case.shape)[:, case.n]


def _table(series: pd.DataFrame) -> pd.DataFrame:
    rows = []
    for name, words in _QUANTITIES.items():
        for count, part in series[series["quantity"] == name].groupby("N"):
            inside = part["r"] <= DISK
            error = (part["y"] - part["exact"]).abs() / part["exact"].abs().max()
            rows.append(
                {
                    "quantity": words,
                    "N": count,
                    "h": part["h"].iloc[0],
                    _ERROR: error[inside].max(),
                    "at r": part.loc[error[inside].idxmax(), "r"],
                    "the same, 3 < r < 5": error[inside & (part["r"] > 3.0)].max(),
                    "the same, r > 5": error[~inside].max(),
                }
            )
    table = pd.DataFrame(rows)
    return table.assign(**{_ORDER: orders_by(table, "quantity", _ERROR)})


def _findings(table: pd.DataFrame, printed: list[int]) -> list[Finding]:
    flux, dd, fpse = _QUANTITIES.values()
    errors = table.pivot_table(index="N", columns="quantity", values=_ERROR).loc[printed]
    values = {name: ", ".join(f"{error:.2g}" for error in errors[name]) for name in errors}
    where = f"of the largest value at N = {', '.join(map(str, printed))}"
    orders = table.set_index(["N", "quantity"])[_ORDER]
    last = orders[printed[-1]]
    beyond = orders[orders.index.get_level_values("N") > printed[-1]].droplevel("N")
    last_, beyond_ = (_spelled(order) for order in (last, beyond))
    grows = "The error does not fall from each lattice to the next."
    falls = np.diff(errors[[flux, dd, fpse]], axis=0) < 0.0
    return [
        statement(
            "L-F7.flux_converges",
            falls[:, 0].all(),
            f"Largest error of the flux along y = 0: {values[flux]} {where}.",
            grows,
        ),
        statement(
            "L-F7.rate_converges",
            falls[:, 1:].all(),
            f"Largest error of the diffusion rate, {where}: {values[dd]} (DD); {values[fpse]} (FPSE).",
            grows,
        ),
        statement(
            "L-F7.second_order",
            ((last - 2.0).abs() < _SECOND).all(),
            f"Observed order of the largest error between the two finest lattices: {last_}; between N = "
            f"{printed[-1]} and the next finer one, not in the paper: {beyond_}.",
            "The peak at the origin is not resolved yet: the order is still below 2.",
        ),
    ]


def _spelled(orders: pd.Series) -> str:
    return ", ".join(f"{order:.2f} ({name})" for name, order in orders.items())
