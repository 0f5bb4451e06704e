"""The periodic images of a power: S(x) = sum_{m != 0} |x + m|^(-n-gamma) over the integer points m, |x|_inf <= 1/2.

On the line these are Hurwitz zeta functions, zeta(1 + gamma, 1 + x) + zeta(1 + gamma, 1 - x). In the plane and in space
they are summed by Ewald's method: with s = n + gamma and the incomplete gamma functions Gamma(a, y) and gamma(a, y),

    pi^(-s/2) Gamma(s/2) S(x) = sum_{m != 0} g(s/2, pi |x + m|^2) - gamma(s/2, pi |x|^2) (pi |x|^2)^(-s/2)
                                + sum_{k != 0} cos(2 pi k.x) g(-gamma/2, pi |k|^2) + 2 / gamma,

    g(a, y) = y^(-a) Gamma(a, y).

S is analytic up to |x|_inf = 1, twice as far as needed, and even in each coordinate: it is represented as a
polynomial in the squares.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from itertools import product

import numpy as np
from scipy.special import gamma, gammainc, gammaincc, zeta

from fracparticles.special.quadrature import gauss_legendre

__all__ = [
    "image_series",
    "image_sum",
    "outside_integrals",
    "power_transform",
    "series_derivatives",
    "square_basis",
]

_DEGREES = {
    1: 9,
    2: 6,
    3: 5,
}  # of the polynomials in each square, by dimension: each degree divides the error by 14
_SHELLS = 2  # of images and of waves in Ewald's sums: exp(-pi 2.5^2) = 3e-9 is left out
_NODES = 16  # of the integrals over a face, along each of its axes
_TAYLOR = 24  # terms of Taylor's series on the line: at |x| = 1/2 each divides the error by 4


def power_transform(exponent: np.ndarray, dim: int) -> np.ndarray:
    """Return kappa of the inverse Fourier transform of |k|^gamma, kappa |x|^(-n-gamma), gamma no even integer.

    kappa = 2^gamma Gamma((n + gamma)/2) / (pi^(n/2) Gamma(-gamma/2)).
    """
    g = np.asarray(exponent, dtype=float)
    return 2.0**g * gamma(0.5 * (dim + g)) / (np.pi ** (0.5 * dim) * gamma(-0.5 * g))


def outside_integrals(
    functions: Callable[[np.ndarray], np.ndarray], degrees: np.ndarray, dim: int
) -> np.ndarray:
    """Return the integrals of homogeneous functions outside the cube |x|_inf < 1/2, or their finite parts.

    By the divergence theorem each is -1 / (n + degree) times the integral of f x.nu over the faces, nu their normal.

    Parameters
    ----------
    functions : callable
        From points, shape (n, points), to the values there, shape (.., points).
    degrees : array, shape (..)
        The degrees of the functions, none of them -n.
    dim : int
        n.
    """
    if dim == 1:  # the faces are points
        ends = functions(np.array([[-0.5, 0.5]]))
        return -0.5 * (ends[..., 0] + ends[..., 1]) / (1.0 + degrees)
    nodes, weights = gauss_legendre(_NODES)
    face = 0.5 * np.array(list(product(nodes, repeat=dim - 1))).T
    weight = 0.5**dim * np.prod(list(product(weights, repeat=dim - 1)), axis=1)
    total: np.ndarray | float = 0.0
    for axis, side in product(range(dim), (-0.5, 0.5)):
        total = total + functions(np.insert(face, axis, side, axis=0)) @ weight
    return np.asarray(-total / (dim + degrees))


def image_sum(x: np.ndarray, exponent: float) -> np.ndarray:
    """Return S at the points x, shape (..., n), |x|_inf <= 1/2; to round-off on the line, to 1e-8 for n = 2 and 3."""
    x = np.asarray(x, dtype=float)
    dim = x.shape[-1]
    if dim == 1:
        s, at = 1.0 + exponent, x[..., 0]
        return np.asarray(zeta(s, 1.0 + at) + zeta(s, 1.0 - at))
    a = 0.5 * (dim + exponent)
    m = np.array([m for m in product(range(-_SHELLS, _SHELLS + 1), repeat=dim) if any(m)], float)
    own = np.pi * np.square(x).sum(axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        lower = np.where(own > 0.0, gamma(a) * gammainc(a, own) * own**-a, 1.0 / a)
    near = np.pi * np.square(x[..., None, :] + m).sum(axis=-1)
    upper = gamma(a) * gammaincc(a, near) * near**-a
    waves = np.cos(2.0 * np.pi * (x @ m.T)) @ _scaled_upper(
        -0.5 * exponent, np.pi * np.square(m).sum(axis=-1)
    )
    return np.asarray((upper.sum(axis=-1) - lower + waves + 2.0 / exponent) * np.pi**a / gamma(a))


def _scaled_upper(a: float, y: np.ndarray) -> np.ndarray:
    """y^(-a) Gamma(a, y) for a < 0, by Gamma(a + 1, y) = a Gamma(a, y) + y^a e^(-y)."""
    up = int(np.ceil(-a)) + 1
    value = gamma(a + up) * gammaincc(a + up, y) * y ** -(a + up)
    for b in a + np.arange(up - 1, -1, -1.0):
        value = (y * value - np.exp(-y)) / b
    return np.asarray(value)


def square_basis(x: np.ndarray, dim: int) -> np.ndarray:
    """Return T_j(8 x^2 - 1), j = 0 .. degree, along one axis, shape (degree + 1, len(x))."""
    s = 8.0 * x * x - 1.0
    values = np.empty((_DEGREES[dim] + 1, x.size))
    values[0], values[1] = 1.0, s
    for j in range(2, len(values)):
        values[j] = 2.0 * s * values[j - 1] - values[j - 2]
    return values


@lru_cache(maxsize=4)
def series_derivatives(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the matrices of d/dx from sum c_j T_j(s), s = 8 x^2 - 1, to x times such a sum, and from this to a sum.

    d/dx f(s) = x 16 f'(s), and d/dx x g(s) = g + 2 (s + 1) g'.
    """
    to, of = np.indices((count, count))
    # T_j' = 2 j (T_{j-1} + T_{j-3} + ..)
    slope = np.where((of > to) & (of + to) % 2, 2.0 * of, 0.0)
    slope[0] *= 0.5
    times_s = 0.5 * (np.eye(count, k=1) + np.eye(count, k=-1))
    times_s[1:2, 0] = 1.0
    return 16.0 * slope, np.eye(count) + 2.0 * (slope + times_s @ slope)


