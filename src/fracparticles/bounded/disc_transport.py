r"""Transport between rings of particles in the unit disc. Only waves grow that the velocity presses together.

The mean of (b u)' and b u' is skew. With b = r a_r and c = a_theta, r div(a u) is this mean and half of div a:

    2 r div(a u) = M(b u) + b P u + d_theta(c u) + c d_theta u + r (div a) u.

P are differences of order 6 in the variable of the map, over its slope r'. M = -r'^-1 P^T r' is their adjoint: the
same differences, except at the ends. Along the rings Fourier transforms are differentiated. With the volumes V = r r',

    sum V w div(a u) + sum V u div(a w) = sum V (div a) u w

to round-off, as for the equation if nothing is carried through the edge. So sum V u^2 grows at most at the rate
max(-div a), less twice the lowest rate of the diffusion. (Differences that are one-sided at the edge, in the form of a
flux, make waves that grow: at rates of 1e2 to 1e4 for |a| = 10, alpha = 1.05 and 8 to 32 rings.)

Centre
    P continues u by the opposite ring, as a smooth u goes on. M then continues by its negative. This suits b u, since
    r a_r is even along a diameter. But r ~ xi^2, so that M r differs from 1 by about h = 1 / N, and a constant velocity
    would make u at the rate a h / r. To have M r = 1, a little is added to P, on the diagonal and for the odd waves
    along the rings, which are r or less. The error left is a share of grad(a u) on the three innermost rings, an area
    of h^4.
Edge, absorbing or given
    u = 0 beyond, and u ~ (1 - r)^(alpha/2) ~ (1 - xi)^(3 alpha/2) before. On the three outermost rings, of the volume
    h^3, P u has an error of its own size, h^(3 alpha/2 - 3). The exterior leaves a share h^(3 alpha/2) of it. So the
    error inside is h^(3 alpha), less than the error h^(4 - alpha) of the diffusion. The velocity is smooth up to the
    edge. So are the differences for div a; they are exact for a velocity that is linear in x and y.
Edge, reflecting
    b = 0, and u is not zero: P is one-sided. Since P 1 = 0, the total is kept if r div a = M b + d_theta c. This is off
    by a share of a_r' on the three outermost rings.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fracparticles.arguments import FloatArray
from fracparticles.bounded.disc_rings import Rings
from fracparticles.bounded.plane_differences import (
    REACH,
    differences_through_centre,
    differences_with_beyond,
    one_sided_differences,
)

__all__ = ["DiscTransport"]

_AT_EDGE = 5  # points of one-sided differences: the adjoint of seven is worse by a factor of two on few rings


class DiscTransport:
    """-div(a u) on rings of the unit disc. All fields have the shape (rings, angles).

    Parameters
    ----------
    rings : Rings
    reflecting : bool
        Whether nothing leaves, and u is not zero at the edge; else u is zero there and beyond.
    """

    def __init__(self, rings: Rings, reflecting: bool) -> None:
        self._r, self._slope = rings.r[:, None], rings.slope[:, None]
        self._reflecting = reflecting
        self._skew = _skew(rings, reflecting)
        self._smooth = _smooth(rings)

    def carried(self, u: FloatArray, outwards: FloatArray, around: FloatArray) -> FloatArray:
        """Return -div(a u) for a_r and a_theta, if u is zero beyond the edge, or nothing leaves."""
        b = self._r * outwards
        parts = self._adjoint(b * u) + b * self._skew.of(u)
        moved, plain = np.split(_around(np.concatenate([around * u, u])), 2)
        parts += moved + around * plain
        return np.asarray(-0.5 * (parts / self._r + self.divergence(outwards, around) * u))

    def of_smooth(self, u: FloatArray, outwards: FloatArray, around: FloatArray) -> FloatArray:
        """Return -div(a u) for a u that is known and smooth up to the edge, and not zero there."""
        return -self.divergence(outwards * u, around * u)

    def divergence(self, outwards: FloatArray, around: FloatArray) -> FloatArray:
        """Return div a of a velocity that is smooth up to the edge; where nothing leaves, it keeps the total."""
        if self._reflecting:
            return np.asarray((self._adjoint(self._r * outwards) + _around(around)) / self._r)
        return np.asarray(self._smooth.of(outwards) + (outwards + _around(around)) / self._r)

    def _adjoint(self, f: FloatArray) -> FloatArray:
        """Return M f."""
        return np.asarray(-self._skew.transposed(self._slope * f) / self._slope)


class _Across(NamedTuple):
    """d/dr between the rings, shape (N, N), and from the innermost ones to those opposite, shape (3, 3)."""

    near: FloatArray
    opposite: FloatArray

    def of(self, f: FloatArray) -> FloatArray:
        out = self.near @ f
        out[:REACH] += self.opposite @ _half_a_turn(f[:REACH])
        return np.asarray(out)

    def transposed(self, f: FloatArray) -> FloatArray:
        return _Across(self.near.T, self.opposite.T).of(f)


def _skew(rings: Rings, reflecting: bool) -> _Across:
    """Return P."""
    count, r, slope = rings.r.size, rings.r[:REACH], rings.slope[:REACH]
    whole = differences_with_beyond(count)
    near = whole[:, REACH:-REACH]
    opposite = whole[:REACH, REACH - 1 :: -1]
    if reflecting:
        near[-REACH:] = one_sided_differences(count, _AT_EDGE)[-REACH:]
    # For odd waves M r = -(near - opposite)^T r / r' has to be 1.
    missing = slope + (near.T @ rings.r)[:REACH] - opposite.T @ r
    more = np.diag(-0.5 * missing / r)
    near[:REACH, :REACH] += more
    return _Across(near / rings.slope[:, None], (opposite - more) / slope[:, None])


def _smooth(rings: Rings) -> _Across:
    """Return d/dr of an outward part, smooth up to the edge and through the centre, where outwards turns round."""
    near = one_sided_differences(rings.r.size) / rings.slope[:, None]
    near[:REACH], opposite = differences_through_centre(rings.r)
    return _Across(near, -opposite)


def _around(f: FloatArray) -> FloatArray:
    """Return df/dtheta along the rings; `irfft` takes no sine of the shortest wave of an even number of angles."""
    count = f.shape[1]
    waves = 1j * np.arange(count // 2 + 1)
    return np.asarray(np.fft.irfft(waves * np.fft.rfft(f, axis=1), count, axis=1))


def _half_a_turn(f: FloatArray) -> FloatArray:
    """Return the field on the other side of the centre, between the angles if their number is odd."""
    waves = np.fft.rfft(f, axis=1)
    waves[:, 1::2] *= -1.0
    return np.asarray(np.fft.irfft(waves, f.shape[1], axis=1))
