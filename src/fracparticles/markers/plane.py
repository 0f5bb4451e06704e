r"""Loading of markers in the plane, Sec. 2.2.

With the marginals <f>_y(x) = int f dy and <f>_x(y) = int f dx, the paper loads

    x_k:  int_-inf^x <f>_y dx' / sigma = (k - 1/2) / n_x,     y_l:  int_-inf^y <f>_x dy' / sigma = (l - 1/2) / n_y,

and W = sigma / (n_x n_y) for every pair (x_k, y_l). These markers have the density <f>_y <f>_x / sigma, which is f if
and only if f is a product. Two ways to mend it, both with sum W = sigma or nearly:

- `weighted`: the same places with W = sigma / (n_x n_y) f / (<f>_y <f>_x / sigma);
- `sequential`: x by its marginal, then y by the density of y given that x; all weights equal.

`TwoBlobs` is a density that goes from a product to the contrary.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import erf

from fracparticles.markers.shapes import Shape
from fracparticles.special.arguments import positive_integer, positive_real

__all__ = ["TwoBlobs", "decoupled", "reconstruct", "sequential", "weighted"]

Loading = tuple[np.ndarray, np.ndarray, np.ndarray]


@dataclass(frozen=True)
class TwoBlobs:
    """f = exp(-(x - a)^2 - (y - a)^2) + exp(-(x + a)^2 - (y + a)^2); a product only for a = 0.

    Attributes
    ----------
    a : float
        0 or more.
    """

    a: float

    @property
    def total(self) -> float:
        """sigma = 2 pi."""
        return 2.0 * math.pi

    def value(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Return f(x, y)."""
        a = self.a
        return np.exp(-((x - a) ** 2) - (y - a) ** 2) + np.exp(-((x + a) ** 2) - (y + a) ** 2)

    def marginal(self, x: np.ndarray) -> np.ndarray:
        """Return <f>_y(x), which is <f>_x too."""
        return math.sqrt(math.pi) * (np.exp(-((x - self.a) ** 2)) + np.exp(-((x + self.a) ** 2)))

    def product(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Return <f>_y(x) <f>_x(y) / sigma."""
        return self.marginal(x) * self.marginal(y) / self.total

    def quantile(self, xi: np.ndarray, right: np.ndarray | float = 0.5) -> np.ndarray:
        """Return x below which the part xi lies, of blobs with the parts `right` and 1 - `right`, by bisection."""
        xi, right = np.broadcast_arrays(np.asarray(xi, dtype=float), right)
        low = np.full(xi.shape, -self.a - 7.0)  # erfc(7) is 4e-23
        high = -low
        for _ in range(60):
            x = 0.5 * (low + high)
            part = right * (1.0 + erf(x - self.a)) + (1.0 - right) * (1.0 + erf(x + self.a))
            below = 0.5 * part < xi
            low, high = np.where(below, x, low), np.where(below, high, x)
        return 0.5 * (low + high)

    def right(self, x: np.ndarray) -> np.ndarray:
        """Return the part that the blob at (a, a) has of what lies at x."""
        return 1.0 / (1.0 + np.exp(-4.0 * self.a * x))


def decoupled(
    quantile: Callable[[np.ndarray], np.ndarray], total: float, counts: tuple[int, int]
) -> Loading:
    """Return the paper's loading x, y, W, each of shape (n_x n_y,), for equal marginals.

    Raises
    ------
    InvalidInput
        If a count is not a positive whole number, or the total not a positive number.
    """
    x, y = (quantile(_midpoints(n)) for n in counts)
    x, y = (part.ravel() for part in np.meshgrid(x, y, indexing="ij"))
    return x, y, np.full(x.size, positive_real("total", total) / x.size)


def weighted(density: TwoBlobs, counts: tuple[int, int]) -> Loading:
    """Return the same places with the weights that make the density f."""
    x, y, w = decoupled(density.quantile, density.total, counts)
    return x, y, w * density.value(x, y) / density.product(x, y)


def sequential(density: TwoBlobs, counts: tuple[int, int]) -> Loading:
    """Return markers of equal weight with x by its marginal, and y given x."""
    x = density.quantile(_midpoints(counts[0]))[:, None]
    y = density.quantile(_midpoints(counts[1]), density.right(x))
    x = np.broadcast_to(x, y.shape).ravel()
    return x, y.ravel(), np.full(x.size, density.total / x.size)


def reconstruct(
    shape: Shape, epsilon: float, markers: Loading, x: np.ndarray, y: np.ndarray
) -> np.ndarray:
    """Return F = sum_j W_j S_eps(x - x_j) S_eps(y - y_j) on the grid, shape (x, y)."""
    xj, yj, w = markers
    epsilon = positive_real("epsilon", epsilon)
    along_x = shape((x[:, None] - xj) / epsilon) * w
    along_y = shape((y[:, None] - yj) / epsilon)
    return along_x @ along_y.T / epsilon**2


def _midpoints(count: int) -> np.ndarray:
    return (np.arange(positive_integer("count", count)) + 0.5) / count
