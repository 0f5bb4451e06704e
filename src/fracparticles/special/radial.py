"""The reduced Green function in n dimensions, from tables that are made once for each alpha.

    Phi_{n,alpha}(r) = (2 pi)^-n int exp(i k.x - |k|^alpha) dk,    r = |x|,    1 < alpha < 2;

Phi_1 = L_alpha^0 of (36), Phi_2 is (58) of Lucchesi et al. (2020). It is evaluated from

- r < 1/2: the series in r^2, `_near_terms`, which is (A.1) for n = 1;
- 1/2 < r < far(alpha, n): for odd n quadrature along a contour, `fracparticles.special.contour`;
  for even n the marginal of n + 1 dimensions, `_project`;
- far(alpha, n) < r: the asymptotic series `_far_terms`, (A.2) for n = 1, which reaches 1e-17 there.

The first two are tabulated as polynomials on pieces of width 1/2; far(alpha, n) lies between 4 and
25. The masses inside and outside the ball of radius r come from the same three. Each of them is a sum of parts that
do not cancel, so no digits are lost in the core or in the tail.

n runs from 1 to 5: the slope in n <= 3 dimensions, Phi_n' = -2 pi r Phi_{n+2}, needs 4 and 5.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.special import gamma

from fracparticles._compiled import njit
from fracparticles.arguments import FloatArray, elementwise
from fracparticles.special import chebyshev
from fracparticles.special.contour import density_and_tail
from fracparticles.special.quadrature import gauss_legendre

__all__ = ["RadialTable", "density", "mass", "radial_table", "tail_sine"]

_WIDTH = 0.5  # of a piece, in r; the series in r^2 serves the first piece
_SERIES_TERMS = 28  # of it, and 2 n more: r^(2k) k^((n-1)/2) has fallen to 1e-18 at r = 1/2
_FAR_TERMS = 30  # of the asymptotic series
_NEGLIGIBLE = 1e-17  # share of a sum below which a term no longer counts
_MOSTLY_OUTSIDE = 0.75  # share of the mass outside above which the mass inside is tabulated
_STEP = 0.125  # of the trapezoidal rule in `_project`, in v
_BLOCK = 16  # nodes of this rule that are added at a time
# Surface S_n of the unit sphere in n dimensions.
_SURFACE = (math.nan, 2.0, 2.0 * math.pi, 4.0 * math.pi, 2.0 * math.pi**2, 8.0 / 3.0 * math.pi**2)
_NODES, _WEIGHTS = gauss_legendre(24)  # of the mass inside


class RadialTable(NamedTuple):
    """Coefficients for one alpha and n.

    `mass` holds the mass inside the ball, divided by r^n, on the first `inside_pieces` pieces. On the other pieces it
    holds the mass outside the ball.
    """

    density: FloatArray
    mass: FloatArray
    far_density: FloatArray
    far_mass: FloatArray
    far_bound: FloatArray
    alpha: float
    n: int
    inside_pieces: int


# --- the two series -------------------------------------------------------------------------------


def _near_terms(alpha: float, n: int, r: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Phi_n = (1/pi) sum_k (-1)^k Gamma(1 + m/alpha)/m! c_k r^(2k), and the mass inside over r^n.

    m = 2k + n, c_k = Gamma((m+1)/2) / (k! pi^((n-1)/2)): the expansion of the mean of exp(i k.x)
    over the directions, integrated term by term.
    """
    k = np.arange(float(_SERIES_TERMS + 2 * n))
    m = 2.0 * k + n
    ratio = gamma(0.5 * (m + 1.0)) / gamma(k + 1.0) / math.pi ** (0.5 * (n - 1))
    one = (-1.0) ** k * gamma(1.0 + m / alpha) / gamma(m + 1.0) / math.pi
    terms = one * ratio * r[..., None] ** (2.0 * k)
    # Small terms first: the sum keeps its last digits.
    return terms[..., ::-1].sum(axis=-1), (_SURFACE[n] * terms / m)[..., ::-1].sum(axis=-1)


def tail_sine(alpha: float, m: FloatArray) -> FloatArray:
    """(-1)^(m+1) sin(pi alpha m/2), written with 2 - alpha to keep its digits near alpha = 2."""
    return np.sin(0.5 * math.pi * (2.0 - alpha) * m)


