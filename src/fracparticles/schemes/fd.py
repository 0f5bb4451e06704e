"""Finite differences (FD): a reconstruction of the paper's reference [41], not the authors' scheme.

They approximate the flux -(D/2) (D_left^beta u - D_right^beta u) / |cos(pi alpha / 2)| to first order in h, with
homogeneous Dirichlet conditions. With omega(z) = z^(1-beta) / Gamma(2-beta) and delta_j = (u_j - u_{j-1}) / h,

    L_i = sum_{j <= i} [omega(x_i - x_{j-1}) - omega(x_i - x_j)] delta_j,     R_i its mirror image,
    du_i/dt = D [(L_{i+1} - L_i) + (R_i - R_{i-1})] / (2 h |cos(pi alpha / 2)|).

As beta goes to zero, so does |cos(pi alpha / 2)|, and with it all but the nearest weights of L: the first-order error
is then of size h / beta.
"""

from __future__ import annotations

from math import factorial, gamma

import numpy as np
from scipy.special import bernoulli, poch, zeta

from fracparticles.schemes.base import Sum
from fracparticles.schemes.setting import Setting

# beta or 1 - beta below which omega is nearly z or 1: its differences are then those of the rest.
_CLOSE = 0.005
_ZETA_TERMS = 10  # of the zeta function, and as many corrections: the next is below round-off
_FAR = 200.0  # m from which the next Taylor term, omega^(9), is below 1e-16 of the first


class FiniteDifferences(Sum):
    """FD."""

    name, place = "FD", 7
    title = "Finite differences (reconstruction)"
    equation = "Ref. [41]"
    conservative = False
    has_kernel = False
    colour, marker = "#56B4E9", "v"

    def weights(self, m: np.ndarray, setting: Setting) -> np.ndarray:
        """Return a_m, even: half the second differences of g_m = omega(m + 1) - omega(m), over |cos(pi alpha/2)|.

        L_i = h^(-beta) sum_{m >= 0} g_m (u_{i-m} - u_{i-m-1}); the two one-sided sums overlap at |m| <= 1.
        """
        m, alpha = np.abs(np.asarray(m, dtype=float)), setting.alpha
        one_sided = _one_sided(m, alpha)
        mirrored = np.where(m <= 1.0, _one_sided(-m, alpha), 0.0)
        return np.asarray(0.5 * (one_sided + mirrored) / _cosine(alpha))

    def symbol(self, theta: np.ndarray, setting: Setting) -> np.ndarray:
        """Return A(theta) h^alpha / D = Re[(e^{i theta} - 1) L^(theta)] / |cos(pi alpha / 2)|.

        L^ = -|1 - e^{i theta}|^2 sum_l (i (theta + 2 pi l))^(beta-2), the flux of the piecewise linear interpolant;
        the sum over the aliases is a pair of Hurwitz zeta functions.
        """
        theta, alpha = np.asarray(theta, dtype=float), setting.alpha
        out = np.zeros_like(theta)
        t = theta[theta != 0.0]
        power = 3.0 - alpha
        turns = t / (2.0 * np.pi)
        if 2.0 - alpha < _CLOSE:
            aliases = _aliases_near_the_pole(2.0 - alpha, turns)
        else:
            quarter = np.exp(-0.5j * np.pi * power)
            aliases = quarter * zeta(power, turns) + np.conj(quarter) * zeta(power, 1.0 - turns)
        aliases = (2.0 * np.pi) ** -power * aliases
        flux = -4.0 * np.sin(0.5 * t) ** 2 * aliases
        out[theta != 0.0] = ((np.exp(1j * t) - 1.0) * flux).real / _cosine(alpha)
        return out


def _cosine(alpha: float) -> float:
    """|cos(pi alpha / 2)| = sin(pi beta / 2), which keeps its digits as beta goes to zero."""
    beta = alpha - 1.0
    if beta < _CLOSE:
        return float(np.sin(0.5 * np.pi * beta))
    return float(abs(np.cos(0.5 * np.pi * alpha)))


def _one_sided(m: np.ndarray, alpha: float) -> np.ndarray:
    """The weight of u_{i-m} in h^beta (L_{i+1} - L_i), m >= -1: g_{m+1} - 2 g_m + g_{m-1}.

    It is the third difference of omega, centred at c = m + 1/2. Far away this would cancel, and the Taylor series
    omega''' + omega^(5) / 8 + 13 omega^(7) / 1920 takes its place.
    """
    near = _g(m + 1.0, alpha) - 2.0 * _g(m, alpha) + _g(m - 1.0, alpha)
    if min(alpha - 1.0, 2.0 - alpha) < _CLOSE:
        near = np.where(m >= 1.0, _third_difference(m, alpha), near)
    p = 2.0 - alpha
    c = np.maximum(m, _FAR) + 0.5
    third = p * (p - 1.0) * (p - 2.0) * c ** (p - 3.0)
    fifth = third * (p - 3.0) * (p - 4.0) / c**2
    seventh = fifth * (p - 5.0) * (p - 6.0) / c**2
    far = (third + fifth / 8.0 + 13.0 * seventh / 1920.0) / gamma(p + 1.0)
    return np.where(m >= _FAR, far, near)


def _g(m: np.ndarray, alpha: float) -> np.ndarray:
    """g_m = omega(m + 1) - omega(m) for m >= 0, zero for m < 0."""
    p = 2.0 - alpha
    base = np.maximum(m, 0.0)
    return np.where(m < 0.0, 0.0, (base + 1.0) ** p - base**p) / gamma(p + 1.0)


def _third_difference(m: np.ndarray, alpha: float) -> np.ndarray:
    """The third difference for m >= 1 and beta near zero or one, from omega less z or 1, whose differences vanish."""
    m, beta = np.maximum(m, 1.0), alpha - 1.0

    def rest(z: np.ndarray) -> np.ndarray:
        logarithm = np.log(np.maximum(z, 1.0))
        if beta < 0.5:
            return z * np.expm1(-beta * logarithm)
        return np.where(z == 0.0, -1.0, np.expm1((1.0 - beta) * logarithm))

    difference = rest(m + 2.0) - 3.0 * rest(m + 1.0) + 3.0 * rest(m) - rest(m - 1.0)
    return difference / gamma(2.0 - beta)


def _aliases_near_the_pole(delta: float, t: np.ndarray) -> np.ndarray:
    """i^-p zeta(p, t) + i^p zeta(p, 1 - t), p = 1 + delta, with the poles 1 / delta of both added exactly."""
    left, right = _zeta_less_pole(delta, t), _zeta_less_pole(delta, 1.0 - t)
    # i^-p = -sin(pi delta / 2) - i cos(pi delta / 2)
    sine, cosine = np.sin(0.5 * np.pi * delta), np.cos(0.5 * np.pi * delta)
    return np.asarray(-sine * (2.0 / delta + left + right) - 1j * cosine * (left - right))


def _zeta_less_pole(delta: float, t: np.ndarray) -> np.ndarray:
    """zeta(p, t) - 1 / delta by the formula of Euler and Maclaurin from the tenth term on (DLMF 25.11.5)."""
    p, z = 1.0 + delta, _ZETA_TERMS + t
    total = sum(((k + t) ** -p for k in range(_ZETA_TERMS)), start=0.5 * z**-p)
    total = total + np.expm1(-delta * np.log(z)) / delta
    power = z**-delta / (z * z)
    for j, number in enumerate(bernoulli(2 * _ZETA_TERMS)[2::2], start=1):
        total += number * power * poch(p, 2 * j - 1) / factorial(2 * j)
        power = power / (z * z)
    return total
