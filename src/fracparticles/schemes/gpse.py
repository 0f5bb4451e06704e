"""Green particle strength exchange (GPSE), Eqs. (38)-(41):

    (u_i^{k+1} - u_i^k) / dt = (1 / epsilon^alpha) sum_j V_j (u_j^k - u_i^k) E_epsilon(x_j - x_i),
    epsilon = (D dt)^(1/alpha).

The kernel is the fundamental solution over one step, E^(k) = exp(-|k|^alpha), so a step is exact up to quadrature. It
is an explicit Euler step of the operator on the right. Its smoothing length is tied to the step: the overlap of the
setting must be (D dt)^(1/alpha) / h. The scheme is conservative and symmetric.
"""

from __future__ import annotations

from fracparticles.schemes.base import Exchange


class GreenExchange(Exchange):
    """GPSE."""

    name, place = "GPSE", 5
    title = "Green particle strength exchange"
    equation, kernel = "Eq. (41)", "Eq. (39)"
    kernel_name = "E"
    orders = box_orders = (2,)
    exteriors = ("truncated", "open")
    tabulated = self_timed = True
    colour, marker = "#CC79A7", "D"
