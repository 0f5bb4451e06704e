r"""Derivatives on particles that a map x = phi(y) places, by differences in y:

    df/dx = (df/dy) / phi'(y),    h df/dy ~ Delta f_i = sum_(m = 1 .. 4) c_m (f_(i+m) - f_(i-m)),   V_i = phi'(y_i) h,

of order 8. Beyond the ends f goes on as the value of the last particle: the distance of x from an end is like y^p, so
that this is the smooth continuation up to f' y^p, and up to y^(p alpha / 2) for what vanishes as a solution does at an
absorbing end. The sum of Delta f is f at one end less f at the other.
"""

from __future__ import annotations

import numpy as np

from fracparticles.arguments import FloatArray

__all__ = ["differences"]

_WEIGHTS = (4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0)


def differences(f: FloatArray) -> FloatArray:
    """Return Delta f, shape (N,)."""
    wide, n, most = np.pad(f, len(_WEIGHTS), mode="edge"), len(f), len(_WEIGHTS)
    return np.asarray(
        sum(
            c * (wide[most + m : most + m + n] - wide[most - m : most - m + n])
            for m, c in enumerate(_WEIGHTS, 1)
        )
    )
