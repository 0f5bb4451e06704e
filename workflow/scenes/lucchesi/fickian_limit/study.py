"""The Fickian limit: the single expression (35), K -> Phi as alpha -> 2, and the moments of both."""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pandas as pd

from fracparticles import time as integrators
from fracparticles.kernels.families import kernel
from fracparticles.schemes import Setting, dpse
from fracparticles.schemes.base import one_pass_operator
from fracparticles.schemes.transform import lattice_transform
from fracparticles.special import mean_radius
from fracstudy.claims import Finding
from fracstudy.inputs import ORDERS, Inputs, Result, listed, statement
from fracstudy.orders import orders_by
from fracstudy.panels import Panels

__all__ = ["decade_moments", "fickian_error", "heat_kernel", "kernel_distance", "study"]

NEEDS = {"scheme": ["KPSE"], "order": [2, 4]}

# Where the kernels differ at all; beyond, both are below 1e-2 (2 - alpha).
_RADII = np.linspace(0.0, 6.0, 1201)
_DECADES = np.arange(-2.0, 7.0)
_NODES = 60  # Gauss-Legendre in log r, a decade: smooth integrands, round-off reached
_ORDER_TOLERANCE = 0.1
_FICKIAN_RADIUS = 2.0 / sqrt(pi)  # R_alpha at alpha = 2
_FARTHER = (1.1, 1.5)  # where the moments are looked at, besides near 2
_ANY = 1.5  # Phi does not depend on alpha: any below 2 will do
_DISTANCE, _SLOPE = "max |K - Φ|", "max |K - Φ| / (2 - alpha)"
_SECOND = {exponent: f"second moment to r = 1e{exponent}" for exponent in (1, 3, 6)}


def heat_kernel(x: np.ndarray, t: float) -> np.ndarray:
    """Return the fundamental solution at alpha = 2, exp(-x^2 / 4t) / sqrt(4 pi t)."""
    return np.exp(-x * x / (4.0 * t)) / sqrt(4.0 * pi * t)


def fickian_error(
    half_width: float, spacing: float, order: int, overlap: float, t_initial: float, t_final: float
) -> float:
    """Return the relative error (48) of (35) at alpha = 2, exact in time.

    du_i/dt = (2 / epsilon^2) sum_j V_j (u_j - u_i) Phi_epsilon(x_j - x_i), from the heat kernel at t_initial, over
    |x| <= 5 R_2. Its symbol, (2 / epsilon^2) sum_l [Phi^(s (theta + 2 pi l)) - Phi^(2 pi l s)], lies between its value
    at theta = pi and 0.
    """
    n = round(half_width / spacing)
    setting = Setting(n=n, spacing=half_width / n, alpha=2.0, order=order, overlap=overlap)
    kernels = replace(setting, alpha=_ANY)
    operator = one_pass_operator(setting, lambda m: dpse.laplacian_weights(m, kernels), 0.0)
    at_zero, at_pi = lattice_transform("Phi", np.array([0.0, pi]), kernels)
    low = setting.rate * 2.0 / overlap**2 * (at_pi - at_zero)
    x = np.arange(-n, n + 1) * setting.spacing
    u = integrators.exponential(t_final - t_initial, low, 0.0)(operator, heat_kernel(x, t_initial))
    inside = np.abs(x) <= 5.0 * _FICKIAN_RADIUS
    deviation = np.abs(u - heat_kernel(x, t_final))[inside]
    return float(setting.spacing * deviation.sum())


def decade_moments(name: str, alpha: float, power: int, order: int = 2) -> np.ndarray:
    """Return 2 int r^power |K(r)| dr over each decade of r from 1e-2 to 1e6, Gauss-Legendre in log r."""
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    logarithm = _DECADES[:-1, None] + 0.5 * (nodes + 1.0)
    r = 10.0**logarithm
    values = np.abs(kernel(name, r, alpha, order=order)) * r ** (power + 1.0)
    return np.log(10.0) * (values @ weights)


def kernel_distance(alpha: float) -> float:
    """Return max_r |K(r) - Phi(r)|, order II."""
    return float(np.abs(kernel("K", _RADII, alpha) - kernel("Phi", _RADII, _ANY)).max())


