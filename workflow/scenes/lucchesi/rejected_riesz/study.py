"""The cut-off Riesz potential, which the paper rejects without showing why, and the flux from it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.kernels.families import kernel
from fracparticles.lattice.fourier import valid_convolution
from fracparticles.schemes import riesz
from fracparticles.special.stable import green, green_flux, mean_radius
from fracstudy.inputs import Inputs, Result, observed_order, statement

__all__ = ["study"]

_POOR = 10.0  # times the error of the flux (19)


def study(inputs: Inputs) -> Result:
    """The flux -v' of the potential cut off at epsilon, and of the mollified one, against Q = x u / (alpha t).

        Q_i = (1 / epsilon^alpha) sum_j V_j u_j r K(r),    r = (x_i - x_j) / epsilon,

    with K of (31), which is the flux (19), or K* of the cut-off potential. The transform of r K* differs from that of
    the exact flux by a part of the relative order (epsilon k)^(2-alpha). The flux is called poor if its relative L1
    error over |x| <= 5 R_alpha is more than ten times that of (19), at every alpha and on every lattice; worst at large
    alpha if the error grows with alpha on every lattice.
    """
    parameters = inputs.parameters
    alphas = [float(alpha) for alpha in parameters["alpha"]]
    rows = [
        _flux_errors(alpha, float(h), parameters) for alpha in alphas for h in parameters["sum_spacing"]
    ]
    flux = pd.DataFrame(rows)
    flux["observed order, cut-off"] = _orders(flux, "error, cut-off")
    flux["observed order, (19)"] = _orders(flux, "error, (19)")
    runs = inputs.scalars.assign(
        alpha=1.0 + inputs.scalars["beta"], h=inputs.scalars["particle_spacing"]
    )
    solution = runs.pivot_table(
        index=["alpha", "h"], columns="scheme", values="relative_l1_error"
    ).reset_index()
    solution["observed order, cut-off"] = _orders(solution, "RIESZ")
    finest = flux[flux["h"] == flux["h"].min()].set_index("alpha")
    table = pd.concat(
        [
            flux.assign(of="flux").rename(columns={"error, (19)": "error, mollified (KPSE)"}),
            solution.assign(of="solution (48)").rename(
                columns={"RIESZ": "error, cut-off", "KPSE": "error, mollified (KPSE)"}
            ),
        ]
    )
    table["2 - α"] = 2.0 - table["alpha"]
    columns = [
        "of",
        "alpha",
        "h",
        "error, cut-off",
        "observed order, cut-off",
        "2 - α",
        "error, mollified (KPSE)",
    ]
    table = table[columns].sort_values(["of", "alpha", "h"], ascending=[True, True, False])
    ratio = flux["error, cut-off"] / flux["error, (19)"]
    by_lattice = flux.pivot_table(index="h", columns="alpha", values="error, cut-off")
    rises = bool((np.diff(by_lattice.to_numpy(), axis=1) > 0.0).all())
    errors = ", ".join(f"{e:.2g} (alpha = {a:g})" for a, e in finest["error, cut-off"].items())
    orders = ", ".join(f"{p:.2f}" for p in finest["observed order, cut-off"])
    others = ", ".join(f"{e:.1g}" for e in finest["error, (19)"])
    findings = [
        statement(
            "L-C16.poor",
            bool((ratio > _POOR).all()),
            f"Relative error of the flux at h = {flux['h'].min():g}: {errors}; of the flux (19): {others}. It falls "
            f"with the orders {orders}.",
            "On the coarsest lattice the flux (19) is not ten times better.",
        ),
        statement(
            "L-C16.worst_large_alpha",
            rises,
            f"Relative error of the flux at h = {flux['h'].min():g}: {errors}; it rises with alpha on every lattice."
            if rises
            else f"Relative error of the flux at h = {flux['h'].min():g}: {errors}.",
            "The error does not rise with alpha on every lattice.",
        ),
    ]
    drawn = pd.concat(
        [
            flux.assign(panel="flux", series="RIESZ", x=flux["h"], y=flux["error, cut-off"]),
            flux.assign(panel="flux", series="KPSE", x=flux["h"], y=flux["error, (19)"]),
            runs.assign(
                panel="solution", series=runs["scheme"], x=runs["h"], y=runs["relative_l1_error"]
            ),
            *_flux_profile(max(alphas), float(parameters["sum_spacing"][-1]), parameters),
        ]
    )
    return Result(table, findings, drawn[["panel", "series", "alpha", "x", "y"]])


def _fluxes(
    alpha: float, h: float, parameters: Mapping[str, Any]
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Positions within 5 R_alpha, the exact flux, that of the cut-off potential, that of (19)."""
    n, s = round(float(parameters["sum_half_width"]) / h), float(parameters["sum_overlap"])
    x, time = np.arange(-n, n + 1) * h, float(parameters["time"])
    u = np.asarray(green(x, time, alpha))
    r = np.arange(-2 * n, 2 * n + 1) / s
    scale = h / (s * h) ** alpha  # V_j / epsilon^alpha
    cut_off = scale * valid_convolution(u, r * riesz.kernel_star(r, alpha))
    mollified = -scale * valid_convolution(u, np.asarray(kernel("F", r, alpha)))
    inside = np.abs(x) <= 5.0 * mean_radius(alpha)
    return (
        x[inside],
        np.asarray(green_flux(x, time, alpha))[inside],
        cut_off[inside],
        mollified[inside],
    )


def _flux_errors(alpha: float, h: float, parameters: Mapping[str, Any]) -> dict[str, float]:
    _, exact, cut_off, mollified = _fluxes(alpha, h, parameters)
    size = np.abs(exact).sum()
    return {
        "alpha": alpha,
        "h": h,
        "error, cut-off": float(np.abs(cut_off - exact).sum() / size),
        "error, (19)": float(np.abs(mollified - exact).sum() / size),
    }


def _flux_profile(alpha: float, h: float, parameters: Mapping[str, Any]) -> list[pd.DataFrame]:
    x, exact, cut_off, mollified = _fluxes(alpha, h, parameters)
    shown = np.flatnonzero((x >= 0.0) & (x <= 6.0))
    shown = shown[:: max(1, shown.size // 200)]
    return [
        pd.DataFrame(
            {"panel": "profile", "series": name, "alpha": alpha, "x": x[shown], "y": y[shown]}
        )
        for name, y in (("exact", exact), ("RIESZ", cut_off), ("KPSE", mollified))
    ]


def _orders(table: pd.DataFrame, column: str) -> np.ndarray:
    """The observed order against the next larger h of the same alpha, nan at the largest."""
    out = pd.Series(np.nan, index=table.index)
    for _, part in table.groupby("alpha"):
        part = part.sort_values("h", ascending=False)
        out[part.index[1:]] = observed_order(part["h"].to_numpy(), part[column].to_numpy())
    return out.to_numpy()
