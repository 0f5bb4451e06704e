r"""What F is off by where the set of markers ends and the field jumps, as that of the square profile does.

There F is as wide as epsilon from the start, and the field as wide as the equation makes it by then. In the frame of
the edge a step of the height J is a sum of waves: F differs from it at the distance y by

    J / pi int_0^inf d(q) sin(q y) / q dq,     d = S^(eps q) g(q) - exp(c_1 q^2 t),

g what the steps multiply a wave of the markers by, -c_1 the diffusivity (`reliability`). Diffusion leaves
0.26 J of it after t = 0.01 eps^2, and 0.07 J after 0.1 eps^2.

Where the field runs against its edge, a = c_0 - V > 0 on the right, the edge is a shock: that of Burgers' equation,
J / (1 + exp(a y / mu)), has the slope of a step after t = 4 mu / (pi a^2), and none of it is taken away later. Of a
step that the equation makes waves of, as KdV does, nothing is said.
"""

from __future__ import annotations

import math
import warnings

import numpy as np

from fracparticles.errors import AccuracyWarning
from fracparticles.markers.reliability import (
    CORE,
    WAVENUMBERS,
    Steps,
    Velocity,
    all_coefficients,
)

__all__ = ["edge_error", "warn_of_edges"]

_MOST = 0.1  # of the peak of F
_NEAR = np.linspace(0.0, 3.0, 31)  # eps: where the error of a step is looked for


def edge_error(velocity: Velocity, x: np.ndarray, weights: np.ndarray, steps: Steps) -> float:
    """Return by how much of the peak F is off after these steps near the ends of the markers; 0 if there are none."""
    c = all_coefficients(velocity, x, weights)
    if velocity.period is not None or c.shape[1] != 2:
        return 0.0
    field = np.abs(velocity.fields(x, weights)[0])
    found = 0.0
    for end, side in ((np.argmin(x), -1.0), (np.argmax(x), 1.0)):
        # At the edge F is a half of the field; what the field does is seen a little inside.
        near = np.abs(x - x[end]) < CORE * velocity.epsilon
        inside = np.argmax(np.where(near, field, -1.0))
        jump = min(2.0 * field[end] / field.max(), 1.0)
        found = max(found, jump * _step_error(velocity, c[inside], side, steps))
    return found


def _step_error(velocity: Velocity, c: np.ndarray, side: float, steps: Steps) -> float:
    """The largest error of a step of height 1 on this side of the markers; zero if its waves grow."""
    against, spread, count = side * c[0], abs(c[1]), float(steps.count)
    if against > 0.0:
        count = min(count, 4.0 * spread / (math.pi * against**2 * steps.dt))
    transform = velocity.shape.transform(WAVENUMBERS)
    exact = steps.dt * c[1] * (WAVENUMBERS / velocity.epsilon) ** 2
    with np.errstate(all="ignore"):
        d = transform * steps.factor(exact * transform) ** count - np.exp(count * exact)
        waves = np.sin(np.outer(_NEAR, WAVENUMBERS)) / WAVENUMBERS
        off = float(np.abs(waves @ d).max()) * (WAVENUMBERS[1] - WAVENUMBERS[0]) / math.pi
    return off if off <= 1.0 else 0.0


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
