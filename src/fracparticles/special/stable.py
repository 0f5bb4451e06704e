"""The symmetric stable density: fundamental solution of the one-dimensional problem (3).

    L_alpha^0(x) = (1/2 pi) int exp(i k x - |k|^alpha) dk,        1 < alpha < 2,

is the reduced Green function of Appendix A of Lucchesi et al. (2020). It is evaluated from

- |x| < 1/2: the series (A.1);
- 1/2 < |x| < far(alpha): quadrature along a contour, see `fracparticles.special.contour`;
- far(alpha) < |x|: the asymptotic series (A.2), which reaches 1e-17 there.

The first two are tabulated once for each alpha, as polynomials on pieces of width 1/2; far(alpha)
lies between 4 and 20. The mass inside or outside [-x, x] comes from the same three, integrated
term by term.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.special import gamma, gammaln, xlogy

from fracparticles.errors import InvalidInput
from fracparticles.special import chebyshev
from fracparticles.special.arguments import (
    elementwise,
    fractional_order,
    positive_integer,
    positive_real,
    real_array,
)
from fracparticles.special.contour import density_and_tail

__all__ = [
    "central_mass",
    "green",
    "green_asymptotic",
    "green_series",
    "mean_radius",
    "reduced_green",
    "tail_mass",
]

FloatArray = NDArray[np.float64]

_WIDTH = 0.5  # of a piece; the series (A.1) serves the first one
_SERIES_TERMS = 30  # x^(2m) alone has fallen to 1e-18 at x = 1/2
_FAR_TERMS = 30
_NEGLIGIBLE = 1e-17


class _Table(NamedTuple):
    """Coefficients for one alpha; mass is inside [-x, x] / x on the first piece, then outside."""

    density: FloatArray
    mass: FloatArray
    far_density: FloatArray
    far_mass: FloatArray
    far_bound: FloatArray
    alpha: float


# --- partial sums of Appendix A -------------------------------------------------------------------


def _tail_sine(alpha: float, m: FloatArray) -> FloatArray:
    """(-1)^(m+1) sin(pi alpha m/2), written with 2 - alpha to keep its digits near alpha = 2."""
    return np.sin(0.5 * math.pi * (2.0 - alpha) * m)


def _sum_of_exponentials(logarithms: FloatArray, factors: FloatArray) -> FloatArray | float:
    """Sum factors * exp(logarithms) over the last axis: may overflow to +-inf, never to nan."""
    largest = logarithms.max(axis=-1)
    scaled = (factors * np.exp(logarithms - largest[..., None])).sum(axis=-1)
    with np.errstate(over="ignore"):
        total = np.where(scaled == 0.0, 0.0, scaled * np.exp(np.minimum(largest, 1e3)))
    return float(total) if total.ndim == 0 else total


def _checked(x: Any, alpha: Any, terms: Any) -> tuple[FloatArray, float, FloatArray]:
    size = np.abs(real_array("x", x))
    if np.isinf(size).any():
        raise InvalidInput("x", x, "finite numbers", "Remove the infinite entries.")
    count = positive_integer("terms", terms)
    return size[..., None], fractional_order(alpha), np.arange(1.0, count + 1.0)


def green_series(x: Any, alpha: float, terms: int) -> FloatArray | float:
    """Return a partial sum of (A.1), the convergent series, as Figs A.10-A.12 show it.

    L_alpha^0(x) = (1/pi) sum_{j=1}^{terms} (-1)^(j-1) Gamma(1 + m/alpha) x^(m-1) / m!,  m = 2j - 1

    (the terms of even m are zero and not counted). Far from 0 a partial sum loses all digits; it
    overflows to +-inf, never to nan.

    Raises
    ------
    InvalidInput
        If x is not finite and numeric, alpha outside (1, 2), or `terms` not a positive integer.
    """
    size, alpha, j = _checked(x, alpha, terms)
    m = 2.0 * j - 1.0
    logarithms = gammaln(1.0 + m / alpha) - gammaln(m + 1.0) + xlogy(m - 1.0, size)
    return _sum_of_exponentials(logarithms, (-1.0) ** (j - 1.0) / math.pi)


def green_asymptotic(x: Any, alpha: float, terms: int) -> FloatArray | float:
    """Return a partial sum of (A.2), the asymptotic series, as Figs A.10-A.12 show it.

    L_alpha^0(x) ~ (1/pi) sum_{m=1}^{terms} (-1)^(m+1) Gamma(1 + alpha m) / m!
    sin(pi alpha m/2) |x|^(-alpha m - 1)

    Close to 0 it overflows to +-inf, never to nan.

    Raises
    ------
    InvalidInput
        If x is not finite and numeric, alpha outside (1, 2), or `terms` not a positive integer.
    """
    size, alpha, m = _checked(x, alpha, terms)
    log_size = np.log(np.maximum(size, np.finfo(float).tiny))
    logarithms = gammaln(1.0 + alpha * m) - gammaln(m + 1.0) - (alpha * m + 1.0) * log_size
    return _sum_of_exponentials(logarithms, _tail_sine(alpha, m) / math.pi)


# --- one table for each alpha ---------------------------------------------------------------------


def _far_terms(alpha: float) -> tuple[FloatArray, FloatArray]:
    """Coefficients of |x|^(-alpha m - 1) in (A.2), and bounds of them relative to the first."""
    m = np.arange(1.0, _FAR_TERMS + 1.0)
    growth = gamma(1.0 + alpha * m) / gamma(m + 1.0)
    sine = _tail_sine(alpha, m)
    # Where the sine of one m happens to vanish, that says nothing of the terms that follow.
    bound = growth * np.minimum(1.0, 0.5 * math.pi * (2.0 - alpha) * m) / (growth[0] * sine[0])
    return growth * sine / math.pi, bound


def _pieces_before_far(alpha: float, first: float, bound: FloatArray) -> int:
    """Count the pieces up to the point where (A.2) is exact to 1e-17.

    There its last term is below 1e-17 of its first, and so is what (A.2) lacks at any number of
    terms: the contribution of the saddle point of exp(i k x - k^alpha), for alpha near 2 the
    Gaussian exp(-x^2/4).
    """
    pieces = 2
    power = alpha / (alpha - 1.0)
    turn = 0.5 * math.pi / (alpha - 1.0)
    while True:
        x = pieces * _WIDTH
        last = bound[-1] * x ** (-alpha * (_FAR_TERMS - 1))
        saddle = 0.0  # out of reach where alpha < 3/2
        if turn < math.pi:
            saddle = math.exp(-(alpha - 1.0) * (x / alpha) ** power * math.sin(turn))
        if last < _NEGLIGIBLE and saddle < _NEGLIGIBLE * first * x ** (-alpha - 1.0):
            return pieces
        pieces += 1


def _near_terms(alpha: float, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(A.1), and its integral over [-x, x] divided by x."""
    m = 2.0 * np.arange(_SERIES_TERMS) + 1.0
    signs = (-1.0) ** np.arange(_SERIES_TERMS)
    terms = signs * gamma(1.0 + m / alpha) / gamma(m + 1.0) / math.pi * x[..., None] ** (m - 1.0)
    # Small terms first: the sum keeps its last digits.
    return terms[..., ::-1].sum(axis=-1), (2.0 * terms / m)[..., ::-1].sum(axis=-1)


