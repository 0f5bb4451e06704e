"""Direct particle strength exchange (DPSE), Eqs. (13), (16):

    v_i = epsilon^(1-beta) sum_j V_j u_j kappa_epsilon(x_i - x_j),
    du_i/dt = (2 D / epsilon^2) sum_j V_j (v_j - v_i) Phi_epsilon(x_j - x_i).

The classical exchange approximation of the Laplacian, applied to the Riesz potential of u. Conservative, but the
potential decays so slowly, like |x|^(-beta), that cutting it at the ends spoils the solution there.

For beta near zero kappa is nearly the constant 1 / beta, of which the differences v_j - v_i leave nothing but its
roundings. There a constant is taken off the weights first, which changes no v_j - v_i: see `potential_differences`.
"""

from __future__ import annotations

import numpy as np

from fracparticles.kernels.families import kernel
from fracparticles.lattice.banded import BandedConvolution
from fracparticles.lattice.operators import LatticeOperator, TwoPassOperator
from fracparticles.lattice.sums import SUMMATIONS
from fracparticles.schemes.base import Setting, lattice_transform, present_sum

NAME = "DPSE"
TITLE = "Direct particle strength exchange"
EQUATION = "Eq. (16)"
KERNEL = "Eqs. (14), (17)"
ORDERS = (2, 4)
BOX_ORDERS: tuple[int, ...] = ()
FAMILIES: tuple[str, ...] = ()
DIMS = (1,)
EXTERIORS = ("truncated",)
CONSERVATIVE = True
DISSIPATIVE = True

_NEARLY_CONSTANT = 0.005  # beta, below which the constant 1 / beta would cost more than two digits
_NODES = 24  # of a panel of 1 / s <= 4 smoothing lengths: exact to round-off for the kernel, a Gaussian at its worst


def potential_weights(m: np.ndarray, alpha: float, order: int, overlap: float) -> np.ndarray:
    """v_i = h^(1-beta) sum_j b_{i-j} u_j with b_m = s^(-beta) kappa(m / s), Eq. (13)."""
    return overlap ** (1.0 - alpha) * kernel("kappa", m / overlap, alpha, order=order)


def potential_differences(m: np.ndarray, alpha: float, order: int, overlap: float) -> np.ndarray:
    """b_m - b_0 of `potential_weights` for m = 0, 1, 2, .., without the cancellation.

    kappa' = F = -r K, so that b_m - b_(m-1) = -s^(-beta) int r K(r) dr from (m - 1) / s to m / s: all of one sign.
    """
    nodes, gauss = np.polynomial.legendre.leggauss(_NODES)
    steps = np.zeros(m.size)
    for node, weight in zip(nodes, gauss, strict=True):
        r = (m[1:] - 0.5 * (1.0 - node)) / overlap
        steps[1:] -= 0.5 * weight / overlap * r * kernel("K", r, alpha, order=order)
    return overlap ** (1.0 - alpha) * np.cumsum(steps)


def laplacian_weights(m: np.ndarray, alpha: float, order: int, overlap: float) -> np.ndarray:
    """du_i/dt = (D / h^2) sum_j c_{i-j} (v_j - v_i) with c_m = 2 s^(-3) Phi(m / s), Eq. (16)."""
    return 2.0 * overlap**-3.0 * kernel("Phi", m / overlap, alpha, order=order)


def operator(setting: Setting) -> LatticeOperator:
    """Return A of Eqs. (13), (16)."""
    alpha, order, overlap, size = setting.alpha, setting.order, setting.overlap, setting.size
    potential = potential_differences if alpha - 1.0 < _NEARLY_CONSTANT else potential_weights
    b = potential(np.arange(size, dtype=float), alpha, order, overlap)
    reach = BandedConvolution.reach(overlap, order)
    c = laplacian_weights(np.arange(reach + 1, dtype=float), alpha, order, overlap)
    return TwoPassOperator(
        SUMMATIONS[setting.summation](setting.rate * b, size),
        BandedConvolution(c, parity=1),
        -present_sum(c, parity=1, size=size),
        None,
    )


def symbol(theta: np.ndarray, alpha: float, order: int = 2, overlap: float = 2.0) -> np.ndarray:
    """A(theta) h^alpha / D = 2 s^(-1-beta) kappa^(theta) [Phi^(theta) - Phi^(0)], sums over the aliases.

    At theta = 0 the potential's kappa^ ~ |k|^(alpha-2) is infinite and the product zero.
    """
    theta = np.asarray(theta, dtype=float)
    out = np.zeros_like(theta)
    t = theta[theta != 0.0]
    potential = lattice_transform("kappa", t, alpha, order, overlap)
    laplacian = lattice_transform("Phi", t, alpha, order, overlap) - lattice_transform(
        "Phi", np.zeros_like(t), alpha, order, overlap
    )
    out[theta != 0.0] = 2.0 * overlap**-alpha * potential * laplacian
    return out
