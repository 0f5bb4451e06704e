r"""What F is off by where the set of markers ends and the field jumps, as that of the square profile does.

There F is as wide as epsilon from the start, and the field as wide as the equation makes it by then. In the frame of
the edge a step of the height J is a sum of waves: F differs from it at the distance y by

    J / pi int_0^inf d(q) sin(q y) / q dq,     d = S^(eps q) g(q) - exp(c_1 q^2 t),

g what the steps multiply a wave of the markers by, -c_1 the diffusivity (`reliability`). That is linear; the method is
not. V = -F_x / F at the edge of F drives the markers apart by what F lacks of the field there, and they stay apart. How
far is measured: a half line of markers is run, and compared with erfc. The larger of both is
0.26 J after t = 0.01 eps^2, 0.07 J after 0.1 eps^2, and 0.03 J after eps^2; what is displaced then falls like 1 / t.

A field that falls to nothing within epsilon of the last marker is a step there, too: by the square of its slope over
that of a step, as what epsilon changes of a smooth field is.

Where the field runs against its edge, a = c_0 - V > 0 on the right, the edge is a shock: that of Burgers' equation,
J / (1 + exp(a y / mu)), has the slope of a step after t = 4 mu / (pi a^2), and none of it is taken away later. Of a
step that the equation makes waves of, as KdV does, nothing is said.
"""

from __future__ import annotations

import math
import warnings

import numpy as np
from scipy.special import erfc

from fracparticles.errors import AccuracyWarning, FracparticlesError
from fracparticles.markers.reliability import (
    CORE,
    WAVENUMBERS,
    Steps,
    Velocity,
    all_coefficients,
)
from fracparticles.markers.shapes import Shape
from fracparticles.markers.stability import extremes
from fracparticles.moving.lagrangian import advance, quotient_velocity
from fracparticles.moving.scattered import NeighbourSum

__all__ = ["edge_error", "warn_of_edges"]

_MOST = 0.03  # of the peak of F
_LINE, _EACH = 8, 20  # epsilon of a half line, and markers in each
_LONG, _FEWEST = 1.0, 8  # epsilon^2, steps
_ACROSS = np.linspace(-3.0, 3.0, 121)  # epsilon
_NEAR = np.linspace(0.0, 3.0, 31)  # eps: where the error of a step is looked for


def edge_error(velocity: Velocity, x: np.ndarray, weights: np.ndarray, steps: Steps) -> float:
    """Return by how much of the peak F is off after these steps near the ends of the markers; 0 if there are none."""
    c = all_coefficients(velocity, x, weights)
    if velocity.period is not None or c.shape[1] != 2:
        return 0.0
    fields = np.abs(velocity.fields(x, weights))
    field, found, peak = fields[0], 0.0, fields[0].max()
    steepest = velocity.shape(np.zeros(1))[0] / velocity.epsilon  # slope of a step of height 1
    for end, side in ((np.argmin(x), -1.0), (np.argmax(x), 1.0)):
        # At the edge F is a half of the field; what the field does is seen a little inside.
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
    transform = velocity.shape.transform(WAVENUMBERS)
    exact = steps.dt * c[1] * (WAVENUMBERS / velocity.epsilon) ** 2
    with np.errstate(all="ignore"):
        # Of waves that grow `warn_of_waves` speaks.
        made = np.minimum(steps.factor(exact * transform) ** count, 1.0)
        d = transform * made - np.exp(count * exact)
        waves = np.sin(np.outer(_NEAR, WAVENUMBERS)) / WAVENUMBERS
        off = float(np.abs(waves @ d).max()) * (WAVENUMBERS[1] - WAVENUMBERS[0]) / math.pi
    return max(off, displaced) if off <= 1.0 else displaced


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
    except FracparticlesError:  # of shapes whose markers gather: that is said by others
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
