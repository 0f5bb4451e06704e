r"""What the markers of a run reveal of waves: whether waves of their places grow, and whether waves of F are wrong.

In a field that is uniform near a marker, displacements exp(i q x) change at the rate

    sigma(q) = -sum_m (c_m - V [m = 0]) (i q)^(m + 1) S^(eps q),     c_m = d(V F) / dF_m,

F_m the m-th derivative of F and S^ the Fourier transform of the shape function: -q^2 S^ for `diffusion`, as in
`stability`. A midpoint step multiplies them by 1 + z + z^2 / 2, z = dt sigma. The c_m are differences of the flux, at
the markers where they are the largest and the smallest. As markers spread, their waves become longer and leave the
range of growth: the result is an upper bound.

Waves of the field change at the rate sigma, too; in the equation S^ is replaced by 1. The error of their amplitude over
the run is estimated for the wavenumber of F, max |F_x| / (max F - min F), and for twice and half of it.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Protocol

import numpy as np

from fracparticles.errors import AccuracyWarning, FracparticlesError, StabilityWarning
from fracparticles.markers.shapes import Shape

__all__ = [
    "CORE",
    "WAVENUMBERS",
    "Steps",
    "Velocity",
    "all_coefficients",
    "coefficients",
    "inner",
    "kept",
    "midpoint",
    "rates",
    "transformed",
    "warn_of_waves",
    "wave_error",
]

_MOST_GROWTH = math.log(10.0)  # of a wave over a run, as an exponent: more is warned of
_WAVE_ERROR = 0.1  # of a wave of F: more is warned of
WAVENUMBERS = np.linspace(0.0, 30.0, 601)[1:]  # eps q
_HARMONICS = np.array([2.0, 1.0, 0.5])  # of the wavenumber of F: where its error is looked for
CORE = 2.0  # epsilon: S8 is negligible for an end that is farther away
_DIFFERENCE = 1e-4  # of a derivative of F, relative to F / eps^m: a flux quadratic in it has exact differences
_TOO_LARGE = 1.0 + 1e-9  # of the stability interval: a step above this is warned of


class Velocity(Protocol):
    """What this module needs of a `solver.MarkerVelocity`."""

    shape: Shape
    epsilon: float
    period: float | None
    flux: Callable[[np.ndarray, np.ndarray], np.ndarray]

    def fields(self, x: Any, weights: Any) -> np.ndarray:
        """Return F and its derivatives at the markers."""

    def field_alone(self, epsilon: float) -> Velocity:
        """Return the same with another epsilon, without derivatives."""


@lru_cache(maxsize=64)
def transformed(shape: Shape) -> np.ndarray:
    """Return S^ at `WAVENUMBERS`, not to be changed: every run asks for it several times."""
    values = shape.transform(WAVENUMBERS)
    values.flags.writeable = False
    return values


def midpoint(z: np.ndarray) -> np.ndarray:
    """Return 1 + z + z^2 / 2: what a midpoint step multiplies a wave by."""
    return np.asarray(1.0 + z + 0.5 * z * z)


@dataclass(frozen=True)
class Steps:
    """The steps of a run.

    Attributes
    ----------
    dt, count : float, int
    factor : callable
        What a step multiplies a wave by, of z = sigma dt.
    interval : float
        The length of the stability interval, 2 for the midpoint rule.
    """

    dt: float
    count: int
    factor: Callable[[np.ndarray], np.ndarray] = midpoint
    interval: float = 2.0


def all_coefficients(velocity: Velocity, x: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return c_m - V [m = 0] at every marker, shape (N, derivatives + 1); not finite where F has no uniform flux."""
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
    return np.array(found).T


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
    c = all_coefficients(velocity, x, weights)
    c = c[np.isfinite(c).all(axis=1)]
    if not c.size:
        return c
    return np.asarray(c[np.unique(np.concatenate([c.argmin(axis=0), c.argmax(axis=0)]))])


