"""Eigenvalues of (-Laplacian)^(alpha/2) on (-1, 1), u = 0 outside, by Jacobi polynomials: for comparison.

With a = alpha / 2 (Dyda, Kuznetsov & Kwasnicki, Constr. Approx. 45 (2017) 427, Theorem 3)

    (-Laplacian)^a [(1 - x^2)^a P_n^(a, a)] = mu_n P_n^(a, a),   mu_n = Gamma(alpha + n + 1) / n!,

so that in the Galerkin method with these functions the operator is diagonal. Only these have to be computed:

    M_mn = int (1 - x^2)^alpha P_m P_n dx,   lambda = 1 / eigenvalue of (mu k)^(-1/2) M (mu k)^(-1/2),

k_n = int (1 - x^2)^a P_n^2 dx. The eigenvalues are upper bounds. alpha may be any number from 0 to 2: for alpha = 2 the
eigenvalues are those of the Laplacian, (n pi / 2)^2.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh
from scipy.special import eval_jacobi, gammaln, roots_jacobi

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray

__all__ = ["jacobi_eigenvalues"]


def jacobi_eigenvalues(alpha: float, count: int = 1, polynomials: int = 100) -> FloatArray:
    """Return the lowest eigenvalues, in ascending order, shape (count,).

    Parameters
    ----------
    alpha : float
        0 < alpha <= 2.
    count : int
        The number of eigenvalues, up to 100.
    polynomials : int
        The size of the basis, three times the count or more, up to 300.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """
    allowed, remedy = "a number with 0 < alpha <= 2", "Give the order of the operator."
    alpha = check.real_between("alpha", alpha, 1e-3, 2.0, allowed=allowed, remedy=remedy)
    count = check.positive_integer("count", count, 100)
    n = np.arange(check.whole_number("polynomials", polynomials, 3 * count, 300))
    half = 0.5 * alpha
    x, weights = roots_jacobi(n.size + 2, half, half)
    values = eval_jacobi(n[:, None], half, half, x)
    norms = (values**2) @ weights
    x, weights = roots_jacobi(n.size + 2, alpha, alpha)
    values = eval_jacobi(n[:, None], half, half, x)
    values /= np.exp(0.5 * (gammaln(alpha + n + 1.0) - gammaln(n + 1.0) + np.log(norms)))[:, None]
    inverse = eigh((values * weights) @ values.T, eigvals_only=True)
    return np.asarray(1.0 / inverse[::-1][:count])
