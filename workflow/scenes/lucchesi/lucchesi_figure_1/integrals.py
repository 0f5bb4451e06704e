"""The integrals that the formulas are held against, and the kernels as the paper prints them, from scipy's 1F1.

The integrals are int |y|^power exp(-a |y|^2) exp(i x.y) dV over R^n, in t = a |y|^2 by Gauss and Laguerre: the cosine
or Bessel function that the angles leave is smooth in t, so that the rule is exact to round-off for the x that are
used.
"""

from math import factorial, gamma, pi, sqrt

import numpy as np
from scipy.special import hyp1f1, j0, j1, roots_genlaguerre

_NODES = 60


def sphere(n: int) -> float:
    """The surface of the unit sphere in R^n."""
    return 2.0 * pi ** (0.5 * n) / gamma(0.5 * n)


def _angles(z: np.ndarray, n: int) -> np.ndarray:
    """The mean of exp(i x.y) over the directions of y, z = |x| |y|."""
    return (np.cos(z), j0(z), np.sinc(z / pi))[n - 1]


def _angles_slope(z: np.ndarray, n: int) -> np.ndarray:
    """Its derivative in z > 0."""
    return (-np.sin(z), -j1(z), (np.cos(z) - np.sinc(z / pi)) / z)[n - 1]


def gaussian_integral(
    power: float, x: np.ndarray, n: int, a: float, slope: bool = False
) -> np.ndarray:
    """Return int |y|^power exp(-a |y|^2 + i x.y) dV(y) over R^n at |x| > 0, or its derivative in |x|; power > -n."""
    exponent = 0.5 * (power + n) - 1.0
    t, weight = roots_genlaguerre(_NODES, exponent)
    y = np.sqrt(t / a)
    z = np.multiply.outer(np.asarray(x, dtype=float), y)
    integrand = y * _angles_slope(z, n) if slope else _angles(z, n)
    return 0.5 * sphere(n) * a ** -(exponent + 1.0) * (integrand @ weight)


def moment(power: float, n: int, a: float) -> float:
    """Return that integral at x = 0."""
    return float(gaussian_integral(power, np.zeros(1), n, a)[0])


def from_transform(
    name: str, x: np.ndarray, alpha: float, n: int, order: int = 2, epsilon: float = 1.0
) -> np.ndarray:
    """Return the inverse transform of the right side of (B.11), (B.12) or (B.13), the vector's component along x."""
    power = alpha if name == "G" else alpha - 2.0
    sign = -1.0 if name == "G" else 1.0

    def one(width: float) -> np.ndarray:
        return gaussian_integral(power, x, n, 0.25 * width**2, slope=name == "F")

    value = one(epsilon) if order == 2 else 2.0 * one(epsilon) - one(sqrt(2.0) * epsilon)
    return sign * value / (2.0 * pi) ** n


def printed_kernel(
    name: str, r: np.ndarray, alpha: float, n: int, wide: float | None = None
) -> np.ndarray:
    """Return (14), (20), (11); with `wide` those of order IV by the rule 2 1F1(x) - 2^-a 1F1(wide x) of (B.18)."""
    forms = {"kappa": (alpha - 2.0, 0, 1.0), "F": (alpha, 2, -r), "G": (alpha, 0, -1.0)}
    power, b, sign = forms[name]
    a, c = 0.5 * (power + n), 0.5 * (n + b)
    value = hyp1f1(a, c, -r * r)
    if wide is not None:
        value = 2.0 * value - 2.0**-a * hyp1f1(a, c, -wide * r * r)
    constant = 2.0**power * gamma(a) / (pi ** (0.5 * n) * gamma(c) * factorial(b))  # (B.14)
    return sign * constant * value
