"""Test fields whose fractional derivatives are known in n dimensions:

    Cauchy      u = (1 + |x|^2)^(-(n+1)/2),  (-Laplacian)^(sigma/2) u = Gamma(n + sigma) / Gamma(n)
                                             2F1((n+sigma)/2, (n+sigma+1)/2; n/2; -|x|^2),
    Gaussian    u = exp(-|x|^2),             (-Laplacian)^(sigma/2) u = 2^sigma Gamma((n+sigma)/2) / Gamma(n/2)
                                             1F1((n+sigma)/2; n/2; -|x|^2).

The fractional gradient is the gradient of the field for sigma = beta - 1: grad^beta = grad (-Laplacian)^((beta-1)/2).
On the line that of Cauchy is Gamma(1 + sigma) (1 + x^2)^(-(1+sigma)/2) cos((1 + sigma) arctan x).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.special import gamma, hyp1f1, hyp2f1

__all__ = ["Cauchy", "Gaussian", "KnownField", "Packet", "exchange_limit"]

Points = Sequence[np.ndarray]
"""The coordinates of points, one array for each dimension."""

_WIDTH = 12.0  # of the packet, in units of x


class KnownField(ABC):
    """A field and its fractional derivatives."""

    @staticmethod
    @abstractmethod
    def value(points: Points) -> np.ndarray:
        """Return u."""

    @staticmethod
    @abstractmethod
    def riesz(points: Points, sigma: Any) -> np.ndarray:
        """Return (-Laplacian)^(sigma/2) u; sigma may be an array."""

    @staticmethod
    @abstractmethod
    def gradient(points: Points, alpha: float) -> list[np.ndarray]:
        """Return the components of grad^beta u, beta = alpha - 1."""

    @classmethod
    def laplacian(cls, points: Points, alpha: Any) -> np.ndarray:
        """Return -(-Laplacian)^(alpha/2) u; alpha may be an array."""
        return -cls.riesz(points, alpha)

    @classmethod
    def flux_divergence(
        cls, points: Points, alpha: float, d: np.ndarray, slopes: Sequence[np.ndarray]
    ) -> np.ndarray:
        """Return div(D grad^beta u) = D div grad^beta u + grad D . grad^beta u, from D (`d`) and grad D (`slopes`)."""
        total = d * cls.laplacian(points, alpha)
        for slope, component in zip(slopes, cls.gradient(points, alpha), strict=True):
            total = total + slope * component
        return np.asarray(total)


class Cauchy(KnownField):
    """(1 + |x|^2)^(-(n+1)/2), whose transform falls like exp(-|k|)."""

    @staticmethod
    def value(points: Points) -> np.ndarray:
        """Return u."""
        return np.asarray((1.0 + _square(points)) ** (-0.5 * (len(points) + 1)))

    @staticmethod
    def riesz(points: Points, sigma: Any) -> np.ndarray:
        """Return (-Laplacian)^(sigma/2) u."""
        n = len(points)
        p = n + np.asarray(sigma)
        value = hyp2f1(0.5 * p, 0.5 * (p + 1.0), 0.5 * n, -_square(points))
        return np.asarray(gamma(p) / gamma(n) * value)

    @staticmethod
    def gradient(points: Points, alpha: float) -> list[np.ndarray]:
        """Return the components of grad^beta u, beta = alpha - 1."""
        n, a = len(points), 0.5 * (len(points) + alpha) - 1.0
        value = hyp2f1(a + 1.0, a + 1.5, 0.5 * n + 1.0, -_square(points))
        slope = -4.0 * a * (a + 0.5) / n * gamma(2.0 * a) / gamma(n) * value
        return [slope * part for part in points]


class Gaussian(KnownField):
    """exp(-|x|^2)."""

    @staticmethod
    def value(points: Points) -> np.ndarray:
        """Return u."""
        return np.asarray(np.exp(-_square(points)))

    @staticmethod
    def riesz(points: Points, sigma: Any) -> np.ndarray:
        """Return (-Laplacian)^(sigma/2) u."""
        n, sigma = len(points), np.asarray(sigma)
        a = 0.5 * (n + sigma)
        scale = 2.0**sigma * gamma(a) / gamma(0.5 * n)
        return np.asarray(scale * hyp1f1(a, 0.5 * n, -_square(points)))

    @staticmethod
    def gradient(points: Points, alpha: float) -> list[np.ndarray]:
        """Return the components of grad^beta u, beta = alpha - 1."""
        n, a = len(points), 0.5 * (len(points) + alpha) - 1.0
        scale = -4.0 * a / n * 2.0 ** (alpha - 2.0) * gamma(a) / gamma(0.5 * n)
        slope = scale * hyp1f1(a + 1.0, 0.5 * n + 1.0, -_square(points))
        return [slope * part for part in points]


class Packet(KnownField):
    """exp(-x^2 / 144) cos x on the line, nearly a single wave: even large errors show the order of the scheme.

    It is the mean of cos(k x) with a Gaussian weight about k = 1, computed by Gauss-Hermite quadrature.
    """

    @staticmethod
    def value(points: Points) -> np.ndarray:
        """Return u."""
        (x,) = points
        return np.asarray(np.exp(-np.square(x / _WIDTH)) * np.cos(x))

    @staticmethod
    def riesz(points: Points, sigma: Any) -> np.ndarray:
        """Return (-Laplacian)^(sigma/2) u."""
        (x,) = points
        return np.asarray(sum(w * k**sigma * np.cos(k * x) for k, w in _waves()))

    @staticmethod
    def gradient(points: Points, alpha: float) -> list[np.ndarray]:
        """Return the components of grad^beta u, beta = alpha - 1."""
        (x,) = points
        return [-np.asarray(sum(w * k ** (alpha - 1.0) * np.sin(k * x) for k, w in _waves()))]


def _waves() -> list[tuple[float, float]]:
    """The wave numbers of the packet and their weights; k < 0 is left out, whose weights are below round-off."""
    node, weight = np.polynomial.hermite.hermgauss(100)
    k = 1.0 + 2.0 * node / _WIDTH
    return [
        (k, w / np.sqrt(np.pi)) for k, w in zip(k, weight, strict=True) if k > 0.0 and w > 1e-18
    ]


def exchange_limit(x: np.ndarray, alpha: float, amplitude: float) -> np.ndarray:
    """Return (D L u + L(D u) - u L D) / 2, L = -(-Laplacian)^(alpha/2), for u = 1 / (1 + x^2) and D = 1 + amplitude u.

    The transform of u^2 is (pi/2) (1 + |k|) exp(-|k|), so that L u^2 is half the sum of L u of the orders
    alpha and alpha + 1. D L u - u L D is L u, since the other terms cancel.
    """
    first = Cauchy.laplacian([x], alpha)
    square = 0.5 * (first + Cauchy.laplacian([x], alpha + 1.0))
    return np.asarray(first + 0.5 * amplitude * square)


def _square(points: Points) -> np.ndarray:
    return np.asarray(sum(np.square(part) for part in points))
