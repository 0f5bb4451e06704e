"""How many walkers a density needs: the number with which `random_walk` equals a scheme, and where too few are left."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.optimize import brentq

from fracparticles.arguments import (
    SIZES,
    fractional_order,
    positive_integer,
    real_array,
    scale,
    within,
)
from fracparticles.errors import InvalidInput
from fracparticles.special.stable import reduced_green

__all__ = ["few_walkers_beyond", "walkers_to_equal"]

_MOST = 2**53  # walkers: more are not told apart in float64


def walkers_to_equal(masses: Any, error: float) -> float:
    """Return the n at which sum_k E |N_k/n - p_k| / sum_k p_k = error, E |...| = (2 p_k (1 - p_k) / (pi n))^(1/2).

    Parameters
    ----------
    masses : array_like
        p_k, the mass of each cell, see `random_walk.cell_masses`.
    error : float
        Relative error, as (48), of the scheme that is to be equalled.

    Raises
    ------
    InvalidInput
        If a mass is not within [0, 1], there is none, or the error is not positive.
    """
    p = within("masses", real_array("masses", masses), 0.0, 1.0)
    if not p.sum() >= SIZES[0]:
        raise InvalidInput("masses", masses, f"masses of {SIZES[0]:g} in all, or more", "Add some.")
    root = np.sqrt(p * (1.0 - p)).sum() / p.sum()
    return float(2.0 / math.pi * (root / scale("error", error)) ** 2)


def few_walkers_beyond(
    walkers: int, width: float, t: float, alpha: float, few: float = 10.0
) -> float:
    """Return the |x| beyond which a cell expects fewer than `few` of the walkers: n width G(x, t) = few.

    Parameters
    ----------
    walkers : int
        n, at most 2^53.
    width : float
        Width of a cell.
    t, alpha : float
        Of the fundamental solution G.
    few : float
        The number of walkers; with 10 the density is uncertain by a third.

    Returns
    -------
    float
        Zero if there are fewer everywhere.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """
    n = positive_integer("walkers", walkers, most=_MOST)
    t, width = scale("t", t), scale("width", width)
    length = t ** (1.0 / fractional_order(alpha))
    level = scale("few", few) / n / (width / length)  # of Phi(x / length) = length G(x, t)
    if reduced_green(0.0, alpha) <= level:
        return 0.0
    far = 1.0
    while reduced_green(far, alpha) > level:
        far *= 2.0
    return float(length * brentq(lambda r: reduced_green(r, alpha) - level, 0.0, far))
