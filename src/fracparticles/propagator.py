"""exp(A t) as one lattice sum, where the Fourier symbol of A is known.

On the infinite lattice an operator with the symbol A(theta) is a Toeplitz matrix, and so is its exponential: with
tau = D t / h^alpha and the symbol in units of D / h^alpha,

    u_i(t) = sum_j e_{i-j} u_j(0),    e_m = (1 / 2 pi) int_{-pi}^{pi} exp(tau A(theta)) e^(i m theta) dtheta.

One sum takes u from 0 to t, whatever t is. On a bounded lattice the initial data beyond its ends are the far field
(`exterior`), or nil; either is used once, not at every operator application, so that the result differs from the
exponential of the bounded operator by what leaves the lattice and comes back.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.fft import irfft
from scipy.special import gamma, zeta

from fracparticles.exterior import tabulated_far_field, tail_constant
from fracparticles.operators import ConvolutionOperator
from fracparticles.sums import FourierConvolution

__all__ = ["exponential_weights", "propagator", "tabulated_operator"]

Symbol = Callable[[np.ndarray], np.ndarray]  # theta in [0, pi] -> A(theta) h^alpha / D

# e_m comes from a circle of this many times its length; of its images these many terms are taken off.
_CIRCLE = 8
_IMAGE_TERMS = 3
# The table of e_m goes on to this many n: there the first term of its expansion is all that the far field needs.
_REACH = 4


def propagator(
    symbol: Symbol, alpha: float, scaled_time: float, n: int, exterior: str
) -> ConvolutionOperator:
    """Return u(0) -> u(t) on the lattice -n .. n.

    Parameters
    ----------
    symbol : callable
        A(theta) h^alpha / D for theta in [0, pi]; even, and -|theta|^alpha near nil.
    alpha : float
        Fractional order.
    scaled_time : float
        tau = D t / h^alpha.
    n : int
        Half the number of lattice intervals.
    exterior : {"truncated", "open"}
        What is beyond the lattice at time 0.
    """
    e = exponential_weights(symbol, alpha, scaled_time, _REACH * n + 2)
    return tabulated_operator(e, n, alpha, scaled_time, exterior)


def tabulated_operator(
    w: np.ndarray, n: int, alpha: float, scale: float, exterior: str
) -> ConvolutionOperator:
    """Return u -> sum_j w_{i-j} u_j from a table of w_m, where w_m -> scale C m^(-1-alpha) for large m."""
    size = 2 * n + 1
    far = None
    if exterior == "open":
        far = tabulated_far_field(w, n, alpha, scale * tail_constant(alpha))
    return ConvolutionOperator(FourierConvolution(w[:size], size), np.zeros(size), far)


def exponential_weights(symbol: Symbol, alpha: float, scaled_time: float, count: int) -> np.ndarray:
    """Return e_m, m = 0 .. count - 1.

    The sum over P points of the circle gives sum_l e_{m + l P}. Far away, by the expansion of the exponential at
    theta = 0,

        e_m ~ sum_{j >= 1} (-1)^(j+1) tau^j / j! Gamma(1 + j alpha) sin(pi j alpha / 2) / pi m^(-1-j alpha),

    as (A.2) of Lucchesi et al. (2020), and the images l = +-1, +-2, .. of a power are Hurwitz zeta functions.
    """
    circle = 1 << (_CIRCLE * count - 1).bit_length()
    theta = np.arange(circle // 2 + 1) * (2.0 * np.pi / circle)
    e = np.asarray(irfft(np.exp(scaled_time * symbol(theta)), circle)[:count])
    m = np.arange(count) / circle
    for j in range(1, _IMAGE_TERMS + 1):
        power = 1.0 + j * alpha
        amplitude = -((-scaled_time) ** j) / gamma(1.0 + j) * tail_constant(j * alpha)
        images = zeta(power, 1.0 + m) + zeta(power, 1.0 - m)
        e -= amplitude * float(circle) ** -power * images
    return e
