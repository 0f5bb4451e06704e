r"""The smooth modes psi_k of `exterior_box`: their transforms, and integrals of these over the wave vectors.

    rho^(-2p)  ->  1/Gamma(p) int_0^c t^(p-1) exp(-t rho^2) dt = psi,

    psi^(k) = pi^(dim/2) c^q E_{1+q}(k^2 / 4 c) / Gamma(dim/2 + q),     p = dim/2 + q,

E_p the exponential integral. For a radial symbol A, (2 pi)^-dim int A psi^ e^{ik.x} dk is a function of |x|^2.
"""

from __future__ import annotations

from functools import cache, reduce

import numpy as np
from scipy.special import gamma, gammaincc, j0, j1, spherical_jn, zeta

from fracparticles._compiled import njit

__all__ = ["radial_integral", "radial_parts", "transforms"]

# The greatest k of the radial integral, in units of 1 / n: there the transform, which falls like exp(-k^2 / 4 c), is
# 1e-16.
_HIGHEST = 66.0
_WAVES = 160  # nodes of the radial integral
_BLOCK = 128  # points that are summed at a time: their sums stay in the first-level cache
_SMALL = 0.1  # p below which the recurrence of E_p would lose digits


def radial_parts(
    symbol: np.ndarray, psi_hat: np.ndarray, dim: int, alpha: float, n: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return A psi_k and psi_k, k = 1, 2, 3, at every |j|^2 on the lattice; for k = 3 without the factor j_1 / n.

    (2 pi)^-dim int A psi^ e^{ik.x} dk is a Chebyshev series in |x|^2. psi_3 is -d psi_1 / dx_1 / (dim + alpha).

    Parameters
    ----------
    symbol : array, shape (_WAVES,)
        The symbol of A along an axis, at the nodes of the radial integral.
    psi_hat : array, shape (2, _WAVES)
        The transforms of psi_1 and psi_2 there.
    dim, alpha, n
        As for `exterior_box.box_far_field`.

    Returns
    -------
    values : array, shape (6, distinct)
    number : array of int, shape (dim n^2 + 1,)
        The column for each |j|^2.
    """
    k, volume, mean, slope = radial_integral(dim)
    first, second = psi_hat * volume
    third = first * k * k / (dim + alpha)
    means = np.stack([symbol * first, symbol * second, first, second]) @ mean
    slopes = np.stack([symbol * third, third]) @ slope
    coefficients = np.stack([means[0], means[1], slopes[0], means[2], means[3], slopes[1]])
    present = np.zeros(dim * n * n + 1, dtype=bool)
    present[reduce(np.add.outer, [np.square(np.arange(n + 1))] * dim)] = True
    distinct = np.flatnonzero(present)
    values = np.empty((6, distinct.size))
    _sum_series(coefficients, distinct * (2.0 / (dim * n * n)) - 1.0, values)
    return values, np.cumsum(present) - 1


@cache
def radial_integral(dim: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The nodes |k| of the integral over all k, their volumes, and for each node two rows of Chebyshev coefficients.

    The first is the mean of e^{ik.x} over the directions of k. The second is minus its derivative along x_1, over
    x_1 k^2. Both are functions of |x|^2 for |x_d| <= 1, with coefficients of shape (_WAVES, terms).
    """
    # k = _HIGHEST s^4 and equal steps of s: powers k^alpha at the origin become smooth enough for equal weights.
    s = np.arange(1, _WAVES + 1) / _WAVES
    k = _HIGHEST * s**4
    surface = {2: 2.0 * np.pi, 3: 4.0 * np.pi}[dim]
    volume = surface * k ** (dim - 1) * (4.0 * k / s / _WAVES) / (2.0 * np.pi) ** dim
    # An even function of the phase k |x| <= _HIGHEST sqrt(dim) takes half as many terms; a few are added to spare.
    terms = 24 + int(0.5 * _HIGHEST * np.sqrt(dim))
    angle = (np.arange(terms) + 0.5) * (np.pi / terms)
    z = np.outer(k, np.sqrt(dim) * np.cos(0.5 * angle))
    mean, slope = (j0(z), j1(z) / z) if dim == 2 else (spherical_jn(0, z), spherical_jn(1, z) / z)
    to_series = (2.0 / terms) * np.cos(np.outer(angle, np.arange(terms)))
    to_series[:, 0] *= 0.5
    return k, volume, mean @ to_series, slope @ to_series


def transforms(k: np.ndarray, alpha: float, dim: int, sharpness: float) -> np.ndarray:
    """The transforms of psi_1 and psi_2, shape (2, ..): pi^(dim/2) c^q E_{1+q}(k^2 / 4 c) / Gamma(dim/2 + q).

    q = alpha / 2 and alpha. The exponential integral E_p is an incomplete gamma function for p < 1. Greater p follow
    from p E_{p+1}(z) = e^-z - z E_p(z), unless p is so small that the two terms cancel.
    """
    z = k * k / (4.0 * sharpness)
    decay = np.exp(-z)
    found = []
    for q in (0.5 * alpha, alpha):
        p = q % 1.0
        integral = z ** (p - 1.0) * gammaincc(1.0 - p, z) * gamma(1.0 - p)
        integral = _next_integral(p, z) if p < _SMALL else (decay - z * integral) / p
        if q > 1.0:
            integral = (decay - z * integral) / (p + 1.0)
        found.append(np.pi ** (0.5 * dim) * sharpness**q / gamma(0.5 * dim + q) * integral)
    return np.array(found)


def _next_integral(p: float, z: np.ndarray) -> np.ndarray:
    """E_{1+p}(z), 0 < p < 0.1: by its series up to z = 1, from there by a continued fraction (DLMF 8.19.10, 17).

    Gamma(-p) z^p and the first term of the series each have the pole 1 / p, which is left out of both.
    """
    k = np.arange(1.0, 20.0)
    small = np.minimum(z, 1.0)
    terms = (-small[..., None]) ** k / (gamma(k + 1.0) * (k - p))
    # The logarithm of Gamma(1 - p).
    log_gamma = np.euler_gamma * p + (zeta(k + 1.0) * p ** (k + 1.0) / (k + 1.0)).sum()
    near = -np.expm1(log_gamma + p * np.log(small)) / p - terms.sum(axis=-1)
    large, far = np.maximum(z, 1.0), np.zeros_like(z)
    for j in range(80, 0, -1):
        far = j * (p + j) / (large + 1.0 + p + 2.0 * j - far)
    return np.where(z < 1.0, near, np.exp(-z) / (large + 1.0 + p - far))


@njit()
def _sum_series(coefficients, x, out):
    """out = sum_m c_m T_m(x) for each row of the coefficients."""
    last, new = np.empty(_BLOCK), np.empty(_BLOCK)
    for start in range(0, x.size, _BLOCK):
        part = x[start : start + _BLOCK]
        before = np.ones(_BLOCK)
        last[: part.size] = part
        for f in range(coefficients.shape[0]):
            total = out[f, start : start + _BLOCK]
            for i in range(part.size):
                total[i] = coefficients[f, 0] + coefficients[f, 1] * part[i]
        for m in range(2, coefficients.shape[1]):
            for i in range(part.size):
                new[i] = 2.0 * part[i] * last[i] - before[i]
                before[i] = last[i]
                last[i] = new[i]
            for f in range(coefficients.shape[0]):
                c, total = coefficients[f, m], out[f, start : start + _BLOCK]
                for i in range(part.size):
                    total[i] += c * last[i]
