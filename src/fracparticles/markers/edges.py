r"""The error of F where the set of markers ends and the field jumps, as that of the square profile does.

There F is smoothed over epsilon from the start, while the field is only as wide as the equation has made it. In the
frame of the edge a step of the height J is a sum of waves: at the distance y, F differs from the field by

    J / pi int_0^inf d(q) sin(q y) / q dq,     d = S^(eps q) g(q) - exp(c_1 q^2 t),

where g is the factor by which the steps multiply a wave of the markers, and -c_1 the diffusivity (`reliability`). This
estimate is linear, and the method is not. At the edge V = -F_x / F is wrong because F is not the field. It drives the
markers apart, and they stay apart. How far is measured: a half line of markers is run and compared with erfc. The
larger of the two errors is 0.26 J after t = 0.01 eps^2, 0.07 J after 0.1 eps^2, and 0.03 J after eps^2; after that the
second falls like 1 / t.

A field that falls to zero within epsilon of the last marker counts as a step, too. Its height is multiplied by the
square of its slope over that of a step, because epsilon changes a smooth field in proportion to this square.

Where the field runs against its edge, a = c_0 - V > 0 on the right, the edge is a shock. That of Burgers' equation,
J / (1 + exp(a y / mu)), has the slope of a step after t = 4 mu / (pi a^2), and its error does not decrease later. There
is no estimate for an equation that turns a step into waves, as KdV does.
"""

from __future__ import annotations

import math
import warnings
from functools import lru_cache

import numpy as np
from scipy.special import erfc

from fracparticles.errors import AccuracyWarning, FracparticlesError
from fracparticles.markers.reliability import (
    CORE,
    WAVENUMBERS,
    Steps,
    Velocity,
    all_coefficients,
    transformed,
)
from fracparticles.markers.shapes import Shape
from fracparticles.markers.stability import extremes
from fracparticles.moving.lagrangian import advance, quotient_velocity
from fracparticles.moving.scattered import NeighbourSum

__all__ = ["edge_error", "warn_of_edges"]

_MOST = 0.03  # of the peak of F: a larger error is warned of
_LINE, _EACH = 8, 20  # length of the measured half line in epsilon, and markers in each epsilon
_LONG, _FEWEST = 1.0, 8  # the longest run of it, in epsilon^2, and its fewest steps
_ACROSS = np.linspace(-3.0, 3.0, 121)  # epsilon: where its error is looked for
_NEAR = np.linspace(0.0, 3.0, 31)  # epsilon: where the error of a step is looked for
_WAVES = np.sin(np.outer(_NEAR, WAVENUMBERS)) / WAVENUMBERS


def edge_error(velocity: Velocity, x: np.ndarray, weights: np.ndarray, steps: Steps) -> float:
    """Return the error of F near the ends of the markers after these steps, over its peak; 0 without an estimate."""
    c = all_coefficients(velocity, x, weights)
    if velocity.period is not None or c.shape[1] != 2:
        return 0.0
    fields = np.abs(velocity.fields(x, weights))
    field, found, peak = fields[0], 0.0, fields[0].max()
    steepest = velocity.shape(np.zeros(1))[0] / velocity.epsilon  # slope of a step of height 1
    for end, side in ((np.argmin(x), -1.0), (np.argmax(x), 1.0)):
        # At the edge F is half of the field, so the field and its slope are taken a little inside.
        near = np.abs(x - x[end]) < CORE * velocity.epsilon
        inside = np.argmax(np.where(near, field, -1.0))
        slope = min(fields[1, near].max() / (steepest * field[inside]), 1.0)
        jump = min(max(2.0 * field[end], field[inside] * slope**2) / peak, 1.0)
        found = max(found, jump * _step_error(velocity, c[inside], side, steps))
    return found


def _step_error(velocity: Velocity, c: np.ndarray, side: float, steps: Steps) -> float:
    """The largest error of a step of height 1 on this side of the markers; zero where it is not known."""
    against, spread, count = side * c[0], abs(c[1]), float(steps.count)
    if against > 0.0:
        count = min(count, 4.0 * spread / (math.pi * against**2 * steps.dt))
    late = -c[1] * count * steps.dt / velocity.epsilon**2
    displaced = _displaced(velocity.shape, float(late)) if late > 0.0 else 0.0
    transform = transformed(velocity.shape)
    exact = steps.dt * c[1] * (WAVENUMBERS / velocity.epsilon) ** 2
    with np.errstate(all="ignore"):
        # Waves that grow are left to `warn_of_waves`.
        made = np.minimum(steps.factor(exact * transform) ** count, 1.0)
        d = transform * made - np.exp(count * exact)
        off = float(np.abs(_WAVES @ d).max()) * (WAVENUMBERS[1] - WAVENUMBERS[0]) / math.pi
    return max(off, displaced) if off <= 1.0 else displaced


@lru_cache(maxsize=256)  # both ends of the markers ask for the same, and run after run
def _displaced(shape: Shape, time: float) -> float:
    """The largest error of F at the edge of a half line of markers, epsilon = 1, by diffusion for this time."""
    x = -(np.arange(_LINE * _EACH) + 0.5) / _EACH
    weights, until = np.full(x.size, 1.0 / _EACH), min(time, _LONG)
    count = max(_FEWEST, math.ceil(2.0 * until / extremes(shape).eta))
    fields = NeighbourSum([shape.kernel(0), shape.kernel(1)], 1.0)

    def velocity(x: np.ndarray, weights: np.ndarray) -> np.ndarray:
        value, slope = fields(x, weights, x)
        return quotient_velocity(-slope, value, x, fields.accuracy)

    try:
        x, weights, _ = advance(x, weights, velocity, dt=until / count, steps=count)
    except FracparticlesError:  # shapes whose markers gather: `warn_of_waves` says so
        return 0.0
    field = fields(x, weights, _ACROSS)[0]
    off = np.abs(field - 0.5 * erfc(_ACROSS / (2.0 * math.sqrt(until)))).max()
    return float(off) * until / time


def warn_of_edges(velocity: Velocity, x: np.ndarray, weights: np.ndarray, steps: Steps) -> None:
    """Warn if the field jumps where the markers end, and F is too smooth there after a run from these markers.

    Warns
    -----
    AccuracyWarning
    """
    found = edge_error(velocity, x, weights, steps)
    if found > _MOST:
        warnings.warn(
            f"the field jumps where the markers end, and F falls over epsilon = {velocity.epsilon:.4g} there: after "
            f"this run it is off by up to {found:.2g} of its peak near the ends. Take a smaller epsilon, or a longer "
            "run.",
            AccuracyWarning,
            stacklevel=3,
        )
