"""Green particle strength exchange (GPSE), Eqs. (38)-(41):

    (u_i^{k+1} - u_i^k) / dt = (1 / epsilon^alpha) sum_j V_j (u_j^k - u_i^k) E_epsilon(x_j - x_i),
    epsilon = (D dt)^(1/alpha).

The kernel is the fundamental solution over one step, so that a step is exact up to quadrature: an explicit
Euler step of the operator on the right, whose smoothing length is tied to the step. Conservative, symmetric.
"""

from __future__ import annotations

import numpy as np

from fracparticles.kernels.families import kernel
from fracparticles.kernels.tabulated import KernelValues
from fracparticles.lattice.operators import LatticeOperator
from fracparticles.schemes.base import Setting, lattice_transform, one_pass_operator

NAME = "GPSE"
TITLE = "Green particle strength exchange"
EQUATION = "Eq. (41)"
KERNEL = "Eq. (39)"
ORDERS = (2,)
BOX_ORDERS = ORDERS
FAMILIES: tuple[str, ...] = ()
DIMS = (1, 2, 3)
EXTERIORS = ("truncated", "open")
CONSERVATIVE = True
DISSIPATIVE = True


def weights(
    m: np.ndarray, alpha: float, overlap: float, dim: int = 1, values: KernelValues = kernel
) -> np.ndarray:
    """a_m = s^(-n-alpha) E(|m| / s)."""
    return overlap ** (-dim - alpha) * values("E", m / overlap, alpha, dim=dim)


def operator(setting: Setting) -> LatticeOperator:
    """Return A of Eq. (41); setting.overlap must be (D dt)^(1/alpha) / h."""
    alpha, overlap, dim = setting.alpha, setting.overlap, setting.dim
    total = lattice_transform("E", np.zeros((1, dim)), alpha, 2, overlap, dim=dim)
    return one_pass_operator(
        setting,
        lambda m: weights(m, alpha, overlap, dim, setting.kernel),
        exchange_sum=float(overlap**-alpha * total.flat[0]),
        decay=dim + alpha,
    )


def symbol(
    theta: np.ndarray, alpha: float, order: int = 2, overlap: float = 2.0, dim: int = 1
) -> np.ndarray:
    """A(theta) h^alpha / D = s^(-alpha) sum_l [E^(s (theta + 2 pi l)) - E^(2 pi l s)].

    E^(k) = exp(-|k|^alpha). There is one order only.
    """
    theta = np.asarray(theta, dtype=float)
    at_theta = lattice_transform("E", theta, alpha, 2, overlap, dim=dim)
    at_zero = lattice_transform("E", np.zeros_like(theta), alpha, 2, overlap, dim=dim)
    return overlap**-alpha * (at_theta - at_zero)
