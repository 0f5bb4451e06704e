"""The stable density in n = 1, 3, 5 dimensions by quadrature along a contour where nothing oscillates.

    Phi_n(x) = (1/pi) (2 pi x^2)^(-(n-1)/2) Re int_Gamma p_n(-i k x) exp(i k x - k^alpha) dk,

with Gamma from 0 to infinity, p_1 = 1, p_3(z) = z, p_5(z) = z + z^2 (from Phi_(n+2) = -Phi_n'/(2 pi x)).

On the real axis the integrand oscillates, and in the tail its parts cancel to all digits. Close to
the path of steepest descent its parts do not cancel. This path leaves 0 along the imaginary axis and
turns towards the right at a saddle point; two straight pieces follow it closely enough:

1. k = i s, 0 < s < s0. There the real part of the integrand is
   exp(-s x - s^alpha cos(pi alpha/2)) sin(s^alpha sin(pi alpha/2)), positive up to a phase of pi:
   this is the power-law tail.
2. k = i s0 + e^(i phi) t, 0 < t < infinity, in the direction of steepest descent at the corner, but
   with phi <= pi / (4 alpha), so that the real part of k^alpha grows along the whole piece: as alpha tends to 2 this
   is the Gaussian core.

The corner s0 is the saddle point of the modulus on the imaginary axis,
x = alpha s^(alpha-1) sin(pi (alpha-1)/2), unless the phase of piece 1 reaches 3/2 before. Nearly all parts of the sum
on each piece are positive, so the result is accurate for every alpha in (1, 2), in the core, in the tail and in the
sharp transition between them near alpha = 2. For n = 1 the sum of the moduli exceeds the result by at most 5 %. On
piece 1, z = -i k x = s x is positive and so is p_n. On piece 2, p_5 makes parts cancel near x = 1/2 and alpha = 2, to
1/20 of their size.

The mass beyond x follows from the same nodes, as the integral of exp(i k y) over y > x is
i exp(i k x) / k:

    T_n(x) = (2/pi) Re int_Gamma (i/k) q_n(-i k x) exp(i k x - k^alpha) dk,

q_1 = 1, q_3 = 1 + z, q_5 = 1 + z + z^2/3 (from T_(n+2) = T_n + x S_n Phi_n / n, where S_n is
the surface of the sphere of radius x).

Piece 1 uses the tanh-sinh rule, piece 2 the double exponential rule t = exp(y - exp(-y)).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fracparticles.arguments import FloatArray

__all__ = ["density_and_tail"]

_PHASE = 1.5  # rad: the largest phase of piece 1 at its end
_LARGEST_TURN = 0.25 * math.pi  # rad: the largest phi alpha
_SMALLEST_FALL = 1e-8  # of `fall` over x: far above rounding errors, met for alpha -> 2 only


def _finite_rule(step: float, reach: float) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights of the tanh-sinh rule on (0, 1)."""
    y = np.arange(-reach, reach + 0.5 * step, step)
    node = 1.0 / (1.0 + np.exp(-math.pi * np.sinh(y)))
    other = 1.0 / (1.0 + np.exp(math.pi * np.sinh(y)))
    return node, step * math.pi * np.cosh(y) * node * other


def _infinite_rule(step: float, lowest: float, highest: float) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights of the double exponential rule on (0, infinity) for integrands that decay like exp(-t)."""
    y = np.arange(lowest, highest + 0.5 * step, step)
    node = np.exp(y - np.exp(-y))
    return node, step * (1.0 + np.exp(-y)) * node


_UNIT_RULE = _finite_rule(0.07, 3.2)
_HALF_RULE = _infinite_rule(0.08, -3.6, 3.8)


# p_n and q_n by their coefficients, lowest power first.
_POLYNOMIALS = {
    1: ((1.0,), (1.0,)),
    3: ((0.0, 1.0), (1.0, 1.0)),
    5: ((0.0, 1.0, 1.0), (1.0, 1.0, 1.0 / 3.0)),
}


def _contour(middle: FloatArray, alpha: float) -> tuple[NDArray[Any], ...]:
    """The nodes -i k of both pieces, one contour a row, with the weights exp(-k^alpha) dk of the sums."""
    delta = 2.0 - alpha
    sine = math.sin(0.5 * math.pi * delta)  # sin(pi alpha/2), all digits kept as alpha -> 2
    rise = math.cos(0.5 * math.pi * delta)  # -cos(pi alpha/2)
    log_saddle = np.log(middle / (alpha * rise)) / (alpha - 1.0)
    log_phase = math.log(_PHASE / sine) / alpha
    corner = np.exp(np.minimum(log_saddle, log_phase))
    slope = alpha * corner ** (alpha - 1.0)
    fall = slope * sine  # -Re of the derivative of the exponent at the corner
    turn = np.maximum(middle - slope * rise, 0.0)  # its imaginary part, 0 at the saddle point
    # At the saddle both parts are nearly zero: rounding errors must not turn the path.
    turn[fall < _SMALLEST_FALL * middle] = 0.0
    angle = np.minimum(np.arctan2(turn, fall), _LARGEST_TURN / alpha)
    direction = np.exp(1j * angle) / np.maximum(np.hypot(fall, turn), 1.0)

    nodes, weights = _UNIT_RULE
    s, power = corner * nodes, (corner * nodes) ** alpha
    positive = corner * weights * np.exp(power * rise) * np.sin(power * sine)
    nodes, weights = _HALF_RULE
    k = 1j * corner + direction * nodes
    return s, positive, -1j * k, direction * weights * np.exp(-(k**alpha))


def _powers(sigma: NDArray[Any], weights: NDArray[Any], count: int) -> NDArray[Any]:
    """weights sigma^m for m = -1 .. count - 1 along a last axis."""
    powers = [weights / sigma, weights]
    while len(powers) <= count:
        powers.append(powers[-1] * sigma)
    return np.stack(powers, axis=-1)


def density_and_tail(x: FloatArray, alpha: float, n: int) -> tuple[FloatArray, FloatArray]:
    """Return Phi_n(x) and the mass outside the ball of radius x.

    Parameters
    ----------
    x : ndarray, shape (rows, points)
        Positive; points of a row lie within half a unit of one another, from 0.4 up to about 25.
    alpha : float
        1 < alpha < 2.
    n : int
        Number of dimensions: 1, 3 or 5.

    Returns
    -------
    density, tail : ndarray
        Shape of x; relative accuracy about 1e-14 (n = 5 at x = 1/2: 1e-13).
    """
    p, q = _POLYNOMIALS[n]
    middle = 0.5 * (x.min(axis=-1, keepdims=True) + x.max(axis=-1, keepdims=True))
    s, positive, sigma, factor = _contour(middle, alpha)
    # sum_j w_j sigma_j^m exp(-sigma_j x) for m = -1, 0, ..: real exponentials and waves are faster than complex ones.
    r = x[..., None]
    factors = _powers(sigma, factor, len(p))
    decay, phase = np.exp(-r * sigma.real[:, None]), r * sigma.imag[:, None]
    sums = np.exp(-r * s[:, None]) @ _powers(s, positive, len(p))
    sums += (decay * np.cos(phase)) @ factors.real + (decay * np.sin(phase)) @ factors.imag
    powers = r ** np.arange(len(p))
    density = (sums[..., 1:] * powers) @ p / math.pi
    tail = (sums[..., :-1] * powers) @ q * (2.0 / math.pi)
    return density / (2.0 * math.pi * x**2) ** ((n - 1) // 2), tail
