"""The far-field closure: the particles that a truncated lattice leaves out.

Beyond the half-width D the solution falls like the fundamental solution, whose expansion (A.2) is in powers
|x|^(-1-k alpha), k = 1, 2, ... Continue the lattice to infinity with the first terms of this expansion,

    u_j = sum_k a_k (n / |j|)^(1 + k alpha),   |j| > n,

fitted to the strengths at as many particles, n - p = n, 3 n / 4, n / 2 (and likewise on the left). A sum over
particles then gains the exterior sums u_{n-p} right_i^p + u_{-n+p} left_i^p. With one term they are

    right_i = sum_{j > n} (n / j)^(1+alpha) w_{i-j},   left_i = parity * right_{-i},

an update of the operator of rank two, computed once; each further term adds two to the rank. This is not in the
papers, which truncate the lattice. A step of GPSE without the exterior lacks int_D E u dy ~ D^(-1-2 alpha). Each
further term reduces the remaining error by another factor D^(-alpha).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fracparticles._compiled import njit
from fracparticles.errors import InvalidInput
from fracparticles.lattice.fourier import valid_convolution
from fracparticles.special.quadrature import gauss_jacobi

__all__ = ["LineFarField", "continuation", "far_field"]

# Lattice points up to 4 n are summed one by one, the others by the Euler-Maclaurin formula. There j - i >= 3 n, so that
# the summand varies on the scale n, and two terms leave a relative error of order n^-4.
_NEAR = 4
# Nodes of the quadrature and of the interpolation: sums over j > 4 n are analytic in i / n for |i| <= 4 n and in n / j,
# and so many nodes give round-off.
_NODES = 24
# p / n at which the expansion is fitted to the strengths: at n, 3 n / 4 and n / 2. Closer together, the fit would
# magnify round-off. At the last one three terms are compared with a strength to which they were not fitted.
_DEPTHS = (0.0, 0.25, 0.5, 0.625)


@dataclass(frozen=True)
class LineFarField:
    """The sum over the exterior, sum_p (u_{n-p} right_i^p + u_{-n+p} left_i^p), of some strengths near the ends.

    Attributes
    ----------
    depth : array of int, shape (terms,)
        p, the distance of these particles from the ends, in spacings.
    right, left : array, shape (terms, points)
        The sums that a unit strength there adds.
    """

    depth: np.ndarray
    right: np.ndarray
    left: np.ndarray

    def add(self, u: np.ndarray, y: np.ndarray) -> None:
        """Add the contribution of the exterior to the sums y."""
        _add(self.depth, self.right, self.left, u, y)


def far_field(
    weight: Callable[[np.ndarray], np.ndarray],
    decay: float,
    alpha: float,
    n: int,
    parity: int = 1,
    pad: int = 0,
    terms: int = 1,
) -> LineFarField:
    """Return the exterior sums for the lattice -n .. n, at i = -n-pad .. n+pad.

    Parameters
    ----------
    weight : callable
        w_m as a function of any real offset m, even or odd.
    decay : float
        w_m ~ |m|^(-decay) far away.
    alpha : float
        Fractional order.
    n : int
        Half the number of lattice intervals.
    parity : {1, -1}
        Whether w is even or odd.
    pad : int
        The number of points beyond each end at which sums are wanted.
    terms : {1, 2, 3}
        The number of terms of the expansion that continues the solution.

    Raises
    ------
    InvalidInput
        If the lattice has too few particles for as many terms.
    """
    i = np.arange(-n - pad, n + pad + 1)
    depth, powers, fit = _expansion(n, alpha, terms)

    j = np.arange(n + 1, _NEAR * n + 1)
    offsets = np.arange(i[0] - j[-1], i[-1] - j[0] + 1)
    sums = valid_convolution((n / j) ** powers[:, None], weight(offsets.astype(float)))

    # The tail at Chebyshev points of i, and from there to every i by barycentric interpolation.
    angle = (np.arange(_NODES) + 0.5) * (np.pi / _NODES)
    nodes = (n + pad) * np.cos(angle)
    for mode, power in zip(sums, powers, strict=True):
        tail = _tails(weight, decay, power, n, nodes)
        mode += np.polynomial.chebyshev.Chebyshev.fit(
            nodes, tail, _NODES - 1, domain=[-(n + pad), n + pad]
        )(i)
    return _far_field_of(depth, fit.T @ sums, parity)


def _tails(
    weight: Callable[[np.ndarray], np.ndarray],
    decay: float,
    power: float,
    n: int,
    i: np.ndarray,
) -> np.ndarray:
    """Return sum_{j > 4 n} (n / j)^power w_{i-j} for each i.

    Euler-Maclaurin from the midpoint X = 4 n + 1/2: sum f(j) = int_X^inf f + f'(X) / 24 - ...; the integral
    by Gauss-Jacobi quadrature in v = X / j, where f(j) dj is v^(power+decay-2) times a smooth function.
    """
    start = _NEAR * n + 0.5
    exponent = power + decay - 2.0
    v, quadrature = gauss_jacobi(_NODES, exponent)
    ends = np.array([start - 0.5, start + 0.5])
    w = weight(i[:, None] - np.concatenate([start / v, ends]))
    smooth = w[:, :-2] * v**-decay
    integral = start * (n / start) ** power * (smooth @ quadrature)
    f = (n / ends) ** power * w[:, -2:]
    return np.asarray(integral + (f[:, 1] - f[:, 0]) / 24.0)


def continuation(
    u: np.ndarray, n: int, alpha: float, terms: int = 1
) -> tuple[np.ndarray, np.ndarray]:
    """Return the expansion of the exterior where it was not fitted to u, shape (2 n + 1,): at the next depth inward.

    Returns
    -------
    places : array of int, shape (2,)
        Indices into u, right and left.
    values : array, shape (2,)
        The values of the expansion there.
    """
    depth, powers, fit = _expansion(n, alpha, terms)
    p = round(n * _DEPTHS[terms])
    modes = (n / (n - p)) ** powers @ fit
    return np.array([2 * n - p, p]), np.array([modes @ u[2 * n - depth], modes @ u[depth]])


def _expansion(n: int, alpha: float, terms: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the depths p, the powers 1 + k alpha, and the matrix from the fitted strengths to the a_k."""
    powers = 1.0 + alpha * np.arange(1, terms + 1)
    depth = np.array([round(n * share) for share in _DEPTHS[:terms]])
    if n < 1 or np.unique(depth).size < terms:
        least = (
            f"a lattice that has {terms} particles from its middle to either end, for as many terms"
        )
        raise InvalidInput("n", n, least, "Take more particles, or exterior='truncated'.")
    return depth, powers, np.linalg.inv((n / (n - depth)[:, None]) ** powers)


def _far_field_of(depth: np.ndarray, right: np.ndarray, parity: int) -> LineFarField:
    return LineFarField(depth, right, np.ascontiguousarray(parity * right[:, ::-1]))


@njit()
def _add(depth, right, left, u, y):
    for k in range(depth.size):
        last, first = u[u.size - 1 - depth[k]], u[depth[k]]
        from_right, from_left = right[k], left[k]
        for i in range(y.size):
            y[i] += last * from_right[i] + first * from_left[i]
