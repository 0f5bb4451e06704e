"""Smooth particles (9), the derivative as an integral operator (18), and its sum over particles (21)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fracparticles.errors import InvalidInput
from fracparticles.pse.moments import nodes_and_weights
from fracparticles.pse.shapes import Kernel

__all__ = ["derivative", "lattice", "reconstruct", "regularised"]

FloatArray = NDArray[np.float64]


def lattice(low: float, high: float, h: float) -> FloatArray:
    """Return the particles i h from the last below `low` to the first above `high`."""
    return h * np.arange(np.floor(low / h), np.ceil(high / h) + 1.0)


def reconstruct(
    x: ArrayLike,
    particles: FloatArray,
    values: FloatArray,
    volumes: ArrayLike,
    epsilon: float,
    kernel: Kernel,
) -> FloatArray:
    """f_eps^h(x) = sum_p f(x_p) V_p eta_eps(x - x_p)  (9).

    Parameters
    ----------
    x : array_like, shape (M,)
        Where.
    particles, values : array, shape (N,)
        x_p and f(x_p).
    volumes : array_like, shape (N,) or ()
        V_p.
    epsilon : float
        Kernel radius, positive.
    kernel : Kernel
        eta.

    Returns
    -------
    array, shape (M,)
    """
    return _matrix(x, particles, volumes, epsilon, kernel) @ values


def derivative(
    x: ArrayLike,
    at: ArrayLike,
    particles: FloatArray,
    values: FloatArray,
    volumes: ArrayLike,
    epsilon: float,
    kernel: Kernel,
    order: int,
) -> FloatArray:
    """eps^-beta sum_p [f(x_p) - f(x)] V_p eta_eps(x - x_p), the sum of (18); (21) for beta = 2.

    Parameters
    ----------
    x, at : array_like, shape (M,)
        The points, and f there.
    order : int
        beta.
    particles, values, volumes, epsilon, kernel
        As in `reconstruct`.

    Returns
    -------
    array, shape (M,)
    """
    weights = _matrix(x, particles, volumes, epsilon, kernel)
    differences = np.asarray(values) - np.asarray(at, dtype=float)[:, None]
    return (weights * differences).sum(axis=1) / epsilon**order


def regularised(
    f: Callable[[FloatArray], FloatArray],
    x: ArrayLike,
    epsilon: float,
    kernel: Kernel,
    order: int,
) -> FloatArray:
    """eps^-beta int [f(x - eps z) - f(x)] eta(z) dz, the integral (18); for beta = 0 the integral of (9).

    The sum without its quadrature error: what is left against the derivative is the error of regularisation.

    Returns
    -------
    array, shape (M,)
    """
    x = np.asarray(x, dtype=float)
    z, w = nodes_and_weights(kernel)
    shifted = f(x[:, None] - epsilon * z)
    if order > 0:
        shifted = shifted - f(x)[:, None]
    return shifted @ (w * kernel(z)) / epsilon**order


def _matrix(
    x: ArrayLike, particles: FloatArray, volumes: ArrayLike, epsilon: float, kernel: Kernel
) -> FloatArray:
    """V_p eta_eps(x - x_p), shape (M, N)."""
    if not (np.isfinite(epsilon) and epsilon > 0.0):
        raise InvalidInput("epsilon", epsilon, "positive and finite", "Give the kernel radius.")
    z = (np.asarray(x, dtype=float)[:, None] - particles) / epsilon
    return kernel(z) * (np.asarray(volumes, dtype=float) / epsilon)