def rates(c: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return -sum_m c_m (i q)^(m + 1), sigma of the equation, shape (rows of c, wavenumbers)."""
    return np.asarray(-c @ (1j * q) ** np.arange(1, c.shape[1] + 1)[:, None])


def kept(velocity: Velocity, x: np.ndarray, weights: np.ndarray, steps: Steps) -> float:
    """Return what a run leaves of the square of a noise of F, int |S^ g|^2 dq / int |S^|^2 dq, g = factor^count.

    Of the c_m that leave the most; at most 1.
    """
    transform = transformed(velocity.shape)
    sigma = rates(coefficients(velocity, x, weights), WAVENUMBERS / velocity.epsilon) * transform
    with np.errstate(all="ignore"):
        left = np.minimum(np.abs(steps.factor(steps.dt * sigma)) ** (2 * steps.count), 1.0)
    squares = transform * transform
    return float((left @ squares).max(initial=0.0) / squares.sum())


def wave_error(velocity: Velocity, x: np.ndarray, weights: np.ndarray, steps: Steps) -> float:
    """Return the largest error in the amplitude of a wave that F holds, as a part of max |F|; zero if it holds none.

    Parameters
    ----------
    velocity : solver.MarkerVelocity
    x, weights : array, shape (N,)
        The markers at the start.
    steps : Steps
    """
    fields = velocity.fields(x, weights)[:, inner(velocity, x)]
    height = float(np.ptp(fields[0]))
    if len(fields) < 2 or not height > 0.0:
        return 0.0
    q = float(np.abs(fields[1]).max()) / height * _HARMONICS
    with np.errstate(all="ignore"):
        exact = steps.dt * rates(coefficients(velocity, x, weights), q)
        ours = steps.factor(exact * velocity.shape.transform(velocity.epsilon * q)) ** steps.count
        error = np.abs(ours - np.exp(steps.count * exact))
    return float(error.max(initial=0.0) * height / np.abs(fields[0]).max())


def inner(velocity: Velocity, x: np.ndarray) -> np.ndarray:
    """Return which markers do not feel the ends of the set, where F ends, too; all if all do."""
    felt = min(velocity.shape.reach, CORE) * velocity.epsilon
    found = (x > x.min() + felt) & (x < x.max() - felt)
    return found if found.any() else np.ones(x.size, dtype=bool)


def warn_of_waves(velocity: Velocity, x: np.ndarray, weights: np.ndarray, steps: Steps) -> None:
    """Warn if a wave grows because dt is too large, or tenfold during the run, or comes out wrong; see `wave_error`.

    Warns
    -----
    StabilityWarning
    AccuracyWarning
    """
    try:
        c = coefficients(velocity, x, weights)
        error = wave_error(velocity, x, weights, steps)
    except FracparticlesError:
        return  # the run will say so, with the step
    sigma = rates(c, WAVENUMBERS / velocity.epsilon) * transformed(velocity.shape)
    complaint = _growth(velocity.epsilon, sigma, steps)
    if complaint:
        warnings.warn(complaint, StabilityWarning, stacklevel=3)
    elif not error <= _WAVE_ERROR:
        warnings.warn(
            f"waves of the length that F has come out wrong, by {error:.2g} of its peak. Take a smaller "
            "epsilon, or a smaller dt.",
            AccuracyWarning,
            stacklevel=3,
        )


def _growth(epsilon: float, sigma: np.ndarray, steps: Steps) -> str:
    """What to say of the fastest and of the growing waves; nothing if there is nothing to say."""
    if not sigma.size:
        return ""
    fastest = float(-sigma.real.min())
    if steps.dt * fastest > steps.interval * _TOO_LARGE:
        limit = steps.interval / fastest
        return (
            f"dt = {steps.dt:.6g} is {steps.dt / limit:.3g} times the limit of stability, {limit:.3g}: waves of the "
            "markers' places grow. Take a smaller dt, or a larger epsilon."
        )
    with np.errstate(divide="ignore", over="ignore"):
        exponents = steps.count * np.log(np.abs(steps.factor(steps.dt * sigma)))
    row, k = np.unravel_index(int(np.argmax(exponents)), exponents.shape)
    if not exponents[row, k] > _MOST_GROWTH:
        return ""
    by_itself = sigma.real[row, k] > 0.0
    remedy = "Take S8, or a shorter run." if by_itself else "Take a smaller dt."
    return (
        f"waves of the markers' places of the length {2.0 * math.pi * epsilon / WAVENUMBERS[k]:.3g} grow, by up to "
        f"exp({exponents[row, k]:.3g}) over this run"
        f"{', whatever the step: the markers gather in clusters' if by_itself else ''}. {remedy}"
    )
