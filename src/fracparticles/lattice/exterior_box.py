"""The far-field closure of a square or cubic lattice, the analogue of `exterior` for dim = 2, 3.

Far away the solution is like that of a point mass, u ~ c r^(-dim-alpha) (1 + c' r^-alpha + ...), about a centre that
need not be the origin. Continue the lattice -n .. n to infinity with

    u_j = a_1 phi_1(j) + ... + a_{dim+2} phi_{dim+2}(j),
    phi_1 = rho^(-dim-alpha), phi_2 = rho^(-dim-2 alpha), phi_{2+d} = rho^(-dim-alpha-2) j_d / n,   rho = |j| / n,

where the a_k fit the outermost particles of the lattice in the least-squares sense. An operator A then gains
sum_k a_k S_k(i), S_k = A (phi_k outside of the lattice): an update of rank dim + 2, computed once. This is not in the
paper, which truncates the lattice.

The outside is the whole space minus the inside. Let psi_k be phi_k, made smooth within the lattice as a mixture of
Gaussians:

    rho^(-2p)  ->  1/Gamma(p) int_0^c t^(p-1) exp(-t rho^2) dt,

psi_k equals phi_k to round-off for rho >= 1. On the infinite lattice A psi_k is an integral over the wave vectors: the
integrand is the transform of psi_k times the symbol of A. The part of the inside is one application of A. So

    S_k = A psi_k - A (psi_k on the lattice).

The transform (`smooth_modes`) is radial, and so is the symbol where the lattice has no aliases; the aliases add a short
Fourier series.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import permutations

import numpy as np

from fracparticles._compiled import njit
from fracparticles.errors import InvalidInput
from fracparticles.lattice.smooth_modes import radial_integral, radial_parts, transforms

__all__ = ["BoxFarField", "box_continuation", "box_far_field"]

# The greatest c. At the faces, rho = 1, the smooth mode differs from phi_k by exp(-c) c^(p-1) / Gamma(p) = 1e-10. On a
# lattice of few points c = pi n: the transform has then fallen as far at 2 pi, where the symbol repeats its value at 0.
_SHARPNESS = 30.0
# By dimension, the period of the Fourier series of the part of the aliases, in units of n. This part falls so fast in
# space that its images are small.
_PERIOD = {2: 8.0, 3: 4.0}
# Less than this share of the integrand is round-off. It must not be larger: psi_k is some thousand times larger in the
# middle than at the faces, and the sums are differences of large values there.
_ROUND_OFF = 1e-13

Symbol = Callable[[np.ndarray], np.ndarray]
Sums = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class BoxFarField:
    """The sums that the exterior of a square or a cube adds to A u, sum_k a_k S_k with a = fit u_boundary.

    S_1 and S_2 are even in every coordinate. S_{2+d} is odd in j_d and even in the others, and is the same function of
    (j_d, the others in any order) for all d. So i >= 0 and d = 1 are enough.

    Attributes
    ----------
    boundary : array of int, shape (B,)
        The outermost particles.
    fit : array, shape (dim + 2, B)
        The matrix from their strengths to the amplitudes a_k.
    sums : array, shape (4, n + 1, 1 or n + 1, n + 1)
        S_1, S_2, S_3 and the sum that is odd in the last coordinate, for i >= 0 in each of them.
    """

    boundary: np.ndarray
    fit: np.ndarray
    sums: np.ndarray

    def add(self, u: np.ndarray, y: np.ndarray) -> None:
        """Add the contribution of the exterior to y, shape (points,)."""
        _, n, middle, _ = np.array(self.sums.shape) - 1
        _add(self.fit @ u[self.boundary], self.sums, y.reshape(2 * n + 1, 2 * middle + 1, -1))


def box_far_field(symbol: Symbol, inside: Sums, alpha: float, n: int, dim: int) -> BoxFarField:
    """Return the exterior sums of an operator for the lattice -n .. n in each coordinate.

    Parameters
    ----------
    symbol : callable
        The symbol of A, for wave vectors theta in -pi .. pi, shape (.., dim).
    inside : callable
        A u for strengths on the lattice alone, shape (2 n + 1,) * dim; it may return a buffer.
    alpha : float
        Fractional order.
    n : int
        Half the number of lattice intervals.
    dim : {2, 3}
        Space dimension.

    Raises
    ------
    InvalidInput
        If the lattice is a single particle.
    """
    if n < 1:
        raise InvalidInput("n", n, "at least 1", "Take more particles, or exterior='truncated'.")
    boundary, edge = _shell(n, dim, n)
    modes = _modes(edge / n, alpha)
    k = radial_integral(dim)[0]
    directions = np.stack([np.eye(dim)[0], np.full(dim, dim**-0.5)])  # an axis and a diagonal
    along, across = _periodic(symbol, directions[:, None] * (k[:, None] / n))
    sharpness = min(_SHARPNESS, np.pi * n)
    psi_hat = transforms(k, alpha, dim, sharpness)
    values, number = radial_parts(along, psi_hat, dim, alpha, n)
    sums = np.empty((4, n + 1, n + 1 if dim == 3 else 1, n + 1))
    # One application serves two modes: the sums of psi_1 are even along the first axis, those of psi_3 odd.
    u = np.empty((2 * n + 1,) * dim)
    _psi(values[[3, 5]], number, _as_planes(u))
    _outside(values[[0, 2]], number, _as_planes(inside(u)), sums[0], sums[2])
    _psi(values[[4]], number, _as_planes(u))
    _outside(values[[1]], number, _as_planes(inside(u)), sums[1], sums[3])
    size = psi_hat[0] * k**dim
    aliased = k[np.abs(across - along) * size > _ROUND_OFF * np.abs(along * size).max()]
    if aliased.size:
        shell = aliased[0], aliased[-1]
        _add_aliases(symbol, alpha, n, sharpness, shell, sums[:3])
    sums[3] = sums[2].transpose(1, 2, 0) if dim == 3 else sums[2].transpose(2, 1, 0)
    return BoxFarField(boundary, np.linalg.solve(modes @ modes.T, modes), sums)


def box_continuation(u: np.ndarray, n: int, alpha: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the continuation sum_k a_k phi_k, fitted to the outermost particles, at those with max |j_d| = 3 n / 4.

    `u` holds the strengths, shape (2 n + 1,) * dim.

    Returns
    -------
    places : array of int, shape (P,)
        Flat indices into u.
    values : array, shape (P,)
        The values of the continuation there.
    """
    boundary, edge = _shell(n, u.ndim, n)
    modes = _modes(edge / n, alpha).T
    amplitudes = np.linalg.lstsq(modes, u.reshape(-1)[boundary], rcond=None)[0]
    inner, position = _shell(n, u.ndim, round(0.75 * n))
    return inner, amplitudes @ _modes(position / n, alpha)


