"""A warning if a kernel is too wide for the strengths that it exchanges.

By the exchange sum_i V_i f_i^2, f_i = Q_i / V_i, falls at the rate 2 E,

    E = sum_i V_i e_i / m_i,   e_i = (D / (2 eps^2)) sum_p V_p eta_eps(x_i - x_p) (f_i - f_p)^2,

which is int D |grad f|^2 but for the smoothing. m_i is the second moment that must be 1; it is smaller at the ends and
gaps of the particles. A kernel of twice the radius errs at least four times as much, see `approximation`. So a third of
the change of E by twice the radius bounds the error of E by the smoothing. E is judged and not the rates dQ_i/dt,
since irregular particles spoil these more than E.
"""

from __future__ import annotations

import warnings

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from fracparticles.arguments import FloatArray
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.pse.moments import ENOUGH
from fracparticles.pse.shapes import Kernel

__all__ = ["warn_of_exchange"]

WRONG = 0.05  # share of E: a larger error by the smoothing is warned of
_MOST = 1024  # particles with the greatest parts of E, at which twice the radius is tried
_MOST_PAIRS = 2**25  # of these particles and their neighbours
_ROUND_OFF = 1e-12  # relative difference of f: less is round-off


def warn_of_exchange(
    points: FloatArray,
    volumes: FloatArray,
    f: np.ndarray,
    epsilon: float,
    kernel: Kernel,
    matrix: csr_array,
    moments: FloatArray,
) -> None:
    """Warn if twice the radius changes E by more than three times the error allowed.

    There is no warning for a stencil, which has one radius only, nor for more than 2^25 pairs at twice the radius.

    Parameters
    ----------
    points : array, shape (N, d)
    volumes, f : arrays, shape (N,)
        V_i, and Q_i / V_i, real or complex.
    epsilon, kernel, matrix, moments
        The radius, eta, A / D and m_i of the exchange.

    Warns
    -----
    AccuracyWarning
        If the smoothing is likely to change E by more than 5 %.
    """
    a = matrix.tocoo()
    part = np.abs(f[a.row] - f[a.col]) ** 2 * a.data * volumes[a.col]
    energies = np.bincount(a.row, part, f.size)  # 2 V_i e_i
    if not energies.sum() > _ROUND_OFF**2 * float(
        abs(matrix).sum(axis=1) @ (volumes * np.abs(f) ** 2)
    ):
        return
    rows = np.argsort(-np.abs(energies))[:_MOST]
    try:
        wide, wide_moments = _of_rows(rows, points, volumes, f, 2.0 * epsilon, kernel)
    except InvalidInput:  # a stencil, which has one radius only, or too many pairs
        return
    whole = (np.minimum(moments[rows], wide_moments) > ENOUGH) & (moments[rows] < 1.0 / ENOUGH)
    found = float((energies[rows] / moments[rows])[whole].sum())
    change = abs(float((wide / wide_moments)[whole].sum()) - found) / 3.0
    if change > WRONG * abs(found):
        warnings.warn(
            "epsilon is too large for the strengths: the smoothing changes the rate at which they even out by about "
            f"{change / max(change, abs(found)):.2g} of it. Take a smaller epsilon, or a kernel of higher order.",
            AccuracyWarning,
            stacklevel=4,
        )


def _of_rows(
    rows: np.ndarray,
    points: FloatArray,
    volumes: FloatArray,
    f: np.ndarray,
    radius: float,
    kernel: Kernel,
) -> tuple[FloatArray, FloatArray]:
    """2 V_i e_i / D and m_i of some particles; raises `InvalidInput` if they have too many neighbours."""
    tree, some, reach = cKDTree(points), cKDTree(points[rows]), kernel.reach * radius
    if some.count_neighbors(tree, reach) > _MOST_PAIRS:
        raise InvalidInput("epsilon", radius, f"at most {_MOST_PAIRS} pairs", "Take fewer.")
    pairs = some.sparse_distance_matrix(tree, reach, output_type="coo_matrix")
    i, p, dim = pairs.row, pairs.col, points.shape[1]
    apart = (points[rows[i]] - points[p]) / radius
    z = apart[:, 0] if dim == 1 else np.sqrt((apart**2).sum(axis=1))
    eta = volumes[p] * kernel(z) / radius**dim
    squares = np.abs(f[rows[i]] - f[p]) ** 2
    energies = volumes[rows] / radius**2 * np.bincount(i, eta * squares, rows.size)
    return energies, np.bincount(i, eta * z * z, rows.size) / (2.0 * dim)
