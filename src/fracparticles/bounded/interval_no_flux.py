"""The third problem with closed ends: u = 0 outside, and no fractional flux through them. FPSE and DPSE solve it.

Such a scheme takes the flux q = -grad^beta u = -d/dx I u of the u on its particles alone, with the Riesz potential
I u = c int u(y) |x - y|^(1-alpha) dy. Then it exchanges the flux between the particles. This keeps sum V u, as the
regional operator does. But

    u_t = -dq/dx,   q = -grad^beta u with u = 0 outside (-1, 1),   q(-1) = q(1) = 0,

is another problem. It does not end in a constant u, but in a constant I u. This holds for (Popov, 1982)

    u = m Gamma(alpha) / (2^(alpha-1) Gamma(alpha/2)^2) (1 - x^2)^(alpha/2-1),   m = int u,

which is infinite at the ends. Every mode decays at a rate of the absorbing problem: if -dq/dx = -lambda u, then q is
zero outside and lambda q = -grad^beta (lambda u) = -grad^beta dq/dx = (-Laplacian)^(alpha/2) q.
"""

from __future__ import annotations

import math

import numpy as np

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray

__all__ = ["no_flux_state"]


def no_flux_state(x: FloatArray, alpha: float, mass: float = 1.0) -> FloatArray:
    """Return the final u of the module text.

    Parameters
    ----------
    x : array
        Places inside (-1, 1); the result has the same shape.
    alpha : float
        Fractional order, 1 < alpha < 2.
    mass : float
        The mass m = int u.

    Raises
    ------
    InvalidInput
        If alpha is not between 1 and 2, or a place not inside.
    """
    alpha, mass = check.fractional_order(alpha), check.finite_real("mass", mass)
    x = check.within("x", check.finite_array("x", x), -1.0, 1.0, inside=True)
    whole = 2.0 ** (alpha - 1.0) * math.gamma(0.5 * alpha) ** 2 / math.gamma(alpha)
    return np.asarray(mass / whole * ((1.0 - x) * (1.0 + x)) ** (0.5 * alpha - 1.0))