def _modes(position: np.ndarray, alpha: float) -> np.ndarray:
    """phi_1 .. phi_{dim+2}, shape (dim + 2, points), at positions j / n of shape (dim, points)."""
    dim = position.shape[0]
    square = np.square(position).sum(axis=0)
    first = square ** (-0.5 * (dim + alpha))
    return np.stack([first, first * square ** (-0.5 * alpha), *(first / square * position)])


def _shell(n: int, dim: int, distance: int) -> tuple[np.ndarray, np.ndarray]:
    """The flat indices and the coordinates of the particles with max |j_d| = distance."""
    there = np.zeros((2 * n + 1,) * dim, dtype=bool)
    there[(slice(n - distance, n + distance + 1),) * dim] = True
    there[(slice(n - distance + 1, n + distance),) * dim] = False
    places = np.flatnonzero(there)
    return places, np.array(np.unravel_index(places, there.shape)) - float(n)


def _periodic(symbol: Symbol, theta: np.ndarray) -> np.ndarray:
    return symbol(theta - 2.0 * np.pi * np.round(theta / (2.0 * np.pi)))


def _add_aliases(
    symbol: Symbol,
    alpha: float,
    n: int,
    sharpness: float,
    shell: tuple[float, float],
    sums: np.ndarray,
) -> None:
    """Add the part of A psi_k, k = 1, 2, 3, that comes from the part of the symbol that is not radial, |k| in a shell.

    The symbol less the symbol along an axis is of fourth order in k, so that its image of psi_k falls fast.
    """
    dim = 2 if sums.shape[2] == 1 else 3
    step = 2.0 * np.pi / _PERIOD[dim]
    k = step * np.arange(int(shell[1] / step) + 1)
    # One of all vectors that differ only in the order of their components.
    place = np.indices((k.size,) * dim).reshape(dim, -1)
    length = np.sqrt(np.square(k[place]).sum(axis=0))
    inner = (shell[0] <= length) & (length <= shell[1]) & (np.diff(place, axis=0) >= 0).all(axis=0)
    place, length = place[:, inner], length[inner]
    along = np.outer(length, np.eye(dim)[0])
    rest = _periodic(symbol, k[place].T / n) - _periodic(symbol, along / n)
    values = rest * transforms(length, alpha, dim, sharpness)
    series = np.zeros((2, *(k.size,) * dim))
    for order in permutations(range(dim)):
        series[(slice(None), *place[list(order)])] = values

    waves = np.outer(k, np.arange(n + 1) / n)
    both = np.where(k > 0.0, 2.0, 1.0)[:, None] / _PERIOD[dim]  # k and -k
    cosines, sines = both * np.cos(waves), both * k[:, None] / (dim + alpha) * np.sin(waves)
    for image, total, first in zip(series[[0, 1, 0]], sums, (cosines, cosines, sines), strict=True):
        for factor in (first, *(cosines,) * (dim - 1)):
            image = np.tensordot(image, factor, axes=(0, 0))
        total += image.reshape(total.shape)


