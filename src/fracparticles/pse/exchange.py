"""Particle strength exchange (26) on particles anywhere, in one, two or three dimensions."""

from __future__ import annotations

import math
import warnings

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array, diags_array, eye_array
from scipy.sparse.linalg import ArpackNoConvergence, eigsh
from scipy.spatial import cKDTree

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.errors import AccuracyWarning, InvalidInput, StabilityWarning
from fracparticles.pse.moments import warn_of_moment
from fracparticles.pse.shapes import Kernel, kernel_of
from fracparticles.pse.smoothing import warn_of_exchange

__all__ = ["StrengthExchange", "cell_volumes"]

_MOST_PAIRS = 2**25  # of neighbours, each twice in the matrix
_VOLUMES = 1e-300, 1e300  # the least and the greatest: their products with a kernel keep all digits
_DENSE = 64  # particles up to which all eigenvalues are computed
_GROWS = 1e-5  # share of the rate: an eigenvalue above it is warned of


class StrengthExchange:
    """dQ_i/dt = (D / eps^2) sum_p [Q_p V_i - Q_i V_p] eta_eps(x_i - x_p)  (26), an `Operator` of `time`.

    If eta is symmetric, p loses to i as much as i gains from p, so that sum_i dQ_i/dt = 0 for any positions and
    volumes. Q_i = c V_i is a steady state for any kernel. If eta >= 0 is symmetric, sum_i Q_i^2 / V_i does not grow.

    Raises `InvalidInput` if a volume, the radius or the diffusivity is not positive and finite, a position is not
    finite, the kernel has another dimension, or the particles have more neighbours than memory holds.

    Warns with `AccuracyWarning` if eta is not symmetric. Warns with it, too, if the second moment of eta at some
    particles, sum_p V_p |x_p - x_i|^2 eta_eps / (2 d eps^2), is far less or far more than one: diffusion there is too
    slow or too fast by this factor. Warns with `StabilityWarning` if eta is negative somewhere and A amplifies,
    whatever the step. `apply` warns with `AccuracyWarning`, the first time, if epsilon is too large for the strengths.

    Parameters
    ----------
    x : array_like, shape (N,) or (N, d)
        Positions, d = 1, 2 or 3.
    volumes : array_like, shape (N,) or ()
        V_i, positive.
    epsilon : float
        Kernel radius, positive.
    kernel : Kernel
        eta, of d dimensions: a function of the signed distance in one dimension, of the distance in two and three.
    diffusivity : float
        D, positive.

    Attributes
    ----------
    matrix : csr_array, shape (N, N)
        A of dQ/dt = A Q.
    rate : float
        A bound of |lambda| over the eigenvalues of A (Gershgorin, by columns).
    """

    def __init__(
        self,
        x: ArrayLike,
        volumes: ArrayLike,
        epsilon: float,
        kernel: Kernel,
        diffusivity: float = 1.0,
    ) -> None:
        points = check.places("x", x)
        points = points[:, None] if points.ndim == 1 else points
        if points.ndim != 2 or not points.size or points.shape[1] > 3:
            shown, allowed = f"array of shape {points.shape}", "shape (N,) or (N, d), d = 1, 2 or 3"
            raise InvalidInput("x", shown, allowed, "Give one row for each particle.")
        self.size, dim = points.shape
        kernel = kernel_of(dim, kernel)
        v = check.within("volumes", volumes, *_VOLUMES, shape=(self.size,))
        epsilon = check.scale("epsilon", epsilon)
        diffusivity = check.scale("diffusivity", diffusivity)
        if abs((2 + dim) * math.log10(epsilon)) > 300.0:
            allowed = "a number whose power does not overflow"
            raise InvalidInput("epsilon", epsilon, allowed, "Change the units.")
        tree, near = cKDTree(points), kernel.reach * epsilon
        if self.size**2 > _MOST_PAIRS and tree.count_neighbors(tree, near) > 2 * _MOST_PAIRS:
            allowed = f"one with at most {_MOST_PAIRS} pairs of neighbours"
            raise InvalidInput("epsilon", epsilon, allowed, "Take a smaller one.")
        pairs = tree.query_pairs(near, output_type="ndarray")
        i, p = np.concatenate([pairs, pairs[:, ::-1]]).T
        apart = (points[i] - points[p]) / epsilon
        z = apart[:, 0] if dim == 1 else np.sqrt((apart**2).sum(axis=1))
        with np.errstate(over="ignore", invalid="ignore"):
            eta = diffusivity / epsilon ** (2 + dim) * kernel(z)
            gain = csr_array((v[i] * eta, (i, p)), shape=(self.size, self.size))
            # Without neighbours bincount returns whole numbers.
            loss = np.bincount(i, v[p] * eta, self.size).astype(float)
            self.matrix = (gain - diags_array(loss)).tocsr()
            self.rate = float(check.finite_result("volumes", abs(self.matrix).sum(axis=0).max()))
            unit = epsilon**2 / (2.0 * dim * diffusivity)
            moments = np.bincount(i, unit * v[p] * eta * z * z, self.size).astype(float)
        self._of_kernel = points, v, epsilon, kernel
        self._diffusivity, self._moments, self._asked = diffusivity, moments, False
        half = len(pairs)
        if not np.array_equal(eta[:half], eta[half:]):
            warnings.warn(
                "the kernel is not symmetric: the exchange does not conserve the total on any particles but a lattice. "
                "Take a symmetric kernel.",
                AccuracyWarning,
                stacklevel=2,
            )
        elif eta.min(initial=0.0) < 0.0:
            _warn_of_growth(self.matrix, np.sqrt(v), self.rate)
        warn_of_moment(moments, "particles", stacklevel=2)

    def apply(self, u: FloatArray) -> FloatArray:
        """Return A Q, for an array of shape (N,).

        Raises `InvalidInput` if it has another shape; so does `combine`.
        """
        u = check.operand("u", u, (self.size,), complex_too=True)
        if not self._asked:
            self._ask(u)
        return np.asarray(self.matrix @ u)

    def combine(
        self, u: FloatArray, out: FloatArray, scale: float, shift: float = 0.0, keep: float = 0.0
    ) -> None:
        """Write scale A u + shift u + keep out into `out`."""
        check.operand("u", u, (self.size,), complex_too=True)
        check.operand("out", out, (self.size,), complex_too=True)
        out *= keep
        out += shift * u
        out += scale * (self.matrix @ u)

    def _ask(self, u: FloatArray) -> None:
        """Judge the first strengths only: later ones are smoother."""
        self._asked = True
        points, v, epsilon, kernel = self._of_kernel
        with np.errstate(all="ignore"):
            matrix = self.matrix / self._diffusivity
            warn_of_exchange(points, v, u / v, epsilon, kernel, matrix, self._moments)


