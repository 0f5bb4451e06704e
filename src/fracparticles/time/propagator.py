"""The propagator: a whole run as one lattice sum, where the Fourier symbol of the operator is known.

On the infinite lattice an operator with the symbol A(theta) is a Toeplitz matrix, and so is any function of it. With
tau = D t / h^alpha, the symbol in units of D / h^alpha and f = exp(tau A), or what n time steps make of it,

    u_i(t) = sum_j e_{i-j} u_j(0),    e_m = (1 / 2 pi) int_{-pi}^{pi} f(theta) e^(i m theta) dtheta.

The propagator takes u from 0 to t, whatever t is. On a bounded lattice the initial data beyond its ends are the far
field (`exterior`), or zero; either is used once, not at every operator application, so that the result differs from the
function of the bounded operator by what leaves the lattice and comes back.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from scipy.fft import irfft
from scipy.special import gamma, zeta

from fracparticles.errors import InvalidInput
from fracparticles.lattice.exterior import tabulated_far_field
from fracparticles.lattice.operators import ConvolutionOperator
from fracparticles.lattice.sums import fast_convolution
from fracparticles.special.tails import tail_constant

__all__ = ["propagator", "propagator_weights", "tabulated_operator", "tail_amplitude"]

Amplification = Callable[[np.ndarray], np.ndarray]  # theta in [0, pi] -> f(theta)

# e_m comes from a circle of this many times its length, and of its width tau^(1/alpha); of its images these many terms
# are taken off.
_CIRCLE = 8
_WIDTHS = 128
_LONGEST = 2**26
_IMAGE_TERMS = 3
# The table of e_m goes on to this many n; beyond, its expansion takes over.
_REACH = 4


def propagator(
    amplification: Amplification,
    alpha: float,
    scaled_time: float,
    n: int,
    exterior: str,
    terms: int = 1,
) -> ConvolutionOperator:
    """Return the propagator u(0) -> u(t) on the lattice -n .. n.

    Parameters
    ----------
    amplification : callable
        f(theta) for theta in [0, pi]; even, and exp(-tau |theta|^alpha) near zero.
    alpha : float
        Fractional order.
    scaled_time : float
        tau = D t / h^alpha.
    n : int
        Half the number of lattice intervals.
    exterior : {"truncated", "open"}
        What is beyond the lattice at time 0.
    terms : {1, 2, 3}
        Of the expansion that continues the initial data in an open exterior.
    """
    e = propagator_weights(amplification, alpha, scaled_time, _REACH * n + 2)
    amplitudes = [tail_amplitude(j, alpha, scaled_time) for j in range(1, terms + 1)]
    return tabulated_operator(e, n, alpha, amplitudes, exterior, terms)


def tabulated_operator(
    w: np.ndarray,
    n: int,
    alpha: float,
    amplitudes: Sequence[float],
    exterior: str,
    terms: int = 1,
) -> ConvolutionOperator:
    """Return u -> sum_j w_{i-j} u_j from a table of w_m; see `exterior.tabulated_far_field`."""
    size = 2 * n + 1
    far = None
    if exterior == "open":
        far = tabulated_far_field(w, n, alpha, amplitudes, terms)
    return ConvolutionOperator(fast_convolution(w[:size], size), np.zeros(size), far)


def tail_amplitude(j: int, alpha: float, scaled_time: float) -> float:
    """Return the factor of m^(-1-j alpha) in the expansion of e_m for large m.

    It is that of exp(-tau |theta|^alpha) at theta = 0, as (A.2) of Lucchesi et al. (2020):

        e_m ~ sum_{j >= 1} (-1)^(j+1) tau^j / j! Gamma(1 + j alpha) sin(pi j alpha / 2) / pi m^(-1-j alpha).
    """
    return float(-((-scaled_time) ** j) / gamma(1.0 + j) * tail_constant(j * alpha))


def propagator_weights(
    amplification: Amplification, alpha: float, scaled_time: float, count: int
) -> np.ndarray:
    """Return e_m, m = 0 .. count - 1, the weights of the propagator.

    The sum over P points of the circle gives sum_l e_{m + l P}; the images l = +-1, +-2, .. of a power of m are Hurwitz
    zeta functions, and those of the first terms of the expansion are taken off. P is much larger than the width of e_m.

    Raises
    ------
    InvalidInput
        If it takes a circle of more than 2^26 points.
    """
    wide = _WIDTHS * scaled_time ** (1.0 / alpha)
    if not wide <= _LONGEST:
        raise InvalidInput(
            "scaled_time",
            scaled_time,
            f"at most {(_LONGEST / _WIDTHS) ** alpha:.3g}: the run spreads a particle over {wide / _WIDTHS:.3g} others",
            "Take a larger spacing or a shorter time.",
        )
    circle = 1 << (max(_CIRCLE * count, int(wide)) - 1).bit_length()
    theta = np.arange(circle // 2 + 1) * (2.0 * np.pi / circle)
    e = np.asarray(irfft(amplification(theta), circle)[:count])
    m = np.arange(count) / circle
    for j in range(1, _IMAGE_TERMS + 1):
        power = 1.0 + j * alpha
        images = zeta(power, 1.0 + m) + zeta(power, 1.0 - m)
        e -= tail_amplitude(j, alpha, scaled_time) * float(circle) ** -power * images
    return e
