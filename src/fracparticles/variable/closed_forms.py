"""Closed forms to test with: the field whose transform falls like exp(-|k|), u = (1 + |x|^2)^(-(n+1)/2).

    (-Laplacian)^(sigma/2) u = Gamma(n + sigma) / Gamma(n) 2F1((n+sigma)/2, (n+sigma+1)/2; n/2; -|x|^2),

and with sigma = beta - 1 the fractional gradient is the gradient of it: grad^beta = grad (-Laplacian)^((beta-1)/2).
On the line these are Gamma(1+sigma) (1+x^2)^(-(1+sigma)/2) cos((1+sigma) arctan x), and so on.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import gamma, hyp2f1

__all__ = [
    "cauchy",
    "cauchy_flux_divergence",
    "cauchy_gradient",
    "cauchy_laplacian",
    "exchange_limit",
]

Points = Sequence[np.ndarray]


def cauchy(points: Points) -> np.ndarray:
    """Return u at points, one array a dimension."""
    return np.asarray((1.0 + _square(points)) ** (-0.5 * (len(points) + 1)))


def cauchy_laplacian(points: Points, alpha: float | np.ndarray) -> np.ndarray:
    """Return -(-Laplacian)^(alpha/2) u; on the line alpha may be an array."""
    if len(points) == 1:
        x, p = points[0], 1.0 + np.asarray(alpha)
        return np.asarray(-gamma(p) * (1.0 + x * x) ** (-0.5 * p) * np.cos(p * np.arctan(x)))
    p = len(points) + np.asarray(alpha)
    value = hyp2f1(0.5 * p, 0.5 * (p + 1.0), 0.5 * len(points), -_square(points))
    return np.asarray(-gamma(p) / gamma(len(points)) * value)


def cauchy_gradient(points: Points, alpha: float) -> list[np.ndarray]:
    """Return the components of grad^beta u, beta = alpha - 1."""
    n, a = len(points), 0.5 * (len(points) + alpha) - 1.0
    if n == 1:
        x = points[0]
        return [-gamma(alpha) * (1.0 + x * x) ** (-0.5 * alpha) * np.sin(alpha * np.arctan(x))]
    value = hyp2f1(a + 1.0, a + 1.5, 0.5 * n + 1.0, -_square(points))
    slope = -4.0 * a * (a + 0.5) / n * gamma(2.0 * a) / gamma(n) * value
    return [slope * part for part in points]


def cauchy_flux_divergence(
    points: Points, alpha: float, d: np.ndarray, slopes: Sequence[np.ndarray]
) -> np.ndarray:
    """Return div(D grad^beta u) = D div grad^beta u + grad D . grad^beta u of a diffusivity and its gradient."""
    total = d * cauchy_laplacian(points, alpha)
    for slope, component in zip(slopes, cauchy_gradient(points, alpha), strict=True):
        total = total + slope * component
    return total


def exchange_limit(x: np.ndarray, alpha: float, amplitude: float) -> np.ndarray:
    """Return (D L u + L(D u) - u L D) / 2 on the line for D = 1 + amplitude u, L = -(-Laplacian)^(alpha/2).

    The transform of u^2 is (pi/2) (1 + |k|) exp(-|k|), so that L u^2 is half the sum of L u of the orders
    alpha and alpha + 1. Of D L u - u L D there remains L u.
    """
    first = cauchy_laplacian([x], alpha)
    square = 0.5 * (first + cauchy_laplacian([x], alpha + 1.0))
    return np.asarray(first + 0.5 * amplitude * square)


def _square(points: Points) -> np.ndarray:
    return np.asarray(sum(np.square(part) for part in points))
