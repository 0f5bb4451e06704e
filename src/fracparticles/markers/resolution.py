r"""What the markers of a run reveal of the accuracy of F. All estimates use the run alone.

- The gaps between the markers leave a ripple on F (`moving.reliability`).
- Gaps d at random leave a noise on F, of the relative variance (var d / d^2) (d / eps) int S^2. It is measured by
  d F / W, which differs between neighbours by (var d / (2 d^2))^(1/2). A run multiplies the wave q of this noise by
  g(q), see `reliability`, and leaves

      variance at the end = variance at the start int |S^ g|^2 dq / int |S^|^2 dq.

  For N markers at random in a field of width L this is about L / (N (8 pi t)^(1/2)) after a time t >> eps^2. At the
  worst of some twenty places F is off by twice the square root of the variance.
- F is smoother than the field. How much is estimated by F with a smaller or a larger epsilon (`smoothing`).
- At a marker without neighbours F is its own shape function, W S(0) / eps (`lone`). The outermost markers of a quiet
  start may be such.
Where the set of markers ends, F ends too, and says nothing about the field.
"""

from __future__ import annotations

import math
import warnings

import numpy as np

from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.markers.reliability import (
    WAVENUMBERS,
    Steps,
    Velocity,
    inner,
    kept,
    transformed,
)
from fracparticles.moving.reliability import RIPPLE, cells, ripple, warn_of_ripple

__all__ = ["noise", "smoothing", "warn_of_resolution"]

# A warning is given above these.
_SMOOTHED = 0.1  # of F: the smoothing
_NOISE = 0.15  # of F: the noise at the start, of which diffusion takes most away
_BOTH = 0.2  # of F: the smoothing and the noise at the end together; each may be allowed
_LONE = 0.03  # of the peak of F: the error at a marker without neighbours, as at an edge
# A marker has no near neighbours if it is farther than this from them, in epsilon; S8 reaches 17 such distances.
_APART, _NEIGHBOURS = 0.4, 17
_PARTS = (2.0, 0.5, 0.25, 0.125)  # of epsilon, with which F is computed again
_SIGMAS = 3.0  # standard deviations: the greatest noise at some hundred markers
_WORST = 2.0  # standard deviations: the greatest noise at the some twenty places of F that are independent


def smoothing(velocity: Velocity, x: np.ndarray, weights: np.ndarray) -> float:
    """Return an estimate of max |F - f| / max |f| over the markers away from the ends, f the field that F smooths.

    It is the greatest of several estimates. F with twice epsilon has an error that is larger by a factor known from the
    order of the shape function. F with a half, a quarter and an eighth of epsilon takes the place of f, as far as the
    gaps between the markers allow, and for the last two their noise.
    """
    inside = inner(velocity, x)
    field, found = velocity.fields(x, weights)[0][inside], 0.0
    for part in _PARTS:
        try:
            other = velocity.field_alone(part * velocity.epsilon)
        except InvalidInput:  # wider than the period
            continue
        if part < 1.0 and ripple(x, weights, other.epsilon, other.shape.transform) > RIPPLE:
            break
        if part < 0.5 and _SIGMAS * noise(other, x, weights) > _SMOOTHED:
            break
        exacter = other.fields(x, weights)[0][inside]
        apart, size = np.abs(field - exacter).max(), np.abs(exacter if part < 1.0 else field).max()
        gained = part**velocity.shape.moment_order - 1.0 if part > 1.0 else 1.0
        found = max(found, float(apart / (gained * size)))
    return found


def lone(velocity: Velocity, x: np.ndarray, weights: np.ndarray) -> float:
    """Return the greatest error of F, over its peak, at a marker whose neighbours are far away.

    It is W / eps sum_j S(j d / eps) - W / d, as if the neighbours were equal markers, d apart on either side.
    """
    if x.size < 2:
        return 0.0
    width = cells(x)
    far = width > _APART * velocity.epsilon
    offsets = np.arange(-_NEIGHBOURS, _NEIGHBOURS + 1.0)[:, None] * width[far] / velocity.epsilon
    held = velocity.shape(offsets).sum(axis=0) / velocity.epsilon
    off = np.abs(weights[far] * (held - 1.0 / width[far])).max(initial=0.0)
    return float(off / np.abs(velocity.fields(x, weights)[0]).max())


def noise(velocity: Velocity, x: np.ndarray, weights: np.ndarray) -> float:
    """Return the noise that gaps at random leave on F, relative to it: the mean over the markers, by their weights."""
    order = np.argsort(x, kind="stable")
    order = order[weights[order] != 0.0]
    x, weights = x[order], weights[order]
    if x.size < 3:
        return 0.0
    width, field = cells(x), velocity.fields(x, weights)[0]
    squares = transformed(velocity.shape) ** 2
    # int S^2, by Parseval.
    square = float(squares.sum()) * (WAVENUMBERS[1] - WAVENUMBERS[0]) / math.pi
    variance = np.minimum(2.0 * np.diff(width * field / weights) ** 2, 1.0)
    held = np.minimum(width[1:] / velocity.epsilon * square, 1.0)
    share = np.abs(weights[1:]) / np.abs(weights).max()
    return float(np.sqrt(share @ (variance * held) / share.sum()))


def warn_of_resolution(
    velocity: Velocity, steps: Steps, *markers: tuple[np.ndarray, np.ndarray]
) -> None:
    """Warn if the markers, at one of several times, are too far apart, or epsilon is too large for their field.

    Also if some of them are far from all others; or if they lie irregularly at the first of the times, so that F is off
    at the start, or by the last of the steps.

    Warns
    -----
    AccuracyWarning
    """
    found = max(ripple(*one, velocity.epsilon, velocity.shape.transform) for one in markers)
    warn_of_ripple(found, velocity.epsilon, "Take more markers, or a larger epsilon.", stacklevel=3)
    noisy, smoothed = noise(velocity, *markers[0]), smoothing(velocity, *markers[0])
    off = smoothed + _WORST * noisy * math.sqrt(kept(velocity, *markers[0], steps))
    if noisy > _NOISE and not found > RIPPLE:
        warnings.warn(
            f"the markers lie irregularly: at the start F is uncertain by about {noisy:.2g} of itself. Take a quiet "
            "start, more markers, or a larger epsilon.",
            AccuracyWarning,
            stacklevel=3,
        )
    elif off > _BOTH and smoothed <= _SMOOTHED and not found > RIPPLE:
        warnings.warn(
            f"the markers lie irregularly: what is left of their noise, and epsilon, may put F off by {off:.2g} of its "
            "peak. Take a quiet start, or more markers.",
            AccuracyWarning,
            stacklevel=3,
        )
    alone = max(lone(velocity, *one) for one in markers)
    if alone > _LONE and not found > RIPPLE:
        warnings.warn(
            "some markers lie far from their neighbours: F is their own there, and off by up to "
            f"{min(alone, 1.0):.2g} of its peak. Take more markers there, or a larger epsilon.",
            AccuracyWarning,
            stacklevel=3,
        )
    if smoothed > _SMOOTHED:
        warnings.warn(
            f"epsilon = {velocity.epsilon:.4g} is too large for this field: it changes F by about "
            f"{smoothed:.2g} of itself. Take a smaller epsilon.",
            AccuracyWarning,
            stacklevel=3,
        )
