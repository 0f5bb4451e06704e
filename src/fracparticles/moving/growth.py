r"""How a displacement wave of particles with a diffusion velocity grows, measured in a uniform field.

The places x_i = i h + xi cos(theta i) change at the rate -D |k|^alpha eta^(k eps), theta = k h, aliases neglected,
which is DD's symbol A(theta): a midpoint step multiplies the wave by 1 + z + z^2 / 2, z = dt A(theta).
"""

from __future__ import annotations

from functools import partial

import numpy as np

from fracparticles.arguments import positive_integer, positive_real, scale
from fracparticles.moving.diffusion_velocity import DiffusionVelocity
from fracparticles.moving.lagrangian import advance

__all__ = ["displacement_growth"]

_STEPS = 3  # of which a measured growth is the mean
_XI = 1e-5  # displacement of a wave, in spacings: its square is what linearity neglects
_MOST = 100_000  # particles on a side


def displacement_growth(velocity: DiffusionVelocity, dt: float, theta: float, half: int) -> float:
    """Return what a midpoint step multiplies a displacement wave by.

    A uniform field on 2 `half` + 1 particles, h = 1, is moved with and without the wave. Their difference in the
    middle, where the ends are not felt yet, is compared with the wave. What the ends do is like (theta `half`)^-alpha.

    Raises
    ------
    InvalidInput
        If the step or the wave is not positive, or `half` no positive whole number.
    """
    theta, half = positive_real("theta", theta), positive_integer("half", half, _MOST)
    x = np.arange(-half, half + 1.0)
    wave = np.cos(theta * x)
    dt, strength = scale("dt", dt), np.ones(x.size)
    move = partial(advance, strength=strength, velocity=velocity, dt=dt, steps=_STEPS)
    change = (move(x + _XI * wave)[0] - move(x)[0]) / _XI
    middle = np.abs(x) <= half / 6.0
    ratio = float(change[middle] @ wave[middle] / (wave[middle] @ wave[middle]))
    return float(np.copysign(np.abs(ratio) ** (1.0 / _STEPS), ratio))
