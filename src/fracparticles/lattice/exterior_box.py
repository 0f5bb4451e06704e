"""The far-field closure of a square or cubic lattice, the analogue of `exterior` for n = 2, 3.

Far away the solution is that of a point mass: u ~ c r^(-n-alpha) (1 + c' r^-alpha + ...), about a centre that need
not be the origin. Continue the lattice to infinity with

    u_j = a_1 phi_1(j) + ... + a_{n+2} phi_{n+2}(j),
    phi_1 = rho^(-n-alpha), phi_2 = rho^(-n-2 alpha), phi_{2+d} = rho^(-n-alpha-2) j_d / N,   rho = |j| / N,

where the a_k fit the outermost particles of the lattice -N .. N in the least-squares sense. A sum over particles
gains sum_k a_k S_k(i), S_k(i) = sum_{j outside} w_{i-j} phi_k(j): an update of rank n + 2, computed once. Not in the
paper, which truncates the lattice.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import roots_jacobi, roots_legendre

from fracparticles._compiled import njit
from fracparticles.lattice.box import BoxConvolution

__all__ = ["BoxFarField", "box_continuation", "box_far_field"]

# Lattice points up to this many times the cube wanted are summed one by one, those beyond by an integral whose
# relative error is of order (2 N)^-4. In three dimensions a larger cube would take too much memory.
_NEAR = {2: 3, 3: 2}
# The sum over the points beyond is a smooth function of i and of N / j.
_TARGET_NODES = {2: 14, 3: 9}
_NODES = {2: 16, 3: 9}

Weight = Callable[..., np.ndarray]


@dataclass(frozen=True)
class BoxFarField:
    """The sums over the exterior of a square or a cube, sum_k a_k S_k with a = fit u_boundary.

    Attributes
    ----------
    boundary : array of int, shape (B,)
        The outermost particles.
    fit : array, shape (K, B)
        From their strengths to the amplitudes of the K modes.
    sums : array, shape (weights, K, points)
        S_k for each weight.
    """

    boundary: np.ndarray
    fit: np.ndarray
    sums: np.ndarray

    def add(self, u: np.ndarray, y: np.ndarray) -> None:
        """Add the contribution of the exterior to the sums y of every weight."""
        amplitudes = self.fit @ u[self.boundary]
        for sums, total in zip(self.sums, y.reshape(self.sums.shape[0], -1), strict=True):
            _add(amplitudes, sums, total)


def box_far_field(
    weights: Sequence[Weight],
    odd_axes: Sequence[int | None],
    decay: float,
    alpha: float,
    n: int,
    dim: int,
    pad: int = 0,
) -> BoxFarField:
    """Return the exterior sums for the lattice -n .. n, at i = -n-pad .. n+pad in each coordinate.

    Parameters
    ----------
    weights : sequence of callable
        Each w_m as a function of the `dim` coordinates of any real offset m.
    odd_axes : sequence of int or None
        The coordinate in which each weight is odd, None if it is even.
    decay : float
        w_m ~ |m|^(-decay) far away.
    alpha : float
        Fractional order.
    n : int
        Half the number of lattice intervals.
    dim : {2, 3}
        Space dimension.
    pad : int
        How many points beyond each face are wanted.
    """
    boundary, edge = _shell(n, dim, n)
    fit = np.linalg.pinv(np.array(list(_modes(edge / n, alpha, dim))).T)
    near = _near_sums(weights, odd_axes, alpha, n, dim, pad)
    near += _tail_sums(weights, odd_axes, decay, alpha, n, dim, pad)
    return BoxFarField(boundary, fit, near.reshape(len(weights), dim + 2, -1))


def box_continuation(u: np.ndarray, n: int, alpha: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the modes, as they fit the outermost particles of u, on the particles with max |j_d| = 3 n / 4.

    Returns
    -------
    places : array of int, shape (P,)
        Flat indices into u.
    values : array, shape (P,)
        What the modes say there.
    """
    boundary, edge = _shell(n, u.ndim, n)
    modes = np.array(list(_modes(edge / n, alpha, u.ndim))).T
    amplitudes = np.linalg.lstsq(modes, u.reshape(-1)[boundary], rcond=None)[0]
    inner, position = _shell(n, u.ndim, round(0.75 * n))
    return inner, amplitudes @ np.array(list(_modes(position / n, alpha, u.ndim)))


def _modes(position: Iterable[np.ndarray], alpha: float, dim: int) -> Iterator[np.ndarray]:
    """phi_1 .. phi_{n+2}, one after the other, at the positions j / N, `dim` arrays that broadcast."""
    square = sum(np.square(part) for part in position)
    yield square ** (-0.5 * (dim + alpha))
    yield square ** (-0.5 * (dim + 2.0 * alpha))
    for part in position:
        yield square ** (-0.5 * (dim + alpha + 2.0)) * part


def _shell(n: int, dim: int, distance: int) -> tuple[np.ndarray, np.ndarray]:
    """The flat indices and the coordinates of the particles with max |j_d| = distance."""
    lattice = np.indices((2 * n + 1,) * dim).reshape(dim, -1) - n
    there = np.flatnonzero(np.abs(lattice).max(axis=0) == distance)
    return there, lattice[:, there].astype(float)


