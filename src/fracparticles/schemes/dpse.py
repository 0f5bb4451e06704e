"""Direct particle strength exchange (DPSE), Eqs. (13), (16):

    v_i = epsilon^(1-beta) sum_j V_j u_j kappa_epsilon(x_i - x_j),
    du_i/dt = (2 D / epsilon^2) sum_j V_j (v_j - v_i) Phi_epsilon(x_j - x_i).

This is the classical exchange approximation of the Laplacian, applied to the Riesz potential of u. It is
conservative. The potential decays so slowly, like |x|^(-beta), that cutting it off at the ends spoils the
solution there.

For beta near zero kappa is nearly the constant 1 / beta, and the differences v_j - v_i would consist of its rounding
errors. A constant is therefore subtracted from the weights first, which changes no v_j - v_i: see
`potential_differences`.
"""

from __future__ import annotations

import numpy as np

from fracparticles.lattice.banded import BandedConvolution
from fracparticles.lattice.operators import LatticeOperator, TwoPassOperator
from fracparticles.lattice.sums import SUMMATIONS, sums_of_weights
from fracparticles.schemes.base import LatticeScheme
from fracparticles.schemes.setting import Setting
from fracparticles.schemes.transform import lattice_transform
from fracparticles.special.quadrature import gauss_legendre

_NEARLY_CONSTANT = 0.005  # beta below which the constant 1 / beta would cost more than two digits
# Nodes of the rule between two lattice points, at most 4 smoothing lengths apart: exact to round-off for the kernel,
# whose fastest part is a Gaussian.
_NODES = 24


def potential_weights(m: np.ndarray, setting: Setting) -> np.ndarray:
    """v_i = h^(1-beta) sum_j b_{i-j} u_j with b_m = s^(-beta) kappa(m / s), Eq. (13)."""
    s = setting.overlap
    return s ** (1.0 - setting.alpha) * setting.kernel("kappa", m / s)


def potential_differences(m: np.ndarray, setting: Setting) -> np.ndarray:
    """b_m - b_0 of `potential_weights` for m = 0, 1, 2, .., without the cancellation.

    kappa' = F = -r K, so that b_m - b_(m-1) = -s^(-beta) int r K(r) dr from (m - 1) / s to m / s. These differences all
    have one sign.
    """
    s = setting.overlap
    nodes, gauss = gauss_legendre(_NODES, 0.0, 1.0)
    steps = np.zeros(m.size)
    for node, weight in zip(nodes, gauss, strict=True):
        r = (m[1:] - 1.0 + node) / s
        steps[1:] -= weight / s * r * setting.kernel("K", r)
    return s ** (1.0 - setting.alpha) * np.cumsum(steps)


def laplacian_weights(m: np.ndarray, setting: Setting) -> np.ndarray:
    """du_i/dt = (D / h^2) sum_j c_{i-j} (v_j - v_i) with c_m = 2 s^(-3) Phi(m / s), Eq. (16)."""
    return 2.0 * setting.overlap**-3.0 * setting.kernel("Phi", m / setting.overlap)


class DirectExchange(LatticeScheme):
    """DPSE."""

    name, place = "DPSE", 2
    title = "Direct particle strength exchange"
    equation, kernel = "Eq. (16)", "Eqs. (14), (17)"
    orders = (2, 4)
    conservative = True
    colour, marker = "#E69F00", "P"

    def operator(self, setting: Setting) -> LatticeOperator:
        """Return A of Eqs. (13), (16)."""
        nearly_constant = setting.alpha - 1.0 < _NEARLY_CONSTANT
        potential = potential_differences if nearly_constant else potential_weights
        b = potential(np.arange(setting.size, dtype=float), setting)
        b -= b[setting.n]
        c = laplacian_weights(np.arange(_reach(setting) + 1, dtype=float), setting)
        c[0] = 0.0  # it has no effect on v_j - v_i but for rounding errors
        return TwoPassOperator(
            SUMMATIONS[setting.summation](setting.rate * b, setting.size),
            BandedConvolution(c, parity=1),
            -sums_of_weights(c, parity=1, size=setting.size),
            None,
        )

    def symbol(self, theta: np.ndarray, setting: Setting) -> np.ndarray:
        """Return A(theta) h^alpha / D = -4 s^(1-alpha) kappa^(theta) sum_(m>0) c_m sin^2(m theta / 2).

        kappa^ is a sum over the aliases. The second factor is Phi^(theta) - Phi^(0), without the cancellation, which
        kappa^ ~ |theta|^(alpha-2) would magnify. At theta = 0 the product is zero.
        """
        theta = np.asarray(theta, dtype=float)
        out = np.zeros_like(theta)
        t = theta[theta != 0.0]
        m = np.arange(_reach(setting) + 1, dtype=float)
        laplacian = np.zeros_like(t)
        for k, weight in zip(m[1:], laplacian_weights(m, setting)[1:], strict=True):
            laplacian -= 4.0 * weight * np.sin(0.5 * k * t) ** 2
        potential = lattice_transform("kappa", t, setting)
        out[theta != 0.0] = setting.overlap ** (2.0 - setting.alpha) * potential * laplacian
        return out


def _reach(setting: Setting) -> int:
    return BandedConvolution.reach(setting.overlap, setting.order)
