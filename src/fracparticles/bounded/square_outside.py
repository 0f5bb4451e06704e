r"""Integrals over the outside of a square |x|, |y| < R, for points inside.

    c int_outside g(y) |x - y|^(-2-alpha) dy
        = (c / alpha) int_0^(2 pi) rho^-alpha int_0^1 g(x + rho tau^(-1/alpha) e) dtau dtheta,

with the distance rho(x, theta) to the edge along e = (cos theta, sin theta). For the side at the distance d, rho is
d / cos theta. The integral of cos^alpha from the foot is half an incomplete beta function. It gives the rate
kappa (g = 1), and is the variable of the quadrature in theta. The mean of a constant g is this constant.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.special import beta, betainc, betaincinv

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.special.quadrature import gauss_legendre
from fracparticles.special.tails import plane_constant

__all__ = ["Outside", "outward_rate"]

_DIRECTIONS, _DISTANCES = 12, 12  # nodes of the two quadratures, for each side


def outward_rate(x: FloatArray, y: FloatArray, half: float, alpha: float) -> FloatArray:
    """Return kappa at points inside the square |x|, |y| < half, of the shape of x and y."""
    total = np.zeros(np.broadcast(x, y).shape)
    for _, _, d, low, high in _sides(x, y, half, alpha):
        total += d**-alpha * (high - low)
    return plane_constant(alpha) / alpha * total


class Outside:
    """Means over the outside of the square |x|, |y| < half, for points x, y inside; the rays are found once."""

    def __init__(self, x: FloatArray, y: FloatArray, half: float, alpha: float) -> None:
        self._x, self._y = x, y
        self.rate = outward_rate(x, y, half, alpha)
        nodes, shares = gauss_legendre(_DIRECTIONS, 0.0, 1.0)
        stretch, self._parts = gauss_legendre(_DISTANCES, 0.0, 1.0)
        self._stretch = stretch ** (-1.0 / alpha)
        whole = alpha / plane_constant(alpha) * self.rate
        # For each side: outward and along it, the distance, and the weight and slope of each direction.
        self._rays = [
            (outward, along, d, [
                (share * d**-alpha * (high - low) / whole, _slope(low + node * (high - low), alpha))
                for node, share in zip(nodes, shares, strict=True)
            ])
            for outward, along, d, low, high in _sides(x, y, half, alpha)
        ]  # fmt: skip

    def mean(self, g: Callable[..., Any]) -> FloatArray:
        """Return the mean of g(x, y) outside, with the weight |x - y|^(-2-alpha), for each point inside."""
        total = np.zeros(self.rate.shape)
        for outward, along, d, directions in self._rays:
            step = np.multiply.outer(self._stretch, d)
            for weight, slope in directions:
                at_x = self._x + step * (outward[0] + slope * along[0])
                at_y = self._y + step * (outward[1] + slope * along[1])
                values = check.sampled("outside", g, at_x, at_y)
                total += weight * np.tensordot(self._parts, values, 1)
        return total


def _sides(x: FloatArray, y: FloatArray, half: float, alpha: float) -> Any:
    """Yield for each side: outward and along it, the distance, and the integrals of cos^alpha to its two corners."""
    for d, t, outward, along in (
        (half - x, y, (1.0, 0.0), (0.0, 1.0)),
        (half + x, y, (-1.0, 0.0), (0.0, 1.0)),
        (half - y, x, (0.0, 1.0), (1.0, 0.0)),
        (half + y, x, (0.0, -1.0), (1.0, 0.0)),
    ):
        yield outward, along, d, _angle((-half - t) / d, alpha), _angle((half - t) / d, alpha)


def _angle(slope: FloatArray, alpha: float) -> FloatArray:
    """Return the integral of cos^alpha theta from 0 to arctan(slope)."""
    part = betainc(0.5, 0.5 * (1.0 + alpha), slope**2 / (1.0 + slope**2))
    return np.asarray(0.5 * beta(0.5, 0.5 * (1.0 + alpha)) * np.sign(slope) * part)


def _slope(angle: FloatArray, alpha: float) -> FloatArray:
    """Return the slope for an integral: the inverse of `_angle`."""
    whole = 0.5 * beta(0.5, 0.5 * (1.0 + alpha))
    squared = betaincinv(0.5, 0.5 * (1.0 + alpha), np.minimum(np.abs(angle) / whole, 1.0))
    return np.asarray(np.sign(angle) * np.sqrt(squared / (1.0 - squared)))
