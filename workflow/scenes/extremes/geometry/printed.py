r"""The matrices of the schemes, entry by entry from the printed formulas, for any particles at multiples of h = 1.

Nothing of the library is used: the confluent functions are mpmath's, the fundamental solution is an integral by
QUADPACK, the sums are loops over pairs. With x = r^2, (a)_j Pochhammer's symbol and L Laguerre's polynomials,

    printed, order II:  M(x) = 1F1(a; b; -x)             order IV:  2 M(x) - 2^-a M(x / 2)
    gamma, order 2 m:   sum_{j<m} (a)_j / j! 1F1(a + j; b; -x),    eta1 = -2 r pi^(-n/2) e^-x L_{m-1}^(n/2+1)(x).
"""

from collections.abc import Callable
from functools import cache
from math import cos, exp, factorial, gamma, inf, pi, sin, sqrt

import mpmath as mp
import numpy as np
from scipy.integrate import quad
from scipy.special import eval_genlaguerre, j0

from scenes.extremes.dense import exchange

# kappa, G and K by 1F1: sign, alpha less the power, and b.
_CONFLUENT = {"kappa": (1.0, 2.0, 0), "G": (-1.0, 0.0, 0), "K": (1.0, 0.0, 2)}
_EXACT = {"limit": 2000, "epsabs": 1e-15, "epsrel": 1e-13}


