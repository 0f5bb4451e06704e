"""Flux particle strength exchange (FPSE), Eqs. (19), (25):

    Q_i = -(1 / epsilon^beta) sum_j V_j u_j F_epsilon(x_i - x_j),
    du_i/dt = -(D / epsilon) sum_j V_j (Q_j + Q_i) eta1_epsilon(x_i - x_j).

The fractional flux by direct differentiation, its divergence by particle strength exchange. Conservative; not
symmetric, because the two sums do not commute on a bounded set of particles.
Stable for D dt / h^alpha <= a; order II, aliases neglected: a = 2 (s/2)^alpha (4 e / alpha)^(alpha/2).
"""

from __future__ import annotations

import numpy as np

from fracparticles.exterior import far_field
from fracparticles.kernels import kernel
from fracparticles.operators import Operator, TwoPassOperator
from fracparticles.schemes.base import Setting, lattice_transform, present_sum
from fracparticles.sums import SUMMATIONS, BandedConvolution

NAME = "FPSE"
TITLE = "Flux particle strength exchange"
EQUATION = "Eq. (25)"
KERNEL = "Eqs. (20), (23)"
ORDERS = (2, 4)
EXTERIORS = ("truncated", "open")
CONSERVATIVE = True
DISSIPATIVE = True


def flux_weights(m: np.ndarray, alpha: float, order: int, overlap: float) -> np.ndarray:
    """Q_i = h^(-beta) sum_j b_{i-j} u_j with b_m = -s^(-alpha) F(m / s), Eq. (19)."""
    return -(overlap**-alpha) * kernel("F", m / overlap, alpha, order=order)


def divergence_weights(m: np.ndarray, alpha: float, order: int, overlap: float) -> np.ndarray:
    """du_i/dt = (D / h) sum_j c_{i-j} (Q_j + Q_i) with c_m = -s^(-2) eta1(m / s), Eq. (25)."""
    return -(overlap**-2.0) * kernel("eta1", m / overlap, alpha, order=order)


def operator(setting: Setting) -> Operator:
    """Return A of Eqs. (19), (25).

    With the open exterior, the flux is also taken at the lattice points next to the ends, as far as the
    divergence reaches; then the sum of eta1 over all neighbours vanishes and with it the term Q_i.
    """
    alpha, order, overlap = setting.alpha, setting.order, setting.overlap
    size, is_open = setting.size, setting.exterior == "open"
    reach = BandedConvolution.reach(overlap, order)
    pad = reach if is_open else 0

    def flux(m: np.ndarray) -> np.ndarray:
        return setting.rate * flux_weights(m, alpha, order, overlap)

    convolve = SUMMATIONS[setting.summation](
        flux(np.arange(size + pad, dtype=float)), size, parity=-1, pad=pad
    )
    c = divergence_weights(np.arange(reach + 1, dtype=float), alpha, order, overlap)
    far, diagonal = None, np.zeros(size)
    if is_open:
        far = far_field(flux, alpha, alpha, setting.n, parity=-1, pad=pad)
    else:
        diagonal = present_sum(c, parity=-1, size=size)
    return TwoPassOperator(convolve, BandedConvolution(c, parity=-1), diagonal, far)


def symbol(theta: np.ndarray, alpha: float, order: int = 2, overlap: float = 2.0) -> np.ndarray:
    """A(theta) h^alpha / D = -s^(-alpha) f(theta) e(theta).

    f and e are the sums over the aliases of F^ = i sgn(k) |k|^beta eta^(k) and of eta1^.
    """
    f = lattice_transform("F", theta, alpha, order, overlap, parity=-1)
    e = lattice_transform("eta1", theta, alpha, order, overlap, parity=-1)
    return -(overlap**-alpha) * f * e
