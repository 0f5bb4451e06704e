"""The fundamental solution of (3) in one, two and three dimensions, and what follows from it.

    G(x, t) = t^(-n/alpha) Phi_{n,alpha}(|x| t^(-1/alpha)),        1 < alpha < 2,

This is (36) for n = 1, where Phi_1 = L_alpha^0 is the symmetric stable density of Appendix A of Lucchesi et
al. (2020), and (57), (58) for n = 2. `fracparticles.special.radial` evaluates Phi_n; here are the
functions of x and t, and the partial sums (A.1), (A.2) that the paper's figures show.

Where |x| t^(-1/alpha) > 1e20 only the first term of (A.2) counts, G = c t |x|^(-n-alpha). It is evaluated directly,
since Phi_n may vanish in float64 there although G does not.

All functions except the masses take signed positions: G and its rate are even functions of x, its slope and its
flux are odd. For n > 1, x is the radius, or a position on an axis.

A function of x returns the shape of x, and a float for a single number. `InvalidInput` names the argument that is
outside its range, or says that t is so short that the result would overflow a float64.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.special import gamma, gammaln, xlogy

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.errors import InvalidInput
from fracparticles.special import radial
from fracparticles.special.radial import radial_table, tail_sine

__all__ = [
    "central_mass",
    "green",
    "green_asymptotic",
    "green_flux",
    "green_rate",
    "green_series",
    "green_slope",
    "mean_radius",
    "reduced_green",
    "tail_mass",
]


_MOST_TERMS = 10_000  # of a partial sum
_FAR = 1e20  # r from which the second term of (A.2) is below 1e-20 of the first


# --- partial sums of Appendix A -------------------------------------------------------------------


def _sum_of_exponentials(logarithms: FloatArray, factors: FloatArray) -> FloatArray | float:
    """Sum factors * exp(logarithms) over the last axis: may overflow to +-inf, never to nan."""
    largest = logarithms.max(axis=-1)
    scaled = (factors * np.exp(logarithms - largest[..., None])).sum(axis=-1)
    with np.errstate(over="ignore"):
        total = np.where(scaled == 0.0, 0.0, scaled * np.exp(np.minimum(largest, 1e3)))
    return float(total) if total.ndim == 0 else total


def _checked(x: Any, alpha: Any, terms: Any) -> tuple[FloatArray, float, FloatArray]:
    size = np.abs(check.real_array("x", x))
    if np.isinf(size).any():
        raise InvalidInput("x", x, "finite numbers", "Remove the infinite entries.")
    count = check.positive_integer("terms", terms, _MOST_TERMS)
    return size[..., None], check.fractional_order(alpha), np.arange(1.0, count + 1.0)


def green_series(x: Any, alpha: float, terms: int) -> FloatArray | float:
    """Return a partial sum of (A.1), the convergent series, as Figs A.10-A.12 show it.

    L_alpha^0(x) = (1/pi) sum_{j=1}^{terms} (-1)^(j-1) Gamma(1 + m/alpha) x^(m-1) / m!,  m = 2j - 1

    (the terms of even m are zero and not counted). Far from 0 a partial sum loses all digits; it
    overflows to +-inf, never to nan.

    Raises `InvalidInput` if x is not finite and numeric, alpha outside (1, 2), or `terms` no whole number, or above
    10 000.
    """
    size, alpha, j = _checked(x, alpha, terms)
    m = 2.0 * j - 1.0
    logarithms = gammaln(1.0 + m / alpha) - gammaln(m + 1.0) + xlogy(m - 1.0, size)
    return _sum_of_exponentials(logarithms, (-1.0) ** (j - 1.0) / math.pi)


def green_asymptotic(x: Any, alpha: float, terms: int) -> FloatArray | float:
    """Return a partial sum of (A.2), the asymptotic series, as Figs A.10-A.12 show it.

    L_alpha^0(x) ~ (1/pi) sum_{m=1}^{terms} (-1)^(m+1) Gamma(1 + alpha m) / m!
    sin(pi alpha m/2) |x|^(-alpha m - 1)

    Close to 0 it overflows to +-inf, never to nan. Errors as for `green_series`.
    """
    size, alpha, m = _checked(x, alpha, terms)
    log_size = np.log(np.maximum(size, np.finfo(float).tiny))
    logarithms = gammaln(1.0 + alpha * m) - gammaln(m + 1.0) - (alpha * m + 1.0) * log_size
    return _sum_of_exponentials(logarithms, tail_sine(alpha, m) / math.pi)


# --- the fundamental solution ---------------------------------------------------------------------


def _reduced(x: FloatArray, alpha: float, n: int) -> FloatArray | float:
    return check.elementwise(radial.density, x, radial_table(alpha, n))


def _similarity(t: Any, alpha: Any) -> float:
    """Return t^(-1/alpha)."""
    t, power = check.positive_real("t", t), -1.0 / check.fractional_order(alpha)
    try:
        return t**power
    except OverflowError:
        raise _too_short(t) from None


def _too_short(t: float) -> InvalidInput:
    allowed = "a time at which the solution is below 1e308"
    return InvalidInput("t", t, allowed, "Take another unit of time or length.")


def _finite(t: float, value: FloatArray | float) -> FloatArray | float:
    """Return the value; the solution is never infinite, but may be too large for a float64."""
    if not np.isfinite(value).all():
        raise _too_short(t)
    return value


def _scaled(x: Any, scale: float) -> FloatArray:
    """Return x t^(-1/alpha); it may be infinite in the far field, where the functions vanish."""
    with np.errstate(over="ignore"):
        return check.real_array("x", x) * scale


def _product(x: FloatArray, value: FloatArray | float) -> FloatArray:
    """Return x value, zero where the value has vanished although x may be infinite."""
    return np.multiply(x, value, out=np.zeros(np.shape(x)), where=np.not_equal(value, 0.0))


def _or_tail(
    value: FloatArray | float, x: FloatArray, scale: float, alpha: float, factor: Any, n: int
) -> FloatArray | float:
    """Return the value, or factor |x|^(-n-alpha) where |x| scale is in the far field."""
    size = np.abs(x)
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        far = size * scale > _FAR
        if not far.any():
            return value
        tail, root = factor, size ** (-0.5 * alpha)
        for one in (root, root, *n * [1.0 / size]):  # one by one: their product alone may underflow
            tail = tail * one
    return np.where(far, tail, value)


def _first_term(alpha: float, n: int) -> float:
    """Return c of Phi_n ~ c r^(-n-alpha)."""
    return float(radial_table(float(alpha), n).far_density[0])


def _times_power(scale: float, n: int, value: FloatArray | float) -> FloatArray | float:
    """Return scale^n value, although scale^n alone may overflow; infinite where the product overflows."""
    with np.errstate(over="ignore"):
        for _ in range(n):
            value = scale * np.asarray(value)
    return value


def reduced_green(x: Any, alpha: float, dim: int = 1) -> FloatArray | float:
    """Return the reduced Green function Phi_{n,alpha}(|x|): L_alpha^0 of (36) for n = 1, or (58).

    Phi_{n,alpha}(r) = (2 pi)^-n int exp(i k.x - |k|^alpha) dk

    Parameters and errors as for `green`; it is 0 at infinite x. Relative accuracy better than 1e-13 for every x and
    alpha. The first call for each alpha takes a few milliseconds longer.
    """
    return _reduced(check.real_array("x", x), check.fractional_order(alpha), check.dimension(dim))


def green(x: Any, t: float, alpha: float, dim: int = 1) -> FloatArray | float:
    """Return the fundamental solution G(x, t) = t^(-n/alpha) Phi_{n,alpha}(|x| t^(-1/alpha)).

    (36) for n = 1, (57) for n = 2.

    Parameters
    ----------
    x : array_like
        Positions (n = 1) or radii, any shape.
    t : float
        Time, t > 0.
    alpha : float
        Fractional order, 1 < alpha < 2.
    dim : int
        Number of dimensions n, 1 to 3.

    Returns
    -------
    ndarray or float
        Same shape as x; accuracy as for `reduced_green`.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """
    scale, n = _similarity(t, alpha), check.dimension(dim)
    x = check.real_array("x", x)
    value = _times_power(scale, n, reduced_green(_scaled(x, scale), alpha, n))
    value = _or_tail(value, x, scale, alpha, float(t) * _first_term(alpha, n), n)
    return check.like(x, _finite(t, value))


def green_slope(x: Any, t: float, alpha: float, dim: int = 1) -> FloatArray | float:
    """Return the radial derivative dG/dr, from Phi_n'(r) = -2 pi r Phi_{n+2}(r).

    Parameters and errors as for `green`; an odd function of x, of relative accuracy better than 1e-12.
    """
    scale, n = _similarity(t, alpha), check.dimension(dim)
    x, r = check.real_array("x", x), _scaled(x, scale)
    slope = -2.0 * math.pi * _product(r, _reduced(r, float(alpha), n + 2))
    factor = -2.0 * math.pi * _first_term(alpha, n + 2) * np.sign(x) * float(t)
    value = _or_tail(_times_power(scale, n + 1, slope), x, scale, alpha, factor, n + 1)
    return check.like(x, _finite(t, value))


def green_flux(x: Any, t: float, alpha: float, dim: int = 1) -> FloatArray | float:
    """Return the radial component of the fractional flux (2) of the fundamental solution.

    Q = -grad^beta G = (r G / (alpha t)) e_r: by self-similarity this is the flux that is regular at 0 and
    has the divergence -dG/dt. Parameters, errors and accuracy as for `green`; an odd function of x.
    """
    value = green(x, t, alpha, dim)
    x = check.real_array("x", x)
    with np.errstate(over="ignore"):
        # alpha and t as Python floats: a float32 would round the flux to its digits.
        flux = _product(x, value) / (float(alpha) * float(t))
    factor = np.sign(x) / float(alpha) * _first_term(alpha, dim)
    value = _or_tail(flux, x, _similarity(t, alpha), alpha, factor, dim - 1)
    return check.like(x, _finite(t, value))


def green_rate(x: Any, t: float, alpha: float, dim: int = 1) -> FloatArray | float:
    """Return the diffusion rate (4) of the fundamental solution.

    Delta^alpha G = dG/dt = -(n G + r dG/dr) / (alpha t)

    Parameters and errors as for `green`; relative accuracy better than 1e-12. Next to the only zero of the rate, it is
    relative to n G / (alpha t).
    """
    scale, n = _similarity(t, alpha), check.dimension(dim)
    x, r = check.real_array("x", x), _scaled(x, scale)
    growth = 2.0 * math.pi * _product(r, _product(r, _reduced(r, float(alpha), n + 2)))
    with np.errstate(over="ignore"):
        rate = (growth - n * _reduced(r, float(alpha), n)) / (float(alpha) * float(t))
    value = _times_power(scale, n, rate)
    return check.like(x, _finite(t, _or_tail(value, x, scale, alpha, _first_term(alpha, n), n)))


def mean_radius(alpha: float) -> float:
    """Return R_alpha = int |x| L_alpha^0(x) dx = (2/pi) Gamma(1 - 1/alpha)  (A.3), 1 < alpha < 2, in closed form."""
    alpha = check.fractional_order(alpha)
    return float(2.0 / math.pi * gamma((alpha - 1.0) / alpha))


def _mass_of(x: Any, t: Any, alpha: Any, dim: Any, inside: bool) -> FloatArray | float:
    r = _scaled(x, _similarity(t, alpha))
    if (r < 0.0).any():
        raise InvalidInput("x", float(r.min()), "x >= 0", "Give the radius (half-width for n = 1).")
    return check.elementwise(
        radial.mass, r, radial_table(float(alpha), check.dimension(dim)), inside
    )


def central_mass(x: Any, t: float, alpha: float, dim: int = 1) -> FloatArray | float:
    """Return the integral of G(y, t) over the ball |y| < x, for radii x >= 0 (half-widths for n = 1).

    Parameters and errors as for `green`; relative accuracy better than 1e-13.
    """
    return _mass_of(x, t, alpha, dim, True)


def tail_mass(x: Any, t: float, alpha: float, dim: int = 1) -> FloatArray | float:
    """Return the integral of G(y, t) over |y| > x: 1 - `central_mass`, without its cancellation.

    Parameters, errors and accuracy as for `central_mass`.
    """
    return _mass_of(x, t, alpha, dim, False)
