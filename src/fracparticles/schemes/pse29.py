"""The first attempt at an exchange scheme, Eq. (29), which the paper rejects:

    du_i/dt = (D / epsilon^alpha) sum_j V_j (u_j - u_i) G_epsilon(x_j - x_i).

DD with the exchange form forced upon it. On the infinite lattice the sum of G vanishes and (29) is DD; on a
bounded one the missing far weights make the diagonal positive, and with it some eigenvalues.
"""

from __future__ import annotations

import numpy as np

from fracparticles.lattice.operators import LatticeOperator
from fracparticles.schemes import dd
from fracparticles.schemes.base import Setting, one_pass_operator

NAME = "PSE29"
TITLE = "Scheme (29), rejected"
EQUATION = "Eq. (29)"
KERNEL = "Eq. (11)"
ORDERS = (2, 4)
BOX_ORDERS: tuple[int, ...] = ()
FAMILIES: tuple[str, ...] = ()
DIMS = (1,)
EXTERIORS = ("truncated",)
CONSERVATIVE = True
DISSIPATIVE = False


def operator(setting: Setting) -> LatticeOperator:
    """Return A of Eq. (29)."""
    alpha, order, overlap = setting.alpha, setting.order, setting.overlap
    at_zero = dd.symbol(np.zeros(1), alpha, order, overlap)
    return one_pass_operator(
        setting, lambda m: dd.weights(m, alpha, order, overlap), exchange_sum=float(at_zero[0])
    )


def symbol(theta: np.ndarray, alpha: float, order: int = 2, overlap: float = 2.0) -> np.ndarray:
    """A(theta) h^alpha / D: that of DD less its value at theta = 0."""
    theta = np.asarray(theta, dtype=float)
    return dd.symbol(theta, alpha, order, overlap) - dd.symbol(
        np.zeros_like(theta), alpha, order, overlap
    )
