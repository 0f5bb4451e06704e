r"""The lattice of a square: the exchange between its particles, and the fit to the edges.

The kernel is c |x - y|^(-2-alpha) on a lattice of spacing h, in the unit h = 1. A punctured rule leaves out the
neighbourhood of i = j. The symbol shows the error, with sums over the m != 0 of the plane, continued (`epstein_zeta`,
`harmonic_zeta`):

    sum w_m (1 - cos k.m) = |k|^alpha + c/2 sum |m|^(-2-alpha) (k.m)^2 - c/24 sum |m|^(-2-alpha) (k.m)^4 + ...

Weights for three kinds of neighbours, at (1, 0), (1, 1) and (2, 0), remove both terms (`neighbours`). A smooth field
then has the order 6 - alpha. The whole weight at (2, 0) is a little negative, all others are positive.

A field that is zero outside behaves like d^(alpha/2) at the distance d from an edge. A lattice that is not fitted to
this has the order one. Here two things are fitted:

- The volumes of the outermost three lines are 1 + delta_k. With them the rule integrates d^p for p = alpha/2,
  alpha/2 + 1 and 1: sum_k delta_k (k - 1/2)^p = -zeta(-p, 1/2), as in Navot's rule. The first two powers are in the
  field. The third is in its work: the operator takes d^(alpha/2 + 1) to d^(1 - alpha/2), which d^(alpha/2) multiplies.
- The rate at which line k gives to all others makes d^(alpha/2) harmonic in the half-plane, as it is for the operator:
  D_k d_k^(alpha/2) = sum_(j != k) W_(k-j) V_j d_j^(alpha/2), with the sum W of w along a line.

This rate replaces that of the infinite lattice, D = sum w, by D + `edge_fit`, which falls like k^-4. Near a corner the
fits of two edges are added.

A field that nothing leaves has a slope along the edge, up to the edge itself. There the neighbourhood of a pair is cut,
and these weights do not make up for it. For u = t, the coordinate along the edge, lines at the distance k exchange
c_1 k^(1-alpha) / (alpha-1) each way. The sum over the lines on the far side of the edge differs from its integral, in
the mean over the cell of line k, by

    zeta(alpha-1, k) + int_(k-1)^k y^(2-alpha) dy / (2-alpha).

Weights of neighbours on line k, `edge_exchange`, make up for this. Without them the order is 3 - alpha. None of this
depends on h.
"""

from __future__ import annotations

from functools import lru_cache
from math import gamma, pi
from typing import Any

import numpy as np
from scipy.special import gammaincc, hyp2f1, kv, zeta, zetac

from fracparticles.arguments import FloatArray
from fracparticles.special.tails import plane_constant, tail_constant

__all__ = [
    "edge_exchange",
    "edge_fit",
    "edge_volumes",
    "epstein_zeta",
    "harmonic_zeta",
    "line_weights",
    "neighbours",
    "rate_of_all",
    "weights",
]

_TERMS = 25  # terms of an accelerated alternating series: 5.8^-25 is below round-off
_SHELLS = 4  # points on either side of the centre: exp(-25 pi) is below round-off
_ALIASES = 6  # terms of Poisson's formula: K_nu(2 pi 6) is 1e-17


def epstein_zeta(s: float) -> float:
    """Return the sum of |m|^-s over the points m != 0 of the square lattice, continued to s < 2."""
    half = 0.5 * s
    odd = 2.0 * np.arange(_TERMS) + 1.0
    return 4.0 * float(1.0 + zetac(half)) * _alternating(odd**-half)


def weights(alpha: float, count: int) -> FloatArray:
    """Return w_m for offsets 0 <= m_1, m_2 < count, 0 for the first, shape (count, count)."""
    squared = np.add.outer(np.arange(count) ** 2.0, np.arange(count) ** 2.0)
    squared[0, 0] = 1.0
    w = plane_constant(alpha) * squared ** (-1.0 - 0.5 * alpha)
    w[0, 0] = 0.0
    next_to, across, second = neighbours(alpha)
    w[0, 1] += next_to
    w[1, 0] += next_to
    w[1, 1] += across
    w[0, 2] += second
    w[2, 0] += second
    return np.asarray(w)


def line_weights(alpha: float, count: int) -> FloatArray:
    """Return W_k, the sum of w along a line at the distance k = 1 .. count, by Poisson's formula."""
    k, nu = np.arange(1.0, count + 1.0), 0.5 * (1.0 + alpha)
    z = 2.0 * pi * np.multiply.outer(k, np.arange(1.0, _ALIASES + 1.0))
    aliases = 2.0 ** (1.0 - nu) / gamma(nu) * z**nu * kv(nu, z)
    w = tail_constant(alpha) * k ** (-1.0 - alpha) * (1.0 + 2.0 * aliases.sum(axis=1))
    next_to, across, second = neighbours(alpha)
    w[0] += next_to + 2.0 * across
    w[1] += second
    return np.asarray(w)


def rate_of_all(alpha: float) -> float:
    """Return D, the sum of w over the infinite lattice."""
    return plane_constant(alpha) * epstein_zeta(2.0 + alpha) + 4.0 * sum(neighbours(alpha))


