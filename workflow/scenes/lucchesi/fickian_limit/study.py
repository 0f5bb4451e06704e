"""The Fickian limit: the single expression (35), K -> Phi as alpha -> 2, and the moments of both."""

from __future__ import annotations

from collections.abc import Iterable
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
from fracstudy.inputs import ORDERS, Inputs, Result, observed_order, statement

__all__ = ["decade_moments", "fickian_error", "heat_kernel", "study"]

_RADII = np.linspace(
    0.0, 6.0, 1201
)  # where the kernels differ at all; beyond, both are below 1e-2 (2 - alpha)
_DECADES = np.arange(-2.0, 7.0)
_NODES = 60  # Gauss-Legendre in log r, a decade: smooth integrands, round-off reached
_ORDER_TOLERANCE = 0.1
_FICKIAN_RADIUS = 2.0 / sqrt(pi)  # R_alpha at alpha = 2
_MOMENTS = (0, 1, 2, 3)
_FARTHER = (1.1, 1.5)  # where the moments are looked at, besides near 2
_ANY = 1.5  # Phi does not depend on alpha: any below 2 will do


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


def study(inputs: Inputs) -> Result:
    """Follow the kernel, the error and the moments of (35) from alpha < 2 to alpha = 2.

    Parameters of the scene: `half_width`, `spacing` (a list), `overlap`, `t_initial`, `t_final` of the lattices at
    alpha = 2, the same as those of the runs. Runs: KPSE, orders 2 and 4, at several beta near 1 and these spacings.
    """
    parameters = inputs.parameters
    spacings = sorted(map(float, parameters["spacing"]), reverse=True)
    betas = sorted(set(inputs.scalars["beta"].round(9)))
    errors = {
        (1.0 + beta, order): _errors_of_runs(inputs, beta, order)
        for beta in betas
        for order in ORDERS
    }
    for order in ORDERS:
        errors[2.0, order] = np.array(
            [
                fickian_error(
                    float(parameters["half_width"]),
                    h,
                    order,
                    float(parameters["overlap"]),
                    float(parameters["t_initial"]),
                    float(parameters["t_final"]),
                )
                for h in spacings
            ]
        )
    alphas = [1.0 + beta for beta in betas]
    table = pd.DataFrame(_row(alpha, errors, spacings) for alpha in [*alphas, 2.0])
    findings = [_single_expression(inputs, table, errors), *_moments(alphas, table)]
    return Result(table, findings, _series(alphas, errors, spacings))


def _errors_of_runs(inputs: Inputs, beta: float, order: int) -> np.ndarray:
    runs = inputs.select(scheme="KPSE", beta=beta, order=order)
    return runs.sort_values("spacing", ascending=False)["relative_l1_error"].to_numpy(dtype=float)


def _row(
    alpha: float, errors: dict[tuple[float, int], np.ndarray], spacings: list[float]
) -> dict[str, object]:
    below = alpha < 2.0
    distance = kernel_distance(alpha) if below else 0.0
    second = np.cumsum(decade_moments("K", alpha, 2) if below else decade_moments("Phi", _ANY, 2))
    h = spacings[-1]
    row: dict[str, object] = {
        "alpha": alpha,
        "kernel": "K" if below else "Φ",
        "max |K - Φ|": distance,
        "max |K - Φ| / (2 - alpha)": distance / (2.0 - alpha) if below else np.nan,
        "R": mean_radius(alpha) if below else _FICKIAN_RADIUS,
    }
    for order, name in ORDERS.items():
        row[f"error {name}, h = {h:g}"] = errors[alpha, order][-1]
        row[f"order {name}"] = observed_order(np.array(spacings), errors[alpha, order])[-1]
    for exponent in (1, 3, 6):
        row[f"second moment to r = 1e{exponent}"] = second[_DECADES[1:] == exponent].item()
    return row


def kernel_distance(alpha: float) -> float:
    """Return max_r |K(r) - Phi(r)|, order II."""
    return float(np.abs(kernel("K", _RADII, alpha) - kernel("Phi", _RADII, _ANY)).max())


