"""The spectrum of an operator on a bounded lattice: its interval, power iteration, dense eigenvalues."""

from __future__ import annotations

import numpy as np

from fracparticles.case import Case
from fracparticles.errors import FracparticlesError
from fracparticles.operators import Operator
from fracparticles.schemes import SCHEMES
from fracparticles.stability import symbol_range

__all__ = ["dense_matrix", "power_iteration", "spectral_interval"]

# The eigenvalues lie inside the symbol's range up to round-off; a little room costs nothing.
_MARGIN = 1e-6


def spectral_interval(case: Case, operator: Operator) -> tuple[float, float]:
    """Return an interval that holds the eigenvalues of A, as the Chebyshev series needs it.

    A truncated convolution (DD, FD) is a compression of the operator on the infinite lattice: its eigenvalues lie
    in the range of the symbol. A truncated exchange is the compression plus a diagonal, the weights that lead out
    of the lattice: positive weights only raise the eigenvalues, to nil at most, and where weights change sign (KPSE
    of order IV from beta = 0.85, of higher orders) the lowest falls by no more than the least element of that
    diagonal (Weyl). DPSE is the product of a negative and a positive symmetric matrix, so that its eigenvalues are
    real. That they lie in the range of the symbol, and that those of FPSE and of the open exterior do and are real,
    was found by computation (tests/test_spectrum.py), but for FPSE of order 6 and more on a truncated lattice: at
    some overlaps (2.9) an eigenvalue is up to 1e-5 of the range above it, so little that the series, of entire
    functions, keeps its digits (tests/test_schemes_high_order.py). Where there are positive eigenvalues, for scheme
    (29) or an overlap too small for the order, the greatest is computed.
    """
    low, high = symbol_range(
        case.scheme, case.beta, case.order, case.epsilon_over_h, case.dim, case.kernel_family
    )
    rate, room = case.setting.rate, _MARGIN * (high - low)
    if not SCHEMES[case.scheme].DISSIPATIVE or high > room:
        high = max(high, _greatest_eigenvalue(operator) / rate)
    return rate * (low - room) + operator.least_excess, rate * (high + room)


def power_iteration(
    operator: Operator, tolerance: float = 1e-10, most: int = 20000, seed: int = 1
) -> tuple[float, int]:
    """Return the eigenvalue of A of the greatest modulus and the number of iterations (paper, Sec. 4.4).

    v <- A v / |A v| with the Rayleigh quotient as the estimate, until it changes by less than `tolerance`,
    relative, over ten iterations.

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
        operator.update(v, 1.0, 0.0, 0.0, w)
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


def _greatest_eigenvalue(operator: Operator) -> float:
    from scipy.sparse.linalg import LinearOperator, eigs  # 0.3 s, and hardly ever needed

    matrix = LinearOperator((operator.size,) * 2, matvec=operator.apply, dtype=float)
    start = np.ones(operator.size)
    value = eigs(matrix, k=1, which="LR", v0=start, return_eigenvectors=False, tol=1e-6)
    return float(value[0].real)
