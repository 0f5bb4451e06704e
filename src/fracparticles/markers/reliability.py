r"""What the markers of a run reveal: whether waves of their positions grow, and whether F is the field.

Stability. In a field that is uniform near a marker, displacements exp(i q x) change at the rate

    sigma(q) = -sum_m (c_m - V [m = 0]) (i q)^(m + 1) S^(eps q),     c_m = d(V F) / dF_m,

F_m the m-th derivative of F and S^ the Fourier transform of the shape function: -q^2 S^ for `diffusion`, as in
`stability`. A midpoint step multiplies them by 1 + z + z^2 / 2, z = dt sigma. The c_m are differences of the flux, at
the markers where they are the largest and the smallest. As markers spread their waves become longer and leave the
range of growth: the result is an upper bound.

Accuracy, estimated from the run alone:
- The gaps between the markers leave a ripple on F (`moving.reliability`).
- Gaps d at random leave a noise of the relative variance (var d / d^2) (d / eps) int S^2. Between neighbours d F / W
  differs by (var d / (2 d^2))^(1/2).
- F is smoother than the field: how much, is what a smaller epsilon changes, or a larger one (`smoothing`).
- Waves of the field change at the rate sigma, where the equation has S^ = 1. The error of their amplitude over the run
  is found for the wavenumber of F, max |F_x| / (max F - min F), and for twice and half of it.
Where the set of markers ends, F ends too, and says nothing about the field.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np

from fracparticles.errors import (
    AccuracyWarning,
    FracparticlesError,
    InvalidInput,
    StabilityWarning,
)
from fracparticles.markers.shapes import Shape
from fracparticles.moving.reliability import RIPPLE, cells, ripple, warn_of_ripple

__all__ = [
    "coefficients",
    "midpoint",
    "noise",
    "rates",
    "smoothing",
    "warn_of_resolution",
    "warn_of_waves",
    "wave_error",
]

_MOST_GROWTH = math.log(10.0)  # of a wave over a run, before there is a warning
_SMOOTHED = 0.1  # of F, the same
_WAVE_ERROR = 0.1
_NOISE = 0.15  # diffusion takes most of it away
_WAVENUMBERS = np.linspace(0.0, 30.0, 601)[1:]  # eps q
_HARMONICS = np.array([2.0, 1.0, 0.5])
_PARTS = (2.0, 0.5, 0.25, 0.125)  # of epsilon
_SIGMAS = 3.0  # of noise, the greatest of some hundred markers
_CORE = 2.0  # epsilon: S8 is negligible for an end that is farther away
_DIFFERENCE = 1e-4  # of a derivative of F, relative to F / eps^m: a flux quadratic in it has exact differences
_TOO_LARGE = 1.0 + 1e-9

Step = Callable[[np.ndarray], np.ndarray]


class Velocity(Protocol):
    """What this module needs of a `solver.MarkerVelocity`."""

    shape: Shape
    epsilon: float
    flux: Callable[[np.ndarray, np.ndarray], np.ndarray]

    def fields(self, x: Any, weights: Any) -> np.ndarray:
        """Return F and its derivatives at the markers."""

    def field_alone(self, epsilon: float) -> Velocity:
        """Return the same with another epsilon, without derivatives."""


def midpoint(z: np.ndarray) -> np.ndarray:
    """Return 1 + z + z^2 / 2: what a midpoint step multiplies a wave by."""
    return np.asarray(1.0 + z + 0.5 * z * z)


def coefficients(velocity: Velocity, x: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return c_m - V [m = 0] at the markers where one of them is the largest or the smallest.

    Parameters
    ----------
    velocity : solver.MarkerVelocity
    x, weights : array, shape (N,)
        The markers.

    Returns
    -------
    array, shape (up to 2 (derivatives + 1), derivatives + 1)
    """
    fields = velocity.fields(x, weights)
    uniform = np.zeros_like(fields)
    uniform[0] = fields[0]
    found = []
    with np.errstate(all="ignore"):
        for m in range(len(fields)):
            step = _DIFFERENCE * fields[0] / velocity.epsilon**m
            up, down = uniform.copy(), uniform.copy()
            up[m] += step
            down[m] -= step
            found.append((velocity.flux(x, up) - velocity.flux(x, down)) / (2.0 * step))
        found[0] = found[0] - velocity.flux(x, uniform) / fields[0]
    c = np.array(found)
    c = c[:, np.isfinite(c).all(axis=0)]
    if not c.size:
        return np.zeros((0, len(fields)))
    worst = np.unique(np.concatenate([c.argmin(axis=1), c.argmax(axis=1)]))
    return np.asarray(c[:, worst].T)