def _single_expression(
    inputs: Inputs, table: pd.DataFrame, errors: dict[tuple[float, int], np.ndarray]
) -> Finding:
    deviations = {
        name: (table[f"order {name}"] - order).abs().max() for order, name in ORDERS.items()
    }
    last, limit = table.iloc[-2], table.iloc[-1]
    column = next(c for c in table.columns if c.startswith("error II,"))
    return statement(
        "L-C17.single_expression",
        max(deviations.values()) <= _ORDER_TOLERANCE,
        f"At alpha = {_list(table['alpha'])} the error of (35) falls with the orders {_list(table['order II'], '.2f')} "
        f"(II) and {_list(table['order IV'], '.2f')} (IV); the {column}, is {last[column]:.3e} at alpha = "
        f"{last['alpha']:g} and {limit[column]:.3e} at 2.",
        "Some alpha does not converge with the order of its kernel.",
        list(inputs.scalars["run"]),
    )


def _moments(alphas: list[float], table: pd.DataFrame) -> list[Finding]:
    # A moment is finite where the decades' shares fall by a constant factor, and infinite where they do not.
    orders = np.array([*_FARTHER, *alphas])
    ratio = {
        power: np.array([_last_ratio(decade_moments("K", alpha, power)) for alpha in orders])
        for power in _MOMENTS
    }
    expected = {power: 10.0 ** (power - orders) for power in _MOMENTS}
    as_tail = all(np.allclose(ratio[p], expected[p], rtol=1e-4) for p in _MOMENTS)
    finite = all((ratio[p] < 1.0).all() for p in (0, 1))
    infinite = all((ratio[p] > 1.0).all() for p in (2, 3))
    first, last = table.iloc[0], table.iloc[-2]
    phi = {
        order: [decade_moments("Phi", _ANY, p, order)[-4:].sum() for p in range(9)]
        for order in ORDERS
    }
    near, far = "second moment to r = 1e3", "second moment to r = 1e6"
    return [
        statement(
            "L-C17.phi_moments",
            max(map(max, phi.values())) == 0.0,
            "Beyond r = 100 nothing is left, in double precision, of the moments 0 to 8 of Phi, order II or IV: "
            "it falls "
            "like a Gaussian.",
            "Some moment of Phi does not converge.",
        ),
        statement(
            "L-C17.K_moments",
            as_tail and finite and infinite,
            f"At alpha = {_list(orders)} the share of moment p in a decade of r is 10^(p - alpha) times that of "
            f"the decade "
            f"before: at most {ratio[1].max():.3f} for p = 0 and 1, a finite moment; at least "
            f"{ratio[2].min():.3f} for p = 2 "
            "and 3, an infinite one.",
            "The moments do not divide there.",
        ),
        statement(
            "L-C17.singular_limit",
            bool(
                infinite
                and table["max |K - Φ|"].is_monotonic_decreasing
                and table[far].iloc[-1] == table[near].iloc[-1]
            ),
            f"max |K - Phi| falls to {last['max |K - Φ|']:.1e} at alpha = {last['alpha']:g}, about "
            f"{last['max |K - Φ| / (2 - alpha)']:.2f} (2 - alpha); yet the second moment up to r = 1e3 and 1e6 is "
            f"{first[near]:.3f} and {first[far]:.3f} at alpha = {first['alpha']:g}, {last[near]:.4f} and "
            f"{last[far]:.4f} at "
            f"{last['alpha']:g}, always growing, and {table[far].iloc[-1]:.4f} in all at 2.",
            "The second moment does not tell the limit from the limiting case.",
        ),
    ]


def _last_ratio(shares: np.ndarray) -> float:
    return float(shares[-1] / shares[-2])


def _series(
    alphas: list[float], errors: dict[tuple[float, int], np.ndarray], spacings: list[float]
) -> pd.DataFrame:
    """Panels "kernel", "error" (order as such) and "moment" (up to r)."""
    rows = []
    r = np.geomspace(0.05, 100.0, 241)
    for alpha in [*alphas, 2.0]:
        name, of = ("K", alpha) if alpha < 2.0 else ("Phi", _ANY)
        values = np.asarray(kernel(name, r, of))
        moments = np.cumsum(decade_moments(name, of, 2))
        for x, y in zip(r, values, strict=True):
            rows.append({"panel": "kernel", "alpha": alpha, "order": 2, "x": x, "y": y})
        for x, y in zip(10.0 ** _DECADES[1:], moments, strict=True):
            rows.append({"panel": "moment", "alpha": alpha, "order": 2, "x": x, "y": y})
        for order in ORDERS:
            for x, y in zip(spacings, errors[alpha, order], strict=True):
                rows.append({"panel": "error", "alpha": alpha, "order": order, "x": x, "y": y})
    return pd.DataFrame(rows)


def _list(values: Iterable[float], form: str = "g") -> str:
    return ", ".join(f"{v:{form}}" for v in values)
