"""The Fickian limit: the single expression (35), K -> Phi as alpha -> 2, and the moments of both."""

from collections.abc import Iterator
from functools import partial
from math import gamma, pi, sqrt

import numpy as np
import pandas as pd

from fracparticles import time as integrators
from fracparticles.kernels.families import kernel
from fracparticles.schemes import Setting, dpse
from fracparticles.schemes.base import one_pass_operator
from fracparticles.schemes.transform import lattice_transform
from fracparticles.special import mean_radius
from fracparticles.special.ends import heat_kernel
from fracstudy.findings import Finding, each, measured
from fracstudy.inputs import ORDERS, Inputs, Result
from fracstudy.orders import orders_by
from fracstudy.panels import Panels

NEEDS = {"scheme": ["KPSE"], "order": [2, 4]}

# Where the kernels differ at all; beyond, both are below 1e-2 (2 - alpha).
_RADII = np.linspace(0.0, 6.0, 1201)
_DECADES = np.arange(-2.0, 7.0)
_NODES = 60  # Gauss-Legendre in log r, a decade: smooth integrands, round-off reached
_FICKIAN_RADIUS = 2.0 / sqrt(pi)  # R_alpha at alpha = 2
_FARTHER = (1.1, 1.5)  # where the moments are looked at, besides near 2
_ANY = 1.5  # Phi does not depend on alpha: any below 2 will do
_DISTANCE, _SLOPE = "max |K - Φ|", "max |K - Φ| / (2 - alpha)"
_SECOND = {exponent: f"second moment to r = 1e{exponent}" for exponent in (1, 3, 6)}


def fickian_error(
    half_width: float, spacing: float, order: int, overlap: float, t_initial: float, t_final: float
) -> float:
    """Return the relative error (48) of (35) at alpha = 2, exact in time.

    du_i/dt = (2 / epsilon^2) sum_j V_j (u_j - u_i) Phi_epsilon(x_j - x_i), from the heat kernel at t_initial, over
    |x| <= 5 R_2. Its symbol, (2 / epsilon^2) sum_l [Phi^(s (theta + 2 pi l)) - Phi^(2 pi l s)], lies between its value
    at theta = pi and 0.
    """
    n = round(half_width / spacing)
    h = half_width / n
    rate = h**-2.0  # of the setting D / h^alpha
    setting = Setting(
        n=n, spacing=h, alpha=_ANY, order=order, overlap=overlap, diffusivity=rate * h**_ANY
    )
    operator = one_pass_operator(setting, lambda m: dpse.laplacian_weights(m, setting), 0.0)
    at_zero, at_pi = lattice_transform("Phi", np.array([0.0, pi]), setting)
    low = rate * 2.0 / overlap**2 * (at_pi - at_zero)
    x = setting.x
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
    findings = _findings(table, list(inputs.scalars["run"]))
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


def _findings(table: pd.DataFrame, files: list[str]) -> Iterator[Finding]:
    by_alpha = table.set_index("alpha")
    orders = by_alpha[[f"order {name}" for name in ORDERS.values()]]
    orders = orders.set_axis(pd.Index(ORDERS, name="order"), axis=1)
    column = next(name for name in table if name.startswith("error II,"))
    below = [*_FARTHER, *table["alpha"][:-1]]
    # A moment is finite where the decades' shares fall by a constant factor, and infinite where they do not.
    growth = {
        name: each(partial(_growth, power=power), alpha=below)
        for power, name in enumerate(("mass", "first", "second", "third"))
    }
    far, near = (by_alpha[_SECOND[exponent]] for exponent in (6, 3))
    distance = by_alpha[_DISTANCE].iloc[:-1]
    difference, last = (orders - [*ORDERS]).abs().stack(), by_alpha[column].iloc[-2:]
    yield measured("L-C17.single_expression", runs=files, difference=difference, last=last)

    def beyond(power: int) -> float:
        """The share of a moment of Phi that lies in the last four decades."""
        moments = (decade_moments("Phi", _ANY, power, order) for order in ORDERS)
        return max(m[-4:].sum() / m.sum() for m in moments)

    powers = {f"moment {power}": power for power in range(9)}
    yield measured(
        "L-C17.phi_moments",
        beyond={name: beyond(power) for name, power in powers.items()},
        exact={name: _phi_off(power) for name, power in powers.items()},
    )
    yield measured("L-C17.K_moments", **growth)
    yield measured(
        "L-C17.singular_limit",
        growth=(far / near - 1.0).iloc[:-1],
        at_two=far.iloc[-1] / near.iloc[-1] - 1.0,
        order=np.diff(np.log(distance)) / np.diff(np.log(2.0 - distance.index.to_numpy())),
        distance=distance.iloc[-1],
    )


def _growth(alpha: float, power: int) -> float:
    """The moment of K in the last decade of r over that in the one before."""
    before, last = decade_moments("K", alpha, power)[-2:]
    return float(last / before)


def _phi_off(power: int) -> float:
    """The moment of Phi, order II, against 2 Gamma((power + 1) / 2) / sqrt(pi), relative."""
    exact = 2.0 * gamma(0.5 * (power + 1.0)) / sqrt(pi)
    inside = 4.0 * 10.0 ** (_DECADES[0] * (power + 1.0)) / ((power + 1.0) * sqrt(pi))
    return float(abs((decade_moments("Phi", _ANY, power).sum() + inside) / exact - 1.0))