def _warn_of_growth(matrix: csr_array, root: np.ndarray, rate: float) -> None:
    """Warn if the largest eigenvalue of a matrix that the square roots of the volumes make symmetric is positive."""
    n = root.size
    symmetric = diags_array(1.0 / root) @ matrix @ diags_array(root)
    if n <= _DENSE:
        greatest = float(np.linalg.eigvalsh(symmetric.toarray()).max())
    else:
        # The shift makes all eigenvalues positive, so that the tolerance is relative to the rate.
        shifted = symmetric + rate * eye_array(n)
        start = np.cos(2.4 * np.arange(n))  # any vector that is not constant, the same every time
        try:
            greatest = float(eigsh(shifted, 1, which="LA", v0=start, tol=1e-6)[0][0]) - rate
        except ArpackNoConvergence as error:
            greatest = float(error.eigenvalues.max(initial=rate)) - rate
    if greatest > _GROWS * rate:
        warnings.warn(
            f"strengths grow like exp({greatest:.3g} t), whatever the step: the kernel is negative somewhere, and the "
            "particles are too irregular for it. Take a larger epsilon, or a kernel that is positive.",
            StabilityWarning,
            stacklevel=3,
        )


def cell_volumes(x: ArrayLike) -> FloatArray:
    """V_j = x_(j+1/2) - x_(j-1/2) of particles in rising order, shape (N,), the half points in the middle (below (10)).

    At the ends a cell extends as far outside as inside.

    Raises `InvalidInput` if there are fewer than two particles, if two are in one place, or if they are not in order.
    """
    x = check.positions("x", x, least=2, rising=True)
    middle = 0.5 * (x[1:] + x[:-1])
    edges = np.concatenate([[2.0 * x[0] - middle[0]], middle, [2.0 * x[-1] - middle[-1]]])
    return np.diff(edges)
