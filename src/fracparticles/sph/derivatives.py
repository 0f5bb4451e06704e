r"""SPH derivatives: sums over the particles within 2 h.

    <grad f(x_i)>   = sum_j V_j f(x_j) grad_i W_ij,                                              (16)
    grad^c_i W_ij   = grad_i W_ij / L_i,     L_i = -sum_j V_j grad_i W_ij (x_i - x_j),      (18), (19)
    <grad^2 f(x_i)> = -2 sum_j V_j (f(x_j) - f(x_i)) x_ij grad^c_i W_ij / (x_ij^2 + eta^2),      (37)

V_j = m_j / rho_j. Equation (19) prints L_i^{-1} for what is L_i: the gradient of f(x) = x is then 1 and not L_i^2.
Equation (37), Brookshaw's, has eta = 0.0001 (1/h)^2 in print, far larger than a distance and of another dimension;
the paper's digits come with eta = 0.0001 h^2.
"""

from __future__ import annotations

import numba as nb
import numpy as np

from fracparticles.sph.cubic_spline import SUPPORT, dw

__all__ = ["BROOKSHAW_ETA", "correction", "gradient", "second_derivative"]

BROOKSHAW_ETA = 1.0e-4  # eta / h^2


def correction(z: np.ndarray, x: np.ndarray, volumes: np.ndarray, h: float) -> np.ndarray:
    """L_i of (19) at the points z, shape (M,), from the particles x, shape (N,). One dimension: a number each."""
    out = np.empty(z.size)
    _correction(z, x, volumes, h, *_neighbours(z, x, h), out)
    return out


def gradient(
    z: np.ndarray,
    x: np.ndarray,
    volumes: np.ndarray,
    f: np.ndarray,
    h: float,
    corrected: bool = True,
) -> np.ndarray:
    """<grad f> (16) at the points z, with the kernel gradient of (18) or, uncorrected, that of (22).

    Parameters
    ----------
    z : ndarray, shape (M,)
        Where.
    x, volumes, f : ndarray, shape (N,)
        Positions in rising order, volumes and values of the particles; f real or complex.
    h : float
        Smoothing length.
    corrected : bool
        Whether to divide by L_i.

    Returns
    -------
    ndarray, shape (M,), of the type of f
    """
    out = np.empty(z.size, dtype=f.dtype)
    _gradient(z, x, volumes * f, h, *_neighbours(z, x, h), out)
    return out / correction(z, x, volumes, h) if corrected else out


def second_derivative(
    z: np.ndarray,
    f_z: np.ndarray,
    x: np.ndarray,
    volumes: np.ndarray,
    f: np.ndarray,
    h: float,
    eta: float | None = None,
    corrected: bool = True,
) -> np.ndarray:
    """<grad^2 f> (37) at the points z, where f has the values f_z. Other parameters as in `gradient`.

    `eta` is that of the formula, by default 0.0001 h^2.
    """
    out = np.empty(z.size, dtype=f.dtype)
    eta = BROOKSHAW_ETA * h * h if eta is None else eta
    _brookshaw(z, f_z, x, volumes, f, h, eta, *_neighbours(z, x, h), out)
    return out / correction(z, x, volumes, h) if corrected else out


def _neighbours(z: np.ndarray, x: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
    """The first particle within 2 h of each point, and the first beyond."""
    return np.searchsorted(x, z - SUPPORT * h), np.searchsorted(x, z + SUPPORT * h)


@nb.njit(cache=True, nogil=True)
def _correction(z, x, volumes, h, first, end, out):
    for i in range(z.size):
        total = 0.0
        for j in range(first[i], end[i]):
            d = z[i] - x[j]
            total -= volumes[j] * dw(d / h) * d
        out[i] = total / (h * h)


@nb.njit(cache=True, nogil=True)
def _gradient(z, x, strengths, h, first, end, out):
    for i in range(z.size):
        total = 0.0 * strengths[0]
        for j in range(first[i], end[i]):
            total += strengths[j] * dw((z[i] - x[j]) / h)
        out[i] = total / (h * h)


@nb.njit(cache=True, nogil=True)
def _brookshaw(z, f_z, x, volumes, f, h, eta, first, end, out):
    for i in range(z.size):
        total = 0.0 * f[0]
        for j in range(first[i], end[i]):
            d = z[i] - x[j]
            if d != 0.0:  # the particle itself has no share
                total -= 2.0 * volumes[j] * (f[j] - f_z[i]) * d * dw(d / h) / (d * d + eta * eta)
        out[i] = total / (h * h)
