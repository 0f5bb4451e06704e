"""Rational functions on the line (Malmquist, Takenaka, Christov), x = L tan(theta/2): no lattice, no truncation.

    phi_n(x) = (1 + i x/L)^n / (1 - i x/L)^(n+1) = (-1)^n / 2 int_0^inf l_n(s) exp(i s x / 2 L) ds,

l_n = e^(-s/2) L_n(s), so that exp(-t (-Laplacian)^(alpha/2)) has the elements

    (-1)^(m+n) int l_m l_n exp(-t (s / 2 L)^alpha) ds.

u (1 - i x/L) is a Fourier series in theta, whose coefficients are those of phi_n.
"""

from __future__ import annotations

import numpy as np
from scipy.fft import fft, ifft
from scipy.special import roots_laguerre

from fracstudy.race.contender import Mapped, Ready
from fracstudy.race.problem import Problem


class Rational(Mapped):
    """One transform, a real matrix, and back."""

    name = label = "rational functions"
    reference = "Christov (1982), SIAM J. Appl. Math. 42, 1337; Iserles & Webb (2020), J. Fourier Anal. Appl. 26, 19"
    place, colour, marker = 3, "#2E6E6E", "P"
    counts, scales = (16, 24, 32, 48, 64, 96, 128, 192), (0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.5, 7.0)

    def prepare(self, problem: Problem, variant: str, points: int, scale: float) -> Ready:
        """Return the matrix of the run made ready."""
        half = points // 2
        theta = (np.arange(points) + 0.5) * (2.0 * np.pi / points) - np.pi
        x = scale * np.tan(0.5 * theta)
        pole = 1.0 - 1j * x / scale
        s, functions, weights = _functions(half, 2 * half + 16)
        decay = np.exp(-problem.time * (s / (2.0 * scale)) ** problem.alpha) * weights
        matrix = (functions * decay) @ functions.T
        shift = np.exp(-1j * np.arange(half) * theta[0])

        def solve(u0: np.ndarray) -> np.ndarray:
            c = fft(u0 * pole, norm="forward")[..., :half] * shift
            c = (c.real @ matrix + 1j * (c.imag @ matrix)) * shift.conj()
            return 2.0 * (ifft(c, points, norm="forward") / pole).real

        volumes = (scale**2 + x**2) / (2.0 * scale) * (2.0 * np.pi / points)
        return Ready((x,), volumes, solve, batched=True)


def _functions(count: int, nodes: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the nodes s of Gauss' rule for Laguerre polynomials, (-1)^n l_n(s), and the weights times e^s."""
    s = roots_laguerre(nodes)[0]
    values = np.empty((nodes + 2, nodes))
    values[0] = np.exp(-0.5 * s)
    values[1] = (s - 1.0) * values[0]
    for n in range(1, nodes + 1):
        values[n + 1] = ((s - 2.0 * n - 1.0) * values[n] - n * values[n - 1]) / (n + 1.0)
    return s, values[:count], s / ((nodes + 1.0) * values[nodes + 1]) ** 2
