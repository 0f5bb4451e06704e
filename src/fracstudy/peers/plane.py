"""What the peers on a square lattice share: a run in the plane as one lattice sum.

They live on the square lattice x_ij = (i h, j h), i, j = -n .. n, and take u for zero beyond it. Their symbol is
a(theta) = -s^(alpha/2) h^(-alpha), where s stands for |theta|^2. On the infinite lattice its exponential is Toeplitz,
and with tau = t / h^alpha one sum takes u from 0 to t, whatever t is:

    u_i(t) = sum_j e_{i-j} u_j(0),    e_m = (2 pi)^-2 int_{[-pi, pi]^2} exp(-tau s^(alpha/2)) e^(i m.theta) dtheta.

    sinc-lattice         s = theta_1^2 + theta_2^2: exact for what the lattice resolves.
    fractional-centred   s = 4 sin^2(theta_1/2) + 4 sin^2(theta_2/2), the five-point Laplacian to the power alpha/2:
                         O(h^2), Hao, Zhang & Du, J. Comput. Phys. 424 (2021) 109851.

The data beyond the square, missing once, leave an error of the order D^(-2-2 alpha) near its centre.
"""

from __future__ import annotations

from collections.abc import Callable
from math import ceil

import numpy as np
from scipy.fft import dct
from scipy.special import factorial, gamma, rgamma, zeta

from fracparticles.lattice.fourier import transform_length
from fracparticles.lattice.sums import BOX_SUMMATIONS
from fracstudy.peers.base import PlaneSolver, Task, half_intervals

__all__ = ["Squares", "plane_weights", "truncated_plane"]

Squares = Callable[[np.ndarray], np.ndarray]  # theta_1 in [0, pi] -> its part of s

# As on the line, e_m comes from a circle of this many times its length, and of its images these many terms are taken
# off. It has at least this many spreads tau^(1/alpha) of the exponential too: closer the terms are no expansion.
_CIRCLE = 8
_IMAGE_TERMS = 3
_SPREADS = 40


def truncated_plane(squares: Squares, task: Task) -> PlaneSolver:
    """Return the solver on the square lattice, u zero beyond it; `squares` as of `plane_weights`."""
    n = half_intervals(task)
    size, h = 2 * n + 1, task.half_width / n
    e = plane_weights(squares, task.alpha, task.time * h**-task.alpha, size)
    convolve = BOX_SUMMATIONS["fft"]([e], [None], size, size)
    return PlaneSolver(np.arange(-n, n + 1) * h, h * h, lambda u0: convolve(u0)[0].copy())


def plane_weights(squares: Squares, alpha: float, scaled_time: float, count: int) -> np.ndarray:
    """Return e_m, m in {0, .., count - 1}^2.

    The symbol is even in both coordinates, so that its inverse transform on a circle of P x P points is a pair of
    cosine transforms. It gives sum_l e_{m + l P}. Far away, by the expansion of the exponential at theta = 0,

        e_m ~ sum_{j >= 1} (-tau)^j / j! 2^(j alpha) Gamma(1 + j alpha/2) / (pi Gamma(-j alpha/2)) |m|^(-2 - j alpha).

    The images of a power |m|^-p are, with mu = m / P, Z(p) = sum_{l != 0} |l|^-p and by the symmetry of the square,

        P^-p sum_{l != 0} |l + mu|^-p = P^-p (Z(p) + (p/2)^2 |mu|^2 Z(p + 2) + O(|mu|^4)).

    They are taken off, because with P in proportion to N the first term changes u by the order D^(-2-alpha), and the
    truncation by D^(-2-2 alpha) only: on a wide lattice the images would win. What is left near the centre is of the
    order D^(-2-4 alpha). The centred differences have one more, of the order tau |m|^(-4-alpha), not taken off: it is
    h^2 D^(-4-alpha), small beside their own error, of the order h^2.

    Parameters
    ----------
    squares : callable
        The part of s that one component of theta in [0, pi] contributes; theta^2 near zero.
    alpha : float
        Fractional order.
    scaled_time : float
        tau = t / h^alpha.
    count : int
        N.
    """
    spread = scaled_time ** (1.0 / alpha)
    circle = transform_length(max(_CIRCLE * count, ceil(_SPREADS * spread)))
    part = squares(np.arange(circle // 2 + 1) * (2.0 * np.pi / circle))
    values = np.exp(-scaled_time * (part[:, None] + part) ** (0.5 * alpha))
    values = dct(values, type=1, axis=1, overwrite_x=True)[:, :count]
    e = dct(values, type=1, axis=0)[:count] / float(circle) ** 2
    mu = np.arange(count) / circle
    mu_squared = mu[:, None] ** 2 + mu**2
    for j in range(1, _IMAGE_TERMS + 1):
        order = j * alpha
        amplitude = (-scaled_time) ** j / factorial(j) * 2.0**order / np.pi
        amplitude *= gamma(1.0 + 0.5 * order) * rgamma(-0.5 * order)
        p = 2.0 + order
        images = _lattice_zeta(p) + (0.5 * p) ** 2 * mu_squared * _lattice_zeta(p + 2.0)
        e -= amplitude * float(circle) ** -p * images
    return e


def _lattice_zeta(p: float) -> float:
    """Return Z(p) = sum_{l != 0} |l|^-p over the square lattice: 4 zeta(p/2) beta(p/2), with Dirichlet's beta."""
    s = 0.5 * p
    return float(4.0 * zeta(s) * (zeta(s, 0.25) - zeta(s, 0.75)) / 4.0**s)
