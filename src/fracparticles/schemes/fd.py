"""Finite differences (FD): a reconstruction of the paper's reference [41], not the authors' scheme.

For the flux -(D/2) (D_left^beta u - D_right^beta u) / |cos(pi alpha / 2)|, first order in h, with homogeneous
Dirichlet conditions. With omega(z) = z^(1-beta) / Gamma(2-beta) and delta_j = (u_j - u_{j-1}) / h,

    L_i = sum_{j <= i} [omega(x_i - x_{j-1}) - omega(x_i - x_j)] delta_j,     R_i its mirror image,
    du_i/dt = D [(L_{i+1} - L_i) + (R_i - R_{i-1})] / (2 h |cos(pi alpha / 2)|).
"""

from __future__ import annotations

from math import gamma

import numpy as np
from scipy.special import zeta

from fracparticles.operators import Operator
from fracparticles.schemes.base import Setting, one_pass_operator

NAME = "FD"
TITLE = "Finite differences (reconstruction)"
EQUATION = "Ref. [41]"
KERNEL = "-"
ORDERS = (2,)
BOX_ORDERS: tuple[int, ...] = ()
FAMILIES: tuple[str, ...] = ()
DIMS = (1,)
EXTERIORS = ("truncated",)
CONSERVATIVE = False
DISSIPATIVE = True

_FAR = 200.0  # the next Taylor term, omega^(9), is below 1e-16 of the first there


def weights(m: np.ndarray, alpha: float) -> np.ndarray:
    """a_m, even: half the second differences of g_m = omega(m + 1) - omega(m), divided by |cos(pi alpha/2)|.

    L_i = h^(-beta) sum_{m >= 0} g_m (u_{i-m} - u_{i-m-1}); the two one-sided sums overlap at |m| <= 1.
    """
    m = np.abs(np.asarray(m, dtype=float))
    one_sided = _one_sided(m, alpha)
    mirrored = np.where(m <= 1.0, _one_sided(-m, alpha), 0.0)
    return 0.5 * (one_sided + mirrored) / abs(np.cos(0.5 * np.pi * alpha))


def _one_sided(m: np.ndarray, alpha: float) -> np.ndarray:
    """The weight of u_{i-m} in h^beta (L_{i+1} - L_i), m >= -1: g_{m+1} - 2 g_m + g_{m-1}.

    It is the third difference of omega, centred at c = m + 1/2; far away from its Taylor series
    omega''' + omega^(5) / 8 + 13 omega^(7) / 1920, where the difference itself would cancel.
    """
    near = _g(m + 1.0, alpha) - 2.0 * _g(m, alpha) + _g(m - 1.0, alpha)
    p = 2.0 - alpha
    c = np.maximum(m, _FAR) + 0.5
    third = p * (p - 1.0) * (p - 2.0) * c ** (p - 3.0)
    fifth = third * (p - 3.0) * (p - 4.0) / c**2
    seventh = fifth * (p - 5.0) * (p - 6.0) / c**2
    far = (third + fifth / 8.0 + 13.0 * seventh / 1920.0) / gamma(p + 1.0)
    return np.where(m >= _FAR, far, near)


def _g(m: np.ndarray, alpha: float) -> np.ndarray:
    """g_m = omega(m + 1) - omega(m) for m >= 0, nil for m < 0."""
    p = 2.0 - alpha
    base = np.maximum(m, 0.0)
    return np.where(m < 0.0, 0.0, (base + 1.0) ** p - base**p) / gamma(p + 1.0)


def operator(setting: Setting) -> Operator:
    """Return A of the module's formula, Dirichlet conditions beyond the last particles."""
    return one_pass_operator(setting, lambda m: weights(m, setting.alpha))


def symbol(theta: np.ndarray, alpha: float, order: int = 2, overlap: float = 2.0) -> np.ndarray:
    """A(theta) h^alpha / D = Re[(e^{i theta} - 1) L^(theta)] / |cos(pi alpha / 2)|,

    L^ = -|1 - e^{i theta}|^2 sum_l (i (theta + 2 pi l))^(beta-2), the flux of the piecewise linear interpolant;
    the sum over the aliases is a pair of Hurwitz zeta functions.
    """
    theta = np.asarray(theta, dtype=float)
    out = np.zeros_like(theta)
    t = theta[theta != 0.0]
    power = 3.0 - alpha
    turns = t / (2.0 * np.pi)
    quarter = np.exp(-0.5j * np.pi * power)
    aliases = (2.0 * np.pi) ** -power * (
        quarter * zeta(power, turns) + np.conj(quarter) * zeta(power, 1.0 - turns)
    )
    flux = -4.0 * np.sin(0.5 * t) ** 2 * aliases
    out[theta != 0.0] = ((np.exp(1j * t) - 1.0) * flux).real / abs(np.cos(0.5 * np.pi * alpha))
    return out
