"""The fundamental solution in two dimensions, (57), (58), Fig. 6."""

from __future__ import annotations

from math import pi

import numpy as np
import pandas as pd
from scipy.special import gamma, gammaln, j0, roots_legendre, xlogy

from fracparticles.special.stable import central_mass, green_rate, reduced_green, tail_mass
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement

__all__ = ["planar_asymptotic", "planar_integral", "planar_series", "study"]

_NODES = 800  # of the quadrature: 4 for each period of J_0(r omega) at r = 100
_LAST_EXPONENT = 45.0  # exp(-omega^alpha) is nil beyond
_AGREES = 1e-10  # in parts of Phi(0)


def planar_integral(r: np.ndarray, alpha: float, power: float = 0.0) -> np.ndarray:
    """Return (1/2 pi) int_0^inf omega^(1 + power) exp(-omega^alpha) J_0(r omega) domega: (58) for power 0.

    Gauss-Legendre in s, omega = s^2, which makes the integrand smooth at 0; exact to round-off for r <= 100.
    """
    x, weight = roots_legendre(_NODES)
    last = _LAST_EXPONENT ** (0.5 / alpha)
    s, weight = 0.5 * last * (1.0 + x), 0.5 * last * weight
    omega = s * s
    factor = weight * 2.0 * s * omega ** (1.0 + power) * np.exp(-(omega**alpha)) / (2.0 * pi)
    return np.asarray(j0(np.multiply.outer(np.asarray(r, dtype=float), omega)) @ factor)


def planar_series(r: np.ndarray, alpha: float, terms: int) -> np.ndarray:
    """Return a partial sum of Phi = (1 / 2 pi alpha) sum_{k>=0} (-1)^k Gamma((2k + 2) / alpha) / (k!)^2 (r/2)^(2k)."""
    k = np.arange(float(terms))
    logarithm = gammaln((2.0 * k + 2.0) / alpha) - 2.0 * gammaln(k + 1.0)
    powers = xlogy(2.0 * k, 0.5 * np.asarray(r, dtype=float)[..., None])
    return ((-1.0) ** k * np.exp(logarithm + powers)).sum(axis=-1) / (2.0 * pi * alpha)


def planar_asymptotic(r: np.ndarray, alpha: float, terms: int) -> np.ndarray:
    """Return a partial sum of the far series.

    Phi ~ (1/pi^2) sum_{k>=1} (-1)^(k+1) / k! 2^(alpha k) Gamma(1 + alpha k / 2)^2 sin(pi alpha k / 2) r^(-alpha k - 2)
    """
    k = np.arange(1.0, terms + 1.0)
    size = np.exp(alpha * k * np.log(2.0) + 2.0 * gammaln(1.0 + 0.5 * alpha * k) - gammaln(k + 1.0))
    factor = (-1.0) ** (k + 1.0) * size * np.sin(0.5 * pi * alpha * k) / pi**2
    return (factor * np.asarray(r, dtype=float)[..., None] ** (-alpha * k - 2.0)).sum(axis=-1)


def study(inputs: Inputs) -> Result:
    """Values of Phi_{2,alpha}, three other ways to compute it, and the density in one dimension beside it."""
    alpha = 1.0 + float(inputs.parameters["beta"])
    terms = inputs.parameters["terms"]
    table = _compare(np.array(inputs.parameters["radii"], dtype=float), alpha, terms)
    low, high = inputs.parameters["reach"]
    fine = np.geomspace(low, high, 241)
    curves = _compare(fine, alpha, terms)
    series = curves.melt(id_vars="r", var_name="series", value_name="y")
    return Result(table, [_fundamental(alpha)], series)


def _compare(r: np.ndarray, alpha: float, terms: dict[str, int]) -> pd.DataFrame:
    phi = np.asarray(reduced_green(r, alpha, 2))
    line = np.asarray(reduced_green(r, alpha, 1))
    near, far, whole = (np.full(r.shape, np.nan) for _ in range(3))
    inside = r <= terms["series_up_to"]
    near[inside] = planar_series(r[inside], alpha, terms["series"])
    outside = r >= terms["asymptotic_from"]
    far[outside] = planar_asymptotic(r[outside], alpha, terms["asymptotic"])
    inside = r <= terms["integral_up_to"]
    whole[inside] = planar_integral(r[inside], alpha)
    return pd.DataFrame(
        {
            "r": r,
            "Phi_2(r)": phi,
            "integral (58), deviation": np.abs(whole / phi - 1.0),
            "series, deviation": np.abs(near / phi - 1.0),
            "asymptotics, deviation": np.abs(far / phi - 1.0),
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
    steep = [_slope(alpha, dim) for dim in (2, 1)]
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


def _slope(alpha: float, dim: int) -> float:
    """The logarithmic slope of Phi between r = 1e3 and 1e4."""
    values = np.asarray(reduced_green(np.array([1e3, 1e4]), alpha, dim))
    return float(np.log10(values[1] / values[0]))
