"""The fundamental solution in two dimensions, (57), (58), Fig. 6."""

from collections.abc import Callable
from math import pi

import numpy as np
import pandas as pd
from scipy.special import gamma, roots_legendre

from fracparticles.special.plane import planar_asymptotic, planar_integral, planar_series
from fracparticles.special.stable import reduced_green, tail_mass
from fracstudy.errors import off
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result

_STEP = 1e-2  # in time, of differences of sixth order
# Of the quadrature of (4): radii around a point, and numbers of radii and angles.
_NEAREST, _FARTHEST, _NODES, _ANGLES = 1e-3, 1e4, 400, 256


def study(
    inputs: Inputs, *, beta: float, radii: list[float], reach: list[float], terms: dict[str, float]
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
    columns = {
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
    return pd.DataFrame(columns)


def _fundamental(alpha: float) -> Finding:
    """Whether (57) with (58) solves (3) with the integral (4), taken in the plane, from a unit mass at the origin."""
    r = np.linspace(0.0, 40.0, 401)
    gap = np.abs(planar_integral(r, alpha) - reduced_green(r, alpha, 2)).max()
    near = np.array([0.0, 0.5, 1.0, 2.0, 4.0])
    rate = _rate(near, alpha)
    laplacian = np.array([fractional_laplacian(radius, alpha) for radius in near])
    x, weight = roots_legendre(200)
    s = 10.0 * (1.0 + x)
    inside = float(20.0 * pi * weight @ (s * planar_integral(s, alpha)))
    return measured(
        "L-F6.fundamental",
        equation=off(laplacian, rate),
        mass=abs(inside + float(tail_mass(20.0, 1.0, alpha, 2)) - 1.0),
        integral=gap / float(reduced_green(0.0, alpha, 2)),
        rate=rate[0],
        laplacian=laplacian[0],
    )


def _rate(r: np.ndarray, alpha: float) -> np.ndarray:
    """d/dt of (57) at t = 1, by differences of sixth order, with (58) by quadrature."""

    def density(t: float) -> np.ndarray:
        return t ** (-2.0 / alpha) * planar_integral(r * t ** (-1.0 / alpha), alpha)

    return sum(
        c / 60.0 * (density(1.0 + k * _STEP) - density(1.0 - k * _STEP)) / _STEP
        for k, c in ((1, 45.0), (2, -9.0), (3, 1.0))
    )


def fractional_laplacian(r: float, alpha: float) -> float:
    """Return (4) of Phi at the distance r from the origin: over circles around the point, then their radii.

    Next to the point the mean over a circle differs from the value there in proportion to the radius squared; far from
    it, it is zero beside it.
    """
    node, weight = roots_legendre(_NODES)
    low, high = np.log(_NEAREST), np.log(_FARTHEST)
    rho = np.exp(low + 0.5 * (high - low) * (node + 1.0))
    angle = 2.0 * pi * np.arange(_ANGLES) / _ANGLES
    x, y = (np.multiply.outer(rho, of(angle)) for of in (np.cos, np.sin))
    distance = np.hypot(r + x, y)
    value = float(reduced_green(r, alpha, 2))
    excess = np.asarray(reduced_green(distance, alpha, 2)).mean(axis=1) - value
    inside = 0.5 * (high - low) * float(weight @ (excess * rho**-alpha))
    nearest = excess[0] * rho[0] ** -2.0 * _NEAREST ** (2.0 - alpha) / (2.0 - alpha)
    farthest = -value * _FARTHEST**-alpha / alpha
    half = 0.5 * alpha
    constant = alpha * 2.0 ** (alpha - 1.0) * gamma(1.0 + half) / (pi * gamma(1.0 - half))
    return 2.0 * pi * constant * (inside + nearest + farthest)
