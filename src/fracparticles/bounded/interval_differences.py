r"""Derivatives on particles that a map x = phi(y) places, by differences in y:

    df/dx = (df/dy) / phi'(y),    h df/dy ~ Delta f_i = sum_(m = 1 .. 4) c_m (f_(i+m) - f_(i-m)),   V_i = phi'(y_i) h,

of order 8. Beyond the ends f goes on as the value of the last particle: the distance of x from an end is like y^p, so
that this is the smooth continuation up to f' y^p, and up to y^(p alpha / 2) for what vanishes as a solution does at an
absorbing end. A flux through walls, which is zero at them, goes on as an odd function, to the same order: the sum of
Delta f is then zero to round-off.
"""

from __future__ import annotations

import numpy as np

from fracparticles.arguments import FloatArray

__all__ = ["differences"]

_WEIGHTS = (4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0)


def differences(f: FloatArray, walls: bool = False) -> FloatArray:
    """Return Delta f, shape (N,); between `walls` of a flux that is zero there."""
    n, most = len(f), len(_WEIGHTS)
    wide = np.pad(f, most, mode="symmetric" if walls else "edge")
    if walls:
        wide[:most] *= -1.0
        wide[-most:] *= -1.0
    return np.asarray(
        sum(
            c * (wide[most + m : most + m + n] - wide[most - m : most - m + n])
            for m, c in enumerate(_WEIGHTS, 1)
        )
    )