def _far_terms(alpha: float, n: int) -> tuple[FloatArray, FloatArray]:
    """Coefficients of r^(-alpha m - n) in the tail, and bounds of them relative to the first.

    Phi_n ~ (1/pi) sum_{m>0} (-1)^(m+1) Gamma(1 + alpha m)/m! sin(pi alpha m/2) d_m r^(-alpha m - n),
    d_m = Gamma((alpha m + n)/2) / (Gamma((alpha m + 1)/2) pi^((n-1)/2)).
    """
    m = np.arange(1.0, _FAR_TERMS + 1.0)
    ratio = gamma(0.5 * (alpha * m + n)) / gamma(0.5 * (alpha * m + 1.0))
    growth = gamma(1.0 + alpha * m) / gamma(m + 1.0) * (ratio / math.pi ** (0.5 * (n - 1)))
    sine = tail_sine(alpha, m)
    # The sine is bounded, not used: it may vanish for one m although the terms that follow do not.
    bound = growth * np.minimum(1.0, 0.5 * math.pi * (2.0 - alpha) * m) / (growth[0] * sine[0])
    return growth * sine / math.pi, bound


def _pieces_before_far(alpha: float, n: int, first: float, bound: FloatArray) -> int:
    """Count the pieces up to the point where the tail's series is exact to 1e-17.

    There its last term is below 1e-17 of its first. So is one of two bounds of the part that the series lacks. The one
    bound is the contribution of the saddle point k = i s of exp(i k r - k^alpha), for alpha near 2 the Gaussian
    exp(-r^2/4), in n dimensions times (s / (2 pi r))^((n-1)/2). The other is the last term times
    sin(pi / (2 alpha))^-(alpha m + n), the integral of |k^(alpha m) / m! exp(i k r)| along the ray on which k^alpha is
    imaginary. It serves alpha above 3/2 and next to it, where the saddle comes to be of the size of a wave, and has no
    part in Phi_n.
    """
    pieces = 2
    power = alpha / (alpha - 1.0)
    turn = 0.5 * math.pi / (alpha - 1.0)
    on_ray = math.sin(0.5 * math.pi / alpha) ** -(alpha * _FAR_TERMS + n)
    while True:
        r = pieces * _WIDTH
        last = bound[-1] * r ** (-alpha * (_FAR_TERMS - 1))
        saddle = 0.0  # out of reach where alpha < 3/2
        if turn < math.pi:
            ratio = (r / alpha) ** (power - 1.0) / (2.0 * math.pi * r)
            saddle = math.exp(-(alpha - 1.0) * (r / alpha) ** power * math.sin(turn))
            saddle *= ratio ** (0.5 * (n - 1))
        lacks = min(on_ray * last, saddle / (first * r ** (-alpha - n)))
        if last < _NEGLIGIBLE and lacks < _NEGLIGIBLE:
            return pieces
        pieces += 1


# --- evaluation -----------------------------------------------------------------------------------


@njit(inline="always")
def _far_sum(power: float, coefficients: FloatArray, bound: FloatArray) -> float:
    """sum_m coefficients[m] power^m, power = r^-alpha, until the terms no longer count."""
    total = coefficients[0]
    factor = 1.0
    for m in range(1, coefficients.size):
        factor *= power
        total += coefficients[m] * factor
        if bound[m] * factor < _NEGLIGIBLE:
            break
    return power * total


@njit()
def density(x: FloatArray, table: RadialTable, out: FloatArray) -> None:
    """Phi_n(|x|), for one-dimensional arrays."""
    pieces = table.density.shape[0]
    for i in range(x.size):
        r = abs(x[i])
        if r < pieces * _WIDTH:
            out[i] = chebyshev.horner(r / _WIDTH, table.density)
        else:
            value = _far_sum(r**-table.alpha, table.far_density, table.far_bound)
            for _ in range(table.n):
                value /= r
            out[i] = value


