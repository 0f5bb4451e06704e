"""The fundamental solution in the plane, Eq. (58), computed in three other ways, and the mass outside a square.

`stable` evaluates the solution for every dimension. The first three functions here do not depend on it.
"""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import gammaln, j0, roots_legendre, xlogy

from fracparticles.arguments import FloatArray
from fracparticles.special.quadrature import gauss_legendre
from fracparticles.special.stable import tail_mass
from fracparticles.special.tails import plane_constant

__all__ = [
    "planar_asymptotic",
    "planar_integral",
    "planar_series",
    "square_exchange_error",
    "square_tail_mass",
]

_NODES = 800  # of the quadrature: 4 for each period of J_0(r omega) at r = 100
_LAST_EXPONENT = 45.0  # the largest omega^alpha: exp(-45) is 3e-20
_OCTANT_NODES = 32  # of the integrals over the angle, whose integrands are smooth


def planar_integral(r: ArrayLike, alpha: float) -> FloatArray:
    """Return (1/2 pi) int_0^inf omega exp(-omega^alpha) J_0(r omega) domega, (58).

    The Gauss-Legendre rule in s, omega = s^2, since this makes the integrand smooth at 0; exact to round-off for
    r <= 100. The result has the shape of r.
    """
    # For so many nodes scipy's rule is quicker than one from the eigenvalues of a matrix.
    x, weight = roots_legendre(_NODES)
    last = _LAST_EXPONENT ** (0.5 / alpha)
    s, weight = 0.5 * last * (1.0 + x), 0.5 * last * weight
    omega = s * s
    factor = weight * 2.0 * s * omega * np.exp(-(omega**alpha)) / (2.0 * pi)
    return np.asarray(j0(np.multiply.outer(np.asarray(r, dtype=float), omega)) @ factor)


def planar_series(r: ArrayLike, alpha: float, terms: int) -> FloatArray:
    """Return a partial sum of Phi = (1 / 2 pi alpha) sum_{k>=0} (-1)^k Gamma((2k + 2) / alpha) / (k!)^2 (r/2)^(2k)."""
    k = np.arange(float(terms))
    logarithm = gammaln((2.0 * k + 2.0) / alpha) - 2.0 * gammaln(k + 1.0)
    powers = xlogy(2.0 * k, 0.5 * np.asarray(r, dtype=float)[..., None])
    return ((-1.0) ** k * np.exp(logarithm + powers)).sum(axis=-1) / (2.0 * pi * alpha)


def planar_asymptotic(r: ArrayLike, alpha: float, terms: int) -> FloatArray:
    """Return a partial sum of the far series.

    Phi ~ (1/pi^2) sum_{k>=1} (-1)^(k+1) / k! 2^(alpha k) Gamma(1 + alpha k / 2)^2 sin(pi alpha k / 2) r^(-alpha k - 2)
    """
    k = np.arange(1.0, terms + 1.0)
    size = np.exp(alpha * k * np.log(2.0) + 2.0 * gammaln(1.0 + 0.5 * alpha * k) - gammaln(k + 1.0))
    # (-1)^(k+1) sin(pi alpha k/2), written with 2 - alpha to keep its digits.
    factor = size * np.sin(0.5 * pi * (2.0 - alpha) * k) / pi**2
    return (factor * np.asarray(r, dtype=float)[..., None] ** (-alpha * k - 2.0)).sum(axis=-1)


def square_tail_mass(half_width: float, t: float, alpha: float) -> float:
    """Return the mass of G(., t) outside the square |x|, |y| <= D.

    It is (4 / pi) int_0^(pi/4) T(D / cos phi) dphi, with T(r) the mass outside the disk of radius r.
    """
    phi, weight = gauss_legendre(_OCTANT_NODES, 0.0, 0.25 * pi)
    return float(4.0 / pi * weight @ tail_mass(half_width / np.cos(phi), t, alpha, 2))


def square_exchange_error(half_width: float, alpha: float, time: float) -> float:
    """Return the relative error that truncation to |x|, |y| <= D causes in KPSE and GPSE.

    It is time int c |y|^(-2-alpha) dy over the outside of the square, with c of (4) for n = 2, `plane_constant`. This
    is the strength that each particle near the origin keeps instead of giving it to places without particles. For n = 1
    see `tails.exchange_truncation_error`. `time` is the time of the run times the diffusivity.
    """
    c = plane_constant(alpha)
    phi, weight = gauss_legendre(_OCTANT_NODES, 0.0, 0.25 * pi)
    return float(time * 8.0 * c / alpha * (weight @ np.cos(phi) ** alpha) * half_width**-alpha)
