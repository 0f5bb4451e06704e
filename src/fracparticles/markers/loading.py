r"""Initial positions and weights of the markers, Sec. 2.2. Each returns x_j and W_j with sum_j W_j = int f, or nearly.

- `uniform`: x_j = a + (j - 1/2) h, W_j = f(x_j) h.
- `equal_weight`, the quiet start: x_j = g^-1(sigma (j - 1/2) / N), W_j = sigma / N (10), for g(x) = int_-inf^x f.
  (11) prints W_j = 1 / N for f = x exp(-x^2), whose sigma is not 1.
- `random`: the same with random xi_j for (j - 1/2) / N, from a seed.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fracparticles.errors import InvalidInput
from fracparticles.markers.profiles import Profile
from fracparticles.special.arguments import positive_integer

__all__ = ["equal_weight", "random", "uniform"]

Loading = tuple[np.ndarray, np.ndarray]


def uniform(
    f: Callable[[np.ndarray], np.ndarray], ends: tuple[float, float], count: int
) -> Loading:
    """Return `count` midpoints of equal cells between the ends, with W_j = f(x_j) h.

    Raises
    ------
    InvalidInput
        If the ends do not increase or the count is not a positive whole number.
    """
    low, high = ends
    if not low < high:
        raise InvalidInput("ends", ends, "two increasing numbers", "Mend their order.")
    h = (high - low) / positive_integer("count", count)
    x = low + h * (np.arange(count) + 0.5)
    return x, h * f(x)


def equal_weight(profile: Profile, count: int) -> Loading:
    """Return markers that share the total equally (10).

    Raises
    ------
    InvalidInput
        If the count is not a positive whole number.
    """
    count = positive_integer("count", count)
    part = profile.total / count
    return profile.quantile(part * (np.arange(count) + 0.5)), np.full(count, part)


def random(profile: Profile, count: int, generator: np.random.Generator) -> Loading:
    """Return markers of equal weight at random, distributed like f, in increasing order.

    Raises
    ------
    InvalidInput
        If the count is not a positive whole number.
    """
    count = positive_integer("count", count)
    xi = np.sort(generator.random(count))
    inside = np.clip(xi, np.finfo(float).tiny, None)  # random() may give 0, never 1
    return profile.quantile(profile.total * inside), np.full(count, profile.total / count)
