"""One Green step of the field between graded particles, which need not resolve the Green's function.

The particles x_j = L sinh(s_j) of `graded` carry the field that is band-limited in s,

    u(y) = sum_j u_j S_j(y),   S_j(y) = sinc(s(y) / ds - j),   s(y) = arcsinh(y / L),

nil beyond the outermost ones. GPSE over the whole time, epsilon^alpha = D T, is then exact for that field:

    u_i(T) = sum_j u_j int E_epsilon(x_i - y) S_j(y) dy.                         (interpolated)

The error is that of the interpolation: exponentially small in 1 / ds where u is smooth in s, as a solution is whose
tails fall like a power of |y|, and that of what lies beyond the outermost particles. Volumes far larger than epsilon do
no harm, which `graded.green_step` cannot say: alpha near 1, with its heavy tails, is where this pays most.

The integrals are done by Gauss's rule on panels that double in length away from y = x_i, the first one epsilon, and
from y = 0, the first one L: within each both factors are smooth, but for the waves of S_j, for which the rule has
enough nodes.
"""

from __future__ import annotations

import numpy as np

from fracparticles.graded import graded_particles
from fracparticles.special import green
from fracparticles.special.arguments import fractional_order, positive_real

__all__ = ["green_step_of_field"]

# The worst panel, of length d, has singularities over one of its ends, d away from it: the error of Gauss's rule is
# about 4.6^(-2 n), 1e-16 for 12 nodes.
_NODES = 12


def green_step_of_field(
    count: int, reach: float, scale: float, alpha: float, time: float
) -> np.ndarray:
    """Return the matrix M of one step, u(T) = M u(0), shape (N, N), for `graded_particles(count, reach, scale)`.

    Parameters
    ----------
    count, reach, scale : int, float, float
        N, the position of the outermost particle, and L.
    alpha : float
        Fractional order, 1 < alpha < 2.
    time : float
        D T.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """
    x, volumes = graded_particles(count, reach, scale)
    alpha, time = fractional_order(alpha), positive_real("time", time)
    half = x.size // 2
    step = volumes[half] / scale
    # A panel spans at most arcsinh(1) in s; waves of pi / ds take a node for each radian of half the panel's phase.
    nodes, weights = np.polynomial.legendre.leggauss(
        _NODES + int(np.ceil(0.5 * np.pi * np.arcsinh(1.0) / step))
    )
    matrix = np.empty((x.size, x.size))
    for i in range(half + 1):
        ends = _panels(x[i], time ** (1.0 / alpha), scale, x[-1])
        middles, halves = 0.5 * (ends[1:] + ends[:-1]), 0.5 * np.diff(ends)
        y = (middles[:, None] + halves[:, None] * nodes).ravel()
        kernel = green(x[i] - y, time, alpha) * (halves[:, None] * weights).ravel()
        matrix[i] = _against_sincs(kernel, np.arcsinh(y / scale) / step, half)
    matrix[half + 1 :] = matrix[:half][::-1, ::-1]
    return matrix


def _panels(x: float, epsilon: float, scale: float, reach: float) -> np.ndarray:
    """The ends of the panels between -reach and reach, in ascending order."""
    doublings = 2.0 ** np.arange(np.ceil(np.log2(2.0 * reach / min(epsilon, scale))) + 1.0)
    around_x, around_0 = epsilon * doublings, scale * doublings
    ends = np.concatenate([[0.0, x], x - around_x, x + around_x, -around_0, around_0])
    return np.unique(np.concatenate([[-reach], ends[np.abs(ends) < reach], [reach]]))


def _against_sincs(values: np.ndarray, t: np.ndarray, half: int) -> np.ndarray:
    """Return sum_q values_q sinc(t_q - j), j = -half .. half: sin(pi (t - j)) / pi is (-1)^j sin(pi t) / pi."""
    j = np.arange(-half, half + 1)
    nearest = np.rint(t)
    # The distance to the nearest j is exact; where it is nil, anything small has the right quotient, one.
    distance = np.where(t == nearest, np.finfo(float).tiny, t - nearest)
    waves = values * np.sin(np.pi * distance) / np.pi * (1.0 - 2.0 * (nearest % 2.0))
    apart = t[:, None] - j
    apart[apart == 0.0] = np.finfo(float).tiny
    return (1.0 - 2.0 * (j % 2)) * (waves @ np.divide(1.0, apart, out=apart))
