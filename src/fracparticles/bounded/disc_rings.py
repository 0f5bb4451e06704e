r"""The exchange between rings of particles in the unit disc, one angular wave number l at a time.

The singular operator of the plane, with c = c_(2,alpha) and mu = 1 + alpha/2,

    L u(x) = c p.v. int (u(y) - u(x)) |x - y|^(-2-alpha) dy,

takes a field f(r) cos(l theta) to another of this form. The integral over the angle is exact; with rho = r< / r>,
DLMF 15.8.1,

    K_l(r, r') = c int_0^(2 pi) cos(l phi) |r - r' e^(i phi)|^(-2 mu) dphi
               = 2 pi c (mu)_l / l! rho^l r>^(-2 mu) (1 - rho^2)^(-1-alpha) 2F1(l - alpha/2, -alpha/2; l + 1; rho^2).

The rings lie at r_i = r(xi_i), xi_i = (i - 1/2) h, h = 1 / N, with volumes V_i = r r'(xi) h for each radian and

    r'(xi) ~ xi (1 - xi)^2.

So they crowd at the edge, where fields behave like (1 - r)^(alpha/2) or (1 - r)^alpha, and neither end of the
trapezoidal rule costs an order. A punctured rule V_i V_j K_l(r_i, r_j) leaves out the neighbourhood of i = j. Its error
follows from the sum over pairs, sum_ij V_i V_j K_l (u_i - u_j)^2 / 2, which is even in xi_i - xi_j:

- Across rings K_l ~ c_1 |r - r'|^(-1-alpha) / r. Neighbours exchange -zeta(alpha - 1) c_1 r |dr|^(1-alpha) more, Navot,
  J. Math. Phys. 40 (1961) 271. This is positive, and the same for all l.
- Along a ring the loss by K_0 - K_l is finite at r = r', except for a term |r - r'|^(1-alpha). It is that of a wave
  l / r along lines dr apart, `loss_along_a_line`, and a term by the curvature of the ring, `_curvature`.

The error is O(h^(4-alpha)). All exchange is symmetric: what one ring loses another gains.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import gamma, pi

import numpy as np
from scipy.special import betainc, gammaln, hyp2f1, kv, rgamma, zeta, zetac

from fracparticles.arguments import FloatArray
from fracparticles.special.tails import plane_constant, tail_constant

__all__ = ["Rings", "exterior_rate", "loss_along_a_line", "plane_constant", "ring_kernel"]

_AT_CENTRE, _AT_EDGE = 2.0, 3.0  # r ~ xi^2 at the centre, 1 - r ~ (1 - xi)^3 at the edge
# The integral of xi (1 - xi)^2: with it r goes from 0 to 1.
_BETA = gamma(_AT_CENTRE) * gamma(_AT_EDGE) / gamma(_AT_CENTRE + _AT_EDGE)
_RESOLVED = 0.3  # q below which the series is accurate to 1e-5 of the loss
_LINES = 150  # lines that are summed: K_nu(0.3 150) is 1e-20


@dataclass(frozen=True)
class Rings:
    """N rings of the unit disc.

    Attributes
    ----------
    r, edge, slope : array, shape (N,)
        Radii, distances 1 - r to the edge (to their own last digit), and h dr/dxi.
    """

    r: FloatArray
    edge: FloatArray
    slope: FloatArray

    @classmethod
    def graded(cls, count: int) -> Rings:
        """Return `count` rings, graded towards the edge."""
        return cls(*_graded((np.arange(count) + 0.5) / count, count))

    @classmethod
    def between(cls, count: int) -> Rings:
        """Return the count - 1 rings between those of `graded`."""
        return cls(*_graded(np.arange(1.0, count) / count, count))

    @property
    def volumes(self) -> FloatArray:
        """V_i, for each radian."""
        return self.r * self.slope

    def exchange(self, alpha: float, wave: int) -> FloatArray:
        """Return W_ij = V_i V_j K_l(r_i, r_j), more for neighbours, and 0 on the diagonal, shape (N, N)."""
        gap = np.abs(self.edge[:, None] - self.edge)
        np.fill_diagonal(gap, 1.0)
        v = self.volumes
        w = v[:, None] * v * ring_kernel(self.r[:, None], self.r, gap, alpha, wave)
        np.fill_diagonal(w, 0.0)
        count = self.r.size
        r, _, slope = _graded(np.arange(1.0, count) / count, count)
        more = -(1.0 + zetac(alpha - 1.0)) * tail_constant(alpha) * r * slope ** (1.0 - alpha)
        i = np.arange(count - 1)
        w[i, i + 1] += more
        w[i + 1, i] += more
        return w

    def loss(self, alpha: float, wave: int) -> FloatArray:
        """Return the part of K_0 - K_l that the punctured rule leaves out, a rate, shape (N,)."""
        if wave == 0:
            return np.zeros_like(self.r)
        along = loss_along_a_line(wave * self.slope / self.r, alpha) * self.slope**-alpha
        return along + self.volumes * self.r ** (-2.0 - alpha) * _curvature(alpha, wave)

    def outward_rate(self, alpha: float) -> FloatArray:
        """Return kappa(r) = c int_(|y| > 1) |x - y|^(-2-alpha) dy, the rate to the outside, shape (N,).

        It is (2 pi c / alpha) 2F1(alpha/2, 1 + alpha/2; 1; r^2), the integral of K_0 over r' > 1, term by term.
        """
        a = 0.5 * alpha
        regular = hyp2f1(-a, 1.0 - a, 1.0, self.r**2) * (self.edge * (1.0 + self.r)) ** -alpha
        return np.asarray(pi * plane_constant(alpha) / a * regular)


def exterior_rate(rings: Rings, alpha: float, wave: int) -> FloatArray:
    """Return V'_j K_l(r_i, r'_j) for the rings r'_j = 1 / r_j outside, shape (N, N)."""
    outside = 1.0 / rings.r
    gap = rings.edge[:, None] + rings.edge / rings.r
    volumes = outside * rings.slope / rings.r**2
    return volumes * ring_kernel(rings.r[:, None], outside, gap, alpha, wave)


