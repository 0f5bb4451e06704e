"""Direct differentiation (DD), Eq. (10):

    du_i/dt = (D / epsilon^alpha) sum_j V_j u_j G_epsilon(x_i - x_j),

the fractional Laplacian of the particle representation, collocated at the particles. Not conservative.
Stable for D dt / h^alpha <= a; order II, aliases neglected: a = 2 (s/2)^alpha (2 e / alpha)^(alpha/2).
"""

from __future__ import annotations

import numpy as np

from fracparticles.kernels.families import kernel
from fracparticles.kernels.tabulated import KernelValues
from fracparticles.lattice.operators import LatticeOperator
from fracparticles.schemes.base import Setting, lattice_transform, one_pass_operator

NAME = "DD"
TITLE = "Direct differentiation"
EQUATION = "Eq. (10)"
KERNEL = "Eq. (11)"
ORDERS = (2, 4, 6, 8, 10, 12)
BOX_ORDERS = ORDERS
FAMILIES = ("printed", "gamma")
DIMS = (1, 2, 3)
EXTERIORS = ("truncated", "open")
CONSERVATIVE = False
DISSIPATIVE = True


def weights(
    m: np.ndarray,
    alpha: float,
    order: int,
    overlap: float,
    dim: int = 1,
    values: KernelValues = kernel,
) -> np.ndarray:
    """a_m = s^(-n-alpha) G(|m| / s)."""
    return overlap ** (-dim - alpha) * values("G", m / overlap, alpha, dim=dim, order=order)


def operator(setting: Setting) -> LatticeOperator:
    """Return A of Eq. (10)."""
    alpha, order, overlap = setting.alpha, setting.order, setting.overlap
    return one_pass_operator(
        setting,
        lambda m: weights(m, alpha, order, overlap, setting.dim, setting.kernel),
        decay=setting.dim + alpha,
    )


def symbol(
    theta: np.ndarray,
    alpha: float,
    order: int = 2,
    overlap: float = 2.0,
    dim: int = 1,
    family: str | None = None,
) -> np.ndarray:
    """A(theta) h^alpha / D = s^(-alpha) sum_l G^(s (theta + 2 pi l)),  G^(k) = -|k|^alpha eta^(k)."""
    return overlap**-alpha * lattice_transform(
        "G", theta, alpha, order, overlap, dim=dim, family=family
    )
