"""Observed orders: of the error between levels of a refinement, and of self-convergence, Eq. (49)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from fracparticles.errors import InvalidInput

__all__ = ["observed_order", "self_convergence_order"]


def observed_order(h: ArrayLike, error: ArrayLike) -> np.ndarray:
    """Return log(e_k / e_{k+1}) / log(h_k / h_{k+1}), the order between neighbouring levels.

    Parameters
    ----------
    h : array_like
        Particle spacing, time step or another quantity that is refined, one for each of K levels.
    error : array_like
        The error of each level; any unit.

    Returns
    -------
    ndarray
        K - 1 orders.

    Raises
    ------
    InvalidInput
        If there is not one error for each level.
    """
    h, error = np.asarray(h, dtype=float), np.asarray(error, dtype=float)
    if h.shape != error.shape or h.ndim != 1:
        allowed = f"one for each of the levels, shape {h.shape}"
        raise InvalidInput("error", error.shape, allowed, "Give a list of levels and their errors.")
    return np.log(error[:-1] / error[1:]) / np.log(h[:-1] / h[1:])


def self_convergence_order(levels: Sequence[np.ndarray] | np.ndarray) -> float:
    """Return the order of self-convergence p of three solutions on common points, Eq. (49).

    p = log2( sum_i |u_i^l - u_i^{l+1}| / sum_i |u_i^{l+1} - u_i^{l+2}| ), where the step or the spacing is halved
    from level to level. It says how fast the solutions approach one another, not whether they approach the right one.

    Parameters
    ----------
    levels : sequence of three ndarrays
        The strengths u of the coarse, the middle and the fine level on the points of the coarse one, of one shape.

    Raises
    ------
    InvalidInput
        If there are not three levels of one shape.
    """
    shapes = [np.shape(level) for level in levels]
    if len(shapes) != 3 or len(set(shapes)) != 1:
        remedy = "Take the points that three levels have in common."
        raise InvalidInput("levels", shapes, "three arrays of one shape", remedy)
    coarse, middle, fine = levels
    return float(np.log2(np.abs(coarse - middle).sum() / np.abs(middle - fine).sum()))
