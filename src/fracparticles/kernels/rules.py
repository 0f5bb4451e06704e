"""The interface of all kernel families: access by name, and kernels that follow from others by a rule.

A kernel family is made by one regularisation eta of the delta function. Equation numbers are those of Lucchesi et al.
(2020). With M(a, b, r^2) for the regularised 1F1(a; b; -r^2) that belongs to eta, and Gamma_{n,b} of (B.14),

    kappa = Gamma_{n,0}(beta-1) M((beta-1+n)/2, n/2, r^2)             k^(alpha-2) eta^(k)     (14), (15), (B.11)
    F     = -r K                                                      k^(alpha-1) eta^(k)     (20), (21), (B.12)
    G     = -Gamma_{n,0}(alpha) M((alpha+n)/2, n/2, r^2)              -k^alpha eta^(k)        (11), (12), (B.13)
    K     = Gamma_{n,2}(alpha) M((alpha+n)/2, (n+2)/2, r^2)           see `k_hat`             (31), (32)

with the transform on the right. `kernel` and `kernel_transform` of a kernel family check their arguments.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from numbers import Real
from typing import Any

import numpy as np
from scipy.special import gamma

from fracparticles.arguments import (
    FloatArray,
    choice,
    dimension,
    fractional_order,
    like,
    real_array,
)
from fracparticles.errors import InvalidInput, one_of

__all__ = ["KernelFamily", "distances", "gamma_nb", "is_order"]


_LARGEST = 1e150  # distance and wavenumber: their squares must not overflow


def gamma_nb(n: int, b: int, alpha: float) -> float:
    """Gamma_{n,b}(alpha) = 2^alpha Gamma((alpha+n)/2) / (pi^(n/2) Gamma((n+b)/2) b!)  (B.14)."""
    below = math.pi ** (0.5 * n) * gamma(0.5 * (n + b)) * math.factorial(b)
    return float(2.0**alpha * gamma(0.5 * (alpha + n)) / below)


def distances(r: Any, dim: int) -> FloatArray:
    """Return the distances r as an array; |r| <= 1e150, and only on the line may they have a sign.

    Raises `InvalidInput` for other values.
    """
    r = real_array("r", r)
    if (np.abs(r) > _LARGEST).any():
        raise InvalidInput("r", float(np.abs(r).max()), "|r| <= 1e150", "Scale the distances.")
    if dim > 1 and (r < 0.0).any():
        raise InvalidInput("r", float(r.min()), "a radius r >= 0 for dim > 1", "Give |r|.")
    return r


def is_order(order: Any, orders: Sequence[int]) -> bool:
    """Return whether a value is one of these orders."""
    return isinstance(order, Real) and not isinstance(order, bool) and order in orders


class KernelFamily(ABC):
    """The kernels of one regularisation: functions of distance, wavenumber, alpha, dimension n and order.

    Attributes
    ----------
    orders : tuple of int
        Orders of accuracy that exist.
    names : tuple of str
        Names of the kernels.
    """

    orders: tuple[int, ...]
    names: tuple[str, ...] = ("eta", "eta1", "Phi", "kappa", "F", "G", "K")

    @abstractmethod
    def m(self, c: float, b: float, r: FloatArray, order: int) -> FloatArray:
        """M(b - c, b, r^2); c = b - a keeps its digits as alpha nears 2."""

    @abstractmethod
    def eta(self, r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """The regularisation of the delta function."""

    @abstractmethod
    def eta1(self, r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """The kernel of the divergence."""

    @abstractmethod
    def phi(self, r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """-(1/r) d eta/dr  (17)."""

    def kappa(self, r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """The kernel of the fractional integral of order 1 - beta."""
        return gamma_nb(n, 0, alpha - 2.0) * self.m(0.5 * (2.0 - alpha), 0.5 * n, r, order)

    def f(self, r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """The kernel of the fractional gradient."""
        return -r * self.k(r, alpha, n, order)

    def g(self, r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """The kernel of the fractional Laplacian."""
        return -gamma_nb(n, 0, alpha) * self.m(-0.5 * alpha, 0.5 * n, r, order)

    def k(self, r: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """The kernel of the strength exchange, -F . r / |r|^2."""
        return gamma_nb(n, 2, alpha) * self.m(0.5 * (2.0 - alpha), 0.5 * (n + 2), r, order)

    @abstractmethod
    def eta_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """The transform of eta."""

    @abstractmethod
    def eta1_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """The transform of eta1."""

    @abstractmethod
    def phi_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """The transform of Phi."""

    def kappa_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """The transform of kappa: infinite at k = 0."""
        with np.errstate(divide="ignore", over="ignore"):
            return k ** (alpha - 2.0) * self.eta_hat(k, alpha, n, order)

    def f_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """The transform of F."""
        return k ** (alpha - 1.0) * self.eta_hat(k, alpha, n, order)

    def g_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """The transform of G."""
        return -(k**alpha) * self.eta_hat(k, alpha, n, order)

    @abstractmethod
    def k_hat(self, k: FloatArray, alpha: float, n: int, order: int) -> FloatArray:
        """The transform of K: from r K = -F it obeys dK^/dk = -k^(alpha-1) eta^(k) and vanishes at infinity."""

    def kernel(
        self, name: str, r: Any, alpha: float, dim: int = 1, order: int = 2
    ) -> FloatArray | float:
        """Return the kernel `name` at distance r; parameters and errors as for `families.kernel`."""
        alpha = self._checked(name, alpha, dim, order)
        r = distances(r, dim)
        return like(r, getattr(self, name.lower())(r, alpha, dim, order))

    def kernel_transform(
        self, name: str, k: Any, alpha: float, dim: int = 1, order: int = 2
    ) -> FloatArray | float:
        """Return the Fourier transform of the kernel `name`; as `families.kernel_transform`."""
        alpha = self._checked(name, alpha, dim, order)
        k = real_array("k", k)
        if not ((k >= 0.0) & (k <= _LARGEST)).all():
            raise InvalidInput("k", k, "0 <= k <= 1e150", "Give the modulus of the wave vector.")
        return like(k, getattr(self, f"{name.lower()}_hat")(k, alpha, dim, order))

    def check_order(self, order: Any) -> None:
        """Refuse an order that the kernel family does not have."""
        if not is_order(order, self.orders):
            raise one_of("order", order, self.orders)

    def _checked(self, name: str, alpha: Any, dim: Any, order: Any) -> float:
        choice("name", name, self.names)
        dimension(dim)
        self.check_order(order)
        return fractional_order(alpha)
