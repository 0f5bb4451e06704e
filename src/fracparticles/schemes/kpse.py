"""Kernel particle strength exchange (KPSE), Eq. (34):

    du_i/dt = (D alpha / epsilon^alpha) sum_j V_j (u_j - u_i) K_epsilon(x_j - x_i).

This is the integral form (4) of the fractional Laplacian with a regularised kernel. It is conservative and symmetric.
For order II and without aliases it is stable for D dt / h^alpha <= a with

    a = 2 s^alpha / (alpha 2^beta gamma(alpha/2, (pi s / 2)^2)),

gamma being the lower incomplete gamma function.
"""

from __future__ import annotations

from math import pi

from scipy.special import gamma, gammainc

from fracparticles.schemes.base import Exchange
from fracparticles.schemes.setting import Setting


class KernelExchange(Exchange):
    """KPSE."""

    name, place = "KPSE", 4
    title = "Kernel particle strength exchange"
    equation, kernel = "Eq. (34)", "Eq. (31)"
    kernel_name = "K"
    orders = box_orders = (2, 4, 6, 8, 10, 12)
    families = ("printed", "gamma")
    exteriors = ("truncated", "open")
    tabulated = True
    colour, marker = "#009E73", "^"

    def factor(self, setting: Setting) -> float:
        """Return alpha."""
        return setting.alpha

    def closed_form_limit(self, beta: float, overlap: float) -> float:
        """Return a, see the module."""
        alpha = 1.0 + beta
        incomplete = gamma(alpha / 2.0) * gammainc(alpha / 2.0, (pi * overlap / 2.0) ** 2)
        return float(2.0 * overlap**alpha / (alpha * 2.0**beta * incomplete))
