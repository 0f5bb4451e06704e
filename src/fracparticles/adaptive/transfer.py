"""From one placement to another: u between the particles, and what is kept of it.

The solution is smooth in the variable of the map, s, in which the particles are equally spaced: u and x are splines of
degree 7 of s. Then sum V u and sum V x u are made what they were,

    u_i <- u_i + |u_i| (a + b (x_i - c)),

c the middle of the particles. The first moment of a heavy tail is far out, where round-off is largest beside u: there b
mends it, and leaves the rest alone. If that would take more than half of a strength, the moment is let go.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import make_interp_spline

from fracparticles.adaptive.placement import LineParticles
from fracparticles.arguments import FloatArray

__all__ = ["among", "between", "conserving", "slopes", "uncertain"]

_DEGREE = 7  # of the splines
_NEWTON = 8  # steps to the s of a place
_PARTS = (np.arange(1, 9) * 0.6180339887498949) % 1.0  # of a gap: eight places that no lattice has
_MOST_CHANGE = 0.5  # of u at an end, to keep the first moment; beyond, only the mass is kept


def between(x: FloatArray, u: FloatArray, at: FloatArray) -> FloatArray:
    """Return u at other places, shape (M,), from u at the particles x, shape (N,); s is found by Newton's method."""
    s = np.arange(x.size, dtype=float)
    place = make_interp_spline(s, x, _DEGREE)
    slope = place.derivative()
    found = np.interp(at, x, s)
    for _ in range(_NEWTON):
        found = np.clip(found - (place(found) - at) / slope(found), 0.0, s[-1])
    return np.asarray(make_interp_spline(s, u, _DEGREE)(found))


def among(x: FloatArray, *values: FloatArray) -> list[FloatArray]:
    """Return irregular places between the particles x, eight to each gap, and what has these values at them there."""
    s = (np.arange(x.size - 1.0)[:, None] + _PARTS).ravel()
    knots = np.arange(x.size, dtype=float)
    return [np.asarray(make_interp_spline(knots, v, _DEGREE)(s)) for v in (x, *values)]


def uncertain(x: FloatArray, u: FloatArray) -> float:
    """Return by what share of int |u| splines of degree 5 and 7 differ half-way between the particles.

    About the share that the particles miss of a solution, if it is smooth in their variable.
    """
    s, gaps = np.arange(x.size, dtype=float), np.diff(x)
    low, high = (make_interp_spline(s, u, d)(s[:-1] + 0.5) for d in (_DEGREE - 2, _DEGREE))
    size = float(gaps @ np.abs(high))
    return float(gaps @ np.abs(low - high)) / size if size else 0.0


def slopes(values: FloatArray) -> FloatArray:
    """Return d/ds at the particles of what has these values there, shape (N,)."""
    s = np.arange(values.size, dtype=float)
    return np.asarray(make_interp_spline(s, values, _DEGREE).derivative()(s))


def conserving(
    particles: LineParticles, u: FloatArray, mass: float, moment: float
) -> tuple[FloatArray, float]:
    """Return u with this mass and first moment, and the share of sum V |u| that has changed."""
    x, weights = particles.x, particles.volumes * np.abs(u)
    r = (2.0 * x - x[0] - x[-1]) / (x[-1] - x[0])
    rows = np.array([[weights.sum(), weights @ r], [weights @ x, weights @ (x * r)]])
    missing = mass - particles.volumes @ u, moment - particles.volumes * x @ u
    a, b = np.linalg.solve(rows, missing)
    if abs(b) > _MOST_CHANGE:
        a, b = missing[0] / weights.sum(), 0.0
    change = a + b * r
    return u + np.abs(u) * change, float(weights @ np.abs(change) / weights.sum())
