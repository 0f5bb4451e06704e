r"""Loading of markers in the plane, Sec. 2.2.

With the marginals <f>_y(x) = int f dy and <f>_x(y) = int f dx, the paper loads

    x_k:  int_-inf^x <f>_y dx' / sigma = (k - 1/2) / n_x,     y_l:  int_-inf^y <f>_x dy' / sigma = (l - 1/2) / n_y,

and W = sigma / (n_x n_y) for every pair (x_k, y_l). These markers have the density <f>_y <f>_x / sigma, which is f if
and only if f is a product. Two loadings correct this, both with sum W = sigma or nearly:

- `weighted`: the same places with W = sigma / (n_x n_y) f / (<f>_y <f>_x / sigma);
- `sequential`: x by its marginal, then y by the density of y given that x; all weights equal.

`TwoBlobs` is a density that is a product at one end of its range and far from one at the other. All functions raise
`InvalidInput` if an argument is not valid, the arrays do not fit together, or there are too many markers for memory.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from scipy.special import erf, erfc

from fracparticles import arguments as check
from fracparticles.errors import InvalidInput
from fracparticles.markers.profiles import bisected
from fracparticles.markers.shapes import Shape

__all__ = ["TwoBlobs", "decoupled", "reconstruct", "sequential", "weighted"]

Loading = tuple[np.ndarray, np.ndarray, np.ndarray]

_TAIL = 1e-10  # a part: erf keeps six digits of it
_MOST_TERMS = 2**27  # of markers and points along one axis


@dataclass(frozen=True)
class TwoBlobs:
    """f = exp(-(x - a)^2 - (y - a)^2) + exp(-(x + a)^2 - (y + a)^2); a product only for a = 0.

    Raises `InvalidInput` if a is outside its range; so do the methods, of values outside their range or shapes that do
    not fit.

    Attributes
    ----------
    a : float
        From 0 to 1000.
    """

    a: float

    def __post_init__(self) -> None:
        check.fields(self, a=partial(check.real_between, low=0.0, high=1000.0))

    @property
    def total(self) -> float:
        """sigma = 2 pi."""
        return 2.0 * math.pi

    def value(self, x: Any, y: Any) -> np.ndarray:
        """Return f(x, y)."""
        (x, y), a = check.together(x=check.places("x", x), y=check.places("y", y)), self.a
        return np.exp(-((x - a) ** 2) - (y - a) ** 2) + np.exp(-((x + a) ** 2) - (y + a) ** 2)

    def marginal(self, x: Any) -> np.ndarray:
        """Return <f>_y(x), which is <f>_x too."""
        x = check.places("x", x)
        return math.sqrt(math.pi) * (np.exp(-((x - self.a) ** 2)) + np.exp(-((x + self.a) ** 2)))

    def product(self, x: Any, y: Any) -> np.ndarray:
        """Return <f>_y(x) <f>_x(y) / sigma."""
        check.together(x=check.places("x", x), y=check.places("y", y))
        return self.marginal(x) * self.marginal(y) / self.total

    def quantile(self, xi: Any, right: Any = 0.5) -> np.ndarray:
        """Return x below which the fraction 0 < xi < 1 lies, for blobs with the fractions `right` and 1 - `right`.

        By bisection, to round-off in xi or, for small xi and 1 - xi, in these.
        """
        xi = check.within("xi", xi, 0.0, 1.0, inside=True)
        xi, right = check.together(xi=xi, right=check.within("right", right, 0.0, 1.0))

        def part(x: np.ndarray) -> np.ndarray:
            both = right * (1.0 + erf(x - self.a)) + (1.0 - right) * (1.0 + erf(x + self.a))
            return 0.5 * both

        x = self._bisected(lambda x: part(x) < xi, xi.shape, 7.0)  # erfc(7) is 4e-23
        low, high = xi < _TAIL, xi > 1.0 - _TAIL
        if (low | high).any():
            # What lies to the left, or to the right, without the 1 in which it would drown.
            end, sign = np.where(low, xi, 1.0 - xi), np.where(low, -1.0, 1.0)

            def too_low(x: np.ndarray) -> np.ndarray:
                near, far = erfc(sign * (x - self.a)), erfc(sign * (x + self.a))
                outside = 0.5 * (right * near + (1.0 - right) * far)
                return np.where(low, outside < end, outside > end)

            x = np.where(low | high, self._bisected(too_low, xi.shape, 28.0), x)
        return x

    def _bisected(
        self, too_low: Callable[[np.ndarray], Any], shape: tuple[int, ...], beyond: float
    ) -> np.ndarray:
        """The x, no farther than that beyond the blobs, where `too_low` turns false."""
        reach = np.full(shape, self.a + beyond)
        return bisected(too_low, -reach, reach, 60)

    def right(self, x: Any) -> np.ndarray:
        """Return the fraction of the density at x that belongs to the blob at (a, a)."""
        with np.errstate(over="ignore"):  # the part is zero then
            return 1.0 / (1.0 + np.exp(-4.0 * self.a * check.places("x", x)))


def decoupled(
    quantile: Callable[[np.ndarray], np.ndarray], total: float, counts: tuple[int, int]
) -> Loading:
    """Return the paper's loading x, y, W, each of shape (n_x n_y,), for a density whose two marginals are equal.

    Parameters
    ----------
    quantile : callable
        The inverse of the distribution of a marginal, at fractions between 0 and 1.
    total : float
        sigma.
    counts : (int, int)
        n_x, n_y.
    """
    total = check.scale("total", total)
    x, y = (check.sampled("quantile", quantile, part) for part in _midpoints(counts))
    x, y = (part.ravel() for part in np.meshgrid(x, y, indexing="ij"))
    return x, y, np.full(x.size, total / x.size)


def weighted(density: TwoBlobs, counts: tuple[int, int]) -> Loading:
    """Return the places of `decoupled` with the weights that make the density f; x, y, W of shape (n_x n_y,)."""
    density = check.instance("density", density, TwoBlobs)
    x, y, w = decoupled(density.quantile, density.total, counts)
    return x, y, w * density.value(x, y) / density.product(x, y)


def sequential(density: TwoBlobs, counts: tuple[int, int]) -> Loading:
    """Return markers of equal weight with x by its marginal, and y given x; x, y, W of shape (n_x n_y,)."""
    along_x, along_y = _midpoints(counts)
    x = check.instance("density", density, TwoBlobs).quantile(along_x)[:, None]
    y = density.quantile(along_y, density.right(x))
    x = np.broadcast_to(x, y.shape).ravel()
    return x, y.ravel(), np.full(x.size, density.total / x.size)


def reconstruct(shape: Shape, epsilon: float, markers: Loading, x: Any, y: Any) -> np.ndarray:
    """Return F = sum_j W_j S_eps(x - x_j) S_eps(y - y_j) on the grid of x, shape (M,), and y, shape (K,): shape (M, K).

    `markers` are the arrays x_j, y_j and W_j, each of shape (N,).
    """
    check.instance("shape", shape, Shape)
    if not isinstance(markers, tuple | list) or len(markers) != 3:
        raise InvalidInput("markers", markers, "x, y and W of the markers", "Give three arrays.")
    xj = check.positions("markers", markers[0])
    yj, w = (check.vector("markers", part, xj.size) for part in markers[1:])
    x, y = check.positions("x", x), check.positions("y", y)
    epsilon = check.scale("epsilon", epsilon)
    if (x.size + y.size) * xj.size > _MOST_TERMS:
        raise InvalidInput("x", f"{x.size} points", "fewer for so many markers", "Do it in parts.")
    along_x = shape((x[:, None] - xj) / epsilon) * w
    along_y = shape((y[:, None] - yj) / epsilon)
    return along_x @ along_y.T / epsilon**2


def _midpoints(counts: tuple[int, int]) -> list[np.ndarray]:
    numbers = [check.positive_integer("counts", n) for n in check.pair("counts", counts)]
    if numbers[0] * numbers[1] > check.MOST:
        raise InvalidInput("counts", counts, f"at most {check.MOST} markers", "Take fewer.")
    return [(np.arange(n) + 0.5) / n for n in numbers]
