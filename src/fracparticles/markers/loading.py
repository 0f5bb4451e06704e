r"""Initial positions and weights of the markers, Sec. 2.2. Each returns x_j and W_j with sum_j W_j = int f, or nearly.

- `uniform`: x_j = a + (j - 1/2) h, W_j = f(x_j) h.
- `equal_weight`, the quiet start: x_j = g^-1(sigma (j - 1/2) / N), W_j = sigma / N (10), for g(x) = int_-inf^x f.
  (11) prints W_j = 1 / N for f = x exp(-x^2), whose sigma is not 1.
- `random`: the same with random xi_j for (j - 1/2) / N, from a seed.

All raise `InvalidInput` if the count is not a positive whole number, the ends do not increase, or f, the profile or
the generator is not valid.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fracparticles import arguments as check
from fracparticles.errors import InvalidInput
from fracparticles.markers.profiles import Profile

__all__ = ["equal_weight", "random", "uniform"]

Loading = tuple[np.ndarray, np.ndarray]


def uniform(
    f: Callable[[np.ndarray], np.ndarray], ends: tuple[float, float], count: int
) -> Loading:
    """Return `count` midpoints of equal cells between the ends, with W_j = f(x_j) h; two arrays of shape (count,)."""
    low, high = check.pair("ends", ends, rising=True)
    h = (high - low) / check.positive_integer("count", count, most=check.MOST)
    x = low + h * (np.arange(count) + 0.5)
    return x, h * check.sampled("f", f, x)


def equal_weight(profile: Profile, count: int) -> Loading:
    """Return the places (10) of markers that share the total equally, and W_j; two arrays of shape (count,)."""
    count = check.positive_integer("count", count, most=check.MOST)
    part = _total(profile) / count
    x = check.sampled("profile", profile.quantile, part * (np.arange(count) + 0.5))
    return x, np.full(count, part)


def random(profile: Profile, count: int, generator: np.random.Generator) -> Loading:
    """Return the places of markers at random, distributed like f and in increasing order, and their equal W_j."""
    count = check.positive_integer("count", count, most=check.MOST)
    total = _total(profile)
    xi = np.sort(check.generator("generator", generator).random(count))
    inside = np.clip(xi, np.finfo(float).tiny, None)  # random() may give 0, never 1
    return check.sampled("profile", profile.quantile, total * inside), np.full(count, total / count)


def _total(profile: Profile) -> float:
    if not callable(getattr(profile, "quantile", None)):
        raise InvalidInput("profile", profile, "a profile, with total and quantile", "Make one.")
    return check.scale("profile.total", getattr(profile, "total", None))
