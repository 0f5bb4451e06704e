"""Problems solved by other methods, with numpy and scipy alone: to compare with particles.

`circle` has Fourier series on a circle so long that its other turns are not felt. `Jacobi` and `Zernike` are Galerkin's
method in the functions that (-Laplacian)^(alpha/2) takes to polynomials, a = alpha/2 (Dyda, Kuznetsov & Kwasnicki,
Constr. Approx. 45 (2017) 427): on (-1, 1)

    (-Laplacian)^a (1 - x^2)^a P_n^(a, a) = mu_n P_n^(a, a),       mu_n = Gamma(alpha + n + 1) / n!,
    grad^beta (1 - x^2)^a P_n^(a, a) = -2 mu_n / (n + alpha) P_(n+1)^(a-1, a-1),

and on the unit disc, V_ln = r^l cos(l angle) P_n^(a, l)(2 r^2 - 1) or with sin,

    (-Laplacian)^a (1 - r^2)^a V_ln = 2^alpha Gamma(a + n + 1) Gamma(a + n + l + 1) / (n! (n + l)!) V_ln.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.fft import irfft, rfft, rfftfreq
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.linalg import expm
from scipy.special import eval_jacobi, gammaln, roots_jacobi

__all__ = ["Jacobi", "Zernike", "circle"]

_LENGTH, _POINTS = 400.0, 2**13
_TOLERANCE = 1e-8
_APART = 1e-5  # of the places of a difference


def circle(
    alpha: float, initial: Any, time: float, d: Any, a: Any, f: Any, pairs: bool = False
) -> Callable[[np.ndarray], np.ndarray]:
    """Return u of u_t + (a u)_x = (D grad^beta u)_x + f at a time, as a function of x; D(x, t), a(x, t), f(x, t, u).

    With `pairs` the diffusion is (D L u + L(D u) - u L D) / 2.
    """
    step = _LENGTH / _POINTS
    x = (np.arange(_POINTS) - _POINTS // 2) * step
    k = 2.0 * np.pi * rfftfreq(_POINTS, step)
    flux = 1j * np.append(0.0, k[1:] ** (alpha - 1.0))

    def laplacian(u: np.ndarray) -> np.ndarray:
        return irfft(-(k**alpha) * rfft(u), _POINTS)

    def rate(t: float, u: np.ndarray) -> np.ndarray:
        now, left = d(x, t), -a(x, t) * u
        if pairs:
            spread = 0.5 * (now * laplacian(u) + laplacian(now * u) - u * laplacian(now))
            return spread + irfft(1j * k * rfft(left), _POINTS) + f(x, t, u)
        left += now * irfft(flux * rfft(u), _POINTS)
        return irfft(1j * k * rfft(left), _POINTS) + f(x, t, u)

    u0 = initial(x)
    run = solve_ivp(rate, (0.0, time), u0, "DOP853", rtol=_TOLERANCE, atol=_TOLERANCE * u0.max())
    return CubicSpline(x, run.y[:, -1])


class _Galerkin:
    """M c' = K(t) c + (phi, f): what both domains have in common; `self.at` are the places of the quadrature."""

    at: tuple[np.ndarray, ...]
    polynomials: np.ndarray
    edge: np.ndarray
    weights: np.ndarray

    def matrix(self, t: float) -> np.ndarray:
        raise NotImplementedError

    def coefficients(self, initial: Any, time: float, f: Any) -> np.ndarray:
        """Return c at a time; without f, K must be the same at all times."""
        basis, tested = self.edge * self.polynomials, self.polynomials * self.weights
        inverse = np.linalg.inv(tested @ basis.T)
        c0 = inverse @ (tested @ initial(*self.at))
        if f is None:
            return expm(time * inverse @ self.matrix(0.0)) @ c0

        def rate(t: float, c: np.ndarray) -> np.ndarray:
            return inverse @ (self.matrix(t) @ c + tested @ f(*self.at, t, c @ basis))

        def derivative(t: float, c: np.ndarray) -> np.ndarray:
            u = c @ basis
            slope = (f(*self.at, t, u + _APART) - f(*self.at, t, u - _APART)) / (2.0 * _APART)
            return inverse @ (self.matrix(t) + (tested * slope) @ basis.T)

        atol = _TOLERANCE * np.abs(c0).max()
        run = solve_ivp(rate, (0, time), c0, "Radau", jac=derivative, rtol=_TOLERANCE, atol=atol)
        return run.y[:, -1]


