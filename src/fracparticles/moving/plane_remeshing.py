r"""Redistribution of particles in the plane onto the lattice x = p h, y = q h:

    U_pq = sum_j U_j W((x_p - x_j) / h) W((y_q - y_j) / h),

W an interpolation function of the line (`remeshing`), with its moments in each coordinate.
"""

from __future__ import annotations

import numpy as np

from fracparticles.errors import InvalidInput
from fracparticles.moving.remeshing import REACH, ULPS, interpolation_function

__all__ = ["Particles", "on_square", "remesh_plane"]

Particles = tuple[np.ndarray, np.ndarray, np.ndarray]  # x, y and strengths

_MOST = 2**13  # lattice points along an axis: a particle that needs more has run away


def remesh_plane(
    x: np.ndarray, y: np.ndarray, strength: np.ndarray, spacing: float, name: str
) -> Particles:
    """Return positions and strengths on the lattice (p h, q h), a rectangle that holds what the particles give.

    Every particle is split among as many points as the interpolation function `name` reaches, in each coordinate.

    Raises `InvalidInput` if a particle has run away.
    """
    cells = [_cell(*axis, spacing) for axis in (("x", x), ("y", y))]
    (first_x, w_x), (first_y, w_y) = (_split(cell, name) for cell in cells)
    low_x, low_y = first_x.min(), first_y.min()
    points = w_x.shape[1]
    shape = int(first_x.max() - low_x) + points, int(first_y.max() - low_y) + points
    q, total = strength.reshape(-1), np.zeros(shape[0] * shape[1])
    for a in range(points):
        for b in range(points):
            index = (first_x - low_x + a) * shape[1] + (first_y - low_y + b)
            total += np.bincount(index, q * w_x[:, a] * w_y[:, b], total.size)
    lines = (
        spacing * (low + np.arange(count)) for low, count in zip((low_x, low_y), shape, strict=True)
    )
    at_x, at_y = np.meshgrid(*lines, indexing="ij")
    return at_x, at_y, total.reshape(shape)


def on_square(
    x: np.ndarray, y: np.ndarray, strength: np.ndarray, spacing: float, n: int
) -> np.ndarray:
    """The strengths of -n .. n in both coordinates; what lies beyond is left out."""
    out = np.zeros((2 * n + 1, 2 * n + 1))
    index = [np.rint(v / spacing).astype(int) + n for v in (x[:, 0], y[0])]
    inside = [(i >= 0) & (i <= 2 * n) for i in index]
    out[np.ix_(index[0][inside[0]], index[1][inside[1]])] = strength[np.ix_(*inside)]
    return out


def _cell(field: str, v: np.ndarray, spacing: float) -> np.ndarray:
    """The coordinates in units of the spacing, if a lattice can hold them."""
    cell = v.reshape(-1) / spacing
    if not cell.max() - cell.min() < _MOST:
        shown = f"particles from {v.min():.6g} to {v.max():.6g}"
        allowed = f"particles less than {_MOST * spacing:.4g} apart, for a lattice of the spacing {spacing:.4g}"
        raise InvalidInput(field, shown, allowed, "Look for a particle that ran away.")
    return cell


def _split(cell: np.ndarray, name: str) -> tuple[np.ndarray, np.ndarray]:
    """The first of the lattice points of each particle, and the weights of all."""
    nearest = np.rint(cell)
    # p h / h may miss p by an ulp, which would leak a little to the neighbours of p each time.
    cell = np.where(np.abs(cell - nearest) <= ULPS * np.abs(cell), nearest, cell)
    left, reach = np.floor(cell), REACH[name]
    distance = (cell - left)[:, None] - np.arange(1.0 - reach, reach + 1.0)
    return left.astype(np.int64) + 1 - reach, interpolation_function(name, distance)
