"""Kernels eta(z) of unit radius; eta_eps(x) = eta(x / eps) / eps^d (7).

A kernel is a function of z (of the distance |z| in d > 1) that states how far it reaches and where its pieces meet.
For d > 1 it has a `dim`. Sums and integrals only take kernels of their own dimension.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from math import comb, factorial, pi
from numbers import Rational
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.errors import InvalidInput

__all__ = [
    "GAUSSIAN_20",
    "TENT_27",
    "GaussianKernel",
    "Kernel",
    "SplineKernel",
    "Stencil",
    "Tent",
    "kernel_of",
]

_NOTHING = 1e3  # the greatest z computed with: exp(-z^2) is 0 from 28 on, and no power overflows
_WIDEST = 1e4  # the greatest reach of a kernel, in radii
_POWERS = 12  # the degree up to which the truncated powers of a spline lose no digit
_BLOCK = 2**12  # points at which a spline is evaluated at a time


class Kernel(Protocol):
    """The methods of a kernel that the sums need."""

    @property
    def reach(self) -> float:
        """The |z| beyond which eta is zero, or below round-off."""

    @property
    def breaks(self) -> tuple[float, ...]:
        """The places where the pieces of eta meet, without the ends; empty if it is smooth."""

    def __call__(self, z: ArrayLike) -> FloatArray:
        """Return eta(z), in the shape of z."""


def kernel_of(dim: int, kernel: Any) -> Kernel:
    """Return the kernel if it has `dim` dimensions.

    Raises `InvalidInput` if it is not a kernel, or has another dimension.
    """
    if not (callable(kernel) and hasattr(kernel, "reach") and hasattr(kernel, "breaks")):
        raise InvalidInput("kernel", kernel, "a kernel, with a reach and breaks", "Make one first.")
    dim, of_kernel = check.dimension(dim), getattr(kernel, "dim", 1)
    if of_kernel != dim:
        allowed = f"a kernel of {dim} dimensions, not of {of_kernel}"
        remedy = f"construct_laplacian(accuracy, {dim}) gives one for the Laplacian."
        raise InvalidInput("kernel", kernel, allowed, remedy)
    check.real_between("kernel.reach", kernel.reach, 0.0, _WIDEST)
    result: Kernel = kernel
    return result


@dataclass(frozen=True)
class GaussianKernel:
    """eta(z) = sum_j c_j z^(p + 2 j) pi^(-d/2) exp(-z^2), with (19): p = 0 symmetric, p = 1 antisymmetric.

    Raises `InvalidInput` if there is no coefficient other than zero, or a value is outside its range.

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
    breaks = ()  # it is smooth

    def __post_init__(self) -> None:
        check.fields(
            self,
            coefficients=_coefficients,
            parity=partial(check.whole_number, most=1),
            dim=lambda _, dim: check.dimension(dim),
            condition=check.finite_real,
        )

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
        z = np.clip(check.real_array("z", z), -_NOTHING, _NOTHING)
        square = z * z
        total = np.zeros_like(z)
        for c in reversed(self.coefficients):
            total = float(c) + square * total
        return z**self.parity * total * np.exp(-square) / pi ** (0.5 * self.dim)


def _coefficients(field: str, value: Any) -> tuple[Fraction | float, ...]:
    if isinstance(value, tuple | list) and all(
        isinstance(c, Rational) and not isinstance(c, bool) for c in value
    ):
        exact = tuple(value)
    else:
        exact = tuple(np.atleast_1d(check.finite_array(field, value)).ravel().tolist())
    if not any(exact):
        raise InvalidInput(field, value, "numbers that are not all zero", "Give at least one.")
    return exact


@dataclass(frozen=True)
class Tent:
    """eta(z) = 2 (1 - |z| / 2) for |z| <= 2, else 0  (27)."""

    reach = 2.0
    breaks = (0.0,)

    def __call__(self, z: ArrayLike) -> FloatArray:
        """Return eta(z), in the shape of z."""
        return np.maximum(2.0 * (1.0 - 0.5 * np.abs(check.real_array("z", z))), 0.0)