@lru_cache(maxsize=256)
def _table(alpha: float) -> _Table:
    far_density, far_bound = _far_terms(alpha)
    m = np.arange(1.0, _FAR_TERMS + 1.0)
    x = chebyshev.sample_points(_WIDTH, _pieces_before_far(alpha, float(far_density[0]), far_bound))
    density, mass = np.empty_like(x), np.empty_like(x)
    density[0], mass[0] = _near_terms(alpha, x[0])
    density[1:], mass[1:] = density_and_tail(x[1:], alpha)
    return _Table(
        density=chebyshev.fit(density),
        mass=chebyshev.fit(mass),
        far_density=far_density,
        far_mass=2.0 * far_density / (alpha * m),
        far_bound=far_bound,
        alpha=alpha,
    )


@numba.njit(cache=True, nogil=True, inline="always")
def _far_sum(power: float, coefficients: FloatArray, bound: FloatArray) -> float:
    """sum_m coefficients[m] power^m, power = |x|^-alpha, until the terms no longer count."""
    total = coefficients[0]
    factor = 1.0
    for m in range(1, coefficients.size):
        factor *= power
        total += coefficients[m] * factor
        if bound[m] * factor < _NEGLIGIBLE:
            break
    return power * total


@numba.njit(cache=True, nogil=True)
def _density(x: FloatArray, table: _Table, out: FloatArray) -> None:
    pieces = table.density.shape[0]
    for i in range(x.size):
        size = abs(x[i])
        if size < pieces * _WIDTH:
            out[i] = chebyshev.horner(size / _WIDTH, table.density)
        else:
            power = size**-table.alpha
            out[i] = _far_sum(power, table.far_density, table.far_bound) / size


