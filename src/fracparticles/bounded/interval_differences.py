r"""Derivatives on particles that a map x = phi(y) places, by differences in y:

    df/dx = (df/dy) / phi'(y),    h df/dy ~ Delta f_i = sum_(m = 1 .. 4) c_m (f_(i+m) - f_(i-m)),   V_i = phi'(y_i) h,

of order 8. Beyond the ends f goes on as the value of the last particle: the distance of x from an end is like y^p, so
that this is the smooth continuation up to f' y^p. A flux through walls, which is zero at them, goes on as an odd
function, to the same order: the sum of Delta f is then zero to round-off.

What vanishes at the ends as a solution does, like y^(p alpha / 2), is zero beyond, and Delta is skew. With

    2 V d(a u)/dx = Delta(a u) + a Delta u + V a' u

sum V u^2 grows no faster than at the rate max(-a'), less twice the lowest rate of the diffusion, as in
`square_transport`. (As a flux, with |a| = 30 and alpha = 1.05, waves grow at 1e8 and more.) Where u is carried out of
an end, it may fall in a layer thinner than the spacing, and Delta sees a jump. There the outward part of a times G u is
added, for the outermost particle first,

    G = e e^T / 2 + (q 1^T - 1 q^T) / 4,    q = r - e / 2,    e = (1, 0, 0, 0),    r_i = sum_(m >= i) c_m:

G 1 = r, so that the jump is gone, and sum u G u = u_1^2 / 2 is what leaves.
"""

from __future__ import annotations

import numpy as np

from fracparticles.arguments import FloatArray

__all__ = ["differences", "transported"]

_WEIGHTS = np.array([4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0])
_MOST = _WEIGHTS.size
_STENCIL = np.concatenate([-_WEIGHTS[::-1], [0.0], _WEIGHTS])


def differences(f: FloatArray, walls: bool = False) -> FloatArray:
    """Return Delta f, shape (N,); between `walls` of a flux that is zero there."""
    if walls:
        return _inside(f, -f[_MOST - 1 :: -1], -f[: -_MOST - 1 : -1])
    return _inside(f, f[0], f[-1])


def transported(u: FloatArray, a: FloatArray) -> FloatArray:
    """Return V d(a u)/dx of what vanishes at the ends, both of shape (N,)."""
    out = _inside(a * u) + a * _inside(u) + differences(a) * u
    out *= 0.5
    out[:_MOST] += max(-a[0], 0.0) * (_OUTFLOW @ u[:_MOST])
    out[: -_MOST - 1 : -1] += max(a[-1], 0.0) * (_OUTFLOW @ u[: -_MOST - 1 : -1])
    return out


def _inside(
    f: FloatArray, left: FloatArray | float = 0.0, right: FloatArray | float = 0.0
) -> FloatArray:
    """Delta f of an f that goes on as `left` and `right`, four values or the same four times."""
    wide = np.empty(f.size + 2 * _MOST)
    wide[:_MOST], wide[_MOST:-_MOST], wide[-_MOST:] = left, f, right
    return np.correlate(wide, _STENCIL)


def _outflow() -> FloatArray:
    """G."""
    q = np.cumsum(_WEIGHTS[::-1])[::-1].copy()
    q[0] -= 0.5
    out = (q[:, None] - q) / _MOST
    out[0, 0] += 0.5
    return out


_OUTFLOW = _outflow()
