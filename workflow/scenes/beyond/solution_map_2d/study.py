"""The two-dimensional problem of Sec. 5: what its studies share, and the map of the solution and its errors."""

from __future__ import annotations

from math import gamma, pi
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.lattice.banded import BandedConvolution
from fracparticles.special.stable import green, tail_mass
from fracstudy.inputs import ORDERS, Inputs, Result

__all__ = [
    "DISK",
    "reconstructed",
    "square_exchange_error",
    "square_tail_mass",
    "study",
    "with_count",
]

DISK = 5.0  # radius of the disk of (59)
_OUTER = 0.8  # of the half-width: beyond it, what the tables call the outer fifth of the square
_NODES = 32


def square_tail_mass(half_width: float, t: float, alpha: float) -> float:
    """Return the mass of G(., t) outside the square |x|, |y| <= D.

    (4 / pi) int_0^(pi/4) T(D / cos phi) dphi, T(r) the mass outside the disk of radius r.
    """
    phi, weight = _first_octant()
    return float(4.0 / pi * weight @ tail_mass(half_width / np.cos(phi), t, alpha, 2))


def square_exchange_error(half_width: float, alpha: float, time: float) -> float:
    """Return the relative error that truncation causes in an exchange scheme, time int c |y|^(-2-alpha) dy.

    The integral is over the outside of the square, c = alpha 2^(alpha-1) Gamma(1 + alpha/2) / (pi Gamma(1 - alpha/2))
    of (4): what each particle near the origin would give to the places without particles, and keeps.
    """
    c = alpha * 2.0 ** (alpha - 1.0) * gamma(1.0 + 0.5 * alpha) / (pi * gamma(1.0 - 0.5 * alpha))
    phi, weight = _first_octant()
    return float(time * 8.0 * c / alpha * (weight @ np.cos(phi) ** alpha) * half_width**-alpha)


def _first_octant() -> tuple[np.ndarray, np.ndarray]:
    """Gauss-Legendre nodes and weights on (0, pi/4)."""
    x, weight = np.polynomial.legendre.leggauss(_NODES)
    return pi / 8.0 * (1.0 + x), pi / 8.0 * weight


def reconstructed(u: np.ndarray, overlap: float) -> np.ndarray:
    """Return u_epsilon of (7) on the lattice, the strengths u smoothed with the Gaussian (8) of overlap s = epsilon/h.

    sum_j V_j u_j eta_epsilon(x_i - x_j) with eta_m = (s sqrt(pi))^-1 exp(-m^2 / s^2) along each axis; the sum is over
    the particles present.
    """
    m = np.arange(BandedConvolution.reach(overlap, 2) + 1) / overlap
    smooth = BandedConvolution(np.exp(-m * m) / (overlap * np.sqrt(pi)), parity=1)
    for axis, count in enumerate(u.shape):
        u = smooth.along(u, axis, count)
    return u


def with_count(runs: pd.DataFrame) -> pd.DataFrame:
    """Add the column N, the number of particles along a side."""
    count = (2.0 * runs["half_width"] / runs["particle_spacing"]).round().astype(int) + 1
    return runs.assign(N=count)


def study(inputs: Inputs) -> Result:
    """Maps of u and of its relative error at t_f, truncated and open; a table of the errors in the disk and outside.

    The first of the `maps` shows u, the others the relative error. Only the quadrant x, y >= 0 goes into the series:
    the rest is its mirror image.
    """
    maps = [tuple(entry) for entry in inputs.parameters["maps"]]
    rows, parts = [], []
    for run in with_count(inputs.scalars).to_dict("records"):
        key = (run["scheme"], run["order"])
        with_field = inputs.open(
            scheme=run["scheme"],
            order=run["order"],
            exterior=run["exterior"],
            spacing=run["spacing"],
        )
        x, u = with_field["x"].values, with_field["u"].values
        r = np.hypot(x[:, None], x[None, :])
        exact = np.asarray(green(r, run["t_final"], 1.0 + run["beta"], 2))
        error = np.abs(u / exact - 1.0)
        rows.append(_row(run, x, u, r, error))
        for panel, (scheme, order, what) in enumerate(maps):
            if (scheme, order) == key:
                quantity = u if what == "u" else error
                parts.append(_quadrant(x, quantity, panel, run["exterior"], what))
    table = pd.DataFrame(rows)
    return Result(table, (), pd.concat(parts, ignore_index=True))


def _row(
    run: dict[str, Any], x: np.ndarray, u: np.ndarray, r: np.ndarray, error: np.ndarray
) -> dict[str, Any]:
    disk = r <= DISK * (1.0 + 1e-12)
    outer = np.maximum(np.abs(x[:, None]), np.abs(x[None, :])) > _OUTER * x[-1]
    alpha, half = 1.0 + run["beta"], float(run["half_width"])
    span = run["t_final"] - run["t_initial"]
    exchange = run["scheme"] in ("KPSE", "GPSE") and run["exterior"] == "truncated"
    return {
        "scheme": run["scheme"],
        "order": ORDERS[run["order"]],
        "exterior": run["exterior"],
        "N": run["N"],
        "error (59)": run["relative_l1_error"],
        "truncation error, predicted": square_exchange_error(half, alpha, span) if exchange else np.nan,
        "largest relative error, r <= 5": error[disk].max(),
        "median relative error, outer fifth": np.median(error[outer]),
        "largest relative error": error.max(),
        "least u / largest u": u.min() / u.max(),
        "mass at t_f": run["mass_final"],
        "the same, exact": 1.0 - square_tail_mass(half, run["t_final"], alpha),
    }  # fmt: skip


def _quadrant(
    x: np.ndarray, quantity: np.ndarray, panel: int, exterior: str, what: str
) -> pd.DataFrame:
    n = x.size // 2
    return pd.DataFrame(
        {
            "panel": panel,
            "exterior": exterior,
            "quantity": what,
            "x": np.repeat(x[n:], n + 1),
            "y": np.tile(x[n:], n + 1),
            "value": quantity[n:, n:].reshape(-1),
        }
    )
