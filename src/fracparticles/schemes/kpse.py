"""Kernel particle strength exchange (KPSE), Eq. (34):

    du_i/dt = (D alpha / epsilon^alpha) sum_j V_j (u_j - u_i) K_epsilon(x_j - x_i).

The integral form (4) of the fractional Laplacian with a regularised kernel. Conservative, symmetric.
Stable for D dt / h^alpha <= a; order II, aliases neglected:
a = 2 s^alpha / (alpha 2^beta gamma(alpha/2, (pi s / 2)^2)) with the lower incomplete gamma function.
"""

from __future__ import annotations

import numpy as np

from fracparticles.kernels.families import kernel
from fracparticles.kernels.tabulated import KernelValues
from fracparticles.lattice.operators import LatticeOperator
from fracparticles.schemes.base import Setting, lattice_transform, one_pass_operator

NAME = "KPSE"
TITLE = "Kernel particle strength exchange"
EQUATION = "Eq. (34)"
KERNEL = "Eq. (31)"
ORDERS = (2, 4, 6, 8, 10, 12)
BOX_ORDERS = ORDERS
FAMILIES = ("printed", "gamma")
DIMS = (1, 2, 3)
EXTERIORS = ("truncated", "open")
CONSERVATIVE = True
DISSIPATIVE = True


def weights(
    m: np.ndarray,
    alpha: float,
    order: int,
    overlap: float,
    dim: int = 1,
    values: KernelValues = kernel,
) -> np.ndarray:
    """a_m = alpha s^(-n-alpha) K(|m| / s)."""
    k = values("K", m / overlap, alpha, dim=dim, order=order)
    return alpha * overlap ** (-dim - alpha) * k


def operator(setting: Setting) -> LatticeOperator:
    """Return A of Eq. (34)."""
    alpha, order, overlap, dim = setting.alpha, setting.order, setting.overlap, setting.dim
    total = lattice_transform(
        "K", np.zeros((1, dim)), alpha, order, overlap, dim=dim, family=setting.family
    )
    return one_pass_operator(
        setting,
        lambda m: weights(m, alpha, order, overlap, dim, setting.kernel),
        exchange_sum=float(alpha * overlap**-alpha * total.flat[0]),
        decay=dim + alpha,
    )


def symbol(
    theta: np.ndarray,
    alpha: float,
    order: int = 2,
    overlap: float = 2.0,
    dim: int = 1,
    family: str | None = None,
) -> np.ndarray:
    """A(theta) h^alpha / D = alpha s^(-alpha) sum_l [K^(s (theta + 2 pi l)) - K^(2 pi l s)]."""
    theta = np.asarray(theta, dtype=float)
    at_theta = lattice_transform("K", theta, alpha, order, overlap, dim=dim, family=family)
    at_zero = lattice_transform(
        "K", np.zeros((1, dim)), alpha, order, overlap, dim=dim, family=family
    )
    return alpha * overlap**-alpha * (at_theta - at_zero.flat[0])
