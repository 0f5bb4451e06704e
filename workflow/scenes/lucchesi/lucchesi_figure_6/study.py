"""The fundamental solution in two dimensions, (57), (58), Fig. 6."""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np
import pandas as pd
from scipy.special import gamma, roots_legendre

from fracparticles.special.plane import planar_asymptotic, planar_integral, planar_series
from fracparticles.special.stable import central_mass, green_rate, reduced_green, tail_mass
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement

__all__ = ["study"]

_AGREES = 1e-10  # in parts of Phi(0)


def study(
    inputs: Inputs,
    *,
    beta: float,
    radii: list[float],
    reach: list[float],
    terms: dict[str, float],
) -> Result:
    """Values of Phi_{2,alpha}, three other ways to compute it, and the density in one dimension beside it."""
    alpha, (low, high) = 1.0 + beta, reach
    curves = _compare(np.geomspace(low, high, 241), alpha, terms)
    series = curves.melt(id_vars="r", var_name="series", value_name="y")
    table = _compare(np.array(radii, dtype=float), alpha, terms)
    return Result(table, inputs.judged([_fundamental(alpha)]), series)


def _compare(r: np.ndarray, alpha: float, terms: dict[str, float]) -> pd.DataFrame:
    phi, line = (np.asarray(reduced_green(r, alpha, dim)) for dim in (2, 1))

    def deviation(used: np.ndarray, other: Callable[..., np.ndarray], *number: float) -> np.ndarray:
        values = np.full(r.shape, np.nan)
        values[used] = other(r[used], alpha, *number)
        return np.abs(values / phi - 1.0)

    near, middle = (r <= terms[name] for name in ("series_up_to", "integral_up_to"))
    far = r >= terms["asymptotic_from"]
    return pd.DataFrame(
        {
            "r": r,
            "Phi_2(r)": phi,
            "integral (58), deviation": deviation(middle, planar_integral),
            "series, deviation": deviation(near, planar_series, terms["series"]),
            "asymptotics, deviation": deviation(far, planar_asymptotic, terms["asymptotic"]),
            "Phi_2(r) / Phi_2(0)": phi / reduced_green(0.0, alpha, 2),
            "Phi_1(r) / Phi_1(0)": line / reduced_green(0.0, alpha, 1),
            "mass outside, n = 2": np.asarray(tail_mass(r, 1.0, alpha, 2)),
            "mass outside, n = 1": np.asarray(tail_mass(r, 1.0, alpha, 1)),
        }
    )


def _fundamental(alpha: float) -> Finding:
    """(57), (58): Phi is the integral; its mass is 1; and (57) fulfils (3), by the transform of the right side."""
    r = np.linspace(0.0, 40.0, 401)
    top = float(reduced_green(0.0, alpha, 2))
    integral = np.abs(planar_integral(r, alpha) - reduced_green(r, alpha, 2)).max() / top
    # The fractional Laplacian of (57) at t = 1 is the integral with -omega^alpha.
    laplacian = -planar_integral(r, alpha, alpha)
    rate = np.abs(green_rate(r, 1.0, alpha, 2) - laplacian).max() / np.abs(laplacian).max()
    x, weight = roots_legendre(200)
    s = 10.0 * (1.0 + x)
    inside = float(20.0 * pi * weight @ (s * reduced_green(s, alpha, 2)))
    mass = abs(inside + float(tail_mass(20.0, 1.0, alpha, 2)) - 1.0)
    closed = abs(top / (gamma(2.0 / alpha) / (2.0 * pi * alpha)) - 1.0)
    far = np.array([1e3, 1e4])
    steep = [float(np.diff(np.log10(reduced_green(far, alpha, dim)))[0]) for dim in (2, 1)]
    inner = [100.0 * float(central_mass(1.0, 1.0, alpha, dim)) for dim in (2, 1)]
    return statement(
        "L-F6.fundamental",
        max(integral, rate, mass, closed) < _AGREES,
        f"In parts of the largest value, for r <= 40: our Phi and quadrature of (58) differ by {integral:.0e}, dG/dt "
        f"and the fractional Laplacian of (57) by {rate:.0e}; the mass is 1 within {mass:.0e}; Phi(0) is "
        f"Gamma(2/alpha)/(2 pi alpha) within {closed:.0e}. Far away it falls like r^{steep[0]:.3f} (n = 1: "
        f"r^{steep[1]:.3f}); {inner[0]:.1f} % of the mass lie within r = 1 (n = 1: {inner[1]:.1f} %).",
        "The integral, the equation or the mass does not come out.",
    )
