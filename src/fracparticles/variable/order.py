"""Variable order, du_i/dt = -D (-Laplacian)^(alpha(x_i)/2) u: row i has the kernel for the order alpha_i, Eq. (10),

    du_i/dt = (D / epsilon^alpha_i) sum_j V_j u_j G^(alpha_i)_epsilon(x_i - x_j).

The rows are interpolated between K orders. These are the Chebyshev points of the interval of radius R that holds all
alpha_i. Each order takes a lattice sum, so that an application takes K of them. The symbol of a row, in units of
D / h^alpha and without its aliases, is -|theta|^alpha eta^(s theta), theta = h k. Its K-th derivative in alpha has the
additional factor (ln |theta|)^K, and the interpolation differs from the symbol by at most

    2 (R/2)^K / K! max_(0 < t <= pi) t^alpha |ln t|^K,

at the least or the largest alpha. K is the least number for which this is below a tolerance. Aliases, which an overlap
below 1 lets in, may add to it: up to 5e-10 at an overlap of 1/4, where the largest weights are 10 to 700.

Far away the local order determines the tail: u falls like |x|^(-1-alpha) with the alpha of either end of the line,
and in the plane with the mean of alpha over the outermost particles. This holds where alpha is constant near the
ends.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from math import e, lgamma, log, pi
from threading import Lock
from typing import Any

import numpy as np

from fracparticles.arguments import finite_array, instance, operand, real_between
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.base import OnePass
from fracparticles.schemes.setting import Setting
from fracparticles.variable.exterior import tails_of
from fracparticles.variable.resolution import warn_unresolved, warn_unsettled
from fracparticles.variable.sums import EvenSum

__all__ = ["VariableOrder", "interpolation_bound", "nodes_needed"]

_TOLERANCE = 1e-12  # of the interpolated symbol, which is at most pi^alpha
_ROWS = 33  # samples of alpha, for a bound of the eigenvalues
# e of `resolution` above which alpha goes up and down. A single jump has less, and leaves an error of 2 % at most.
_UP_AND_DOWN = 0.5
_MOST = 40  # nodes at most; alpha from 1.01 to 1.99 takes fewer


def interpolation_bound(nodes: int, least: float, greatest: float) -> float:
    """Return the bound of the module on the error of the symbol of any row, alpha from `least` to `greatest`."""
    radius = 0.5 * (greatest - least)
    if radius == 0.0:
        return 0.0
    # t^alpha |ln t|^K is greatest at ln t = -K / alpha, or at t = pi.
    below = nodes * log(nodes / (least * e))
    above = greatest * log(pi) + nodes * log(log(pi))
    return 2.0 * float(np.exp(nodes * log(0.5 * radius) - lgamma(nodes + 1.0) + max(below, above)))


def nodes_needed(least: float, greatest: float, tolerance: float = _TOLERANCE) -> int:
    """Return the least K whose bound is below the tolerance; 1 if there is one order only."""
    for nodes in range(1, _MOST):
        if interpolation_bound(nodes, least, greatest) <= tolerance:
            return nodes
    return _MOST


class VariableOrder:
    """-D (-Laplacian)^(alpha(x)/2) on a lattice by direct differentiation; D is that of the setting.

    Parameters
    ----------
    setting : Setting
        A setting of DD on the line or in the plane; its alpha is ignored.
    alpha : array_like, shape `setting.shape`, or float
        The order at each particle, 1 < alpha < 2.
    tail : float or (float, float), optional
        p of u ~ |x|^-p in an open exterior, at the left and the right end; the module gives the default.
    tolerance : float
        Largest error of the interpolated symbol, see the module; from 1e-15 to 0.1.

    Attributes
    ----------
    nodes : array
        The orders between which the rows are interpolated.

    Raises
    ------
    InvalidInput
        If an order is outside of (1, 2), or there is no such operator.

    Warns
    -----
    AccuracyWarning
        If alpha varies near the ends of an open exterior, or up and down between the particles.
    """

    conservative = False

    def __init__(
        self,
        setting: Setting,
        alpha: Any,
        tail: float | tuple[float, float] | None = None,
        tolerance: float = _TOLERANCE,
    ) -> None:
        self.setting = instance("setting", setting, Setting)
        scheme = instance("scheme", SCHEMES["DD"], OnePass)
        scheme.check(setting.dim, setting.order, setting.family)
        if setting.dim > 2:
            raise InvalidInput("dim", setting.dim, "1 or 2", "Take the line or the plane.")
        tolerance = real_between("tolerance", tolerance, 1e-15, 0.1)
        alpha = finite_array("alpha", alpha, setting.shape)
        least, greatest = float(alpha.min()), float(alpha.max())
        if not 1.0 < least <= greatest < 2.0:
            wrong = least if least <= 1.0 else greatest
            raise InvalidInput("alpha", wrong, "1 < alpha < 2 everywhere", "Mend alpha(x).")
        varies = greatest > least
        warn_unresolved("alpha - 1", alpha - 1.0, setting, _UP_AND_DOWN)
        if setting.is_open and varies:
            _check_ends(setting, alpha, tail is not None)
        tails = tails_of(setting, tail, _usual_tails(setting, alpha))
        self.nodes = _chebyshev_points(nodes_needed(least, greatest, tolerance), least, greatest)
        self._sums = [
            EvenSum(scheme, replace(setting, alpha=float(node)), tails) for node in self.nodes
        ]
        # Only the symbol is interpolated: `unit` replaces the h^-alpha of a node, in its sums, by that of the row.
        unit = setting.spacing ** (self.nodes[:, None] - alpha.reshape(-1))
        self._alpha, self._lock = alpha, Lock()
        self._shares = (_lagrange(self.nodes, alpha.reshape(-1)) * unit).reshape(-1, *setting.shape)

    def apply(self, u: np.ndarray) -> np.ndarray:
        """Return du/dt for the strengths u, shape `setting.shape`."""
        u = np.ascontiguousarray(operand("u", u, self.setting.shape))
        total = np.zeros(self.setting.shape)
        with self._lock:  # the sums keep work arrays
            for share, sums in zip(self._shares, self._sums, strict=True):
                total += share * sums(u)
        return total

    def spectral_radius(self) -> float:
        """Return an upper bound of |lambda|, the largest sum of |weights| of a row.

        For an open exterior it is that of the lattice without its continuation.
        """
        # Equal orders have equal rows; between two samples of the order they hardly change.
        values, first = np.unique(self._alpha.reshape(-1), return_index=True)
        samples = first[np.unique(np.linspace(0, values.size - 1, _ROWS).round().astype(int))]
        shares = self._shares.reshape(self.nodes.size, -1)[:, samples]
        kinds = [sums.weights.reshape(-1) for sums in self._sums]
        sides = self._sums[0].sides.reshape(-1)
        rows = (np.abs(row @ np.array(kinds)) @ sides for row in shares.T)
        return 1.01 * float(max(rows))


def _usual_tails(setting: Setting, alpha: np.ndarray) -> tuple[float, float]:
    dim = setting.dim
    if dim == 1:
        return 1.0 + float(alpha[0]), 1.0 + float(alpha[-1])
    edge = np.concatenate([alpha[0], alpha[-1], alpha[1:-1, 0], alpha[1:-1, -1]])
    mean = dim + float(np.clip(edge.mean(), edge.min(), edge.max()))
    return mean, mean


def _check_ends(setting: Setting, alpha: np.ndarray, tail_given: bool) -> None:
    """Refuse a tail that is not known, and warn of one that is doubtful, unless it was given."""
    if tail_given:
        return
    if setting.far_terms > 1:
        raise InvalidInput(
            "far_terms",
            setting.far_terms,
            "1 where the order varies",
            "The further terms of the tail are not known.",
        )
    warn_unsettled("alpha - 1", alpha - 1.0, setting.n)
    if setting.dim > 1:
        edge = np.concatenate([alpha[0], alpha[-1], alpha[:, 0], alpha[:, -1]])
        if np.ptp(edge) > 0.05:
            message = (
                f"alpha varies by {np.ptp(edge):.2g} along the faces of the lattice, and the tail of the solution is "
                "continued with its mean there: widen the domain."
            )
            warnings.warn(message, AccuracyWarning, stacklevel=3)


def _chebyshev_points(count: int, least: float, greatest: float) -> np.ndarray:
    if count == 1:
        return np.array([0.5 * (least + greatest)])
    angle = (np.arange(count) + 0.5) * (pi / count)
    return 0.5 * (least + greatest) + 0.5 * (greatest - least) * np.cos(angle)


def _lagrange(nodes: np.ndarray, at: np.ndarray) -> np.ndarray:
    """The Lagrange polynomials of the nodes, shape (nodes, points), by their products."""
    shares = np.ones((nodes.size, at.size))
    for k, node in enumerate(nodes):
        for other in np.delete(nodes, k):
            shares[k] *= (at - other) / (node - other)
    return shares
