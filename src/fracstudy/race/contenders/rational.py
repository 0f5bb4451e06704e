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


class RationalLine:
    """An even number of points x on the line, and the coefficients with n >= 0 of a real u there."""

    def __init__(self, points: int, scale: float) -> None:
        self.count = points // 2
        theta = (np.arange(points) + 0.5) * (2.0 * np.pi / points) - np.pi
        self.x = scale * np.tan(0.5 * theta)
        self._pole = 1.0 - 1j * self.x / scale
        self._shift = np.exp(-1j * np.arange(self.count) * theta[0])

    def waves(self, u: np.ndarray) -> np.ndarray:
        """Return the coefficients, along the last axis."""
        return np.asarray(fft(u * self._pole, norm="forward")[..., : self.count] * self._shift)

    def values(self, c: np.ndarray) -> np.ndarray:
        """Return u at the points."""
        full = ifft(c * self._shift.conj(), self.x.size, norm="forward")
        return np.asarray(2.0 * (full / self._pole).real)


class Rational(Mapped):
    """One transform, a real matrix, and back."""

    name = label = "rational functions"
    reference = "Christov (1982), SIAM J. Appl. Math. 42, 1337; Iserles & Webb (2020), J. Fourier Anal. Appl. 26, 19"
    place, colour, marker = 3, "#2E6E6E", "P"
    counts, scales = (16, 24, 32, 48, 64, 96, 128, 192), (0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.5, 7.0)

    def prepare(self, problem: Problem, variant: str, points: int, scale: float) -> Ready:
        """Return the matrix of the run made ready."""
        line = RationalLine(points, scale)
        s, functions, weights = _functions(points // 2, 2 * (points // 2) + 16)
        decay = np.exp(-problem.time * (s / (2.0 * scale)) ** problem.alpha) * weights
        matrix = (functions * decay) @ functions.T

        def solve(u0: np.ndarray) -> np.ndarray:
            c = line.waves(u0)
            return line.values(c.real @ matrix + 1j * (c.imag @ matrix))

        volumes = (scale**2 + line.x**2) / (2.0 * scale) * (2.0 * np.pi / points)
        return Ready((line.x,), volumes, solve, batched=True)


def _functions(count: int, nodes: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the nodes s of Gauss' rule for Laguerre polynomials, (-1)^n l_n(s), and the weights times e^s."""
    s = roots_laguerre(nodes)[0]
    values = np.empty((nodes + 2, nodes))
    values[0] = np.exp(-0.5 * s)
    values[1] = (s - 1.0) * values[0]
    for n in range(1, nodes + 1):
        values[n + 1] = ((s - 2.0 * n - 1.0) * values[n] - n * values[n - 1]) / (n + 1.0)
    return s, values[:count], s / ((nodes + 1.0) * values[nodes + 1]) ** 2
