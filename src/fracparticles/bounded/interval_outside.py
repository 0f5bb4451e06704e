"""The loss of particles to the outside of an interval, and the gain from values that are given there.

On (-1, 1), with the distances d of particle i from the two ends,

    kappa_i = C int_outside |x_i - y|^(-1-alpha) dy = (C / alpha) sum_ends d^(-alpha),
    b_i = C int_outside g(y) |x_i - y|^(-1-alpha) dy = C sum_ends int g(end +- e^s) (d + e^s)^(-1-alpha) e^s ds,
    (grad^beta u)_i = (C / alpha) int_outside g(y) sgn(y - x_i) |x_i - y|^-alpha dy + the integral inside.

If g is smooth in log |y - end|, the integrand is smooth in s on the scale one, wherever the particle is. The
trapezoidal rule with the step 1/4 has an error of e^(-8 pi^2) for a constant g. The weights are scaled to add up to
kappa_i, so that a constant outside is met by the same constant inside to round-off. Values that jump, or that swing for
ever like cos(y), are not smooth in log |y - end|. Then every other point alone gives another sum, and there is a
warning.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles.adaptive.maps import GradedParticles
from fracparticles.arguments import FloatArray
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.special import tail_constant

__all__ = ["OutsideValues", "loss_rates"]

_STEP = 0.25  # in s
_FAR = 60.0  # the last s, e^60 half-widths: the values beyond weigh e^(-60 alpha)
# The difference of the sums of all points and of every other, over kappa max |g|: for smooth values below 1e-8.
_UNRESOLVED = 1e-5
_NEAR = 40.0  # the first point is at e^-40 of the distance of the first particle


def loss_rates(particles: GradedParticles, alpha: float) -> FloatArray:
    """Return kappa_i, the rate of loss to the outside, shape (N,)."""
    losses = particles.left**-alpha + particles.right**-alpha
    return np.asarray(tail_constant(alpha) / alpha * losses)


class OutsideValues:
    """b_i of a function g(y) that is given outside (-1, 1).

    Parameters
    ----------
    particles : GradedParticles
    alpha : float
    place : callable
        Takes places in the unit of (-1, 1) to those of the caller.
    """

    def __init__(
        self,
        particles: GradedParticles,
        alpha: float,
        place: Callable[[FloatArray], FloatArray],
    ) -> None:
        first = np.log(min(particles.left[0], particles.right[-1]))
        s = np.arange(first - _NEAR, _FAR, _STEP)
        beyond = np.exp(s)
        self._points = place(np.concatenate([-1.0 - beyond, 1.0 + beyond]))
        ends = np.array([s.size, 2 * s.size]) - 1
        self._farthest, self._near = ends, np.tile(s <= math.log(10.0), 2)
        self._far_share = math.exp(-alpha * s[-1])
        lost = tail_constant(alpha) / alpha
        self._flux_weights = np.concatenate(
            [
                sign * lost / (alpha - 1.0) * distance[:, None] ** (1.0 - alpha) * weights
                for sign, distance in ((-1.0, particles.left), (1.0, particles.right))
                for weights in [_flux_weights(distance, beyond, alpha)]
            ],
            axis=1,
        )
        self._weights = np.concatenate(
            [
                _weights(distance, beyond, alpha) * (lost * distance**-alpha)[:, None]
                for distance in (particles.left, particles.right)
            ],
            axis=1,
        )

    def load(self, g: Callable[..., Any]) -> tuple[float, FloatArray, FloatArray]:
        """Return a level, and for g less this level b_i and the part of grad^beta u, both of shape (N,).

        Raises
        ------
        InvalidInput
            If g does not return finite values, or grows like |y|^alpha.

        Warns
        -----
        AccuracyWarning
            If the points do not resolve g.
        """
        values = check.sampled("outside", lambda y: np.asarray(g(y)) + 0.0 * y, self._points)
        if (
            self._far_share * np.abs(values[self._farthest]).max()
            > _UNRESOLVED * np.abs(values[self._near]).max()
        ):
            allowed = "values that do not grow like |y|^alpha far out, where nothing would be left of the integral"
            raise InvalidInput("outside", g, allowed, "Give bounded ones.")
        level = 0.5 * float(values[0] + values[values.size // 2])  # next to the ends
        less = values - level
        load = np.asarray(self._weights @ less)
        every_other = 2.0 * self._weights[:, ::2] @ less[::2]
        size = self._weights.sum(axis=1) * np.abs(values).max()
        share = float((np.abs(load - every_other) / np.maximum(size, np.finfo(float).tiny)).max())
        if share > _UNRESOLVED:
            warnings.warn(
                f"the values outside are not smooth in log |y - end|: their sum is off by up to {share:.1g} of what "
                "they can weigh. Smooth jumps, and let what swings fall off.",
                AccuracyWarning,
                stacklevel=3,
            )
        return level, load, np.asarray(self._flux_weights @ less)


def _weights(distance: FloatArray, beyond: FloatArray, alpha: float) -> FloatArray:
    """Return weights in proportion to (d + e^s)^(-1-alpha) e^s, with the sum one in each row."""
    weights = (1.0 + beyond / distance[:, None]) ** (-1.0 - alpha) * (beyond / distance[:, None])
    return np.asarray(weights / weights.sum(axis=1, keepdims=True))


def _flux_weights(distance: FloatArray, beyond: FloatArray, alpha: float) -> FloatArray:
    """Return weights in proportion to (d + e^s)^-alpha e^s, with the sum one in each row: the last has all beyond."""
    ratio = beyond / distance[:, None]
    weights = (alpha - 1.0) * _STEP * (1.0 + ratio) ** -alpha * ratio
    weights[:, -1] += 1.0 - weights.sum(axis=1)
    return np.asarray(weights)
