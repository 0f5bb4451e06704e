"""Kummer's confluent hypergeometric function of a negative argument.

All smoothing kernels of the fractional operators are values of

    1F1(a; b; -z) = exp(-z) 1F1(b - a; b; z),        z = |r|^2 >= 0,

(Kummer's transformation, DLMF 13.2.39). With c = b - a > -1 the series on the right has terms of
one sign after the first, so that it sums without cancellation. Far out (DLMF 13.7.2)

    1F1(a; b; -z) ~ Gamma(b) / Gamma(b - a) z^-a sum_k (a)_k (a - b + 1)_k / (k! z^k).

The near series is tabulated once for each pair of parameters, as piecewise polynomials.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import gamma, poch, rgamma

from fracparticles._compiled import njit
from fracparticles.arguments import elementwise, finite_real, real_array
from fracparticles.errors import InvalidInput
from fracparticles.special import chebyshev

__all__ = ["WIDTH", "kummer", "kummer_order_four", "kummer_transformed", "poisson_weights"]

_FAR = 64.0  # z from which the asymptotic series falls to 1e-17 before it diverges, in at most 40 terms
WIDTH = 2.0  # of a piece of the table, in z
_PIECES = int(_FAR / WIDTH)
_TERMS = 40  # of the asymptotic series
_WEIGHTS = 260  # terms k of the near series: p_k(80) < 1e-50 for greater k


class _Table(NamedTuple):
    """1F1(a; b; -z) for one pair (a, b): near coefficients, far prefactor, power and series."""

    near: NDArray[np.float64]
    prefactor: float
    a: float
    far: NDArray[np.float64]
    far_order_four: NDArray[np.float64]


@lru_cache(maxsize=2)
def poisson_weights(pieces: int) -> NDArray[np.float64]:
    """p_k(z) = e^-z z^k / k! at the points of `chebyshev.sample_points(WIDTH, pieces)`, shape (k, points)."""
    z = chebyshev.sample_points(WIDTH, pieces).reshape(-1)
    p = np.empty((_WEIGHTS, z.size))
    p[0] = 1.0
    for k in range(1, _WEIGHTS):  # whole rows, one after the other: faster than cumprod along them
        np.multiply(p[k - 1], z / k, out=p[k])
    p *= np.exp(-z)
    return p


@njit(inline="always")
def _far(z: float, table: _Table, series: NDArray[np.float64]) -> float:
    power = 1.0
    total = series[0]
    for k in range(1, _TERMS):
        power /= z
        term = series[k] * power
        total += term
        if k > 1 and abs(term) < 1e-17:  # of order four, the term k = 1 is zero
            break
    return table.prefactor * z**-table.a * total


@njit(inline="always")
def _value(z: float, table: _Table) -> float:
    if z < _FAR:
        return chebyshev.horner(z / WIDTH, table.near)
    return _far(z, table, table.far)


@njit()
def _evaluate(z: NDArray[np.float64], table: _Table, out: NDArray[np.float64]) -> None:
    for i in range(z.size):
        out[i] = _value(z[i], table)


@njit()
def _evaluate_order_four(z: NDArray[np.float64], table: _Table, out: NDArray[np.float64]) -> None:
    weight = 2.0**-table.a
    for i in range(z.size):
        if z[i] < 2.0 * _FAR:
            out[i] = 2.0 * _value(z[i], table) - weight * _value(0.5 * z[i], table)
        else:
            # The powers are the same, 2^-a (z/2)^-a = z^-a: one series does for both.
            out[i] = _far(z[i], table, table.far_order_four)


@lru_cache(maxsize=512)
def _table(c: float, b: float) -> _Table:
    a = b - c
    # exp(-z) sum_k (c)_k / (b)_k z^k / k!
    k = np.arange(_WEIGHTS - 1)
    samples = np.append(1.0, np.cumprod((c + k) / (b + k))) @ poisson_weights(_PIECES)
    k = np.arange(_TERMS)
    # 1 / Gamma(c) by two steps of the recurrence: keeps its digits where c is close to 0 or -1.
    reciprocal_gamma = c * (c + 1.0) * rgamma(c + 2.0)
    far = poch(a, k) * poch(1.0 - c, k) / gamma(k + 1.0)
    return _Table(
        near=chebyshev.fit(samples.reshape(_PIECES, -1)),
        prefactor=float(gamma(b) * reciprocal_gamma),
        a=a,
        far=far,
        far_order_four=(2.0 - 2.0**k) * far,
    )


def _checked(c: float, b: float, z: Any) -> tuple[_Table, NDArray[np.float64]]:
    c, b = finite_real("b - a", c), finite_real("b", b)
    if not (-1.0 < c < b <= 4.0 and b - c <= 4.0 and c != 0.0):
        allowed = "-1 < b - a < b <= 4, b - a not 0, and a <= 4"
        remedy = "The kernels of the fractional operators lie inside this range."
        raise InvalidInput("(b - a, b)", (c, b), allowed, remedy)
    z = real_array("z", z)
    if (z < 0.0).any():
        raise InvalidInput("z", float(z.min()), "z >= 0", "Give the squared distance.")
    return _table(c, b), z


def kummer(a: float, b: float, z: Any) -> NDArray[np.float64] | float:
    """Return 1F1(a; b; -z) for z >= 0, 0 < a <= 4, 0 < b <= 4, b - a > -1 and b not a.

    z, accuracy and errors as for `kummer_transformed`.
    """
    return kummer_transformed(b - a, b, z)


def kummer_transformed(c: float, b: float, z: Any) -> NDArray[np.float64] | float:
    """Return exp(-z) 1F1(c; b; z) = 1F1(b - c; b; -z) for z >= 0.

    The same function as `kummer` with c = b - a given instead of a: near c = 0 or c = -1 the
    difference b - a would lose digits that the far field, proportional to c (c + 1), needs.

    Raises `InvalidInput` if a parameter is outside its range, or z is negative, nan or not numeric.

    Parameters
    ----------
    c, b : float
        -1 < c < b <= 4, c not 0, and a = b - c <= 4.
    z : array_like
        Non-negative arguments, any shape.

    Returns
    -------
    ndarray or float
        Same shape as z; relative accuracy 1e-13, for c < 0 relative to the larger of the two
        parts exp(-z) and value - exp(-z), which cancel at the one zero.
    """
    table, z = _checked(c, b, z)
    return elementwise(_evaluate, z, table)


def kummer_order_four(c: float, b: float, z: Any) -> NDArray[np.float64] | float:
    """Return 2 M(z) - 2^-a M(z/2), M(z) = 1F1(a; b; -z), a = b - c: the order-IV rule (B.18).

    (B.18) of Lucchesi et al. (2020) prints z/sqrt(2); (12), (15) and (21) have z/2. Parameters and errors as of
    `kummer_transformed`; relative accuracy 1e-13, next to a zero relative to the two terms.
    """
    table, z = _checked(c, b, z)
    return elementwise(_evaluate_order_four, z, table)
