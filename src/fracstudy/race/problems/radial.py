"""Data whose Fourier transform is known: the solution by quadrature.

    u(r, t) = (2 pi)^(-n/2) int_0^inf u^(k) exp(-t k^alpha) k^(n-1) (k r)^(1-n/2) J_{n/2-1}(k r) dk,

by Gauss' rule on many intervals, the first of them halved towards k = 0, where k^alpha is not smooth.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.polynomial.chebyshev import Chebyshev
from scipy.special import gamma, jv

from fracstudy.race.problem import Points, Problem, distance

_LAST = 36.0  # exp(-k^alpha) is 1e-22 and less there
_INTERVALS, _HALVINGS, _NODES = 144, 24, 24
_WAVES = 24.0  # of the polynomial that stands for the solution: beyond, exp(-k^alpha) is round-off


class Radial(Problem):
    """What such problems share; a subclass gives the transform u^(k)."""

    def transform(self, k: np.ndarray) -> np.ndarray:
        """Return u^(k)."""
        raise NotImplementedError

    def exact(self, x: Points) -> np.ndarray:
        """Return the solution, within two error radii."""
        return np.asarray(_solution(self)(distance(x)))


@lru_cache(maxsize=16)
def _solution(problem: Radial) -> Chebyshev:
    edges = np.linspace(0.0, _LAST, _INTERVALS + 1)
    edges = np.concatenate([[0.0], edges[1] * 0.5 ** np.arange(_HALVINGS, 0, -1.0), edges[1:]])
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    half = 0.5 * np.diff(edges)[:, None]
    k = (edges[:-1, None] + half * (1.0 + nodes)).ravel()
    weight = (
        (half * weights).ravel() * problem.transform(k) * np.exp(-problem.time * k**problem.alpha)
    )
    n = problem.dim

    def at(r: np.ndarray) -> np.ndarray:
        phase = np.outer(r, k)
        if n == 1:
            return np.cos(phase) @ weight / np.pi
        if n == 3:
            return np.sinc(phase / np.pi) @ (weight * k * k) / (2.0 * np.pi**2)
        return jv(0, phase) @ (weight * k) / (2.0 * np.pi)

    end = 2.0 * problem.error_radius
    return Chebyshev.interpolate(at, int(_WAVES * end) + 40, domain=[-end, end])


class OtherTail(Radial):
    """(1 + |x|^2)^(-(n+1)/2), whose tail is |x|^(-n-1): heavier than that of the solution. u^ ~ exp(-k)."""

    name, title, place = "other tail", "data with another tail", 3

    @property
    def tail(self) -> tuple[float, ...]:
        """Two powers."""
        return (self.dim + 1.0, self.dim + 3.0)

    def initial(self, x: Points) -> np.ndarray:
        """Return the data."""
        return (1.0 + distance(x) ** 2) ** (-0.5 * (self.dim + 1))

    def transform(self, k: np.ndarray) -> np.ndarray:
        """Return pi^((n+1)/2) / Gamma((n+1)/2) exp(-k)."""
        half = 0.5 * (self.dim + 1)
        return np.pi**half / gamma(half) * np.exp(-k)


class Compact(Radial):
    """(1 - |x|^2)^3 within |x| < 1, zero beyond. u^ = 2^3 3! (2 pi)^(n/2) J_{n/2+3}(k) / k^(n/2+3)."""

    name, title, place = "compact", "compact data", 4

    @property
    def tail(self) -> tuple[float, ...]:
        """None: the data end."""
        return ()

    def initial(self, x: Points) -> np.ndarray:
        """Return the data."""
        return np.maximum(1.0 - distance(x) ** 2, 0.0) ** 3

    def transform(self, k: np.ndarray) -> np.ndarray:
        """Return the transform; for small k by two terms of its series, where the quotient would lose digits."""
        order = 0.5 * self.dim + 3.0
        factor = 48.0 * (2.0 * np.pi) ** (0.5 * self.dim)
        small = k < 1e-3
        safe = np.where(small, 1.0, k)
        series = (1.0 - 0.25 * k * k / (order + 1.0)) / (2.0**order * gamma(order + 1.0))
        return factor * np.where(small, series, jv(order, safe) / safe**order)
