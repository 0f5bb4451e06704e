"""Difference formulas on the line, by the symbol of their weights: one pair of transforms takes any time.

-(-Laplacian)^(alpha/2) u(x_i) ~ h^(-alpha) sum_m a_m u_{i-m},    a(theta) = a_0 + 2 sum_{m > 0} a_m cos(m theta)
"""

from __future__ import annotations

import numpy as np
from scipy.fft import irfft, rfft

from fracparticles.special.images import image_series, square_basis
from fracparticles.special.tails import tail_constant
from fracparticles.time.whole_space import WholeSpace
from fracstudy.race.contender import Contender, Ready, Trials, lattices, sweep
from fracstudy.race.problem import Problem, lattice

_SPACINGS = (0.4, 0.2, 0.1, 0.05, 0.025, 0.0125, 0.006, 0.003)
_TRUNCATIONS = (5.0, 10.0, 40.0, 160.0)


class _Differences(Contender):
    """The base of the formulas: periodic in a wide box, or with the tails of `whole_space`, which are lent to them."""

    dims = (1,)
    far = (1.0, 1.0)  # the even and the odd weights over C m^(-1-alpha), far away

    def symbol(self, theta: np.ndarray, alpha: float) -> np.ndarray:
        """Return a(theta) at the waves of a circle: its weights are sums over images, a_m ~ C m^(-1-alpha) far away."""
        half = theta.size - 1
        m = np.arange(1.0, half + 1.0)
        images = image_series(np.array([alpha]), 1)[0] @ square_basis(m / (2 * half), 1)
        a = np.zeros(2 * half)
        a[1 : half + 1] = self.weights(alpha, half)
        factor = tail_constant(alpha) * np.where(m % 2.0 == 0.0, *self.far)
        a[1 : half + 1] += factor * (2.0 * half) ** (-1.0 - alpha) * images
        a[half] *= 0.5  # the image at the other side of the circle is itself
        a[:half:-1] += a[1:half]
        a[half] *= 2.0
        sums = rfft(a).real
        return sums - sums[0]  # a_0 makes the formula exact for constants

    def weights(self, alpha: float, count: int) -> np.ndarray:
        """Return a_1 .. a_count."""
        raise NotImplementedError

    def trials(self, problem: Problem) -> Trials:
        """Yield lattices of second-order formulas: finer ones, fewer widths."""
        for variant in ("periodic", "tails lent"):
            yield from sweep(lattices(problem, _SPACINGS, _TRUNCATIONS), variant=variant)

    def prepare(self, problem: Problem, variant: str, points: int, half_width: float) -> Ready:
        """Return the multiplier made ready."""
        alpha, h = problem.alpha, 2.0 * half_width / points
        tau = problem.time * h**-alpha

        def amplification(theta: np.ndarray) -> np.ndarray:
            return np.exp(tau * self.symbol(theta, alpha))

        x = lattice(points, half_width, 1)
        if variant == "tails lent":
            run = WholeSpace(points, 1, alpha, tau, amplification=amplification, tail=problem.tail)
            return Ready(x, h, run.solve, batched=True)
        decay = amplification(np.linspace(0.0, np.pi, points // 2 + 1))
        return Ready(x, h, lambda u0: irfft(rfft(u0) * decay, points), batched=True)


class FractionalCentred(_Differences):
    """a(theta) = -(2 sin(theta/2))^alpha."""

    name = label = "fractional centred"
    reference = "Ortigueira (2006); Celik & Duman (2012), J. Comput. Phys. 231, 1743"
    place, colour, marker = 5, "#666666", "^"

    def symbol(self, theta: np.ndarray, alpha: float) -> np.ndarray:
        """Return -(2 sin(theta/2))^alpha."""
        return -((2.0 * np.sin(0.5 * theta)) ** alpha)


class DuoWykZhang(_Differences):
    """The weighted trapezoidal rule with gamma = 1 + alpha/2, nu = gamma - alpha:

    a_1 = C 2^nu / (2 nu),   a_k = C ((k+1)^nu - (k-1)^nu) / (2 nu k^gamma).
    """

    name = label = "Duo-van Wyk-Zhang"
    reference = "Duo, van Wyk & Zhang (2018), J. Comput. Phys. 355, 233"
    place, colour, marker = 6, "#A0522D", "v"

    def weights(self, alpha: float, count: int) -> np.ndarray:
        """Return a_1 .. a_count."""
        gamma = 1.0 + 0.5 * alpha
        nu, k = gamma - alpha, np.arange(1.0, count + 1.0)
        return tail_constant(alpha) / (2.0 * nu) * ((k + 1.0) ** nu - (k - 1.0) ** nu) / k**gamma


class HuangOberman(_Differences):
    """Quadratic interpolation of the second difference, with G''' = nu = C y^(-1-alpha):

    a_1 = C / (2-alpha) - G''(1) - (G'(3) + 3 G'(1)) / 2 + G(3) - G(1),
    a_j = 2 (G'(j+1) + G'(j-1) - G(j+1) + G(j-1)),                 j = 2, 4, ..
    a_j = -(G'(j+2) + 6 G'(j) + G'(j-2)) / 2 + G(j+2) - G(j-2),    j = 3, 5, ..
    """

    name = label = "Huang-Oberman"
    reference = "Huang & Oberman (2014), SIAM J. Numer. Anal. 52, 3056"
    place, colour, marker = 7, "#8A6D3B", "s"
    far = (4.0 / 3.0, 2.0 / 3.0)

    def weights(self, alpha: float, count: int) -> np.ndarray:
        """Return a_1 .. a_count; from j = 200 on Simpson's 4/3 nu and 2/3 nu: the differences of G lose digits."""
        c = tail_constant(alpha)
        j = np.arange(1.0, count + 1.0)
        a = np.where(j % 2.0 == 0.0, *self.far) * c * j ** (-1.0 - alpha)
        t = np.arange(min(count, 200) + 3.0)
        g1 = np.append(0.0, t[1:] ** (1.0 - alpha)) * (c / ((alpha - 1.0) * alpha))
        g = t * g1 / (2.0 - alpha)
        even, odd = np.arange(2, t.size - 2, 2), np.arange(3, t.size - 2, 2)
        a[even - 1] = 2.0 * (g1[even + 1] + g1[even - 1] - g[even + 1] + g[even - 1])
        a[odd - 1] = g[odd + 2] - g[odd - 2] - 0.5 * (g1[odd + 2] + 6.0 * g1[odd] + g1[odd - 2])
        a[0] = c / (2.0 - alpha) + c / alpha - 0.5 * (g1[3] + 3.0 * g1[1]) + g[3] - g[1]
        return a
