r"""The law of the error (19), measured on the Gaussian exp(-x^2) after t = 1:

    |F - f| <= C_1 eps^k + C_2 (h / eps)^M,     eps_best = (M h^M / k)^(1 / (k + M)),

for markers of weight f h at equal distances h. k is the order of the moments of S, and M = p + 1 for a shape function
with p bounded derivatives; S8 is smooth and has no M. The formula for the best eps leaves out the constants.
"""

from __future__ import annotations

import math

import numpy as np

from fracparticles.arguments import instance, real_between, scale
from fracparticles.errors import InvalidInput
from fracparticles.markers.profiles import Gaussian
from fracparticles.markers.shapes import Shape
from fracparticles.markers.solver import MarkerVelocity

__all__ = [
    "optimal_support",
    "predicted_support",
    "quadrature_exponent",
    "quadrature_order",
    "smoothing_exponent",
]

_T = 1.0
_PER_UNIT = 6  # values of eps / h between whole numbers
_FINEST = 1e-4  # h: thousands of markers in each of some hundred sums


def smoothing_exponent(shape: Shape) -> float:
    """Return k, measured with two support parameters and so many markers that only the error eps^k remains.

    Raises `InvalidInput` if it is not a shape function. So do the others.
    """
    z = np.linspace(-1.0, 1.0, 41)
    errors = [_error(shape, epsilon, epsilon / 200.5, z) for epsilon in (0.1, 0.2)]
    return float(np.log2(errors[1] / errors[0]))


def quadrature_exponent(shape: Shape) -> float:
    """Return M, measured: F against that of very many markers, eps / h from 2 to 3 and from 8 to 9.

    It takes the worst of several ratios and offsets, because at some ratios the error happens to vanish.
    """
    z, epsilon = np.linspace(-1.0, 1.0, 41), 0.5
    fine = _on_lattice(shape, epsilon, epsilon / 2000.5, z)
    worst = [
        max(
            np.abs(_on_lattice(shape, epsilon, epsilon / (first + r), z, offset) - fine).max()
            for r in np.linspace(0.0, 1.0, 13)
            for offset in (0.0, 0.25, 0.5, 0.75)
        )
        for first in (2.0, 8.0)
    ]
    return float(np.log2(worst[0] / worst[1]) / 2.0)


def quadrature_order(shape: Shape) -> float:
    """Return M = p + 1 of the smoothness p; nan for a shape function that has all derivatives."""
    p = instance("shape", shape, Shape).smoothness
    return math.nan if p is None else p + 1


def predicted_support(shape: Shape, h: float) -> float:
    """Return eps_best = (M h^M / k)^(1 / (k + M)); nan without M. h is positive."""
    m, h = quadrature_order(shape), scale("h", h)
    k = shape.moment_order
    return (m * h**m / k) ** (1.0 / (k + m))


def optimal_support(shape: Shape, h: float) -> tuple[float, float]:
    """Return the eps with the least error of F for markers h apart, and the best over ranges of eps.

    At some eps / h the error of equally spaced markers happens to vanish. The second result is therefore judged by
    the worst error over a range of eps as wide as h, and is the middle of the best range. Values from h to 14 h are
    tried.

    Raises `InvalidInput` as the others do; also if h is not from 1e-4 to 1, or the best epsilon is beyond 14 h.
    """
    z, h = np.linspace(-1.0, 1.0, 97), real_between("h", h, _FINEST, 1.0)
    ratios = np.arange(1.0, 14.0, 1.0 / _PER_UNIT)
    errors = [_error(shape, r * h, h, z) for r in ratios]
    worst = np.lib.stride_tricks.sliding_window_view(errors, _PER_UNIT + 1).max(axis=1)
    if np.argmin(worst) >= worst.size - _PER_UNIT:
        allowed = "markers for which the best epsilon is at most 14 h"
        raise InvalidInput("h", h, allowed, "Take a larger h.")
    best, middle = ratios[int(np.argmin(errors))], ratios[int(np.argmin(worst))] + 0.5
    return float(best * h), float(middle * h)


def _error(shape: Shape, epsilon: float, h: float, z: np.ndarray) -> float:
    return float(np.abs(_on_lattice(shape, epsilon, h, z) - Gaussian().value(z, _T)).max())


def _on_lattice(
    shape: Shape, epsilon: float, h: float, z: np.ndarray, offset: float = 0.0
) -> np.ndarray:
    """F at z, by markers of weight f h at (j + offset) h wherever S_eps reaches."""
    reach = 1.5 + instance("shape", shape, Shape).reach * epsilon
    j = np.arange(math.floor(-reach / h) - 1, math.ceil(reach / h) + 2)
    x = (j + offset) * h
    weights = h * Gaussian().value(x, _T)
    return MarkerVelocity(shape, epsilon, derivatives=0).fields(x, weights, z)[0]
