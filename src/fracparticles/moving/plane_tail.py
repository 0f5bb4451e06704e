r"""What lies beyond a rectangle of particles in the plane: the far field A |x|^(-2-alpha) of data about the origin.

Next to the rectangle it is particles: every line of the rectangle goes on with its last gap, for as many as the smooth
kernels reach, with strengths that fall like |x|^(-2-alpha) from the last. Beyond those, outside a square |x|, |y| < W,
only its flux is felt, and there the kernel is its own far field, F_eps ~ C |r|^(-1-alpha):

    Q(x) = -D C A W^(-1-2 alpha) g(x / W),
    g(x) = int_outside |y|^(-2-alpha) (x - y) |x - y|^(-2-alpha) dy,     W = 1,

g_x is x times a function of x^2 and y^2, here a polynomial; g_y is the same with x and y exchanged. The polynomial
meets the integral, in polar coordinates about x, at Chebyshev points. On the line all this is `tail`.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev

from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import kernel
from fracparticles.special.quadrature import gauss_legendre

__all__ = ["PlaneTail", "far_flux"]

REACH = 7.0  # smoothing lengths: exp(-49 / 2) of a kernel of order IV is 2e-11
_DEGREE = 11  # of the polynomial, in x^2 and in y^2
_ANGLES, _RADII = 24, 24  # nodes of the integral for each side of the square
_FAR = 1e6  # a distance at which F is its far field
_MOST = 2**12  # rows around the rectangle: rows that all but coincide would need any number


class PlaneTail:
    """The far field of a rectangle of particles.

    Parameters
    ----------
    alpha : float
    order : int
        Of the kernels.
    epsilon : float
    """

    def __init__(self, alpha: float, order: int, epsilon: float) -> None:
        self._alpha, self._epsilon = alpha, epsilon
        self._constant = float(kernel("F", _FAR, alpha, 2, order)) * _FAR ** (1.0 + alpha)

    def continued(
        self, x: np.ndarray, y: np.ndarray, strength: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the particles, shape (N, N), with those around them.

        Raises `InvalidInput` if the outermost rows have met, or are too close for so many.
        """
        gap = float(min(np.diff(x, axis=0)[[0, -1]].min(), np.diff(y, axis=1)[:, [0, -1]].min()))
        closest = REACH * self._epsilon / _MOST
        if not gap > closest:
            shown = f"outermost rows with particles {gap:.4g} apart"
            allowed = f"rows in order and more than {closest:.4g} apart, for this smoothing length"
            raise InvalidInput("x", shown, allowed, "Remesh, take a smaller dt or overlap.")
        more = int(np.ceil(REACH * self._epsilon / gap))
        wide_x, wide_y = _extended(x, more), _extended(y, more)
        last = np.pad(strength, more, mode="edge")
        r, at = np.hypot(wide_x, wide_y), np.pad(np.hypot(x, y), more, mode="edge")
        fall = np.where(r > 0.0, at / np.where(r > 0.0, r, 1.0), 1.0) ** (2.0 + self._alpha)
        return wide_x, wide_y, last * fall

    def misfit(self, x: np.ndarray, y: np.ndarray, strength: np.ndarray) -> float:
        """Return how much of the total the far field may hold wrongly: its share times the spread of A at the ends."""
        edge = _edge(x)
        r = np.hypot(x[edge], y[edge])
        radius = float(r.mean())
        # A and the far field beyond a circle of that radius, 2 pi A R^-alpha / alpha, in units of R.
        area = _cells(x, y)[edge] / radius**2
        amplitude = (
            strength[edge] / abs(strength.sum()) / area * (r / radius) ** (2.0 + self._alpha)
        )
        return float(2.0 * np.pi / self._alpha * amplitude.std())

    def flux(
        self, wide: tuple[np.ndarray, np.ndarray, np.ndarray], x: np.ndarray, y: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return sum U F_eps, both components, of what lies beyond the continued particles, at points among them."""
        at_x, at_y, strength = wide
        low_x, high_x, low_y, high_y = at_x[0], at_x[-1], at_y[:, 0], at_y[:, -1]
        sides = [-low_x.mean(), high_x.mean(), -low_y.mean(), high_y.mean()]
        gap = 0.25 * float(
            np.diff(at_x, axis=0)[[0, -1]].mean(axis=1).sum()
            + np.diff(at_y, axis=1)[:, [0, -1]].mean(axis=0).sum()
        )
        width = float(np.mean(sides)) + 0.5 * gap
        edge = _edge(at_x)
        r = np.hypot(at_x[edge], at_y[edge])
        field = strength[edge] / _cells(at_x, at_y)[edge]
        far = float((field * (r / width) ** (2.0 + self._alpha)).mean())  # A W^(-2-alpha)
        # Sums of F_eps, before the 1 / eps^beta.
        size = self._constant * far * (self._epsilon / width) ** (self._alpha - 1.0)
        inner = float(max(np.abs(x).max(), np.abs(y).max())) / width
        # A few of them serve the whole run.
        reach = min(0.97, 0.05 * np.ceil(20.0 * inner))
        return (
            size * far_flux(x / width, y / width, self._alpha, reach),
            size * far_flux(y / width, x / width, self._alpha, reach),
        )


def far_flux(x: np.ndarray, y: np.ndarray, alpha: float, reach: float) -> np.ndarray:
    """Return g_x at points of the square |x|, |y| < reach < 1."""
    coefficients, scale = _polynomial(alpha, reach), 2.0 / reach**2
    a, b = scale * x * x - 1.0, scale * y * y - 1.0
    return np.asarray(x * chebyshev.chebval2d(a, b, coefficients))


@lru_cache(maxsize=64)
def _polynomial(alpha: float, reach: float) -> np.ndarray:
    """The coefficients of g_x / x in T_i(2 x^2 / reach^2 - 1) T_j(2 y^2 / reach^2 - 1)."""
    nodes = np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1))
    places = reach * np.sqrt(0.5 * (1.0 + nodes))
    x, y = (v.reshape(-1, 1, 1) for v in np.meshgrid(places, places, indexing="ij"))
    values = np.zeros(x.size)
    for turn in range(4):  # towards the side x = 1, after a quarter turn of the plane each time
        a, b = [(x, y), (y, -x), (-x, -y), (-y, x)][turn]
        cos, sin, v, weight = _rays(a, b)
        rho = (1.0 - a) / cos
        far = np.hypot(a + rho / v * cos, b + rho / v * sin)
        ray = (weight * rho ** (1.0 - alpha) * v ** (alpha - 2.0) * far ** (-2.0 - alpha)).sum(2)
        # The x of e after turning back.
        component = [cos, -sin, -cos, sin][turn][:, :, 0]
        values -= (ray * component).sum(axis=1)
    table = (values / x[:, 0, 0]).reshape(_DEGREE + 1, _DEGREE + 1)
    matrix = np.linalg.inv(chebyshev.chebvander(nodes, _DEGREE))
    return np.asarray(matrix @ table @ matrix.T)


def _rays(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """cos and sin of angles towards the side x = 1 from (a, b), v = rho / s on (0, 1), and the weights of both."""
    nodes, weights = gauss_legendre(_ANGLES)
    low, high = np.arctan2(-1.0 - b, 1.0 - a), np.arctan2(1.0 - b, 1.0 - a)
    angle = 0.5 * (high + low) + 0.5 * (high - low) * nodes[None, :, None]
    v, parts = gauss_legendre(_RADII, 0.0, 1.0)
    weight = 0.5 * (high - low) * weights[None, :, None] * parts
    return np.cos(angle), np.sin(angle), v, weight


def _extended(v: np.ndarray, more: int) -> np.ndarray:
    """The rectangle with `more` on either side of both axes, each line with its last gap."""
    k = np.arange(1.0, more + 1.0)[:, None]
    for _ in range(2):
        below = v[0] - k[::-1] * (v[1] - v[0])
        above = v[-1] + k * (v[-1] - v[-2])
        v = np.concatenate([below, v, above]).T
    return v


def _edge(x: np.ndarray) -> np.ndarray:
    """Whether a particle is on the rim of the rectangle."""
    edge = np.zeros(x.shape, dtype=bool)
    edge[[0, -1]] = edge[:, [0, -1]] = True
    return edge


def _cells(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The area of the cell of each particle."""
    (xa, xb), (ya, yb) = np.gradient(x), np.gradient(y)
    return np.abs(xa * yb - xb * ya)
