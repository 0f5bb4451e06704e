"""Kernels eta(z) of unit radius; eta_eps(x) = eta(x / eps) / eps^d (7).

A kernel is a function of z (of the distance |z| in d > 1) that says how far it reaches and where its pieces meet.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import comb, factorial, pi
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fracparticles.errors import InvalidInput

__all__ = [
    "GAUSSIAN_20",
    "TENT_27",
    "GaussianKernel",
    "Kernel",
    "SplineKernel",
    "Stencil",
    "Tent",
]

FloatArray = NDArray[np.float64]


class Kernel(Protocol):
    """What the sums need to know of a kernel."""

    @property
    def reach(self) -> float:
        """Where eta is nil, or below round-off: |z| > reach."""

    @property
    def breaks(self) -> tuple[float, ...]:
        """Where the pieces of eta meet, the ends left out; empty if it is smooth."""

    def __call__(self, z: ArrayLike) -> FloatArray:
        """Return eta(z), in the shape of z."""


@dataclass(frozen=True)
class GaussianKernel:
    """eta(z) = sum_j c_j z^(p + 2 j) pi^(-d/2) exp(-z^2), with (19): p = 0 symmetric, p = 1 antisymmetric.

    Attributes
    ----------
    coefficients : tuple
        c_j; `Fraction` where they are exact.
    parity : {0, 1}
        p.
    dim : int
        d; a radial kernel if d > 1.
    condition : float
        Condition number of the moment conditions that gave c_j.
    """

    coefficients: tuple[Fraction | float, ...]
    parity: int = 0
    dim: int = 1
    condition: float = 1.0
    breaks: tuple[float, ...] = ()

    @property
    def reach(self) -> float:
        """exp(-z^2) z^q is below round-off beyond it: z^2 - q log z > 40 + log of the coefficients."""
        power = self.parity + 2 * (len(self.coefficients) - 1)
        size = np.log(max(abs(float(c)) for c in self.coefficients))
        z = 6.5
        for _ in range(20):  # a contraction: q / (2 z^2) < 1
            z = float(np.sqrt(40.0 + max(size, 0.0) + power * np.log(z)))
        return z

    def __call__(self, z: ArrayLike) -> FloatArray:
        """Return eta(z), in the shape of z."""
        z = np.asarray(z, dtype=float)
        square = z * z
        total = np.zeros_like(z)
        for c in reversed(self.coefficients):
            total = float(c) + square * total
        return z**self.parity * total * np.exp(-square) / pi ** (0.5 * self.dim)


@dataclass(frozen=True)
class Tent:
    """eta(z) = 2 (1 - |z| / 2) for |z| <= 2, else 0  (27)."""

    reach: float = 2.0
    breaks: tuple[float, ...] = (0.0,)

    def __call__(self, z: ArrayLike) -> FloatArray:
        """Return eta(z), in the shape of z."""
        return np.maximum(2.0 * (1.0 - 0.5 * np.abs(np.asarray(z, dtype=float))), 0.0)


@dataclass(frozen=True)
class SplineKernel:
    """eta = 24 / (q + 1) B_q, the centred B-spline of degree q with M_2 = 2: for f'', r = 2, by any particles.

    B_q(z) = 1/q! sum_k (-1)^k binom(q+1, k) (z + (q+1)/2 - k)_+^q has unit mass, the second moment (q+1)/12 and
    the transform (sin(k/2) / (k/2))^(q+1): the quadrature error is of the order m = q + 1.

    Raises
    ------
    InvalidInput
        Unless q is a whole number from 1 on.
    """

    degree: int

    def __post_init__(self) -> None:
        if isinstance(self.degree, bool) or not isinstance(self.degree, int) or self.degree < 1:
            raise InvalidInput("degree", self.degree, "a whole number from 1 on", "1 is the tent.")

    @property
    def reach(self) -> float:
        """Half of the support."""
        return 0.5 * (self.degree + 1)

    @property
    def breaks(self) -> tuple[float, ...]:
        """The inner knots."""
        return tuple(k - self.reach for k in range(1, self.degree + 1))

    def __call__(self, z: ArrayLike) -> FloatArray:
        """Return eta(z), in the shape of z."""
        q = self.degree
        # From the nearer end: fewer terms, no cancellation in the tail.
        left = self.reach - np.abs(np.asarray(z, dtype=float))
        total = np.zeros_like(left)
        for k in range(q + 1):
            total += (-1) ** k * comb(q + 1, k) * np.maximum(left - k, 0.0) ** q
        return 24.0 / (q + 1) / factorial(q) * total


@dataclass(frozen=True)
class Stencil:
    """A kernel known at the points of the lattice only, eta(i), |i| <= n, for eps = h (Sec. 3.1).

    Attributes
    ----------
    values : tuple of Fraction
        eta(-n), ..., eta(n); eta(0) is free, since f(x_p) - f(x_i) is nil there, and set to 0.
    condition : float
        Condition number of the moment conditions that gave the values.
    """

    values: tuple[Fraction, ...]
    condition: float = 1.0
    breaks: tuple[float, ...] = ()

    @property
    def reach(self) -> float:
        """The outermost point."""
        return 0.5 * (len(self.values) - 1)

    def __call__(self, z: ArrayLike) -> FloatArray:
        """Return eta at the lattice point next to z, in the shape of z."""
        i = np.rint(np.asarray(z, dtype=float)).astype(int)
        n = len(self.values) // 2
        table = np.array([0.0, *map(float, self.values), 0.0])
        return table[np.clip(i, -n - 1, n + 1) + n + 1]


GAUSSIAN_20 = GaussianKernel((Fraction(4),))  # 4 / sqrt(pi) exp(-z^2)  (20)
TENT_27 = Tent()
