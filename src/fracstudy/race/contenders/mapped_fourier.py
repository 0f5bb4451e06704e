"""A Fourier method on the line, x = L cot s, 0 < s < pi, by Galerkin's method with a matrix exponential.

With the basis ((x + i L) / (x - i L))^k = e^(2 i k s) and b_k = sqrt(k) a_k, db/dt = -(2 L)^(-alpha) S b,

    S_jk = (j k)^(-1/2) sum_i w_(j-1-i) w_(k-1-i) Gamma(2+alpha+i) / i!,    w_m = (-alpha)_m / m!.
"""

from __future__ import annotations

import numpy as np
from scipy.fft import irfft, rfft
from scipy.linalg import eigh, toeplitz
from scipy.special import poch

from fracstudy.race.contender import Mapped, Ready
from fracstudy.race.problem import Problem


class MappedFourier(Mapped):
    """A transform, a real matrix, and back."""

    name = label = "mapped Fourier"
    reference = "Cayama, Cuesta & de la Hoz (2021), Appl. Math. Comput. 389, 125577"
    place, colour, marker = 4, "#4B5D8C", "D"
    counts, scales = (17, 25, 33, 49, 65, 97, 129, 193), (0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.5)

    def prepare(self, problem: Problem, variant: str, points: int, scale: float) -> Ready:
        """Return the exponential made ready."""
        modes, alpha = points // 2, problem.alpha
        s = (points - np.arange(points) - 0.5) * (np.pi / points)
        k, m = np.arange(1.0, modes + 1.0), np.arange(1.0, modes)
        w = toeplitz(np.cumprod([1.0, *((m - 1.0 - alpha) / m)]), np.zeros(modes))
        galerkin = (w * poch(k, 1.0 + alpha)) @ w.T / np.sqrt(np.outer(k, k))
        values, vectors = eigh(galerkin)
        decay = np.exp(-problem.time * (2.0 * scale) ** -alpha * values)
        matrix = ((vectors * decay) @ vectors.T * np.sqrt(k / k[:, None])).T
        shift = np.exp(-1j * np.pi / points * np.arange(modes + 1))

        def solve(u0: np.ndarray) -> np.ndarray:
            a = rfft(u0[..., ::-1], norm="forward") * shift
            moved = a[..., 1:].real @ matrix + 1j * (a[..., 1:].imag @ matrix)
            a[..., 0] += 2.0 * (a[..., 1:].real.sum(axis=-1) - moved.real.sum(axis=-1))
            a[..., 1:] = moved
            return irfft(a * shift.conj(), points, norm="forward")[..., ::-1]

        volumes = np.pi / points * scale / np.sin(s) ** 2
        return Ready((scale / np.tan(s),), volumes, solve, batched=True)