def edge_volumes(alpha: float, count: int) -> FloatArray:
    """Return the volumes of lines at the distances 1/2, 3/2, .. from an edge, shape (count,), 3 or more."""
    power = np.array([0.5 * alpha, 0.5 * alpha + 1.0, 1.0])
    moments = np.power([0.5, 1.5, 2.5], power[:, None])
    missing = -(2.0**-power - 1.0) * (1.0 + zetac(-power))  # -zeta(-p, 1/2)
    v = np.ones(count)
    v[:3] += np.linalg.solve(moments, missing)
    return v


def edge_fit(alpha: float, count: int) -> FloatArray:
    """Return the rate of each line less that of the infinite lattice, shape (count,)."""
    lines, s, k = 2 * count + 200, 0.5 * alpha, np.arange(count)
    d = np.arange(lines) + 0.5
    w = np.concatenate([[0.0], line_weights(alpha, lines)])
    next_to, _, second = neighbours(alpha)
    own = 2.0 * (plane_constant(alpha) * zeta(2.0 + alpha) + next_to + second)
    volumes = edge_volumes(alpha, lines)
    inflow = w[np.abs(k[:, None] - np.arange(lines))] @ (volumes * d**s)
    # Beyond, the sum is the integral of c_1 (y - d_k)^(-1-alpha) y^s, up to the inverse square of the distance.
    far = hyp2f1(1.0 + alpha, s, s + 1.0, d[:count] / lines) * lines**-s / s
    inflow += tail_constant(alpha) * far
    return np.asarray(inflow / d[:count] ** s + volumes[:count] * own - rate_of_all(alpha))


def edge_exchange(alpha: float, count: int) -> FloatArray:
    """Return the additional exchange between neighbours on line k = 1 .. count, shape (count,)."""
    k = np.arange(1.0, count + 1.0)
    # zeta(s, k) = zeta(s) - sum_(i < k) i^-s
    passed = np.concatenate([[0.0], np.cumsum(k[:-1] ** (1.0 - alpha))])
    mean = (k ** (3.0 - alpha) - (k - 1.0) ** (3.0 - alpha)) / (3.0 - alpha)
    excess = 1.0 + zetac(alpha - 1.0) - passed + mean / (2.0 - alpha)
    more = 0.5 * tail_constant(alpha) / (alpha - 1.0) * excess
    more[0] += neighbours(alpha)[1]  # line 1 has no neighbours beyond the edge
    return np.asarray(more)


@lru_cache(maxsize=16)
def neighbours(alpha: float) -> tuple[float, float, float]:
    """Return the weights at (1, 0), (1, 1) and (2, 0) that are added to those of the kernel.

    For weights a, b, e there, sum w (k.m)^2 / 2 is (a + 2 b + 4 e) |k|^2, and sum w (k.m)^4 / 24 is
    (a + 2 b + 16 e) (k_1^4 + k_2^4) / 12 + b k_1^2 k_2^2.
    """
    c = plane_constant(alpha)
    second = -0.25 * c * epstein_zeta(alpha)
    # The sums of m_1^4 and of m_1^2 m_2^2, from that of |m|^4 / 2 and that of |m|^4 cos 4 theta.
    both, harmonic = 0.5 * epstein_zeta(alpha - 2.0), harmonic_zeta(alpha)
    fourth = (harmonic + 6.0 * both) / 8.0
    b = -0.25 * c * (both - fourth)
    e = (-0.5 * c * fourth - second) / 12.0
    return second - 2.0 * b - 4.0 * e, b, e


def harmonic_zeta(alpha: float) -> float:
    """Return the sum of |m|^(2-alpha) cos(4 theta_m) over the m != 0 of the plane, continued.

    The theta function of the harmonic polynomial P = |m|^4 cos 4 theta at 1/t is t^5 times that at t. So the sum is,
    with w = 1 + alpha/2, pi^w / Gamma(w) sum P (g(w) + g(5 - w)), g(a) = int_1^inf t^(a-1) exp(-pi |m|^2 t) dt.
    """
    w, m = 1.0 + 0.5 * alpha, np.arange(-_SHELLS, _SHELLS + 1.0)
    x, y = (v.reshape(-1) for v in np.meshgrid(m, m))
    polynomial, y = x**4 - 6.0 * x**2 * y**2 + y**4, pi * np.maximum(x**2 + y**2, 1.0)

    def g(a: float) -> FloatArray:
        return np.asarray(gamma(a) * gammaincc(a, y) * y**-a)

    return float(pi**w / gamma(w) * (polynomial * (g(w) + g(5.0 - w))).sum())


def _alternating(terms: Any) -> float:
    """Return the sum of (-1)^k a_k: Cohen, Rodriguez Villegas & Zagier, Exp. Math. 9 (2000) 3, Algorithm 1."""
    n = terms.size
    d = (3.0 + np.sqrt(8.0)) ** n
    d = 0.5 * (d + 1.0 / d)
    b, c, total = -1.0, -d, 0.0
    for k in range(n):
        c = b - c
        total += c * terms[k]
        b *= (k + n) * (k - n) / ((k + 0.5) * (k + 1.0))
    return float(total / d)
