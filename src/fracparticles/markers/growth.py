r"""How a perturbation of equally spaced markers grows, measured: x_j = j h + a cos(q j h) on a periodic line.

To the first order in a, a midpoint step multiplies the perturbation by 1 + z + z^2 / 2, z = dt sigma(q), with the rate
sigma of `stability`. What is measured is log |amplitude| per time, which is sigma but for (sigma dt)^2 / 6.
Lengths are in units of epsilon, times in units of epsilon^2.
"""

from __future__ import annotations

import math

import numpy as np

from fracparticles.arguments import MOST, instance, positive_integer, scale
from fracparticles.markers.shapes import Shape
from fracparticles.markers.solver import MarkerVelocity, run
from fracparticles.markers.stability import extremes

__all__ = ["largest_step", "measured_rate"]

_HALVINGS = 12
_STEPS = 24


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

    Raises `InvalidInput` if a number is not positive, the mode or the steps are not whole, or the shape
    function does not do.
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
    end = run(x, np.full(count, h), velocity, dt=dt * epsilon**2, steps=steps)
    left = 2.0 * np.mean((end.x - lattice) * wave) / (amplitude * epsilon)
    return k, math.log(abs(left)) / (dt * steps)


def largest_step(shape: Shape, epsilon: float = 1.0) -> float:
    """Return the largest dt / eps^2 from 0.05 to 2 at which the wave that decays fastest does not grow, by bisection.

    Raises `InvalidInput` if it is no shape function with a first derivative, or epsilon is not positive.
    """
    wavelength = 2.0 * math.pi / extremes(shape).k_decay
    waves = math.floor(2.0 * shape.reach / wavelength) + 1
    # Where S'' jumps, at eps, neighbours half a spacing off on either side make the smallest lattice error.
    counts = waves * np.arange(24, 64)
    off = np.abs(np.mod(shape.reach * counts / (waves * wavelength), 1.0) - 0.5)
    period = waves * wavelength
    lattice = {"spacing": period / counts[int(np.argmin(off))], "period": period, "amplitude": 1e-6}
    low, high = 0.05, 2.0
    for _ in range(_HALVINGS):
        dt = 0.5 * (low + high)
        _, rate = measured_rate(shape, waves, **lattice, dt=dt, steps=_STEPS, epsilon=epsilon)
        low, high = (dt, high) if rate <= 0.0 else (low, dt)
    return 0.5 * (low + high)