def _as_planes(block: np.ndarray) -> np.ndarray:
    return block if block.ndim == 3 else block[:, None, :]


@njit()
def _psi(values, number, u):
    """u = psi from the first row of values; plus j_1 / n times the second row, if there is one."""
    n, middle = u.shape[0] // 2, u.shape[1] // 2
    for i in range(u.shape[0]):
        x = (i - n) / n
        for j in range(u.shape[1]):
            square = (i - n) ** 2 + (j - middle) ** 2
            for k in range(u.shape[2]):
                column = number[square + (k - n) ** 2]
                u[i, j, k] = values[0, column]
                if values.shape[0] == 2:
                    u[i, j, k] += x * values[1, column]


@njit()
def _outside(values, number, y, even, odd):
    """A psi less the part y of the inside, for i >= 0: the part that is even along the first axis, and the odd part."""
    n, middle = y.shape[0] // 2, y.shape[1] // 2
    for i in range(even.shape[0]):
        for j in range(even.shape[1]):
            right, left = y[n + i, middle + j], y[n - i, middle + j]
            for k in range(even.shape[2]):
                column = number[i * i + j * j + k * k]
                even[i, j, k] = values[0, column] - 0.5 * (right[n + k] + left[n + k])
                if values.shape[0] == 2:
                    inner = 0.5 * (right[n + k] - left[n + k])
                    odd[i, j, k] = i / n * values[1, column] - inner


@njit()
def _add(amplitudes, sums, y):
    n, middle = y.shape[0] // 2, y.shape[1] // 2
    a, b, c, last = amplitudes[0], amplitudes[1], amplitudes[2], amplitudes[-1]
    row = np.empty(n + 1)
    for i in range(y.shape[0]):
        p = abs(i - n)
        along = c if i > n else -c
        for j in range(y.shape[1]):
            q = abs(j - middle)
            first, second, third, odd = sums[0, p, q], sums[1, p, q], sums[2, p, q], sums[3, p, q]
            for k in range(n + 1):
                row[k] = a * first[k] + b * second[k] + along * third[k]
            if middle > 0:
                across = amplitudes[3] if j > middle else -amplitudes[3]
                other = sums[2, q, p]
                for k in range(n + 1):
                    row[k] += across * other[k]
            y[i, j, n] += row[0]
            right, left = y[i, j, n:], y[i, j, : n + 1][::-1]
            for k in range(1, n + 1):
                right[k] += row[k] + last * odd[k]
                left[k] += row[k] - last * odd[k]