class Jacobi(_Galerkin):
    """On (-1, 1), u = 0 outside: u_t + (a u)_x = (D grad^beta u)_x + f."""

    def __init__(self, alpha: float, d: Any, a: Any, count: int = 60) -> None:
        self.alpha, self.half, self.d, self.a = alpha, 0.5 * alpha, d, a
        self.n = n = np.arange(count)[:, None]
        x, self.weights = roots_jacobi(2 * count + 20, self.half, self.half)
        self.at, self.edge = (x,), (1.0 - x * x) ** self.half
        self.size = 1.0
        self.size = 1.0 / np.sqrt(self._values(x) ** 2 @ self.weights)[:, None]
        self.polynomials = self._values(x)
        mu = np.exp(gammaln(alpha + n + 1.0) - gammaln(n + 1.0))
        self.applied = -mu * self.polynomials
        after = eval_jacobi(n + 1, self.half - 1.0, self.half - 1.0, x)
        self.gradient = -2.0 * mu / (n + alpha) * self.size * after
        # Of (1 - x^2)^a p phi' it is (1 - x^2)^(alpha - 1) that makes the weights.
        self.inside, weights = roots_jacobi(x.size, alpha - 1.0, alpha - 1.0)
        y, p = self.inside, self._values(self.inside)
        rise = eval_jacobi(np.maximum(n - 1, 0), self.half + 1.0, self.half + 1.0, y)
        rise *= 0.5 * (n + alpha + 1.0) * (n > 0) * self.size
        self.slopes, self.carried = ((1.0 - y * y) * rise - alpha * y * p) * weights, p

    def _values(self, x: np.ndarray) -> np.ndarray:
        return self.size * eval_jacobi(self.n, self.half, self.half, x)

    def matrix(self, t: float) -> np.ndarray:
        """Return (phi, D A phi + D' grad^beta phi) + (phi', a phi)."""
        (x,), tested = self.at, self.polynomials * self.weights
        slope = (self.d(x + _APART, t) - self.d(x - _APART, t)) / (2.0 * _APART)
        spread = tested @ (self.d(x, t) * self.applied + slope * self.gradient).T
        return spread + (self.slopes * self.a(self.inside, t)) @ self.carried.T

    def solve(self, initial: Any, time: float, f: Any) -> Callable[[np.ndarray], np.ndarray]:
        """Return u at a time, as a function of x."""
        c = self.coefficients(initial, time, f)
        return lambda x: (1.0 - x * x) ** self.half * (c @ self._values(x))


class Zernike(_Galerkin):
    """In the unit disc, u = 0 outside: u_t + div(a u) = div grad^beta u + f, a = (a_x, a_y)(x, y)."""

    def __init__(self, alpha: float, a: Any, radial: int = 12, turns: int = 10) -> None:
        self.half = half = 0.5 * alpha
        kinds = [
            (turn, s) for turn in range(turns + 1) for s in (0.0, 0.5 * np.pi)[: 1 + (turn > 0)]
        ]
        every = [(n, *kind) for kind in kinds for n in range(radial)]
        self.n, self.turn, self.shift = (np.array(one)[:, None] for one in zip(*every, strict=True))
        self.size = 1.0
        r, angle, self.weights = self._places(half, radial + turns + 20, 4 * turns + 24)
        self.at, self.edge = (r * np.cos(angle), r * np.sin(angle)), (1.0 - r * r) ** half
        self.size = 1.0 / np.sqrt(self._values(r, angle) ** 2 @ self.weights)[:, None]
        self.polynomials = self._values(r, angle)
        n, turn = self.n, self.turn
        mu = 2.0**alpha * np.exp(
            gammaln(half + n + 1.0) + gammaln(half + n + turn + 1.0) - gammaln(n + 1.0)
            - gammaln(n + turn + 1.0)
        )  # fmt: skip
        spread = -(self.polynomials * self.weights) @ (mu * self.polynomials).T
        self._matrix = spread + self._carried(a, radial + turns + 20, 4 * turns + 24)

    def matrix(self, t: float) -> np.ndarray:
        """Return (phi, A phi) + (grad phi, a phi)."""
        return self._matrix

    def solve(self, initial: Any, time: float, f: Any) -> Callable[..., np.ndarray]:
        """Return u at a time, as a function of x and y."""
        c = self.coefficients(initial, time, f)

        def u(x: np.ndarray, y: np.ndarray) -> np.ndarray:
            r, angle = np.hypot(x, y).ravel(), np.arctan2(y, x).ravel()
            return ((1.0 - r * r) ** self.half * (c @ self._values(r, angle))).reshape(x.shape)

        return u

    @staticmethod
    def _places(power: float, rings: int, angles: int) -> tuple[np.ndarray, ...]:
        """r, the angle and weights of int (1 - r^2)^power .. dx dy."""
        z, w = roots_jacobi(rings, power, 0.0)
        angle = 2.0 * np.pi * np.arange(angles) / angles
        w = w / 2.0 ** (power + 2.0) * 2.0 * np.pi / angles
        return np.repeat(np.sqrt(0.5 * (1.0 + z)), angles), np.tile(angle, rings), w.repeat(angles)

    def _values(self, r: np.ndarray, angle: np.ndarray) -> np.ndarray:
        return self._radial(r) * np.cos(self.turn * angle - self.shift)

    def _radial(self, r: np.ndarray) -> np.ndarray:
        r, ring = np.unique(r, return_inverse=True)
        powers = eval_jacobi(self.n, self.half, self.turn, 2.0 * r * r - 1.0)
        return self.size * (r**self.turn * powers)[:, ring]

    def _carried(self, a: Any, rings: int, angles: int) -> np.ndarray:
        r, angle, weights = self._places(2.0 * self.half - 1.0, rings, angles)
        n, turn, z = self.n, self.turn, 2.0 * r * r - 1.0
        a_x, a_y = a(r * np.cos(angle), r * np.sin(angle))
        outwards = a_x * np.cos(angle) + a_y * np.sin(angle)
        around = a_y * np.cos(angle) - a_x * np.sin(angle)
        z, ring = np.unique(z, return_inverse=True)
        below = eval_jacobi(np.maximum(n - 1, 0), self.half + 1.0, turn + 1.0, z)[:, ring]
        rise = 2.0 * r * (n > 0) * (n + self.half + turn + 1.0) * below * r**turn * self.size
        rise = (rise + turn / r * self._radial(r)) * np.cos(turn * angle - self.shift)
        sideways = -turn / r * self._radial(r) * np.sin(turn * angle - self.shift)
        p = self._values(r, angle)
        slopes = outwards * ((1.0 - r * r) * rise - 2.0 * self.half * r * p)
        slopes += around * (1.0 - r * r) * sideways
        return (slopes * weights) @ p.T