@dataclass(frozen=True)
class SplineKernel:
    """eta = 24 / (q + 1) B_q, the centred B-spline of degree q with M_2 = 2: for f'', r = 2, on any particles.

    B_q(z) = 1/q! sum_k (-1)^k binom(q+1, k) (z + (q+1)/2 - k)_+^q has unit mass, the second moment (q+1)/12 and
    the transform (sin(k/2) / (k/2))^(q+1). The quadrature error is therefore of the order m = q + 1.

    The powers have both signs, and cancel for a large q. B_q is then computed with positive terms only, for
    u = z + (q+1)/2, by

        q B_q(u) = u B_(q-1)(u) + (q + 1 - u) B_(q-1)(u - 1)     (de Boor).

    Raises `InvalidInput` unless q is a whole number from 1 to 300.
    """

    degree: int

    def __post_init__(self) -> None:
        check.fields(self, degree=partial(check.whole_number, least=1, most=300))

    @property
    def reach(self) -> float:
        """Half the length of the support."""
        return 0.5 * (self.degree + 1)

    @property
    def breaks(self) -> tuple[float, ...]:
        """The inner knots."""
        return tuple(k - self.reach for k in range(1, self.degree + 1))

    def __call__(self, z: ArrayLike) -> FloatArray:
        """Return eta(z), in the shape of z."""
        q = self.degree
        # Measured from the nearer end: this takes fewer terms, and they do not cancel in the tail.
        left = self.reach - np.abs(check.real_array("z", z))
        if q > _POWERS:
            flat = left.ravel()
            blocks = [_spline(q, flat[i : i + _BLOCK]) for i in range(0, flat.size, _BLOCK)]
            return 24.0 / (q + 1) * np.concatenate([*blocks, []]).reshape(left.shape)
        total = np.zeros_like(left)
        for k in range(q + 1):
            total += (-1) ** k * comb(q + 1, k) * np.maximum(left - k, 0.0) ** q
        return 24.0 / (q + 1) / factorial(q) * total


def _spline(degree: int, u: FloatArray) -> FloatArray:
    """B_q at u = z + (q+1)/2, from the values of B_0 at u, u - 1, ..., u - q."""
    u = u - np.arange(degree + 1.0)[:, None]
    b = np.where((u >= 0.0) & (u < 1.0), 1.0, 0.0)
    u[~np.isfinite(u)] = 0.0  # B_0 is 0 there, and stays so
    for q in range(1, degree + 1):
        b = (u[: len(b) - 1] * b[:-1] + (q + 1.0 - u[: len(b) - 1]) * b[1:]) / q
    return b[0]


@dataclass(frozen=True)
class Stencil:
    """A kernel that has values only at the points of the lattice, eta(i), |i| <= n, for eps = h (Sec. 3.1).

    Raises `InvalidInput` if the number of values is even, or one is not finite.

    Attributes
    ----------
    values : tuple of Fraction
        eta(-n), ..., eta(n); eta(0) is free, since f(x_p) - f(x_i) is zero there, and set to 0.
    condition : float
        Condition number of the moment conditions that gave the values.
    """

    values: tuple[Fraction, ...]
    condition: float = 1.0
    breaks = ()  # there is nothing between the points

    def __post_init__(self) -> None:
        check.fields(self, values=_coefficients, condition=check.finite_real)
        if len(self.values) % 2 == 0:
            raise InvalidInput("values", self.values, "an odd number of them", "Give eta(0) too.")

    @property
    def reach(self) -> float:
        """The outermost point."""
        return 0.5 * (len(self.values) - 1)

    def __call__(self, z: ArrayLike) -> FloatArray:
        """Return eta at the lattice points z, in the shape of z.

        Raises `InvalidInput` if a z within the reach is no lattice point, to a millionth.
        """
        n = len(self.values) // 2
        z = np.clip(check.real_array("z", z), -n - 1.0, n + 1.0)
        i = np.rint(z)
        between = z[np.abs(z - i) > 1e-6]
        if between.size:
            allowed = "only points of the lattice, eps = h: a stencil has no values between them"
            remedy = "Take a kernel that has, from `construct`."
            raise InvalidInput("z", float(between[0]), allowed, remedy)
        table = np.array([0.0, *map(float, self.values), 0.0])
        return table[i.astype(int) + n + 1]


GAUSSIAN_20 = GaussianKernel((Fraction(4),))  # 4 / sqrt(pi) exp(-z^2)  (20)
TENT_27 = Tent()
