"""Direct differentiation (DD), Eq. (10):

    du_i/dt = (D / epsilon^alpha) sum_j V_j u_j G_epsilon(x_i - x_j),

the fractional Laplacian of the particle representation, collocated at the particles: G^(k) = -|k|^alpha eta^(k). It
is not conservative. For order II and without aliases it is stable for D dt / h^alpha <= a with

    a = 2 (s/2)^alpha (2 e / alpha)^(alpha/2).
"""

from __future__ import annotations

from math import e

from fracparticles.schemes.base import Sum


class DirectDifferentiation(Sum):
    """DD."""

    name, place = "DD", 1
    title = "Direct differentiation"
    equation, kernel = "Eq. (10)", "Eq. (11)"
    kernel_name = "G"
    orders = box_orders = (2, 4, 6, 8, 10, 12)
    families = ("printed", "gamma")
    exteriors = ("truncated", "open")
    conservative = False
    tabulated = True
    colour, marker = "#0072B2", "o"

    def closed_form_limit(self, beta: float, overlap: float) -> float:
        """Return a, see the module."""
        alpha = 1.0 + beta
        return 2.0 * (overlap / 2.0) ** alpha * (2.0 * e / alpha) ** (alpha / 2.0)
