"""The symbols of the schemes once more, from scipy's functions: sums over the aliases of the kernels' transforms."""

from itertools import product

import numpy as np
from scipy.special import gamma, gammaincc


def symbol(scheme: str, theta: np.ndarray, alpha: float, order: int, overlap: float) -> np.ndarray:
    """Return A(theta) h^alpha / D of DD, FPSE or KPSE, theta of shape (points, n); n > 1 for DD and KPSE alone.

    With k_l = s (theta + 2 pi l):  DD  -s^-alpha sum |k_l|^alpha eta^(k_l),
    KPSE  alpha s^-alpha sum [K^(k_l) - K^(2 pi s l)],
    FPSE  -s^-alpha sum sgn(k_l) |k_l|^beta eta^(k_l) sum sgn(k_l) eta1^(k_l).
    """
    dim, scale = theta.shape[-1], overlap**-alpha
    last = int(17.0 / (2.0 * np.pi * overlap)) + 1
    total, first, second = (np.zeros(len(theta)) for _ in range(3))
    for alias in product(range(-last, last + 1), repeat=dim):
        at_zero = 2.0 * np.pi * overlap * np.array(alias)
        vector = overlap * theta + at_zero
        k = np.sqrt(np.square(vector).sum(axis=-1))
        if scheme == "DD":
            total -= k**alpha * _eta(k, order)
        elif scheme == "KPSE":
            nothing = np.sqrt(np.square(at_zero).sum())
            total += alpha * (_exchange(k, alpha, order) - _exchange(nothing, alpha, order))
        else:
            sign = np.sign(vector[:, 0])
            first += sign * k ** (alpha - 1.0) * _eta(k, order)
            second += sign * k * (_eta(k, order) if order != 4 else gammaincc(2, k * k / 4.0))
    return scale * (total if scheme != "FPSE" else -first * second)


def _eta(k: np.ndarray, order: int) -> np.ndarray:
    """(8), (9); from order 6 on the incomplete gamma function."""
    if order == 4:
        return 2.0 * np.exp(-k * k / 4.0) - np.exp(-k * k / 2.0)
    return gammaincc(order // 2, k * k / 4.0)


def _exchange(k: np.ndarray, alpha: float, order: int) -> np.ndarray:
    """int_k^inf x^(alpha-1) eta^(x) dx: 2^(alpha-1) Gamma(s, k^2 / 4) for the Gaussian, s = alpha / 2."""
    s, z = 0.5 * alpha, k * k / 4.0
    if order == 4:
        wide = 2.0**-s * gamma(s) * gammaincc(s, 2.0 * z)
        return 2.0 ** (alpha - 1.0) * (2.0 * gamma(s) * gammaincc(s, z) - wide)
    terms = range(order // 2)
    return 2.0 ** (alpha - 1.0) * sum(
        gamma(s + j) / gamma(j + 1.0) * gammaincc(s + j, z) for j in terms
    )
