"""The definition of the fractional integral, by quadrature: the reference for closed forms and SPH sums."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.special import gamma, roots_jacobi

from fracparticles.arguments import SIZES, finite_result, positive_integer, sampled, within
from fracparticles.errors import AccuracyWarning

__all__ = ["defining_integral"]

_UNRESOLVED = 1e-3  # share of the greatest integral: a larger change with more nodes is warned of
# The least and the greatest order: the nodes of lower ones are lost in round-off, and Gamma of higher ones overflows.
_ORDERS = 1e-12, 150.0


def defining_integral(
    f: Callable[[np.ndarray], np.ndarray], x: Any, alpha: Any, nodes: int = 40
) -> np.ndarray:
    """I^alpha f (1), (7), shape (M,), by Gauss-Jacobi: x^alpha / Gamma(alpha) int_0^1 (1-t)^(alpha-1) f(x t) dt.

    This is x^alpha / Gamma(1 + alpha) times the mean of f(x t) by the weights of the quadrature.

    Raises `InvalidInput` if a point is negative, an order outside its range, their shapes differ, f does not take
    arrays, or the integral overflows. Warns with `AccuracyWarning` if the nodes do not resolve f.

    Parameters
    ----------
    f : callable
        A function of an array of any shape, smooth on [0, x].
    x : array_like, shape (M,)
        Points x >= 0.
    alpha : array_like, shape (M,)
        The order at each, from 1e-12 to 150.
    nodes : int
        The quadrature is exact for polynomials of degree 2 nodes - 1.
    """
    x = within("x", x, 0.0, SIZES[1])
    alpha = within("alpha", alpha, *_ORDERS, shape=x.shape)
    nodes = positive_integer("nodes", nodes)
    out, finer = (_quadrature(f, x, alpha, n) for n in (nodes, nodes + nodes // 2 + 1))
    off, size = float(np.abs(out - finer).max(initial=0.0)), float(np.abs(finer).max(initial=0.0))
    if not off <= _UNRESOLVED * size:
        warnings.warn(
            f"{nodes} nodes do not resolve f: half as many more change the integral by {off:.2g}, beside its greatest "
            f"value {size:.2g}. Take more nodes.",
            AccuracyWarning,
            stacklevel=2,
        )
    return out


def _quadrature(
    f: Callable[[np.ndarray], np.ndarray], x: np.ndarray, alpha: np.ndarray, nodes: int
) -> np.ndarray:
    out = np.empty_like(x)
    for order in np.unique(alpha):
        at_nodes, weights = roots_jacobi(nodes, order - 1.0, 0.0)  # on [-1, 1]
        at = alpha == order
        mean = sampled("f", f, 0.5 * np.outer(x[at], at_nodes + 1.0)) @ (weights / weights.sum())
        with np.errstate(over="ignore", invalid="ignore"):
            out[at] = x[at] ** order / gamma(1.0 + order) * mean
    return np.asarray(finite_result("f", out))
