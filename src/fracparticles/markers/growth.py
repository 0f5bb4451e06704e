r"""How a perturbation of equally spaced markers grows, measured: x_j = j h + a cos(q j h) on a periodic line.

To the first order in a, a midpoint step multiplies the perturbation by 1 + z + z^2 / 2, z = dt sigma(q), with the rate
sigma of `stability`. The measured rate is log |amplitude| per time, which equals sigma up to (sigma dt)^2 / 6.
Lengths are in units of epsilon, times in units of epsilon^2.
"""

from __future__ import annotations

import math

import numpy as np

from fracparticles.arguments import MOST, instance, positive_integer, scale
from fracparticles.errors import InvalidInput
from fracparticles.markers.shapes import Shape
from fracparticles.markers.solver import MarkerVelocity
from fracparticles.markers.stability import extremes
from fracparticles.moving.lagrangian import advance

__all__ = ["largest_step", "measured_rate"]

# Of the mean square of a wave, and of an amplitude over the period: less is round-off.
_LEAST = 1e-12
_HALVINGS = 12  # of the interval in which the largest step lies
_STEPS = 24  # over which growth is judged there


def measured_rate(
    shape: Shape,
    mode: int,
    *,
    spacing: float,
    period: float,
    amplitude: float,
    dt: float = 0.005,
    steps: int = 10,
    epsilon: float = 1.0,
) -> tuple[float, float]:
    """Return k = eps q and eps^2 times the rate of a wave of `mode` wavelengths in a period.

    Parameters
    ----------
    shape : Shape
        S, with a first derivative.
    mode : int
        Wavelengths in the period.
    spacing, period, amplitude : float
        h, the length of the line and a, in units of epsilon.
    dt, steps : float, int
        The midpoint steps of the measurement; dt is in units of epsilon^2.
    epsilon : float
        Scales all lengths.

    Raises
    ------
    InvalidInput
        If a number is not positive, the mode or the steps are not whole numbers, the shape function has no first
        derivative, or there is nothing to measure: the amplitude is lost in round-off, or the wave is zero at the
        markers.
    """
    shape, epsilon = instance("shape", shape, Shape), scale("epsilon", epsilon)
    period, amplitude, dt = scale("period", period), scale("amplitude", amplitude), scale("dt", dt)
    count = positive_integer("period / spacing", round(period / scale("spacing", spacing)), MOST)
    h = epsilon * period / count
    k = 2.0 * math.pi * positive_integer("mode", mode, count) / period
    lattice = h * (np.arange(count) + 0.5)
    wave = np.cos(k / epsilon * lattice)
    velocity = MarkerVelocity(shape, epsilon, period=epsilon * period)
    x = lattice + amplitude * epsilon * wave
    size = float(np.mean(wave * wave))
    if size < _LEAST:
        allowed = "a wave that is not zero at the markers"
        raise InvalidInput("mode", mode, allowed, "Take another, or more markers.")
    if amplitude < _LEAST * period:
        allowed = f"at least {_LEAST * period:.3g}: less drowns in the round-off of the places"
        raise InvalidInput("amplitude", amplitude, allowed, "Take a larger one.")
    x, _, _ = advance(x, np.full(count, h), velocity, dt=scale("dt", dt * epsilon**2), steps=steps)
    left = np.mean((x - lattice) * wave) / (size * amplitude * epsilon)
    return k, math.log(abs(left)) / (dt * steps)


def largest_step(shape: Shape, epsilon: float = 1.0) -> float:
    """Return the largest dt / eps^2 from 0.05 to 2 at which the wave that decays fastest does not grow, by bisection.

    Raises `InvalidInput` if the shape function has no first derivative, epsilon is not positive, or the wave grows at
    every such step, or at none.
    """
    wavelength = 2.0 * math.pi / extremes(shape).k_decay
    waves = math.floor(2.0 * shape.reach / wavelength) + 1
    # Where S'' jumps, at eps, neighbours half a spacing off on either side make the smallest lattice error.
    counts = waves * np.arange(24, 64)
    off = np.abs(np.mod(shape.reach * counts / (waves * wavelength), 1.0) - 0.5)
    period = waves * wavelength
    lattice = {"spacing": period / counts[int(np.argmin(off))], "period": period, "amplitude": 1e-6}

    def grows(dt: float) -> bool:
        found = measured_rate(shape, waves, **lattice, dt=dt, steps=_STEPS, epsilon=epsilon)
        return found[1] > 0.0

    low, high = 0.05, 2.0
    if grows(low) or not grows(high):
        allowed = f"one with a limit between {low} and {high} epsilon^2"
        raise InvalidInput("shape", shape.name, allowed, "Take another: markers see its kinks.")
    for _ in range(_HALVINGS):
        dt = 0.5 * (low + high)
        low, high = (low, dt) if grows(dt) else (dt, high)
    return 0.5 * (low + high)
