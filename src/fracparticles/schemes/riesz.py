"""The regularised Riesz potential, the ad-hoc variant of KPSE that the paper rejects (end of 3.2.3):

    du_i/dt = (D alpha / epsilon^alpha) sum_j V_j (u_j - u_i) K*_epsilon(x_j - x_i),
    K*(r) = -(1 / r) d kappa*/dr,   kappa*(r) = c (r^2 + 1)^(-beta/2).

The potential's kernel c |r|^(-beta) is cut off at the length epsilon directly instead of being convolved with eta.
The paper prints no formula; this is the classical algebraic regularisation. Its symbol differs from |k|^alpha
by a term of relative size (epsilon k)^(2-alpha), so that it hardly converges for alpha near 2.
"""

from __future__ import annotations

from math import gamma, pi, sqrt

import numpy as np
from scipy.special import kv

from fracparticles.schemes.base import Exchange
from fracparticles.schemes.setting import Setting


def potential_constant(alpha: float) -> float:
    """c of kappa, with which |k|^(alpha-2) is the transform of c |r|^(1-alpha), n = 1."""
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


class RieszExchange(Exchange):
    """RIESZ."""

    name, place = "RIESZ", 9
    title = "Regularised Riesz potential, rejected"
    equation, kernel = "Sec. 3.2.3, second remark", "K*, see the module"
    rejected = True
    colour, marker = "#8A6D3B", "*"

    def factor(self, setting: Setting) -> float:
        """Return alpha."""
        return setting.alpha

    def values(self, r: np.ndarray, setting: Setting) -> np.ndarray:
        """Return K*(r)."""
        return kernel_star(r, setting.alpha)

    def transform(self, theta: np.ndarray, setting: Setting) -> np.ndarray:
        """Return sum_l K*^(s (theta + 2 pi l))."""
        s, theta = setting.overlap, np.asarray(theta, dtype=float)
        last = 1 + int(np.ceil(44.0 / (2.0 * pi * s)))  # K_nu(k) ~ exp(-k)
        total = np.zeros_like(theta)
        for alias in range(-last, last + 1):
            total += kernel_star_transform(s * (theta + 2.0 * pi * alias), setting.alpha)
        return total

    def symbol(self, theta: np.ndarray, setting: Setting) -> np.ndarray:
        """Return A(theta) h^alpha / D: the transform of the weights less its value at theta = 0."""
        at_zero = self.scaled_transform(np.zeros(1), setting)
        return self.scaled_transform(theta, setting) - at_zero