def ring_kernel(
    r: FloatArray, other: FloatArray, gap: FloatArray, alpha: float, wave: int
) -> FloatArray:
    """Return K_l(r, r'); the distance `gap` = |r - r'| is given, since it may be far below r."""
    mu, large = 1.0 + 0.5 * alpha, np.maximum(r, other)
    rho = np.minimum(r, other) / large
    size = 2.0 * pi * plane_constant(alpha)
    size *= np.exp(gammaln(mu + wave) - gammaln(mu) - gammaln(wave + 1.0))
    near = (gap * (r + other) / large**2) ** (-1.0 - alpha)  # 1 - rho^2
    regular = hyp2f1(wave - 0.5 * alpha, -0.5 * alpha, wave + 1.0, rho**2)
    return np.asarray(size * rho**wave * large ** (-2.0 * mu) * near * regular)


def loss_along_a_line(q: FloatArray, alpha: float) -> FloatArray:
    r"""Return the rate at which the particles of one line lose a wave q along it, less the part that other lines take.

    The lines are a unit apart, and q is the wave number. All lines and the plane between them take q^alpha. The lines
    at the distances k take c_1 k^(-1-alpha) (1 - M(q k)) each, with the constant c_1 of the line and the correlation M
    of Matern, (z/2)^nu 2 K_nu(z) / Gamma(nu), nu = (1 + alpha)/2. The rest is

        q^alpha - 2 c_1 sum_(k >= 1) k^(-1-alpha) (1 - M(q k))
            ~ c_1 (-zeta(alpha-1) q^2 / (alpha-1) + g q^(1+alpha) + zeta(alpha-3) q^4 / (16 (1-nu) (2-nu)))

    for small q, g = 4^(-nu) pi / (sin(nu pi) Gamma(nu) Gamma(1+nu)). It is positive, and q^alpha itself for large q.
    """
    q = np.asarray(q, dtype=float)
    nu, c = 0.5 * (1.0 + alpha), tail_constant(alpha)
    g = 4.0**-nu * pi / (np.sin(nu * pi) * gamma(nu) * gamma(1.0 + nu))
    second = -(1.0 + zetac(alpha - 1.0)) / (alpha - 1.0)
    fourth = (1.0 + zetac(alpha - 3.0)) / (16.0 * (1.0 - nu) * (2.0 - nu))
    out = c * (second * q**2 + g * q ** (1.0 + alpha) + fourth * q**4)
    coarse = q > _RESOLVED
    k = np.arange(1.0, _LINES + 1.0)[:, None]
    z = q[coarse] * k
    correlation = 2.0 ** (1.0 - nu) / gamma(nu) * z**nu * kv(nu, z)
    taken = zeta(1.0 + alpha) - (k ** (-1.0 - alpha) * correlation).sum(axis=0)
    out[coarse] = q[coarse] ** alpha - 2.0 * c * taken
    return np.asarray(out)


def _curvature(alpha: float, wave: int) -> float:
    """Return r^(2+alpha) times the finite part of K_0 - K_l at r = r', less that of a straight line.

    By the connection of 2F1 to 1 - rho^2 (DLMF 15.8.4) the finite part of K_l is, in the same units,

        2 pi c Gamma(-1-alpha) / (Gamma(mu) Gamma(-alpha/2)) Gamma(mu + l) / Gamma(l - alpha/2).

    On a straight line the last quotient is l^(1+alpha).
    """

    def quotient(wave: int) -> float:
        return float(np.exp(gammaln(1.0 + 0.5 * alpha + wave)) * rgamma(wave - 0.5 * alpha))

    unit = 2.0 * pi * plane_constant(alpha) * gamma(-1.0 - alpha)
    unit /= gamma(1.0 + 0.5 * alpha) * gamma(-0.5 * alpha)
    return unit * (quotient(0) - quotient(wave) + wave ** (1.0 + alpha))


def _graded(xi: FloatArray, count: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return r, 1 - r and dr/dxi / count."""
    slope = xi ** (_AT_CENTRE - 1.0) * (1.0 - xi) ** (_AT_EDGE - 1.0) / (_BETA * count)
    return betainc(_AT_CENTRE, _AT_EDGE, xi), betainc(_AT_EDGE, _AT_CENTRE, 1.0 - xi), slope
