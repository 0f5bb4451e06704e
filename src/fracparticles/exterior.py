"""The far-field closure: the particles that a truncated lattice leaves out.

Beyond the half-width D the solution falls like the fundamental solution, whose leading term (A.2) is
proportional to |x|^(-1-alpha). Continue the lattice to infinity with the strengths

    u_j = u_n (n / |j|)^(1+alpha),   |j| > n,      (u_{-n} on the left)

and a sum over particles gains the exterior sum u_n right_i + u_{-n} left_i with

    right_i = sum_{j > n} (n / j)^(1+alpha) w_{i-j},   left_i = parity * right_{-i},

a rank-two update of the operator, computed once. Not in the papers, which truncate the lattice.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.special import roots_jacobi

from fracparticles.operators import FarField
from fracparticles.sums import valid_convolution

__all__ = ["far_field"]

# Lattice points beyond 4 n are summed by the Euler-Maclaurin formula: there j - i >= 3 n, so the summand
# varies on the scale n and two terms leave a relative error of order n^-4.
_NEAR = 4
# Sums over j > 4 n are analytic in i / n in |i| <= 4 n and in n / j: these many nodes give round-off.
_NODES = 24


def far_field(
    weight: Callable[[np.ndarray], np.ndarray],
    decay: float,
    alpha: float,
    n: int,
    parity: int = 1,
    pad: int = 0,
) -> FarField:
    """Return the exterior sums for the lattice -n .. n, at i = -n-pad .. n+pad.

    Parameters
    ----------
    weight : callable
        w_m as a function of any real offset m, even or odd.
    decay : float
        w_m ~ |m|^(-decay) far away.
    alpha : float
        Fractional order; the solution is continued like |x|^(-1-alpha).
    n : int
        Half the number of lattice intervals.
    parity : {1, -1}
        Whether w is even or odd.
    pad : int
        How many points beyond each end are wanted.
    """
    i = np.arange(-n - pad, n + pad + 1)
    tail_power = 1.0 + alpha

    j = np.arange(n + 1, _NEAR * n + 1)
    offsets = np.arange(i[0] - j[-1], i[-1] - j[0] + 1)
    near = valid_convolution((n / j) ** tail_power, weight(offsets.astype(float)))

    # The tail at Chebyshev points of i, and from there to every i by barycentric interpolation.
    angle = (np.arange(_NODES) + 0.5) * (np.pi / _NODES)
    nodes = (n + pad) * np.cos(angle)
    tail = _tails(weight, decay, tail_power, n, nodes)
    right = near + np.polynomial.chebyshev.Chebyshev.fit(
        nodes, tail, _NODES - 1, domain=[-(n + pad), n + pad]
    )(i)
    return FarField(right=right, left=parity * right[::-1])


def _tails(
    weight: Callable[[np.ndarray], np.ndarray],
    decay: float,
    tail_power: float,
    n: int,
    i: np.ndarray,
) -> np.ndarray:
    """Return sum_{j > 4 n} (n / j)^(1+alpha) w_{i-j} for each i.

    Euler-Maclaurin from the midpoint X = 4 n + 1/2: sum f(j) = int_X^inf f + f'(X) / 24 - ...; the integral
    by Gauss-Jacobi quadrature in v = X / j, where f(j) dj is v^(1+alpha+decay-2) times a smooth function.
    """
    start = _NEAR * n + 0.5
    exponent = tail_power + decay - 2.0
    nodes, quadrature = roots_jacobi(_NODES, 0.0, exponent)
    v = 0.5 * (1.0 + nodes)
    ends = np.array([start - 0.5, start + 0.5])
    w = weight(i[:, None] - np.concatenate([start / v, ends]))
    smooth = w[:, :-2] * v**-decay
    integral = start * (n / start) ** tail_power * (smooth @ quadrature) / 2.0 ** (exponent + 1.0)
    f = (n / ends) ** tail_power * w[:, -2:]
    return np.asarray(integral + (f[:, 1] - f[:, 0]) / 24.0)