def image_series(exponents: np.ndarray, dim: int) -> np.ndarray:
    """Return c with S(x) = sum c_{ij..} T_i(8 x_1^2 - 1) T_j(8 x_2^2 - 1) .. for each exponent.

    Returns
    -------
    array, shape (exponents, degree + 1, .., degree + 1)
    """
    if not exponents.size:
        return np.zeros((0, *(_DEGREES[dim] + 1,) * dim))
    if dim > 1:
        return np.array([_box_series(float(exponent), dim) for exponent in exponents])
    # Taylor's series, 2 sum_i zeta(s + 2 i) (s)_{2 i} / (2 i)! x^(2 i), with its powers written in the T_j.
    s, even = 1.0 + np.asarray(exponents, dtype=float)[:, None], 2.0 * np.arange(_TAYLOR)
    ratios = (s + even - 1.0) * (s + even - 2.0) / np.maximum(even * (even - 1.0), 1.0)
    ratios[:, 0] = 2.0
    return np.asarray((zeta(s + even) * np.cumprod(ratios, axis=1)) @ _powers_of_square())


@lru_cache(maxsize=1)
def _powers_of_square() -> np.ndarray:
    """Row i: x^(2 i) = ((1 + t) / 8)^i in T_j(t), up to the degree on the line."""
    nodes = np.cos((np.arange(_TAYLOR) + 0.5) * (np.pi / _TAYLOR))
    powers = ((1.0 + nodes) / 8.0) ** np.arange(_TAYLOR)[:, None]
    return np.asarray(powers @ _to_series(_TAYLOR).T)[:, : _DEGREES[1] + 1]


def _to_series(count: int) -> np.ndarray:
    """The matrix from values at the Chebyshev points to coefficients."""
    angle = (np.arange(count) + 0.5) * (np.pi / count)
    transform = np.cos(np.outer(np.arange(count), angle)) * (2.0 / count)
    transform[0] *= 0.5
    return transform


@lru_cache(maxsize=64)
def _box_series(exponent: float, dim: int) -> np.ndarray:
    count = _DEGREES[dim] + 1
    angle = (np.arange(count) + 0.5) * (np.pi / count)
    nodes = np.sqrt(0.125 * (np.cos(angle) + 1.0))
    # S is the same in any order of the axes: it is summed once for each.
    index = np.sort(np.indices((count,) * dim).reshape(dim, -1), axis=0)
    distinct, place = np.unique(index, axis=1, return_inverse=True)
    values = image_sum(nodes[distinct.T], exponent)[place].reshape((count,) * dim)
    for _ in range(dim):
        values = np.tensordot(values, _to_series(count), axes=(0, 1))
    return values
