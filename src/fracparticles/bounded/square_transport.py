r"""Transport between the particles of a square. Only waves grow that the velocity presses together.

Along either axis, in the unit of the spacing and with the volumes V of the lines, as between the rings of a disc
(`disc_transport`),

    2 d(a u)/dx = M(a u) + a P u + (da/dx) u,    M = -V^-1 P^T V.

P are differences of order 6. sum V u^2 grows at most at the rate max(-div a), less twice the lowest rate of the
diffusion. (Differences that are one-sided at the edges, in the form of a flux, make waves that grow: at 13 to 142 for
|a| = 10, alpha = 1.05 and 8 to 32 particles a side.)

Edge, absorbing or given
    u = 0 beyond, and u ~ d^(alpha/2) before, at the distance d. P = M = V^-1 Q with a skew Q. Q has central differences
    and an additional exchange between the five lines at an edge. The exchange brings P d^p nearest to p d^(p-1) for
    p = alpha/2, alpha/2 + 1, alpha/2 + 2, by least squares.
Edge where u is carried out
    u falls to zero in a layer of the thickness |a|^(-1/(alpha-1)), which may be far less than the spacing. P sees a
    jump there, and makes waves. With the velocity a_n through the edge, max(a_n, 0) V^-1 G u is added to the
    divergence,

        G = e e^T / 2 + S.

    e^T u is u at the edge, by a parabola. S is skew, and brings P and G together nearest to the derivatives of 1, d,
    d^(alpha/2) and d^(alpha/2 + 1). The part that is carried out, sum a_n (e^T u)^2 / 2, is lost.
Edge, reflecting
    a_n = 0. P continues u as an even function, and then M continues the flux as an odd one. Since P 1 = 0, the total is
    kept if the divergence of a is M a.

In a layer d^(alpha/2) has d^(alpha/2 + alpha - 1) beside it, to which nothing is fitted: the order of int |error| is
alpha.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from fracparticles.arguments import FloatArray
from fracparticles.bounded.plane_differences import (
    REACH,
    differences_with_beyond,
    one_sided_differences,
)

__all__ = ["SquareTransport"]

_LINES = 5  # lines at an edge whose differences are fitted


class SquareTransport:
    """-div(a u) on a square lattice of spacing one. All fields have the shape (N, N).

    Parameters
    ----------
    alpha : float
        Fractional order, 1 < alpha < 2.
    line : array, shape (N,)
        Volumes of the particles along an axis; those of the square are their products.
    reflecting : bool
        Whether nothing leaves, and u is not zero at the edges; else u is zero there and beyond.
    """

    def __init__(self, alpha: float, line: FloatArray, reflecting: bool) -> None:
        self._smooth = one_sided_differences(line.size)
        self._outflow = np.zeros((_LINES, _LINES))
        if reflecting:
            self._along = _even(line.size)
        else:
            first = line[:_LINES]
            own = _fitted(first, 0.5 * alpha + np.arange(3.0), np.zeros(_LINES))
            powers = np.array([0.0, 1.0, 0.5 * alpha, 0.5 * alpha + 1.0])
            edge = _value_at_edge()
            more = _fitted(first, powers, edge) - own
            # At the first edge outwards is backwards.
            self._outflow = (0.5 * np.multiply.outer(edge, edge) - more) / first[:, None]
            exchange = _zero_beyond(line.size)
            exchange[:_LINES, :_LINES] += own
            exchange[-_LINES:, -_LINES:] -= own[::-1, ::-1]
            self._along = exchange / line[:, None]
        self._adjoint = -(self._along * line[:, None]).T / line[:, None]
        self._of_velocity = self._adjoint if reflecting else self._smooth

    def carried(self, u: FloatArray, a_x: FloatArray, a_y: FloatArray) -> FloatArray:
        """Return -div(a u), if u is zero beyond the edges, or nothing leaves."""
        out = np.zeros(u.shape)
        for v, a, moved in ((u, a_x, out), (u.T, a_y.T, out.T)):  # along either axis
            moved -= 0.5 * (self._adjoint @ (a * v) + a * (self._along @ v))
            moved -= 0.5 * (self._of_velocity @ a) * v
            moved[:_LINES] -= np.maximum(-a[0], 0.0) * (self._outflow @ v[:_LINES])
            from_end = self._outflow @ v[: -_LINES - 1 : -1]
            moved[: -_LINES - 1 : -1] -= np.maximum(a[-1], 0.0) * from_end
        return out

    def of_smooth(self, u: FloatArray, a_x: FloatArray, a_y: FloatArray) -> FloatArray:
        """Return -div(a u) for a u that is known and smooth up to the edges, and not zero there."""
        return np.asarray(-(self._smooth @ (a_x * u)) - (a_y * u) @ self._smooth.T)

    def divergence(self, a_x: FloatArray, a_y: FloatArray) -> FloatArray:
        """Return div a of a velocity that is smooth up to the edges; where nothing leaves, it keeps the total."""
        return np.asarray(self._of_velocity @ a_x + a_y @ self._of_velocity.T)


def _zero_beyond(count: int) -> FloatArray:
    """Return central differences of a field that is zero beyond the ends: they are skew."""
    return differences_with_beyond(count)[:, REACH:-REACH].copy()


def _even(count: int) -> FloatArray:
    """Return central differences of a field that is even beyond the ends."""
    whole = differences_with_beyond(count)
    d = whole[:, REACH:-REACH].copy()
    d[:, :REACH] += whole[:, REACH - 1 :: -1]
    d[:, -REACH:] += whole[:, : -REACH - 1 : -1]
    return d


def _value_at_edge() -> FloatArray:
    """Return e, the weights of a parabola through the first three lines, at half a spacing before them."""
    e = np.zeros(_LINES)
    e[:3] = 15.0 / 8.0, -5.0 / 4.0, 3.0 / 8.0
    return e


def _fitted(line: FloatArray, powers: FloatArray, edge: FloatArray) -> FloatArray:
    """Return the skew S of the first lines for which (Q + S - e e^T / 2) d^p is nearest to V p d^(p-1).

    d is the distance to the edge. Q are central differences of a field that is zero beyond. Each equation is divided
    by V.
    """
    d = np.arange(_LINES + REACH) + 0.5
    own, fields = d[:_LINES], d ** powers[:, None]  # (powers, lines)
    slopes = powers[:, None] * own ** (powers[:, None] - 1.0)
    have = fields @ _zero_beyond(d.size)[:_LINES].T
    have -= 0.5 * np.multiply.outer(fields[:, :_LINES] @ edge, edge)
    pairs = list(combinations(range(_LINES), 2))
    matrix = np.zeros((powers.size, _LINES, len(pairs)))
    for column, (i, j) in enumerate(pairs):
        matrix[:, i, column], matrix[:, j, column] = fields[:, j], -fields[:, i]
    matrix /= line[:, None]
    missing = slopes - have / line
    found = np.linalg.lstsq(matrix.reshape(-1, len(pairs)), missing.reshape(-1), rcond=None)[0]
    skew = np.zeros((_LINES, _LINES))
    for (i, j), weight in zip(pairs, found, strict=True):
        skew[i, j], skew[j, i] = weight, -weight
    return skew
