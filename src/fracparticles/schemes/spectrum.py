"""The spectrum of an operator on a bounded lattice: its interval, power iteration, dense eigenvalues."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from fracparticles.errors import FracparticlesError
from fracparticles.lattice.operators import LatticeOperator, Operator
from fracparticles.schemes.discovery import scheme
from fracparticles.schemes.setting import Setting
from fracparticles.schemes.stability import grows, range_in

__all__ = [
    "dense_matrix",
    "eigenvalue_bounds",
    "largest_degree",
    "power_iteration",
    "scheme_matrix",
    "spectral_interval",
]

# Margin of the interval, as a share of its length. Below the range of the symbol the function of time is bounded, and a
# small margin costs nothing; above zero the function would grow.
_ROOM = 1e-6
_ROOM_OF_A_TABLE = 1e-2  # the same in a box with interpolated kernels, which change the eigenvalues
# Largest margin below, as a share of |lambda_min| / n for n steps: steps at the stability limit amplify waves below the
# range of the symbol, and with this margin a run amplifies them by two at most.
_ROOM_OF_STEPS = 0.1
# Where the eigenvalues are not proved to be real and in the interval, T_k of the operator may grow like exp(g k). The
# coefficients of a series of degree K fall like exp(-74 (k / K)^2), so that its terms grow by exp((g K)^2 / 300) at
# most. g was measured (tests/run/test_stiff.py): g < 0.001 on the line with exact kernels, unless the ends amplify, and
# otherwise g < 0.1. This allows K = 10000 and K = 400.
_LARGEST_DEGREE = {"line": 10_000, "other": 400}
# Half the intervals of a small lattice, per overlap and at most: it is some reaches of the kernels long, and its
# eigenvalues take milliseconds.
_FEW_OVERLAPS, _FEW = 24, 150


def eigenvalue_bounds(
    name: str, setting: Setting, operator: LatticeOperator
) -> tuple[float, float]:
    """Return bounds of the real parts of the eigenvalues of A, at most zero if nothing grows.

    They are the range of the symbol on an infinite lattice, plus what the ends of a bounded lattice add to it.

    Parameters
    ----------
    name : str
        The scheme.
    setting : Setting
    operator : LatticeOperator
        A of the scheme in this setting.

    Notes
    -----
    A truncated convolution (DD, FD) is a compression of the operator on the infinite lattice: its eigenvalues lie
    in the range of the symbol. A truncated exchange is the compression plus a diagonal, the weights that lead out
    of the lattice. Positive weights only raise the eigenvalues, to zero at most. Where weights change sign (KPSE
    of order IV from beta = 0.85, and of higher orders), the lowest falls by no more than the least element of this
    diagonal (Weyl). DPSE is the product of a negative and a positive symmetric matrix, so that its eigenvalues are
    real. On the line the symbol takes the interpolation of kernels into account.

    The rest was found by computation, not proved (tests/schemes/test_spectrum.py): exchanges whose weights change sign
    stay below zero, and the eigenvalues of DPSE, FPSE and of the open exterior lie in the range of the symbol and are
    real on the line. `largest_degree` keeps the series short enough for the known deviations, and the evaluation
    checks the size of its terms. Where the ends amplify (FPSE from order 6 on), the largest eigenvalue lies up to 3e-4
    of the range above zero. It does not depend on the size of the lattice, and is computed on a small one. Where there
    are positive eigenvalues, for scheme (29) or an overlap too small for the order, the largest is computed.
    """
    low, high = range_in(name, setting)
    one, rate = scheme(name), setting.rate
    if not one.dissipative or grows(low, high):
        high = max(high, _greatest_eigenvalue(operator, rate * high) / rate)
    elif one.ends_amplify(setting):
        few = min(setting.n, _FEW, int(np.ceil(_FEW_OVERLAPS * setting.overlap)))
        small = replace(setting, n=few, spacing=1.0, diffusivity=1.0)
        high = max(0.0, _greatest_by_matrix(name, small))
    else:
        high = max(0.0, high)
    return rate * low + operator.diagonal_shift[0], rate * high


def spectral_interval(
    name: str, setting: Setting, operator: LatticeOperator, steps: int = 0
) -> tuple[float, float]:
    """Return an interval that holds the eigenvalues of A, as the Chebyshev series needs it.

    It consists of their bounds, with a margin. For a dissipative scheme it ends exactly at zero, since a series of
    exp(z t) grows with any part above zero.

    Parameters
    ----------
    name, setting, operator
        As for `eigenvalue_bounds`.
    steps : int
        The number of time steps that the series stands for; 0 for the exponential.
    """
    low, high = eigenvalue_bounds(name, setting, operator)
    tabulated_box = setting.kernel_table is not None and setting.dim > 1
    room = (_ROOM_OF_A_TABLE if tabulated_box else _ROOM) * (high - low)
    below = min(room, -_ROOM_OF_STEPS * low / steps) if steps else room
    positive = grows(*range_in(name, setting)) or not scheme(name).dissipative
    return low - below, high + room if positive else high


def largest_degree(name: str, setting: Setting, operator: LatticeOperator) -> int | None:
    """Return the largest degree of a Chebyshev series of A; None if its spectrum is proved to lie in the interval."""
    exact = setting.kernel_table is None
    if operator.symmetric and exact:
        return None
    on_the_line = setting.dim == 1 and exact and not scheme(name).ends_amplify(setting)
    return _LARGEST_DEGREE["line" if on_the_line else "other"]


def power_iteration(
    operator: Operator, tolerance: float = 1e-10, most: int = 20000, seed: int = 1
) -> tuple[float, int]:
    """Return the eigenvalue of A of the largest modulus and the number of iterations (paper, Sec. 4.4).

    v <- A v / |A v| with the Rayleigh quotient as the estimate, until its relative change over ten iterations is less
    than `tolerance`.

    Raises
    ------
    FracparticlesError
        If it does not converge within `most` iterations.
    """
    v = np.random.default_rng(seed).standard_normal(operator.size)
    v /= np.linalg.norm(v)
    w = np.zeros_like(v)
    before = 0.0
    for iteration in range(1, most + 1):
        operator.combine(v, w, 1.0)
        estimate = float(v @ w)
        v, w = w / np.linalg.norm(w), v
        if iteration % 10 == 0:
            if abs(estimate - before) <= tolerance * abs(estimate):
                return estimate, iteration
            before = estimate
    raise FracparticlesError(f"power iteration: no convergence within {most} iterations")


def dense_matrix(operator: Operator) -> np.ndarray:
    """Return A as an N x N array, column by column; for small N."""
    return np.array([operator.apply(column) for column in np.eye(operator.size)]).T


def scheme_matrix(name: str, setting: Setting) -> np.ndarray:
    """Return A of a scheme in a setting as an N x N array; for small N."""
    return dense_matrix(scheme(name).operator(setting))


def _greatest_eigenvalue(operator: LatticeOperator, of_the_symbol: float) -> float:
    """The largest real part of the eigenvalues, or an upper bound of it where the iteration does not converge."""
    # Imported here: this takes 0.3 s, and is hardly ever needed.
    from scipy.sparse.linalg import ArpackError, LinearOperator, eigs, eigsh

    matrix = LinearOperator((operator.size,) * 2, matvec=operator.apply, dtype=float)
    start = np.ones(operator.size)
    try:
        if operator.symmetric:
            value = eigsh(matrix, k=1, which="LA", v0=start, return_eigenvectors=False, tol=1e-6)
        else:
            value = eigs(matrix, k=1, which="LR", v0=start, return_eigenvectors=False, tol=1e-6)
    except ArpackError:  # Weyl, for a symmetric operator
        return max(of_the_symbol, 0.0) + operator.diagonal_shift[1]
    return float(value[0].real)


@lru_cache(maxsize=64)
def _greatest_by_matrix(name: str, setting: Setting) -> float:
    return float(np.linalg.eigvals(scheme_matrix(name, setting)).real.max())
