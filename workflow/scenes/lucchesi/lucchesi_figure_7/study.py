"""Radial flux and diffusion rate of the initial condition in two dimensions, Fig. 7."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.lattice.sums import BOX_SUMMATIONS
from fracparticles.run.case import Case
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.fpse import flux_weights
from fracparticles.special.stable import green, green_flux, green_rate
from fracstudy.inputs import Inputs, Result, observed_order, statement
from scenes.beyond.solution_map_2d.study import DISK

__all__ = ["flux_along_axis", "study"]

_SECOND = 0.25  # how far from 2 an observed order may be
_COLUMN = "largest error for r <= 5 / largest value"
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


def study(inputs: Inputs) -> Result:
    """Errors of the flux and the rate of G(., t_0) along y = 0, on the printed lattices and finer ones."""
    parameters = inputs.parameters
    counts = [*parameters["particles"], *parameters["finer"]]
    time, alpha = float(parameters["time"]), 1.0 + float(parameters["beta"])
    parts = []
    for count in counts:
        x, h, profiles = _profiles(parameters, count)
        kept = x >= 0.0
        r = x[kept]
        exact = {"flux": green_flux(r, time, alpha, 2), "rate": green_rate(r, time, alpha, 2)}
        for name, profile in profiles.items():
            true = exact["flux" if name == "flux" else "rate"]
            parts.append(
                pd.DataFrame(
                    {
                        "quantity": name,
                        "N": count,
                        "h": h,
                        "r": r,
                        "y": profile[kept],
                        "exact": true,
                    }
                )
            )
    series = pd.concat(parts, ignore_index=True)
    table = _table(series)
    findings = _findings(table, counts[: len(parameters["particles"])])
    fine = series["N"].max()
    shown = (series["r"] <= DISK) & (series["N"] <= max(parameters["particles"]))
    drawn = series[shown | (series["N"] == fine)]
    return Result(table, findings, drawn)


def _profiles(
    parameters: Mapping[str, Any], count: int
) -> tuple[np.ndarray, float, dict[str, np.ndarray]]:
    """The positions, h, and flux and rates along y = 0 on the lattice of `count` particles a side."""
    profiles = {}
    for scheme in ("DD", "FPSE"):
        case = Case(
            scheme=scheme,
            beta=parameters["beta"],
            dim=2,
            truncation=parameters["truncation"],
            # The half-width does not depend on the spacing asked for.
            spacing=_spacing(parameters, count),
            integrator="exponential",
        )
        u = np.asarray(green(case.radius, parameters["time"], case.alpha, 2))
        rate = SCHEMES[scheme].operator(case.setting).apply(u.reshape(-1)).reshape(case.shape)
        profiles[scheme] = rate[:, case.n]
        if scheme == "FPSE":
            profiles["flux"] = flux_along_axis(case, u)
    return case.x, case.particle_spacing, profiles


def _spacing(parameters: Mapping[str, Any], count: int) -> float:
    probe = Case(
        scheme="DD",
        beta=parameters["beta"],
        dim=2,
        truncation=parameters["truncation"],
        spacing=1.0,
        integrator="exponential",
    )
    return 2.0 * probe.domain / (count - 1)


def _table(series: pd.DataFrame) -> pd.DataFrame:
    rows = []
    for (name, count), part in series.groupby(["quantity", "N"]):
        inside = part["r"] <= DISK
        error = (part["y"] - part["exact"]).abs() / part["exact"].abs().max()
        rows.append(
            {
                "quantity": name,
                "N": count,
                "h": part["h"].iloc[0],
                _COLUMN: error[inside].max(),
                "at r": part.loc[error[inside].idxmax(), "r"],
                "the same, 3 < r < 5": error[inside & (part["r"] > 3.0)].max(),
                "the same, r > 5": error[~inside].max(),
            }
        )
    table = pd.DataFrame(rows).sort_values(["quantity", "N"]).reset_index(drop=True)
    table["observed order"] = np.nan
    for _, part in table.groupby("quantity"):
        order = observed_order(part["h"], part[_COLUMN])
        table.loc[part.index[1:], "observed order"] = order
    # The flux first, as in the figure.
    place = table["quantity"].map({name: k for k, name in enumerate(_QUANTITIES)})
    table = table.assign(place=place).sort_values(["place", "N"]).drop(columns="place")
    return table.assign(quantity=table["quantity"].map(_QUANTITIES)).reset_index(drop=True)


def _findings(table: pd.DataFrame, printed: list[int]) -> list:
    errors = table.pivot_table(index="N", columns="quantity", values=_COLUMN)
    here = errors.loc[printed]
    spelled = {
        name: ", ".join(f"{error:.2g}" for error in here[name]) for name in _QUANTITIES.values()
    }
    where = f"of the largest value at N = {', '.join(map(str, printed))}"
    orders = table.dropna(subset=["observed order"])
    last = orders[orders["N"] == printed[-1]].set_index("quantity")["observed order"]
    beyond = orders[orders["N"] > printed[-1]].set_index("quantity")["observed order"]
    flux, *rates = _QUANTITIES.values()
    return [
        statement(
            "L-F7.flux_converges",
            bool((np.diff(here[flux]) < 0.0).all()),
            f"Largest error of the flux along y = 0: {spelled[flux]} {where}.",
            "The error does not fall from each lattice to the next.",
        ),
        statement(
            "L-F7.rate_converges",
            bool((np.diff(here[rates], axis=0) < 0.0).all()),
            f"Largest error of the diffusion rate, {where}: {spelled[rates[0]]} (DD); {spelled[rates[1]]} (FPSE).",
            "The error does not fall from each lattice to the next.",
        ),
        statement(
            "L-F7.second_order",
            bool(((last - 2.0).abs() < _SECOND).all()),
            f"Observed order of the largest error between the two finest lattices: {_spell(last)}; between N = "
            f"{printed[-1]} and the next finer one, not in the paper: {_spell(beyond)}.",
            "The peak at the origin is not resolved yet: the order is still below 2.",
        ),
    ]


def _spell(values: pd.Series) -> str:
    return ", ".join(f"{values[name]:.2f} ({name})" for name in _QUANTITIES.values())
