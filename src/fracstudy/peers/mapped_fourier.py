"""A Fourier pseudospectral method on the whole line, x = L cot s, 0 < s < pi: no truncation.

The basis lambda_k(x) = ((x + i L) / (x - i L))^k = e^(2 i k s), the Higgins functions, is that of Cayama, Cuesta &
de la Hoz, Appl. Math. Comput. 389 (2021) 125577 and Appl. Numer. Math. 158 (2020) 164. Their fractional Laplacian
follows from the Laplace transform of Laguerre polynomials (DLMF 18.17): with p = (L + i x) / (2 L), so that
(p - 1) / p = lambda_1,

    1 - lambda_k(x) = int_0^inf L^(1)_(k-1)(t) e^(-p t) dt,    k > 0:

each is a sum of waves e^(-i x t / (2 L)), which -(-Laplacian)^(alpha/2) multiplies by -(t / (2 L))^alpha. With
L^(1)_m = sum_i (1-alpha)_(m-i) / (m-i)! L^(alpha)_i (DLMF 18.18), at any x

    -(-Laplacian)^(alpha/2) lambda_k = (2 L)^(-alpha) p^(-1-alpha) sum_{i<k} (1-alpha)_(k-1-i) / (k-1-i)!
                                       Gamma(1+alpha+i) / i! lambda_1^i,                                       (apply)

and lambda_(-k) is the complex conjugate. In time, u = c + 2 Re sum_{k=1}^K a_k (lambda_k - 1) is advanced by Galerkin's
method with the weight t, for which the L^(1) are orthogonal: with b_k = sqrt(k) a_k,

    db/dt = -(2 L)^(-alpha) S b,    S_jk = (j k)^(-1/2) int t^(1+alpha) e^(-t) L^(1)_(j-1) L^(1)_(k-1) dt        (solve)
          = (j k)^(-1/2) sum_i w_(j-1-i) w_(k-1-i) Gamma(2+alpha+i) / i!,   w_m = (-alpha)_m / m!,

a positive definite matrix: its exponential is computed once from its eigenvectors. The constant c, the interpolant at
infinity, does not move. A solve is a transform, a product with a K x K matrix, and a transform back.

Solutions that fall like |x|^(-1-alpha) are |s|^(1+alpha) at s = 0: the error falls like N^(-1-alpha), not
exponentially.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.fft import ifft, irfft, rfft
from scipy.linalg import eigh, toeplitz
from scipy.special import poch

from fracparticles.errors import InvalidInput
from fracstudy.peers.base import Peer, Task, half_intervals

__all__ = ["PEER", "MappedFourierSolver", "galerkin_matrix"]

_MOST = 8001  # points: the dense matrices then take 128 MB each


@dataclass(frozen=True)
class MappedFourierSolver:
    """The method made ready, see `base.Solver`.

    Attributes
    ----------
    x, volumes : array, shape (N,)
        x = L cot s at the midpoints s of N equal intervals, in ascending order; dx/ds times pi / N.
    scale : float
        L.
    alpha : float
    propagator : array, shape (K, K)
        From a_k at time 0 to a_k at the time prepared for, K = (N - 1) / 2.
    """

    x: np.ndarray
    volumes: np.ndarray
    scale: float
    alpha: float
    propagator: np.ndarray
    _shift: np.ndarray  # e^(-i k pi / N): the first node is half an interval from s = 0

    def solve(self, u0: np.ndarray) -> np.ndarray:
        """Return u at the time prepared for."""
        a = self._coefficients(u0)
        # A real matrix: real and imaginary parts as two columns.
        moved = (self.propagator @ a[1:].view(float).reshape(-1, 2)).view(complex)[:, 0]
        a[0] += 2.0 * (a[1:].real.sum() - moved.real.sum())
        a[1:] = moved
        return self._values(a)

    def apply(self, u: np.ndarray) -> np.ndarray:
        """Return -(-Laplacian)^(alpha/2) of the interpolant of u at x: exact, without the projection of `solve`."""
        alpha, a = self.alpha, self._coefficients(u)[1:]
        mixing = toeplitz(binomials(1.0 - alpha, a.size), np.zeros(a.size))
        inner = mixing.T @ a
        inner *= poch(np.arange(1.0, a.size + 1.0), alpha)
        waves = ifft(inner * self._shift[:-1].conj(), self.x.size, norm="forward")[::-1]
        p = (self.scale + 1j * self.x) / (2.0 * self.scale)
        return np.asarray((2.0 * self.scale) ** -alpha * 2.0 * (p ** (-1.0 - alpha) * waves).real)

    def _coefficients(self, u: np.ndarray) -> np.ndarray:
        """Return a_k of u = sum_k a_k e^(2 i k s), k = 0 .. K; s ascends where x descends."""
        return rfft(u[::-1], norm="forward") * self._shift

    def _values(self, a: np.ndarray) -> np.ndarray:
        return irfft(a * self._shift.conj(), self.x.size, norm="forward")[::-1]


def binomials(a: float, count: int) -> np.ndarray:
    """Return (a)_m / m!, m = 0 .. count - 1."""
    m = np.arange(1.0, count)
    return np.cumprod([1.0, *((a + m - 1.0) / m)])


def galerkin_matrix(alpha: float, size: int) -> np.ndarray:
    """Return S_jk, j, k = 1 .. size."""
    w = toeplitz(binomials(-alpha, size), np.zeros(size))
    k = np.arange(1.0, size + 1.0)
    product = (w * poch(k, 1.0 + alpha)) @ w.T
    return np.asarray(product / np.sqrt(np.outer(k, k)))


def _prepared(task: Task) -> MappedFourierSolver:
    """L is the half-width: half of the points lie within |x| <= L; the spacing is that at x = 0, pi L / N."""
    alpha, scale = task.alpha, task.half_width
    modes = half_intervals(task, stretch=0.5 * np.pi)
    points = 2 * modes + 1
    if points > _MOST:
        raise InvalidInput("count", points, f"at most {_MOST} points", "Take fewer points.")
    s = (points - np.arange(points) - 0.5) * (np.pi / points)
    x = scale / np.tan(s)
    x[modes] = 0.0
    eigenvalues, vectors = eigh(galerkin_matrix(alpha, modes))
    decay = np.exp(-task.time * (2.0 * scale) ** -alpha * eigenvalues)
    root = np.sqrt(np.arange(1.0, modes + 1.0))
    return MappedFourierSolver(
        x=x,
        volumes=np.pi / points * scale / np.sin(s) ** 2,
        scale=scale,
        alpha=alpha,
        propagator=(vectors * decay) @ vectors.T * (root / root[:, None]),
        _shift=np.exp(-1j * np.pi / points * np.arange(modes + 1)),
    )


PEER = Peer(
    name="mapped-fourier",
    label="mapped Fourier",
    reference="Cayama, Cuesta & de la Hoz (2021), Appl. Math. Comput. 389, 125577",
    place=5,
    colour="#4B5D8C",
    marker="D",
    exteriors=("line",),
    propagations=("dense",),
    make=_prepared,
    scaled=True,
)
