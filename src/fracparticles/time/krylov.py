"""Steps for linear problems with constant coefficients, u' = A u + b, by Krylov spaces:

    u(t + tau) = u + tau phi_1(tau A) r,    r = A u + b,    phi_1(z) = (e^z - 1) / z.

In the space of r, A r, .. A^(m-1) r, with the orthonormal basis V_m and the Hessenberg matrix H_m of Arnoldi,

    tau phi_1(tau A) r ~ |r| V_m tau phi_1(tau H_m) e_1,    error ~ |r| h_(m+1,m) |e_m^T tau^2 phi_2(tau H_m) e_1|,

Saad, SIAM J. Numer. Anal. 29 (1992) 209, Theorem 5.1. Both come from one exponential of H_m with two more rows. The
space does not depend on tau: a step that is too long is taken shorter, without another application of A. The sums are
done by einsum: unlike those of BLAS, their order does not depend on the number of threads.

A v is (R(s v) - b) / s. For s = 1 a large b would cancel all digits of A v. They are kept for s = T |b|, with T the
time of the run: the round-off of b is then an ulp of 1 / T in A, and A counts only if its size is that of 1 / T.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import expm

from fracparticles.time.steps import Absolute, absolute, blown_up, norm

__all__ = ["KrylovStep"]

_MOST = 40  # the most vectors of a space
_NUMBERS = 4_000_000  # the most numbers in all of them together
_FEWEST = 12  # vectors that a space may have in any case
_SHORTER, _LONGER = 0.2, 4.0  # the least and the greatest ratio of a step to the one before
_SAFETY = 0.85  # a step over the one that would just meet the tolerance
# The least share of u that a step leaves. A longer one would cost digits, and be judged by the size of u before it.
_FADED = 1e-3
_NOTHING = 1e-14  # the share of a vector outside a space, below which it lies in the space


class KrylovStep:
    """Steps of u' = R(u), R affine.

    Parameters
    ----------
    rate : callable
        R(u).
    size : int
        The number N of entries of u.
    rtol : float
    atol : float, or function of t and u
        The error of the run in the 2-norm is to be below rtol |u| + atol sqrt(N). Each step has a share of it by its
        length; |u| is the smaller of the norms before and after the step.
    run : float
        The time of the run.

    Attributes
    ----------
    accepted, rejected : int
        Steps taken, and lengths that were too long.
    largest : float
        The largest |lambda| found in a space.
    """

    def __init__(
        self,
        rate: Callable[[np.ndarray], np.ndarray],
        size: int,
        rtol: float,
        atol: Absolute,
        run: float,
    ) -> None:
        self._rate, self._rtol, self._atol, self._run = rate, rtol, atol, run
        self._most = max(_FEWEST, min(_MOST, size, _NUMBERS // size))
        self.accepted = self.rejected = 0
        self.largest = 0.0
        self._origin: np.ndarray | None = None  # R(0) = b
        self._size = 1.0  # s

    def advance(self, u: np.ndarray, span: float, start: float = 0.0) -> np.ndarray:
        """Return u after the time `span`, shape (N,).

        Raises
        ------
        NonFiniteSolution
            If it is not finite; says when.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            return self._advanced(u, span, start)

    def forget(self) -> None:
        """Do nothing: the right-hand side does not depend on time, and a step finds its length anew for each span."""

    def _advanced(self, u: np.ndarray, span: float, start: float) -> np.ndarray:
        if self._origin is None:
            self._origin = self._rate(np.zeros_like(u))
            self._size = max(1.0, _power_of_two(self._run * norm(self._origin)))
        left, tau = span, span
        while left > 0.0:
            r = self._rate(u)
            size = norm(r)
            if not np.isfinite(size):
                raise blown_up(start + span - left, u)
            if size == 0.0:
                return u
            basis, h = self._arnoldi(r / size)
            tau = min(tau, left)
            while True:
                weights, error = _phi(h, basis.shape[0], tau)
                new = u + size * np.einsum("i,ij->j", weights, basis)
                scale = min(self._allowed(start, u), self._allowed(start, new))
                allowed, error = scale * tau / self._run, size * error
                faded = 0.0 < norm(new) < _FADED * norm(u)
                if error <= allowed and not faded:
                    break
                self.rejected += 1
                shorter = _SAFETY * (allowed / error) ** (1.0 / basis.shape[0]) if error else 0.5
                tau *= max(_SHORTER, min(0.5, shorter) if faded else shorter)
            u = new
            if not np.isfinite(u).all():
                raise blown_up(start + span - left + tau, u)
            left = left - tau if left - tau > 1e-14 * span else 0.0
            self.accepted += 1
            if error > 0.0:
                tau *= min(_LONGER, _SAFETY * (allowed / error) ** (1.0 / basis.shape[0]))
            else:
                tau = left
        return u

    def _allowed(self, t: float, u: np.ndarray) -> float:
        return self._rtol * norm(u) + absolute(self._atol, t, u) * float(np.sqrt(u.size))

    def _arnoldi(self, first: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return V_m, shape (m, N), and H, shape (m + 1, m); m is smaller if the space is full."""
        basis = np.empty((self._most, first.size))
        h = np.zeros((self._most + 1, self._most))
        basis[0] = first
        for j in range(self._most):
            w = (self._rate(self._size * basis[j]) - self._origin) / self._size
            for _ in range(2):  # the second time removes what the first leaves by round-off
                along = np.einsum("ij,j->i", basis[: j + 1], w)
                w -= np.einsum("i,ij->j", along, basis[: j + 1])
                h[: j + 1, j] += along
            h[j + 1, j] = norm(w)
            if (
                not np.isfinite(h[j + 1, j])
                or h[j + 1, j] <= _NOTHING * np.abs(h[: j + 1, j]).max()
            ):
                break
            if j + 1 < self._most:
                basis[j + 1] = w / h[j + 1, j]
        m = j + 1
        if np.isfinite(h).all():
            self.largest = max(self.largest, float(np.abs(np.linalg.eigvals(h[:m, :m])).max()))
        return basis[:m], h[: m + 1, :m]


def _power_of_two(size: float) -> float:
    """Return the power of two at or below a size: a product with it has the digits of the other factor."""
    return float(np.ldexp(0.5, np.frexp(size)[1]))


def _phi(h: np.ndarray, m: int, tau: float) -> tuple[np.ndarray, float]:
    """Return tau phi_1(tau H) e_1, and h_(m+1,m) |e_m^T tau^2 phi_2(tau H) e_1|."""
    longer = np.zeros((m + 2, m + 2))
    longer[:m, :m] = tau * h[:m]
    longer[0, m] = longer[m, m + 1] = 1.0  # not times tau: its unit is arbitrary
    e = expm(longer)
    error = tau * h[m, m - 1] * tau * abs(e[m - 1, m + 1])
    return tau * e[:m, m], float(error) if np.isfinite(e).all() else np.inf