def _near_sums(
    weights: Sequence[Weight],
    odd_axes: Sequence[int | None],
    alpha: float,
    n: int,
    dim: int,
    pad: int,
) -> np.ndarray:
    """The sums over the lattice points outside -N .. N and inside _NEAR times that, one mode at a time."""
    wide = _NEAR[dim] * (n + pad)
    sources, targets = 2 * wide + 1, 2 * (n + pad) + 1
    offsets = np.arange((sources + targets) // 2, dtype=float)
    convolve = BoxConvolution(
        [weight(*np.meshgrid(*(offsets,) * dim, indexing="ij", sparse=True)) for weight in weights],
        odd_axes,
        sources,
        targets,
    )
    axis = np.arange(-wide, wide + 1) / n
    inside = (slice(wide - n, wide + n + 1),) * dim
    sums = np.empty((len(weights), dim + 2, *(targets,) * dim))
    with np.errstate(divide="ignore", invalid="ignore"):  # at the origin, which is inside
        for k, mode in enumerate(
            _modes(np.meshgrid(*(axis,) * dim, indexing="ij", sparse=True), alpha, dim)
        ):
            mode[inside] = 0.0
            sums[:, k] = convolve(mode)
    return sums


def _tail_sums(
    weights: Sequence[Weight],
    odd_axes: Sequence[int | None],
    decay: float,
    alpha: float,
    n: int,
    dim: int,
    pad: int,
) -> np.ndarray:
    """The sums over the lattice points beyond, at Chebyshev points of i >= 0, mirrored, and from there at every i."""
    nodes = np.polynomial.chebyshev.chebpts1(_TARGET_NODES[dim]) * (n + pad)
    right = nodes[nodes.size // 2 :]
    j, volume = _midpoint_points(
        *_exterior_quadrature(_NEAR[dim] * (n + pad) + 0.5, dim, alpha + decay - 1.0)
    )
    modes = np.array(list(_modes(j / n, alpha, dim))) * volume
    tail = np.empty((len(weights), dim + 2, *(right.size,) * dim))
    for place in np.ndindex(*(right.size,) * dim):
        offset = right[list(place)][:, None] - j
        for k, weight in enumerate(weights):
            tail[(k, slice(None), *place)] = modes @ weight(*offset)
    for axis in range(dim):
        tail = _with_mirror_image(tail, odd_axes, axis, nodes.size % 2)
    lattice = np.arange(-n - pad, n + pad + 1) / (n + pad)
    polynomials = np.polynomial.chebyshev.chebvander(nodes / (n + pad), nodes.size - 1)
    interpolate = np.linalg.solve(
        polynomials.T, np.polynomial.chebyshev.chebvander(lattice, nodes.size - 1).T
    )
    for axis in range(dim):
        tail = np.moveaxis(np.tensordot(tail, interpolate, axes=(2 + axis, 0)), -1, 2 + axis)
    return tail


def _with_mirror_image(
    tail: np.ndarray, odd_axes: Sequence[int | None], axis: int, shared: int
) -> np.ndarray:
    """Continue the sums from i_d >= 0 to all i_d; `shared` counts the nodes at 0, which are their own image.

    Mirror i and j: the sum gets the sign of the weight times that of the mode, of which only phi_{2+d} is odd.
    """
    sign = np.ones(tail.shape[:2])
    sign[[odd == axis for odd in odd_axes]] *= -1.0
    sign[:, 2 + axis] *= -1.0
    image = np.flip(tail, 2 + axis) * sign.reshape(*sign.shape, *(1,) * (tail.ndim - 2))
    kept = np.take(image, range(image.shape[2 + axis] - shared), axis=2 + axis)
    return np.concatenate([kept, tail], axis=2 + axis)


def _exterior_quadrature(start: float, dim: int, exponent: float) -> tuple[np.ndarray, np.ndarray]:
    """Points, shape (dim, points), and volumes for the integral over the outside of the cube |j_d| < X = start.

    On the face of direction d, j_d = +-X / v and j_e = eta_e X / v with 0 < v < 1 and
    -1 < eta_e < 1, so that dj = X^n / v^(n+1) dv deta, and the integrand is v^exponent times a smooth function.
    """
    t, jacobi = roots_jacobi(_NODES[dim], 0.0, exponent)
    v = 0.5 * (1.0 + t)
    radial = jacobi / 2.0 ** (exponent + 1.0) * start**dim / v ** (dim + 1.0 + exponent)
    eta, legendre = roots_legendre(_NODES[dim])
    grid = np.meshgrid(v, *(eta,) * (dim - 1), indexing="ij")
    volumes = np.meshgrid(radial, *(legendre,) * (dim - 1), indexing="ij")
    along, across = start / grid[0], [eta * start / grid[0] for eta in grid[1:]]
    points = []
    for axis in range(dim):
        for sign in (-1.0, 1.0):
            face = [*across[:axis], sign * along, *across[axis:]]
            points.append(np.stack([part.ravel() for part in face]))
    volume = np.prod(volumes, axis=0).ravel()
    return np.concatenate(points, axis=1), np.tile(volume, 2 * dim)


def _midpoint_points(j: np.ndarray, volume: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """From int g to sum_j g(j) = int (g - Laplacian(g) / 24) + ..., the Laplacian by central differences."""
    dim = j.shape[0]
    steps = np.concatenate([np.zeros((1, dim)), np.eye(dim), -np.eye(dim)])
    factors = np.array([1.0 + 2.0 * dim / 24.0, *[-1.0 / 24.0] * (2 * dim)])
    return (j[:, None, :] + steps.T[:, :, None]).reshape(dim, -1), np.outer(factors, volume).ravel()


@njit()
def _add(amplitudes, sums, y):
    for k in range(amplitudes.size):
        amplitude, mode = amplitudes[k], sums[k]
        for i in range(y.size):
            y[i] += amplitude * mode[i]