def rates(c: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return -sum_m c_m (i q)^(m + 1), sigma of the equation, shape (rows of c, wavenumbers)."""
    return np.asarray(-c @ (1j * q) ** np.arange(1, c.shape[1] + 1)[:, None])


def wave_error(
    velocity: Velocity,
    x: np.ndarray,
    weights: np.ndarray,
    dt: float,
    steps: int,
    step: Step = midpoint,
) -> float:
    """Return the largest error in the amplitude of a wave that F holds, as a part of max |F|; zero if it holds none.

    Parameters
    ----------
    velocity : solver.MarkerVelocity
    x, weights : array, shape (N,)
        The markers at the start.
    dt, steps : float, int
    step : callable
        What a step multiplies a wave by, of z = sigma dt.
    """
    fields = velocity.fields(x, weights)[:, _inner(velocity, x)]
    height = float(np.ptp(fields[0]))
    if len(fields) < 2 or not height > 0.0:
        return 0.0
    q = float(np.abs(fields[1]).max()) / height * _HARMONICS
    with np.errstate(all="ignore"):
        exact = dt * rates(coefficients(velocity, x, weights), q)
        ours = step(exact * velocity.shape.transform(velocity.epsilon * q)) ** steps
        error = np.abs(ours - np.exp(steps * exact))
    return float(error.max(initial=0.0) * height / np.abs(fields[0]).max())


def warn_of_waves(
    velocity: Velocity,
    x: np.ndarray,
    weights: np.ndarray,
    dt: float,
    steps: int,
    step: Step = midpoint,
    interval: float = 2.0,
) -> None:
    """Warn if a wave grows because dt is too large, or tenfold during the run, or comes out wrong.

    Parameters
    ----------
    velocity : solver.MarkerVelocity
    x, weights : array, shape (N,)
        The markers at the start.
    dt, steps : float, int
    step : callable
        What a step multiplies a wave by, of z = sigma dt.
    interval : float
        The length of the stability interval, 2 for the midpoint rule.

    Warns
    -----
    StabilityWarning
    AccuracyWarning
    """
    try:
        c = coefficients(velocity, x, weights)
        error = wave_error(velocity, x, weights, dt, steps, step)
    except FracparticlesError:
        return  # the run will say so, with the step
    sigma = rates(c, _WAVENUMBERS / velocity.epsilon) * velocity.shape.transform(_WAVENUMBERS)
    complaint = _growth(velocity.epsilon, sigma, dt, steps, step, interval)
    if complaint:
        warnings.warn(complaint, StabilityWarning, stacklevel=3)
    elif not error <= _WAVE_ERROR:
        warnings.warn(
            f"waves of the length that F has come out wrong, by {error:.2g} of its peak. Take a smaller "
            "epsilon, or a smaller dt.",
            AccuracyWarning,
            stacklevel=3,
        )


def _growth(
    epsilon: float, sigma: np.ndarray, dt: float, steps: int, step: Step, interval: float
) -> str:
    """What to say of the fastest and of the growing waves; nothing if there is nothing to say."""
    if not sigma.size:
        return ""
    fastest = float(-sigma.real.min())
    if dt * fastest > interval * _TOO_LARGE:
        limit = interval / fastest
        return (
            f"dt = {dt:.6g} is {dt / limit:.3g} times the limit of stability, {limit:.3g}: waves of the markers' "
            "places grow. Take a smaller dt, or a larger epsilon."
        )
    with np.errstate(divide="ignore", over="ignore"):
        exponents = steps * np.log(np.abs(step(dt * sigma)))
    row, k = np.unravel_index(int(np.argmax(exponents)), exponents.shape)
    if not exponents[row, k] > _MOST_GROWTH:
        return ""
    by_itself = sigma.real[row, k] > 0.0
    remedy = "Take S8, or a shorter run." if by_itself else "Take a smaller dt."
    return (
        f"waves of the markers' places of the length {2.0 * math.pi * epsilon / _WAVENUMBERS[k]:.3g} grow, by up to "
        f"exp({exponents[row, k]:.3g}) over this run"
        f"{', whatever the step: the markers gather in clusters' if by_itself else ''}. {remedy}"
    )


def smoothing(velocity: Velocity, x: np.ndarray, weights: np.ndarray) -> float:
    """Return an estimate of max |F - f| / max |f| over the markers away from the ends, f the field that F smooths.

    The greatest of what others say of it: F with twice of epsilon, whose error is larger by a factor that the order
    tells; and in the place of f itself F with a half, a quarter and an eighth of epsilon, as far as the gaps between
    the markers allow, and for the last two their noise.
    """
    inner = _inner(velocity, x)
    field, found = velocity.fields(x, weights)[0][inner], 0.0
    for part in _PARTS:
        try:
            other = velocity.field_alone(part * velocity.epsilon)
        except InvalidInput:  # wider than the period
            continue
        if part < 1.0 and ripple(x, weights, other.epsilon, other.shape.transform) > RIPPLE:
            break
        if part < 0.5 and _SIGMAS * noise(other, x, weights) > _SMOOTHED:
            break
        exacter = other.fields(x, weights)[0][inner]
        apart, size = np.abs(field - exacter).max(), np.abs(exacter if part < 1.0 else field).max()
        gained = part**velocity.shape.moment_order - 1.0 if part > 1.0 else 1.0
        found = max(found, float(apart / (gained * size)))
    return found


def noise(velocity: Velocity, x: np.ndarray, weights: np.ndarray) -> float:
    """Return the noise that gaps at random leave on F, relative to it: the mean over the markers, by their weights."""
    order = np.argsort(x, kind="stable")
    order = order[weights[order] != 0.0]
    x, weights = x[order], weights[order]
    if x.size < 3:
        return 0.0
    width, field = cells(x), velocity.fields(x, weights)[0]
    squares = velocity.shape.transform(_WAVENUMBERS) ** 2
    square = (
        float(squares.sum()) * (_WAVENUMBERS[1] - _WAVENUMBERS[0]) / math.pi
    )  # int S^2, by Parseval
    variance = np.minimum(2.0 * np.diff(width * field / weights) ** 2, 1.0)
    held = np.minimum(width[1:] / velocity.epsilon * square, 1.0)
    share = np.abs(weights[1:]) / np.abs(weights).max()
    return float(np.sqrt(share @ (variance * held) / share.sum()))


def _inner(velocity: Velocity, x: np.ndarray) -> np.ndarray:
    """Which markers do not feel the ends of the set; all if all do."""
    felt = min(velocity.shape.reach, _CORE) * velocity.epsilon
    inner = (x > x.min() + felt) & (x < x.max() - felt)
    return inner if inner.any() else np.ones(x.size, dtype=bool)


def warn_of_resolution(velocity: Velocity, *markers: tuple[np.ndarray, np.ndarray]) -> None:
    """Warn if the markers, at one of several times, are too far apart, or epsilon is too large for their field.

    Warns
    -----
    AccuracyWarning
    """
    found = max(ripple(*one, velocity.epsilon, velocity.shape.transform) for one in markers)
    warn_of_ripple(found, velocity.epsilon, "Take more markers, or a larger epsilon.", stacklevel=3)
    noisy = noise(velocity, *markers[0])
    if noisy > _NOISE and not found > RIPPLE:
        warnings.warn(
            f"the markers lie irregularly: at the start F is uncertain by about {noisy:.2g} of itself. Take a quiet "
            "start, more markers, or a larger epsilon.",
            AccuracyWarning,
            stacklevel=3,
        )
    smoothed = smoothing(velocity, *markers[0])
    if smoothed > _SMOOTHED:
        warnings.warn(
            f"epsilon = {velocity.epsilon:.4g} is too large for this field: it changes F by about "
            f"{smoothed:.2g} of itself. Take a smaller epsilon.",
            AccuracyWarning,
            stacklevel=3,
        )
