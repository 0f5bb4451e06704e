"""Kernels from the moment conditions of Sec. 2.2: for the derivative of order beta with accuracy r,

    M_k = 0 for k in S = {1, ..., beta + r - 1} without beta,    M_beta = (-1)^beta beta!.

With the symmetry (19) every other condition holds automatically. The remaining conditions are a linear system for the
coefficients of a polynomial times a Gaussian, or for the values of a kernel at the points of a lattice.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import factorial
from numbers import Rational
from typing import Any

import numpy as np

from fracparticles.arguments import dimension, instance, real_between, whole_number
from fracparticles.errors import InvalidInput
from fracparticles.pse.moments import gaussian_moment, lattice_moment
from fracparticles.pse.shapes import GaussianKernel, Stencil, kernel_of

__all__ = [
    "construct",
    "construct_laplacian",
    "construct_stencil",
    "required_moments",
    "solve_exactly",
    "taylor_constant",
]

_MOST = 24  # beta + r: for every three the values of the kernel lose about a digit
# The least and the greatest overlap. Below the least a kernel is 1e7 times as large between the particles as at them.
_OVERLAPS = (0.25, 1000.0)
_WORST = 1e10  # condition number up to which the conditions are met to six digits


def required_moments(derivative: int, accuracy: int) -> dict[int, int]:
    """Return k -> M_k for all conditions of Sec. 2.2; derivative 0 is the function itself, M_0 = 1 by (5).

    Raises `InvalidInput` unless beta >= 0 and r >= 1 are whole numbers with beta + r <= 24.
    """
    derivative = whole_number("derivative", derivative)
    accuracy = whole_number("accuracy", accuracy, least=1)
    if derivative + accuracy > _MOST:
        remedy = "The kernel would drown in round-off."
        raise InvalidInput("accuracy", accuracy, f"derivative + accuracy <= {_MOST}", remedy)
    first = 0 if derivative == 0 else 1  # f(y) - f(x) in (18) frees M_0
    return {
        k: (-1) ** derivative * factorial(derivative) if k == derivative else 0
        for k in range(first, derivative + accuracy)
    }


def construct(derivative: int, accuracy: int, overlap: float | None = None) -> GaussianKernel:
    """Return the kernel c_j z^(p + 2 j) exp(-z^2) / sqrt(pi), p = beta mod 2, that meets the conditions.

    Errors as for `required_moments`; also if the lattice has too few points within the kernel for the conditions.

    Parameters
    ----------
    derivative, accuracy : int
        beta and r; an odd r gives r + 1 by symmetry.
    overlap : float, optional
        eps / h of a lattice, from 0.25 to 1000. The conditions are then met on this lattice, (28), and not over the
        line: the sum over the lattice has no quadrature error in them, however few particles a kernel holds. Without
        it the coefficients are exact fractions.
    """
    conditions = required_moments(derivative, accuracy)
    parity = derivative % 2
    conditions = _of_parity(conditions, parity)
    powers = range(parity, parity + 2 * len(conditions), 2)
    if overlap is None:
        coefficients, condition = _solve(conditions, lambda k, j: gaussian_moment(k + powers[j]))
        return GaussianKernel(coefficients, parity, 1, condition)
    overlap = real_between("overlap", overlap, *_OVERLAPS)
    matrix = np.array(
        [[_lattice_moment_of_power(k + power, overlap) for power in powers] for k in conditions]
    )
    condition = float(np.linalg.cond(matrix))
    if not condition < _WORST:
        allowed = f"enough particles in a kernel for {len(conditions)} conditions"
        remedy = "Take a larger overlap, or construct_stencil."
        raise InvalidInput("overlap", overlap, allowed, remedy)
    solution = np.linalg.solve(matrix, np.array(list(conditions.values()), dtype=float))
    return GaussianKernel(tuple(solution.tolist()), parity, 1, condition)


def construct_laplacian(accuracy: int, dim: int) -> GaussianKernel:
    """Return the radial kernel of the Laplacian in d dimensions, accuracy r.

    The Taylor series of f around x, averaged over directions, gives

        eps^-2 int [f(y) - f(x)] eta_eps(x - y) dy
            = sum_k eps^(2k-2) I_2k Lap^k f(x) / (4^k k! (d/2)_k),   I_2k = int |z|^2k eta dz,

    so that I_2 = 2 d and I_4 = ... = I_r = 0. For d = 1 it is `construct(2, r)`.

    Errors as for `required_moments`; also if d is not 1, 2 or 3.
    """
    dim = dimension(dim)
    conditions = _of_parity(required_moments(2, accuracy), 0)
    conditions[2] *= dim
    coefficients, condition = _solve(conditions, lambda k, j: gaussian_moment(k + 2 * j, dim))
    return GaussianKernel(coefficients, 0, dim, condition)


def construct_stencil(derivative: int, accuracy: int) -> Stencil:
    """Return the narrowest kernel on the lattice with eps = h: the discrete conditions (28) for its values.

    With (18) it is the centred finite difference of accuracy r; beta = 2, r = 2 gives (31).

    Errors as for `required_moments`; also for beta = 0, where (9) at a particle is f itself.
    """
    conditions = required_moments(derivative, accuracy)
    if derivative == 0:
        raise InvalidInput("derivative", 0, "1 or more", "The function itself needs no stencil.")
    parity = derivative % 2
    conditions = _of_parity(conditions, parity)
    # The unknowns are eta(1), ..., eta(n); eta(-i) = (-1)^beta eta(i) doubles each.
    right, condition = _solve(conditions, lambda k, j: Fraction(2 * (j + 1) ** k))
    left = [(-1) ** derivative * v for v in reversed(right)]
    return Stencil((*left, Fraction(0), *right), condition)


def taylor_constant(kernel: GaussianKernel, derivative: int, accuracy: int) -> Fraction | float:
    """Return the constant of the first error term of (17), C eps^r f^(beta+r): (-1)^k M_k / k!, k = beta + r.

    It holds for an even r, in one dimension. |C| is C_1 of Sec. 2.2, with the norm of f^(beta+r), not f^(r).

    Errors as for `required_moments`; also if r is odd, or the kernel is not one-dimensional.
    """
    required_moments(derivative, accuracy)
    kernel_of(1, instance("kernel", kernel, GaussianKernel))
    if accuracy % 2:
        raise InvalidInput("accuracy", accuracy, "an even number", "An odd r gives r + 1.")
    k = derivative + accuracy
    powers = range(k + kernel.parity, k + kernel.parity + 2 * len(kernel.coefficients), 2)
    terms = (c * gaussian_moment(p) for p, c in zip(powers, kernel.coefficients, strict=True))
    return sum(terms, Fraction(0)) * (-1) ** k / factorial(k)


def solve_exactly(
    matrix: Sequence[Sequence[Fraction]], right: Sequence[Fraction]
) -> list[Fraction]:
    """Solve a square linear system by Gauss elimination in fractions.

    Raises `InvalidInput` if the matrix is not square, not of whole numbers and fractions, or singular.
    """
    n = len(_listed("right", right))
    if len(_listed("matrix", matrix)) != n or any(len(_listed("matrix", r)) != n for r in matrix):
        raise InvalidInput("matrix", matrix, f"{n} rows of {n} numbers", "Make it square.")
    if not all(isinstance(v, Rational) for row in (*matrix, right) for v in row):
        raise InvalidInput("matrix", matrix, "whole numbers and fractions", "Convert them.")
    rows = [[*map(Fraction, row), Fraction(v)] for row, v in zip(matrix, right, strict=True)]
    for i in range(n):
        pivot = next((r for r in range(i, n) if rows[r][i]), None)
        if pivot is None:
            raise InvalidInput("matrix", matrix, "a regular matrix", "Check the equations.")
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [value / rows[i][i] for value in rows[i]]
        for r in range(len(rows)):
            if r != i:
                factor = rows[r][i]
                rows[r] = [a - factor * b for a, b in zip(rows[r], rows[i], strict=True)]
    return [row[-1] for row in rows]


def _solve(
    conditions: dict[int, int], entry: Callable[[int, int], Fraction]
) -> tuple[tuple[Fraction, ...], float]:
    matrix = [[entry(k, j) for j in range(len(conditions))] for k in conditions]
    solution = solve_exactly(matrix, [Fraction(value) for value in conditions.values()])
    return tuple(solution), float(np.linalg.cond(np.array(matrix, dtype=float)))


def _of_parity(conditions: dict[int, int], parity: int) -> dict[int, int]:
    """The conditions that (19) does not meet by itself."""
    return {k: value for k, value in conditions.items() if k % 2 == parity}


def _lattice_moment_of_power(power: int, overlap: float) -> float:
    """M^_0 of z^power exp(-z^2) / sqrt(pi) for an even power."""
    monomial = GaussianKernel((0.0,) * (power // 2) + (1.0,))
    return float(lattice_moment(monomial, 0, overlap))


def _listed(field: str, value: Any) -> Any:
    return instance(field, value, (list, tuple), "a list")
