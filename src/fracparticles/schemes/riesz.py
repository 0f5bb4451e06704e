"""The regularised Riesz potential, the ad-hoc variant of KPSE that the paper rejects (end of 3.2.3):

    du_i/dt = (D alpha / epsilon^alpha) sum_j V_j (u_j - u_i) K*_epsilon(x_j - x_i),
    K*(r) = -(1 / r) d kappa*/dr,   kappa*(r) = c (r^2 + 1)^(-beta/2).

The potential's kernel c |r|^(-beta) is cut off at the length epsilon directly instead of being convolved with eta.
The paper prints no formula; this is the classical algebraic regularisation. Its symbol differs from |k|^alpha
by a term of relative size (epsilon k)^(2-alpha): nearly no convergence for alpha near 2.
"""

from __future__ import annotations

from math import gamma, pi, sqrt

import numpy as np
from scipy.special import kv

from fracparticles.lattice.operators import LatticeOperator
from fracparticles.schemes.base import Setting, one_pass_operator

NAME = "RIESZ"
TITLE = "Regularised Riesz potential, rejected"
EQUATION = "Sec. 3.2.3, second remark"
KERNEL = "K*, see the module"
ORDERS = (2,)
BOX_ORDERS: tuple[int, ...] = ()
FAMILIES: tuple[str, ...] = ()
DIMS = (1,)
EXTERIORS = ("truncated",)
CONSERVATIVE = True
DISSIPATIVE = True


def potential_constant(alpha: float) -> float:
    """c of kappa: |k|^(alpha-2) is the transform of c |r|^(1-alpha), n = 1."""
    beta = alpha - 1.0
    return gamma(beta / 2.0) / (2.0 ** (1.0 - beta) * sqrt(pi) * gamma((1.0 - beta) / 2.0))


def kernel_star(r: np.ndarray, alpha: float) -> np.ndarray:
    """K*(r) = beta c (r^2 + 1)^(-(beta+2)/2)."""
    beta = alpha - 1.0
    return beta * potential_constant(alpha) * (1.0 + np.square(r)) ** (-0.5 * beta - 1.0)


def kernel_star_transform(k: np.ndarray, alpha: float) -> np.ndarray:
    """K*^(k) = beta c 2 sqrt(pi) / Gamma(nu + 1/2) (|k| / 2)^nu K_nu(|k|), nu = (1 + beta) / 2."""
    nu = 0.5 * alpha
    k = np.abs(np.asarray(k, dtype=float))
    safe = np.where(k == 0.0, 1.0, k)
    shape = np.where(k == 0.0, 0.5 * gamma(nu), (0.5 * safe) ** nu * kv(nu, safe))
    amplitude = (alpha - 1.0) * potential_constant(alpha) * 2.0 * sqrt(pi) / gamma(nu + 0.5)
    return amplitude * shape


def weights(m: np.ndarray, alpha: float, overlap: float) -> np.ndarray:
    """a_m = alpha s^(-1-alpha) K*(m / s)."""
    return alpha * overlap ** (-1.0 - alpha) * kernel_star(m / overlap, alpha)


def operator(setting: Setting) -> LatticeOperator:
    """Return A of the module's formula."""
    alpha, overlap = setting.alpha, setting.overlap
    return one_pass_operator(
        setting, lambda m: weights(m, alpha, overlap), exchange_sum=_alias_sum(0.0, alpha, overlap)
    )


def symbol(theta: np.ndarray, alpha: float, order: int = 2, overlap: float = 2.0) -> np.ndarray:
    """A(theta) h^alpha / D = alpha s^(-alpha) sum_l [K*^(s (theta + 2 pi l)) - K*^(2 pi l s)]."""
    theta = np.asarray(theta, dtype=float)
    return _alias_sum(theta, alpha, overlap) - _alias_sum(0.0, alpha, overlap)


def _alias_sum(theta, alpha, overlap):
    last = 1 + int(np.ceil(44.0 / (2.0 * pi * overlap)))  # K_nu(k) ~ exp(-k)
    total = sum(
        kernel_star_transform(overlap * (theta + 2.0 * pi * alias), alpha)
        for alias in range(-last, last + 1)
    )
    return alpha * overlap**-alpha * total