@numba.njit(cache=True, nogil=True)
def _mass(x: FloatArray, table: _Table, inside: bool, out: FloatArray) -> None:
    pieces = table.mass.shape[0]
    for i in range(x.size):
        if x[i] < _WIDTH:
            value = x[i] * chebyshev.horner(x[i] / _WIDTH, table.mass)
            out[i] = value if inside else 1.0 - value
        else:
            if x[i] < pieces * _WIDTH:
                value = chebyshev.horner(x[i] / _WIDTH, table.mass)
            else:
                value = _far_sum(x[i] ** -table.alpha, table.far_mass, table.far_bound)
            out[i] = 1.0 - value if inside else value


# --- public ---------------------------------------------------------------------------------------


def reduced_green(x: Any, alpha: float) -> FloatArray | float:
    """Return the reduced Green function L_alpha^0(x) of (36), (A.1), (A.2).

    Parameters
    ----------
    x : array_like
        Any shape; infinities give 0.
    alpha : float
        Fractional order, 1 < alpha < 2.

    Returns
    -------
    ndarray or float
        Same shape as x; relative accuracy better than 1e-13 for every x and alpha. The first call
        for an alpha takes a few milliseconds more.

    Raises
    ------
    InvalidInput
        If x is nan or not numeric, or alpha outside (1, 2).
    """
    x, alpha = real_array("x", x), fractional_order(alpha)
    return elementwise(_density, x, _table(alpha))


def green(x: Any, t: float, alpha: float, dim: int = 1) -> FloatArray | float:
    """Return the fundamental solution G(x, t) = t^(-1/alpha) L_alpha^0(x t^(-1/alpha))  (36).

    Parameters
    ----------
    x : array_like
        Positions, any shape.
    t : float
        Time, t > 0.
    alpha : float
        Fractional order, 1 < alpha < 2.
    dim : int
        Number of dimensions: 1.

    Returns
    -------
    ndarray or float
        Same shape as x; accuracy as of `reduced_green`.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """
    if dim != 1:
        raise InvalidInput("dim", dim, "1", "Use the one-dimensional fundamental solution.")
    scale = _scale(t, alpha)
    return scale * reduced_green(_scaled(x, scale), alpha)


def mean_radius(alpha: float) -> float:
    """Return R_alpha = int |x| L_alpha^0(x) dx = (2/pi) Gamma(1 - 1/alpha)  (A.3), in closed form.

    Raises
    ------
    InvalidInput
        If alpha is outside (1, 2).
    """
    alpha = fractional_order(alpha)
    return float(2.0 / math.pi * gamma((alpha - 1.0) / alpha))


def _scale(t: Any, alpha: Any) -> float:
    return positive_real("t", t) ** (-1.0 / fractional_order(alpha))


def _scaled(x: Any, scale: float) -> FloatArray:
    """Return x t^(-1/alpha); what overflows is in the far field, where the functions vanish."""
    with np.errstate(over="ignore"):
        return real_array("x", x) * scale


def _mass_of(x: Any, t: Any, alpha: Any, inside: bool) -> FloatArray | float:
    x = _scaled(x, _scale(t, alpha))
    if (x < 0.0).any():
        raise InvalidInput("x", float(x.min()), "x >= 0", "Give the half-width of the interval.")
    return elementwise(_mass, x, _table(float(alpha)), inside)


def central_mass(x: Any, t: float, alpha: float) -> FloatArray | float:
    """Return the integral of G(y, t) over -x < y < x.

    Parameters
    ----------
    x : array_like
        Half-widths x >= 0, any shape.
    t : float
        Time, t > 0.
    alpha : float
        Fractional order, 1 < alpha < 2.

    Returns
    -------
    ndarray or float
        Same shape as x; relative accuracy better than 1e-13.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """
    return _mass_of(x, t, alpha, True)


def tail_mass(x: Any, t: float, alpha: float) -> FloatArray | float:
    """Return the integral of G(y, t) over |y| > x: 1 - `central_mass`, without its cancellation.

    Parameters
    ----------
    x : array_like
        Half-widths x >= 0, any shape.
    t : float
        Time, t > 0.
    alpha : float
        Fractional order, 1 < alpha < 2.

    Returns
    -------
    ndarray or float
        Same shape as x; relative accuracy better than 1e-13.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """
    return _mass_of(x, t, alpha, False)