@njit()
def mass(r: FloatArray, table: RadialTable, inside: bool, out: FloatArray) -> None:
    """Mass inside or outside the ball of radius r >= 0, for one-dimensional arrays."""
    pieces = table.mass.shape[0]
    for i in range(r.size):
        if r[i] < table.inside_pieces * _WIDTH:
            value = chebyshev.horner(r[i] / _WIDTH, table.mass)
            for _ in range(table.n):
                value *= r[i]
            out[i] = value if inside else 1.0 - value
        else:
            if r[i] < pieces * _WIDTH:
                value = chebyshev.horner(r[i] / _WIDTH, table.mass)
            else:
                value = _far_sum(r[i] ** -table.alpha, table.far_mass, table.far_bound)
            out[i] = 1.0 - value if inside else value


# --- tables ---------------------------------------------------------------------------------------


def _project(r: FloatArray, alpha: float, n: int) -> tuple[FloatArray, FloatArray]:
    """Phi_n and the mass outside as marginals of n + 1 dimensions, with rho^2 = r^2 + y^2.

    Phi_n(r) = 2 int_0^inf Phi_{n+1}(rho) dy,
    T_n(r) = c_n r^n int_0^inf T_{n+1}(rho) rho^-(n+1) dy,
    c_n = 2 Gamma((n+1)/2) / (sqrt(pi) Gamma(n/2)), which makes T_n = 1 where T_{n+1} = 1.

    All terms are positive. The trapezoidal rule is used in v, y = min(r, 1) sinh(v): the integrands are analytic
    for |Im v| < pi/4 at least, and decay like exp(-(n + alpha) v).
    """
    above = radial_table(alpha, n + 1)
    densities, tails = np.zeros(r.shape), np.zeros(r.shape)
    r, scale = r[..., None], np.minimum(r, 1.0)[..., None]
    first, more = 0, True
    while more:
        v = _STEP * np.arange(first, first + _BLOCK)
        rho, step = np.hypot(r, scale * np.sinh(v)), scale * (_STEP * np.cosh(v))
        if first == 0:
            step[..., 0] *= 0.5
        density_there = step * elementwise(density, rho, above)
        tail_there = step * elementwise(mass, rho, above, False) * (r / rho) ** n / rho
        densities += density_there.sum(axis=-1)
        tails += tail_there.sum(axis=-1)
        more = bool(
            (density_there[..., -1] > _NEGLIGIBLE * densities).any()
            or (tail_there[..., -1] > _NEGLIGIBLE * tails).any()
        )
        first += _BLOCK
    constant = 2.0 * gamma(0.5 * (n + 1)) / (math.sqrt(math.pi) * gamma(0.5 * n))
    return 2.0 * densities, constant * tails


@lru_cache(maxsize=512)
def radial_table(alpha: float, n: int) -> RadialTable:
    """Return the table of Phi_n for one alpha, 1 < alpha < 2, n = 1 to 5."""
    far_density, far_bound = _far_terms(alpha, n)
    r = chebyshev.sample_points(
        _WIDTH, _pieces_before_far(alpha, n, float(far_density[0]), far_bound)
    )
    values, masses = np.empty_like(r), np.empty_like(r)
    values[0], masses[0] = _near_terms(alpha, n, r[0])
    between = _project if n % 2 == 0 else density_and_tail
    values[1:], masses[1:] = between(r[1:], alpha, n)
    inside_pieces = 1 + int((masses[1:, 0] > _MOSTLY_OUTSIDE).sum())
    m = np.arange(1.0, _FAR_TERMS + 1.0)
    table = RadialTable(
        density=chebyshev.fit(values),
        mass=np.empty_like(values),
        far_density=far_density,
        far_mass=_SURFACE[n] * far_density / (alpha * m),
        far_bound=far_bound,
        alpha=alpha,
        n=n,
        inside_pieces=inside_pieces,
    )
    # Mass inside over r^n: S_n int_0^1 s^(n-1) Phi_n(r s) ds.
    s, weight = 0.5 * (1.0 + _NODES), 0.5 * _WEIGHTS
    within = np.asarray(elementwise(density, r[1:inside_pieces, :, None] * s, table))
    masses[1:inside_pieces] = within @ (_SURFACE[n] * weight * s ** (n - 1))
    return table._replace(mass=chebyshev.fit(masses))
