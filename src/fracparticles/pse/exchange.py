"""Particle strength exchange (26) on particles anywhere, in one, two or three dimensions."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array, diags_array
from scipy.spatial import cKDTree

from fracparticles.errors import InvalidInput
from fracparticles.pse.shapes import Kernel

__all__ = ["StrengthExchange", "cell_volumes"]

FloatArray = NDArray[np.float64]


class StrengthExchange:
    """dQ_i/dt = (D / eps^2) sum_p [Q_p V_i - Q_i V_p] eta_eps(x_i - x_p)  (26), an `Operator` of the integrators.

    What i gains of p, p loses to i if eta is symmetric: then sum_i dQ_i/dt = 0 for any positions and volumes.
    Q_i = c V_i is a steady state for any kernel; and if eta >= 0 is symmetric, sum_i Q_i^2 / V_i does not grow.

    Parameters
    ----------
    x : array_like, shape (N,) or (N, d)
        Positions, different from each other.
    volumes : array_like, shape (N,) or ()
        V_i, positive.
    epsilon : float
        Kernel radius, positive.
    kernel : Kernel
        eta; in one dimension a function of the signed distance, in more of the distance.
    diffusivity : float
        D.

    Attributes
    ----------
    matrix : csr_array, shape (N, N)
        A of dQ/dt = A Q.
    rate : float
        A bound of |lambda| over the eigenvalues of A (Gershgorin, by columns).

    Raises
    ------
    InvalidInput
        If a volume or the radius is not positive and finite, or a position not finite.
    """

    least_excess: float = 0.0

    def __init__(
        self,
        x: ArrayLike,
        volumes: ArrayLike,
        epsilon: float,
        kernel: Kernel,
        diffusivity: float = 1.0,
    ) -> None:
        points = np.asarray(x, dtype=float)
        points = points[:, None] if points.ndim == 1 else points
        self.size, dim = points.shape
        v = np.broadcast_to(np.asarray(volumes, dtype=float), self.size)
        for name, value in (("volumes", v), ("epsilon", epsilon)):
            if not (np.isfinite(value) & (np.asarray(value) > 0.0)).all():
                raise InvalidInput(name, value, "positive and finite", "Check the particles.")
        if not np.isfinite(points).all():
            raise InvalidInput("x", x, "finite", "Check the particles.")
        pairs = cKDTree(points).query_pairs(kernel.reach * epsilon, output_type="ndarray")
        i, p = np.concatenate([pairs, pairs[:, ::-1]]).T
        apart = (points[i] - points[p]) / epsilon
        z = apart[:, 0] if dim == 1 else np.sqrt((apart**2).sum(axis=1))
        eta = diffusivity / epsilon ** (2 + dim) * kernel(z)
        gain = csr_array((v[i] * eta, (i, p)), shape=(self.size, self.size))
        loss = np.bincount(i, v[p] * eta, self.size)
        self.matrix = (gain - diags_array(loss)).tocsr()
        self.rate = float(abs(self.matrix).sum(axis=0).max())

    def apply(self, u: FloatArray) -> FloatArray:
        """Return A Q."""
        return np.asarray(self.matrix @ u)

    def update(self, u: FloatArray, a: float, b: float, c: float, v: FloatArray) -> None:
        """Write a (A Q) + b Q + c v into v."""
        v *= c
        v += b * u
        v += a * (self.matrix @ u)


def cell_volumes(x: FloatArray) -> FloatArray:
    """V_j = x_(j+1/2) - x_(j-1/2) of sorted particles, the half points in the middle (below (10)).

    At the ends a cell is as wide outside as inside.
    """
    middle = 0.5 * (x[1:] + x[:-1])
    edges = np.concatenate([[2.0 * x[0] - middle[0]], middle, [2.0 * x[-1] - middle[-1]]])
    return np.diff(edges)
