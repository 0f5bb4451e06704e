r"""Modes with a forcing in time: y' = -lambda y + F(t), exact for a polynomial F on each of some panels of time.

On a panel of length T with r = T - s, F = sum_m F_m (r / T)^m,

    y(T) = e^(-z) y(0) + T sum_m F_m I_m(z),   I_m(z) = int_0^1 e^(-z r) r^m dr,   z = lambda T.

F is interpolated at Chebyshev points, both ends of the panel among them; panels are halved until the result stands.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from scipy.special import gammainc

from fracparticles.arguments import FloatArray
from fracparticles.errors import NonFiniteSolution

__all__ = ["forced_modes", "moments_of_decay", "slopes_in_time"]

_DEGREE = 8
_MOST_PANELS = 512
_TERMS = 24  # of the series for z <= 1


def moments_of_decay(z: FloatArray, degree: int) -> FloatArray:
    """Return I_m(z) for m = 0, .., degree and z >= 0, shape (degree + 1, ..): m! P(m + 1, z) / z^(m+1)."""
    small = np.minimum(z, 1.0)
    large = np.maximum(z, 1.0)
    result = []
    for m in range(degree + 1):
        series, term = np.zeros_like(small), np.ones_like(small)
        for k in range(_TERMS):
            series += term / (m + 1.0 + k)
            term = term * (-small / (k + 1.0))
        closed = math.factorial(m) * gammainc(m + 1.0, large) * large ** -(m + 1.0)
        result.append(np.where(z <= 1.0, series, closed))
    return np.array(result)


def forced_modes(
    rates: FloatArray,
    start: FloatArray,
    forcing: Callable[[FloatArray], FloatArray],
    time: float,
    tolerance: float,
) -> FloatArray:
    """Return y(time), shape (K,).

    Parameters
    ----------
    rates : array, shape (K,)
        lambda.
    start : array, shape (K,)
        y(0).
    forcing : callable
        From the times of a panel, shape (9,) in ascending order, to F at them, shape (9, K).
    time : float
    tolerance : float
        Of |y|, between the results of one number of panels and of twice as many.

    Raises
    ------
    NonFiniteSolution
        If the forcing is not resolved by 512 panels.
    """
    panels, before = 1, None
    while panels <= _MOST_PANELS:
        y = _on_panels(rates, start, forcing, time, panels)
        if before is not None and np.linalg.norm(y - before) <= tolerance * np.linalg.norm(y):
            return y
        panels, before = 2 * panels, y
    raise NonFiniteSolution(
        f"the source or the values outside are not resolved by {_MOST_PANELS} panels of time up to t = {time:g}: "
        "they vary too fast or jump. Solve from jump to jump."
    )


def _on_panels(
    rates: FloatArray,
    y: FloatArray,
    forcing: Callable[[FloatArray], FloatArray],
    time: float,
    panels: int,
) -> FloatArray:
    length = time / panels
    nodes = 0.5 - 0.5 * np.cos(np.pi * np.arange(_DEGREE + 1) / _DEGREE)
    powers = np.vander(1.0 - nodes, increasing=True)
    weights = length * moments_of_decay(rates * length, _DEGREE)
    decay = np.exp(-rates * length)
    for panel in range(panels):
        values = forcing((panel + nodes) * length)
        y = decay * y + (weights * np.linalg.solve(powers, values)).sum(axis=0)
    return y


def slopes_in_time(times: FloatArray, values: FloatArray) -> FloatArray:
    """Return the derivative of the polynomial through the values, at the same times."""
    middle, half = 0.5 * (times[0] + times[-1]), 0.5 * (times[-1] - times[0])
    s = (times - middle) / half
    coefficients = np.linalg.solve(np.polynomial.chebyshev.chebvander(s, len(s) - 1), values)
    slopes = np.polynomial.chebyshev.chebder(coefficients) / half
    return np.asarray(np.polynomial.chebyshev.chebval(s, slopes).T)
