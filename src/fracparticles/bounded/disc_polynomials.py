r"""The absorbing disc by polynomials instead of particles; tests compare `disc` with it.

On the unit disc, with s = alpha/2 and P_n^(s,l) Jacobi's polynomials,

    (-Laplacian)^s ((1 - r^2)^s V P_n^(s,l)(2 r^2 - 1)) = mu_n V P_n^(s,l)(2 r^2 - 1),     V = r^l cos(l theta),
    mu_n = 2^alpha Gamma(1+s+n) Gamma(1+s+l+n) / (n! (l+n)!),

Dyda, Kuznetsov & Kwasnicki, Constr. Approx. 45 (2017) 427, Theorem 3. In this basis the quadratic form of the operator
is diagonal; the mass matrix follows from Gauss-Jacobi quadratures. The eigenvalues converge from above: with 20
polynomials the first have ten digits (J. London Math. Soc. 95 (2017) 500 bounds them from both sides).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.linalg import eigh
from scipy.special import eval_jacobi, gammaln, roots_jacobi

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray

__all__ = ["AbsorbingDisc"]


class AbsorbingDisc:
    """Fields f(r) cos(l theta) on the unit disc, u = 0 outside.

    Parameters
    ----------
    alpha : float
        0 < alpha < 2; orders below one serve to compare with printed values.
    wave : int
        The wave number l.
    terms : int
        The number of polynomials, up to 60.

    Attributes
    ----------
    eigenvalues : array, shape (terms,)
        In rising order; the first third of them is accurate to round-off.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """

    def __init__(self, alpha: float, wave: int = 0, terms: int = 40) -> None:
        alpha = check.real_between("alpha", alpha, 0.0, 2.0, inside=True)
        self._wave, terms = (
            check.whole_number("wave", wave),
            check.positive_integer("terms", terms, 60),
        )
        self._s, self._n = 0.5 * alpha, np.arange(terms)
        s, n, wave = self._s, self._n, self._wave
        logarithm = gammaln(1.0 + s + n) + gammaln(1.0 + s + wave + n)
        mu = np.exp(logarithm - gammaln(n + 1.0) - gammaln(wave + n + 1.0)) * 2.0**alpha
        # r dr = dt / 4 and r^2 = (1 + t) / 2, 1 - r^2 = (1 - t) / 2 for t = 2 r^2 - 1: common factors are left out.
        form = mu[:, None] * self._gram(s)
        self._mass = 2.0**-s * self._gram(alpha)
        self.eigenvalues, self._vectors = eigh(0.5 * (form + form.T), self._mass)

    def evolve(
        self, profile: Callable[[FloatArray], Any], time: float, r: FloatArray
    ) -> FloatArray:
        """Return u(r, time) of the initial field (1 - r^2)^(alpha/2) r^l p(r), at distances r from the centre.

        Parameters
        ----------
        profile : callable
            p(r).
        time : float
        r : array
            The result has its shape.

        Raises
        ------
        InvalidInput
            If the time is negative.
        """
        t = check.not_negative("time", time)
        nodes, weights = roots_jacobi(2 * self._n.size + 8, 2.0 * self._s, self._wave)
        at = np.sqrt(0.5 * (1.0 + nodes))
        moments = self._polynomials(nodes) @ (weights * profile(at)) * 2.0**-self._s
        parts = np.exp(-self.eigenvalues * t) * (self._vectors.T @ moments)
        values = (self._vectors @ parts) @ self._polynomials(2.0 * np.square(r) - 1.0)
        return np.asarray((1.0 - np.square(r)) ** self._s * np.asarray(r) ** self._wave * values)

    def _gram(self, power: float) -> FloatArray:
        """Return int (1 - t)^power (1 + t)^l P_m P_n dt."""
        nodes, weights = roots_jacobi(2 * self._n.size + 8, power, self._wave)
        values = self._polynomials(nodes)
        return np.asarray((values * weights) @ values.T)

    def _polynomials(self, t: FloatArray) -> FloatArray:
        return np.array([eval_jacobi(n, self._s, self._wave, t) for n in self._n])
