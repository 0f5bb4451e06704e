"""Particles of (-1, 1) that are graded towards both ends, x_i = phi(y_i), y_i = (i + 1/2) / N, V_i = phi'(y_i) / N.

The map is the regularised incomplete beta function,

    1 + phi(y) = 2 I_y(p, p),   phi'(y) = 2 [y (1 - y)]^(p-1) / B(p, p),   0 < y < 1,

a polynomial of degree 2 p - 1 for a whole p. The distance d to an end behaves like y^p there. A solution that behaves
like d^(alpha/2) at an absorbing end behaves like y^(p alpha/2) in y, which is smooth enough for the trapezoidal rule,
and the whole interval has particles. p = 1 is the lattice of equal volumes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import betainc, betaln

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.errors import InvalidInput

__all__ = ["LEAST", "MOST", "GradedParticles", "graded_on_interval"]

LEAST = 16  # particles: of fewer the first eigenvalue is off by one per cent
MOST = 4000  # particles: a matrix of them takes 128 MB
_MOST_DEGREE = 12.0
_CLOSEST = 1e-60  # of a particle to an end, whose powers are still numbers


class GradedParticles(NamedTuple):
    """Particles of (-1, 1) in ascending order, with their distances from the ends stored separately.

    Close to an end the positions equal the end to round-off, but the distances keep their digits.

    Attributes
    ----------
    x, volumes : array, shape (N,)
        Positions, and what the particles stand for.
    left, right : array, shape (N,)
        Distances to the ends.
    """

    x: FloatArray
    volumes: FloatArray
    left: FloatArray
    right: FloatArray

    @property
    def distances(self) -> FloatArray:
        """|x_i - x_j|, shape (N, N), to relative round-off; the diagonal is zero."""
        near_right = self.left[:, None] + self.left > 2.0
        by_left = self.left[:, None] - self.left
        by_right = self.right - self.right[:, None]
        return np.asarray(np.abs(np.where(near_right, by_right, by_left)))


def graded_on_interval(particles: int, degree: float = 8.0) -> GradedParticles:
    """Return particles of (-1, 1), graded towards both ends.

    Parameters
    ----------
    particles : int
        N, from `LEAST` to `MOST`.
    degree : float
        p, 1 <= p <= 12: the first particle is about N^(-p) from its end; 1 for equal volumes.

    Raises
    ------
    InvalidInput
        If an argument is outside its range, or a particle closer to an end than a power of the distance can be told.
    """
    count = check.whole_number("particles", particles, LEAST, MOST)
    p = check.real_between("degree", degree, 1.0, _MOST_DEGREE)
    y = (np.arange(count) + 0.5) / count
    left = 2.0 * betainc(p, p, y)
    if left[0] < _CLOSEST:
        allowed = f"a degree that leaves the first of {count} particles {_CLOSEST:g} from its end"
        raise InvalidInput("degree", degree, allowed, "Take a lower degree or fewer particles.")
    right = left[::-1].copy()
    volumes = 2.0 / count * np.exp((p - 1.0) * (np.log(y) + np.log1p(-y)) - betaln(p, p))
    volumes = 0.5 * (volumes + volumes[::-1])
    return GradedParticles(0.5 * (left - right), volumes, left, right)
