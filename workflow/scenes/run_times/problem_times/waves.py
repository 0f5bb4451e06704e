"""Steps on a circle: Lawson's form of the classical Runge-Kutta scheme, and a velocity without a jump.

u^' = -decay u^ + rate(u^) is the classical scheme for exp(t decay) u^, whose diffusion is exact.
"""

from collections.abc import Callable

import numpy as np

_STABLE = 2.5  # of the scheme's 2.8 on the imaginary axis
_MENDED = 0.8  # of the half-width: where a velocity is still what it is


def mended(velocity: np.ndarray, far: np.ndarray) -> np.ndarray:
    """Return a velocity that falls to zero where the ends of the circle meet; `far` is |x| over the half-width."""
    share = np.clip((far - _MENDED) / (1.0 - _MENDED), 0.0, 1.0)
    return np.asarray(velocity * 0.5 * (1.0 + np.cos(np.pi * share)))


def lawson(
    rate: Callable[[np.ndarray], np.ndarray],
    decay: np.ndarray,
    waves: np.ndarray,
    time: float,
    fastest: float,
    least: int,
) -> np.ndarray:
    """Return u^ after a time, in at least so many steps, and as many as the fastest wave of the velocity asks."""
    steps = max(least, int(np.ceil(time * fastest / _STABLE)))
    dt = time / steps
    half = np.exp(-0.5 * dt * decay)
    for _ in range(steps):
        first = rate(waves)
        second = rate(half * (waves + 0.5 * dt * first))
        third = rate(half * waves + 0.5 * dt * second)
        fourth = rate(half * (half * waves + dt * third))
        waves = half * (half * (waves + dt / 6.0 * first) + dt / 3.0 * (second + third))
        waves += dt / 6.0 * fourth
    return waves
