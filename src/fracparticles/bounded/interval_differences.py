r"""Derivatives on particles that a map x = phi(y) places, by differences in y of order 8:

    df/dx = (df/dy) / phi'(y),    h df/dy ~ Delta f_i = sum_(m = 1 .. 4) c_m (f_(i+m) - f_(i-m)),   V_i = phi'(y_i) h.

Beyond the ends f is continued by the value of the last particle. The distance of x from an end is like y^p, so that
this is the smooth continuation up to f' y^p. A flux is zero at walls and is continued as an odd function, to the same
order. The sum of Delta f is then zero to round-off.

A solution vanishes at the ends like y^(p alpha / 2). It is zero beyond, and Delta is skew. With

    2 V d(a u)/dx = Delta(a u) + a Delta u + V a' u

sum V u^2 grows at most at the rate max(-a'), less twice the lowest rate of the diffusion, as in `square_transport`. (In
the form of a flux, with |a| = 30 and alpha = 1.05, waves grow at 1e8 and more.) Where u is carried out of an end, it
may fall in a layer thinner than the spacing, and Delta sees a jump. There the outward part of a times G u is added,
with the outermost particle first,

    G = e e^T / 2 + (q 1^T - 1 q^T) / 4,    q = r - e / 2,    e = (1, 0, 0, 0),    r_i = sum_(m >= i) c_m.

G 1 = r removes the jump, and sum u G u = u_1^2 / 2 is the part that leaves.
"""

from __future__ import annotations

import numpy as np

from fracparticles.arguments import FloatArray

__all__ = ["differences", "transported"]

# The weights c_m, their number, and the whole stencil from -4 to 4.
_WEIGHTS = np.array([4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0])
_MOST = _WEIGHTS.size
_STENCIL = np.concatenate([-_WEIGHTS[::-1], [0.0], _WEIGHTS])


def differences(f: FloatArray, walls: bool = False) -> FloatArray:
    """Return Delta f, shape (N,); with `walls`, f is a flux that is zero at the ends."""
    if walls:
        return _inside(f, -f[_MOST - 1 :: -1], -f[: -_MOST - 1 : -1])
    return _inside(f, f[0], f[-1])


def transported(u: FloatArray, a: FloatArray) -> FloatArray:
    """Return V d(a u)/dx for a u that vanishes at the ends; u and a have the shape (N,)."""
    out = _inside(a * u) + a * _inside(u) + differences(a) * u
    out *= 0.5
    out[:_MOST] += max(-a[0], 0.0) * (_OUTFLOW @ u[:_MOST])
    out[: -_MOST - 1 : -1] += max(a[-1], 0.0) * (_OUTFLOW @ u[: -_MOST - 1 : -1])
    return out


def _inside(
    f: FloatArray, left: FloatArray | float = 0.0, right: FloatArray | float = 0.0
) -> FloatArray:
    """Return Delta f of an f that is continued by `left` and `right`: four values, or one value four times."""
    wide = np.empty(f.size + 2 * _MOST)
    wide[:_MOST], wide[_MOST:-_MOST], wide[-_MOST:] = left, f, right
    return np.correlate(wide, _STENCIL)


def _outflow() -> FloatArray:
    """Return G."""
    q = np.cumsum(_WEIGHTS[::-1])[::-1].copy()
    q[0] -= 0.5
    out = (q[:, None] - q) / _MOST
    out[0, 0] += 0.5
    return out


_OUTFLOW = _outflow()