class Kernels:
    """The kernels of a scheme, for scalar distances r in units of epsilon; `family` is "printed" or "gamma"."""

    def __init__(self, alpha: float, dim: int = 1, order: int = 2, family: str = "printed") -> None:
        self.alpha, self.dim, self.order, self.family = alpha, dim, order, family
        self.values = cache(self._value)

    def _value(self, name: str, r: float) -> float:
        if name == "F":
            return -r * self._value("K", r)
        if name not in _CONFLUENT:
            return float(getattr(self, f"_{name}")(r))
        sign, less, b = _CONFLUENT[name]
        power, half = self.alpha - less, 0.5 * self.dim
        # Gamma_{n,b}(power)  (B.14)
        above = 2.0**power * gamma(0.5 * (power + self.dim))
        constant = above / (pi**half * gamma(0.5 * (self.dim + b)) * factorial(b))
        return sign * constant * self._confluent(0.5 * (power + self.dim), half + 0.5 * b, r * r)

    def _confluent(self, a: float, b: float, x: float) -> float:
        f = lambda a, x: mp.hyp1f1(a, b, -x)
        if self.family == "gamma":
            j = range(self.order // 2)
            return float(mp.fsum(mp.rf(a, k) / mp.factorial(k) * f(a + k, x) for k in j))
        narrow = f(a, x)
        return float(narrow if self.order == 2 else 2 * narrow - mp.mpf(2) ** -a * f(a, x / 2))

    def _eta1(self, r: float) -> float:
        n, x = self.dim, r * r
        unit = -r * pi ** (-0.5 * n) * exp(-x)
        if self.family == "gamma":
            return 2.0 * unit * eval_genlaguerre(self.order // 2 - 1, 0.5 * n + 1.0, x)
        return unit * (2.0 if self.order == 2 else n + 4.0 - 2.0 * x)

    def _Phi(self, r: float) -> float:
        narrow, wide = exp(-r * r) / sqrt(pi), exp(-0.5 * r * r) / sqrt(2.0 * pi)
        return 2.0 * narrow if self.order == 2 else 4.0 * narrow - wide

    def _E(self, r: float) -> float:
        """The inverse transform of exp(-k^alpha): (1 / pi) int cos(k r) exp(-k^alpha) dk on the line."""
        alpha, most = self.alpha, 44.0 ** (1.0 / self.alpha)
        integrands: dict[int, Callable[[float], float]] = {
            1: lambda k: cos(k * r) / pi,
            2: lambda k: k * j0(k * r) / (2.0 * pi),
            3: lambda k: k * k * (sin(k * r) / (k * r) if k * r > 0.0 else 1.0) / (2.0 * pi * pi),
        }
        wave = integrands[self.dim]
        return quad(lambda k: wave(k) * exp(-(k**alpha)), 0.0, most, **_EXACT)[0]

    def _Kstar(self, r: float) -> float:
        """beta c (r^2 + 1)^(-(beta+2)/2): the Riesz potential c r^-beta, cut off at epsilon."""
        beta = self.alpha - 1.0
        c = gamma(0.5 * beta) / (2.0 ** (1.0 - beta) * sqrt(pi) * gamma(0.5 * (1.0 - beta)))
        return beta * c * (1.0 + r * r) ** (-0.5 * (beta + 2.0))


def places(n: int, dim: int) -> np.ndarray:
    """Return the lattice points -n .. n in each coordinate, shape (N^dim, dim), in the order of the library."""
    return np.array(list(np.ndindex(*(2 * n + 1,) * dim)), dtype=int).reshape(-1, dim) - n


def matrix(scheme: str, kernels: Kernels, n: int, overlap: float) -> np.ndarray:
    """Return A of du/dt = A u on the truncated lattice, D = h = 1, epsilon = s."""
    if scheme == "FD":
        return _finite_differences(2 * n + 1, kernels.alpha)
    s, alpha, points = overlap, kernels.alpha, places(n, kernels.dim)
    apart = points[:, None, :] - points[None, :, :]
    square = np.square(apart).sum(axis=-1)
    volume = s**-kernels.dim

    def sums(name: str) -> np.ndarray:
        """V K_epsilon(x_i - x_j)."""
        distinct, where = np.unique(square, return_inverse=True)
        values = np.array([kernels.values(name, sqrt(m) / s) for m in distinct.tolist()])
        return volume * values[where].reshape(square.shape)

    if scheme == "DD":
        return s**-alpha * sums("G")
    if scheme == "FPSE":
        direction = apart / np.sqrt(np.where(square > 0, square, 1))[..., None]
        flux, slope = sums("F"), sums("eta1")
        total = np.zeros(square.shape)
        for axis in range(kernels.dim):
            q = -(s ** (1.0 - alpha)) * flux * direction[..., axis]
            c = -slope * direction[..., axis] / s
            total += c @ q + c.sum(axis=1)[:, None] * q
        return total
    if scheme == "DPSE":
        potential = s ** (2.0 - alpha) * sums("kappa")
        return 2.0 / s**2 * exchange(sums("Phi")) @ potential
    name = {"KPSE": "K", "GPSE": "E", "PSE29": "G", "RIESZ": "Kstar"}[scheme]
    factor = alpha if scheme in ("KPSE", "RIESZ") else 1.0
    return factor * s**-alpha * exchange(sums(name))


def _finite_differences(size: int, alpha: float) -> np.ndarray:
    """L_i = sum_{j <= i} [omega(i - j + 1) - omega(i - j)] (u_j - u_{j-1}), u zero beyond, and its mirror image."""
    beta = alpha - 1.0

    def left(i: int) -> np.ndarray:
        row = np.zeros(size + 2)  # u_{-1} .. u_{size}
        for j in range(i + 1):
            step = (i - j + 1.0) ** (1.0 - beta) - float(i - j) ** (1.0 - beta)
            step /= gamma(2.0 - beta)
            row[j + 1] += step
            row[j] -= step
        return row[1:-1]

    one_sided = np.array([left(i + 1) - (left(i) if i >= 0 else 0.0) for i in range(size)])
    return (one_sided + one_sided[::-1, ::-1]) / (2.0 * abs(cos(0.5 * pi * alpha)))


def power_sum(weight: Callable[[float], float], power: float, n: int, i: int, far: int) -> float:
    """Return sum_{j > n} (n / j)^power w(j - i): term by term up to `far`, from there the integral of the rest."""
    near = sum((n / j) ** power * weight(j - i) for j in range(n + 1, far + 1))
    term = lambda y: (n / y) ** power * weight(y - i)
    return near + quad(term, far + 0.5, inf, epsabs=0.0, limit=200)[0]