def study(inputs: Inputs) -> Result:
    """Follow the kernel, the error and the moments of (35) from alpha < 2, the runs, to alpha = 2."""
    errors = inputs.scalars.assign(alpha=1.0 + inputs.scalars["beta"].round(9))
    errors = errors.rename(columns={"spacing": "h", "relative_l1_error": "error"})
    lattices = errors[errors["alpha"] == errors["alpha"].max()]
    grid = ["half_width", "h", "order", "overlap", "t_initial", "t_final"]
    at_two = [fickian_error(*lattice) for lattice in lattices[grid].itertuples(index=False)]
    errors = pd.concat([errors, lattices.assign(alpha=2.0, error=at_two)])
    errors = errors.sort_values(["alpha", "order", "h"], ascending=[1, 1, 0], ignore_index=True)
    errors["observed"] = orders_by(errors, ["alpha", "order"], "error")

    panels, rows = Panels(), []
    r = np.geomspace(0.05, 100.0, 241)
    for alpha, part in errors.groupby("alpha"):
        name, of = ("K", alpha) if alpha < 2.0 else ("Phi", _ANY)
        second = np.cumsum(decade_moments(name, of, 2))
        panels.add("kernel", 2, r, kernel(name, r, of), alpha=alpha)
        panels.add("moment", 2, 10.0 ** _DECADES[1:], second, alpha=alpha)
        panels.add("error", part["order"], part["h"], part["error"], alpha=alpha)
        rows.append(_row(alpha, part, dict(zip(_DECADES[1:], second, strict=True))))
    table = pd.DataFrame(rows)
    findings = [
        _single_expression(table, list(inputs.scalars["run"])),
        *_moments(table),
    ]
    return Result(table, inputs.judged(findings), panels.frame)


def _row(alpha: float, errors: pd.DataFrame, second: dict[float, float]) -> dict[str, object]:
    below = alpha < 2.0
    distance = kernel_distance(alpha) if below else 0.0
    row: dict[str, object] = {
        "alpha": alpha,
        "kernel": "K" if below else "Φ",
        _DISTANCE: distance,
        _SLOPE: distance / (2.0 - alpha) if below else np.nan,
        "R": mean_radius(alpha) if below else _FICKIAN_RADIUS,
    }
    for order, name in ORDERS.items():
        finest = errors[errors["order"] == order].iloc[-1]
        row[f"error {name}, h = {finest['h']:g}"] = finest["error"]
        row[f"order {name}"] = finest["observed"]
    return row | {column: second[exponent] for exponent, column in _SECOND.items()}


def _single_expression(table: pd.DataFrame, files: list[str]) -> Finding:
    off = [(table[f"order {name}"] - order).abs().max() for order, name in ORDERS.items()]
    second, fourth = (listed(table[f"order {name}"], ".2f") for name in ORDERS.values())
    column = next(name for name in table if name.startswith("error II,"))
    last, limit = table.iloc[-2], table.iloc[-1]
    return statement(
        "L-C17.single_expression",
        max(off) <= _ORDER_TOLERANCE,
        f"At alpha = {listed(table['alpha'])} the error of (35) falls with the orders {second} (II) and {fourth} (IV); "
        f"the {column}, is {last[column]:.3e} at alpha = {last['alpha']:g} and {limit[column]:.3e} at 2.",
        "Some alpha does not converge with the order of its kernel.",
        files,
    )


def _moments(table: pd.DataFrame) -> list[Finding]:
    # A moment is finite where the decades' shares fall by a constant factor, and infinite where they do not.
    alphas = np.array([*_FARTHER, *table["alpha"][:-1]])
    shares = np.array([[decade_moments("K", a, p)[-2:] for a in alphas] for p in range(4)])
    ratio = shares[..., 1] / shares[..., 0]
    as_tail = np.allclose(ratio, 10.0 ** (np.arange(4.0)[:, None] - alphas), rtol=1e-4)
    finite, infinite = (ratio[:2] < 1.0).all(), (ratio[2:] > 1.0).all()
    phi = max(
        decade_moments("Phi", _ANY, p, order)[-4:].sum() for order in ORDERS for p in range(9)
    )
    near, far = _SECOND[3], _SECOND[6]
    first, last, limit = (table.iloc[k] for k in (0, -2, -1))
    return [
        statement(
            "L-C17.phi_moments",
            phi == 0.0,
            "Beyond r = 100 nothing is left, in double precision, of the moments 0 to 8 of Phi, order II or IV: it "
            "falls like a Gaussian.",
            "Some moment of Phi does not converge.",
        ),
        statement(
            "L-C17.K_moments",
            as_tail and finite and infinite,
            f"At alpha = {listed(alphas)} the share of moment p in a decade of r is 10^(p - alpha) times that of the "
            f"decade before: at most {ratio[1].max():.3f} for p = 0 and 1, a finite moment; at least "
            f"{ratio[2].min():.3f} for p = 2 and 3, an infinite one.",
            "The moments do not divide there.",
        ),
        statement(
            "L-C17.singular_limit",
            infinite and table[_DISTANCE].is_monotonic_decreasing and limit[far] == limit[near],
            f"max |K - Phi| falls to {last[_DISTANCE]:.1e} at alpha = {last['alpha']:g}, about {last[_SLOPE]:.2f} (2 - "
            f"alpha); yet the second moment up to r = 1e3 and 1e6 is {first[near]:.3f} and {first[far]:.3f} at alpha = "
            f"{first['alpha']:g}, {last[near]:.4f} and {last[far]:.4f} at {last['alpha']:g}, always growing, and "
            f"{limit[far]:.4f} in all at 2.",
            "The second moment does not tell the limit from the limiting case.",
        ),
    ]
