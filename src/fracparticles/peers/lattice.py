"""What the peers on a lattice x_i = i h, i = -n .. n, share.

All are Toeplitz, (A u)_i = h^(-alpha) sum_j a_{i-j} u_j, with a_m -> C |m|^(-1-alpha) for large m (`tail_constant`).
Outside the lattice u is nil (`truncated`), or it falls like |x|^(-1-alpha) (`open`): Huang & Oberman's
far-field condition, here for all of them. Then, as they do, the lattice sum goes on to the offset M and what is beyond
is an integral: with u_k = u_n (n / k)^(1+alpha) for k > n,

    right_i = sum''_{m <= M, i + m > n} a_m (n / (i + m))^(1+alpha)
              + C int_M^inf (n / (i + y))^(1+alpha) y^(-1-alpha) dy,

where '' halves the term m = M; the integral is C n^(1+alpha) M^(-1-2 alpha) / (1 + 2 alpha) times
2F1(1+alpha, 1+2 alpha; 2+2 alpha; -i/M).

In time, exp(A t) is one Chebyshev series (`series`). Where the symbol a(theta) of A is known, exp(A t) on the infinite
lattice is Toeplitz too (`convolution`), with the coefficients e_m of exp(t h^(-alpha) a(theta)): one lattice sum takes
u from 0 to t. It differs from the exponential of the finite matrix by what leaves the lattice and comes back.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft
from scipy.special import gamma, hyp2f1, zeta

from fracparticles.integrators import ChebyshevSeries, exponential
from fracparticles.operators import ConvolutionOperator, FarField
from fracparticles.peers.base import check_choice, half_intervals, tail_constant
from fracparticles.special.arguments import fractional_order, positive_real
from fracparticles.sums import FourierConvolution, valid_convolution

__all__ = ["EXTERIORS", "SERIES", "SERIES_OR_CONVOLUTION", "LatticeSolver", "prepare_lattice"]

EXTERIORS = ("truncated", "open")
SERIES = ("series",)
SERIES_OR_CONVOLUTION = ("series", "convolution")

Weights = Callable[[float, int], np.ndarray]  # (alpha, count) -> a_m, m = 0 .. count - 1
Symbol = Callable[[np.ndarray, float], np.ndarray]  # (theta, alpha) -> a(theta)

# The eigenvalues lie inside the symbol's range up to round-off and the sampling of the symbol.
_MARGIN = 1e-6
_OVERSAMPLING = 4
# e_m comes from a circle of this many times its length; of its images these many terms are taken off.
_CIRCLE = 8
_IMAGE_TERMS = 3


@dataclass(frozen=True)
class LatticeSolver:
    """A Toeplitz peer made ready, see `base.Solver`.

    Attributes
    ----------
    x, volumes : array, shape (N,)
        The lattice, and h.
    operator : ConvolutionOperator
        A.
    series : ChebyshevSeries or None
        exp(A t); None if there is a propagator.
    propagator : ConvolutionOperator or None
        exp(A t) as one lattice sum.
    """

    x: np.ndarray
    volumes: np.ndarray
    operator: ConvolutionOperator
    series: ChebyshevSeries | None
    propagator: ConvolutionOperator | None

    @property
    def applications(self) -> int:
        """The number of lattice sums that a solve takes."""
        return 1 if self.series is None else self.series.degree

    def apply(self, u: np.ndarray) -> np.ndarray:
        """Return A u."""
        return self.operator.apply(u)

    def solve(self, u0: np.ndarray) -> np.ndarray:
        """Return exp(A t) u0."""
        if self.series is not None:
            return self.series(self.operator, u0)
        assert self.propagator is not None
        return self.propagator.apply(u0)


def prepare_lattice(
    weights: Weights,
    *,
    alpha: float,
    half_width: float,
    time: float,
    spacing: float | None,
    count: int | None,
    exterior: str,
    propagation: str,
    symbol: Symbol | None = None,
) -> LatticeSolver:
    """Return a Toeplitz peer made ready.

    Parameters
    ----------
    weights : callable
        (alpha, count) -> a_m for m = 0 .. count - 1.
    alpha, half_width, time, spacing, count
        As of `Peer.prepare`; count is odd.
    exterior : {"truncated", "open"}
        u beyond the lattice.
    propagation : {"series", "convolution"}
        How exp(A t) is done.
    symbol : callable, optional
        (theta, alpha) -> a(theta), without which there is no convolution in time.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """
    alpha = fractional_order(alpha)
    half_width, time = positive_real("half_width", half_width), positive_real("time", time)
    check_choice("exterior", exterior, EXTERIORS)
    check_choice("propagation", propagation, SERIES if symbol is None else SERIES_OR_CONVOLUTION)
    n = half_intervals(half_width, spacing, count)
    size, h = 2 * n + 1, half_width / n
    last = 4 * n + 1  # M, odd: there a panel of Huang & Oberman's rule ends
    rate = h**-alpha
    a = rate * weights(alpha, size if exterior == "truncated" else last + 1)
    operator = _convolution(a, n, rate, alpha, exterior)
    series, propagator = None, None
    if propagation == "series":
        series = exponential(time, *_spectral_interval(a[:size]))
    else:
        assert symbol is not None
        e = _propagator_weights(symbol, alpha, time * rate, last + 1)
        propagator = _convolution(e, n, time * rate, alpha, exterior)
    x = np.arange(-n, n + 1) * h
    return LatticeSolver(x, np.full(size, h), operator, series, propagator)


def _convolution(
    w: np.ndarray, n: int, scale: float, alpha: float, exterior: str
) -> ConvolutionOperator:
    """Return u -> sum_j w_{i-j} u_j; w_m -> scale C m^(-1-alpha)."""
    size = 2 * n + 1
    far = None if exterior == "truncated" else _far_field(w, n, scale, alpha)
    return ConvolutionOperator(FourierConvolution(w[:size], size), np.zeros(size), far)


def _far_field(w: np.ndarray, n: int, scale: float, alpha: float) -> FarField:
    """Return right_i, and left_i = right_{-i}; w holds m = 0 .. M."""
    last = w.size - 1
    i = np.arange(-n, n + 1)
    k = np.arange(n + 1, n + last + 1)
    present = np.zeros(2 * n + last)  # w_{i-k} for the offsets i - k = -2 n - M .. -1, nil beyond M
    present[2 * n :] = w[:0:-1]
    present[2 * n] *= 0.5
    near = valid_convolution((n / k) ** (1.0 + alpha), present)
    beyond = hyp2f1(1.0 + alpha, 1.0 + 2.0 * alpha, 2.0 + 2.0 * alpha, -i / last)
    amplitude = scale * tail_constant(alpha) * n ** (1.0 + alpha) / (1.0 + 2.0 * alpha)
    right = near + amplitude * float(last) ** (-1.0 - 2.0 * alpha) * beyond
    return FarField(right=right, left=right[::-1])


def _spectral_interval(a: np.ndarray) -> tuple[float, float]:
    """Return an interval that holds the eigenvalues of the Toeplitz matrix with the first row a.

    They lie between the least and the largest value of sum_m a_|m| e^(i m theta), whatever a is beyond the row.
    """
    length = next_fast_len(_OVERSAMPLING * a.size, real=True)
    values = 2.0 * rfft(a, length).real - a[0]
    low, high = float(values.min()), max(0.0, float(values.max()))
    room = _MARGIN * (high - low)
    return low - room, high + room


def _propagator_weights(symbol: Symbol, alpha: float, scaled_time: float, count: int) -> np.ndarray:
    """Return e_m = (1 / 2 pi) int exp(t h^(-alpha) a(theta)) e^(i m theta) dtheta, m = 0 .. count - 1.

    The sum over P points of the circle gives sum_l e_{m + l P}. Far away, by the expansion of the exponential at
    theta = 0 with tau = t h^(-alpha),

        e_m ~ sum_{j >= 1} (-1)^(j+1) tau^j / j! Gamma(1 + j alpha) sin(pi j alpha / 2) / pi m^(-1-j alpha),

    as (A.2) of Lucchesi et al. (2020), and the images l = +-1, +-2, .. of a power are Hurwitz zeta functions.
    """
    circle = 1 << (_CIRCLE * count - 1).bit_length()
    theta = np.arange(circle // 2 + 1) * (2.0 * np.pi / circle)
    e = np.asarray(irfft(np.exp(scaled_time * symbol(theta, alpha)), circle)[:count])
    m = np.arange(count) / circle
    for j in range(1, _IMAGE_TERMS + 1):
        power = 1.0 + j * alpha
        amplitude = -((-scaled_time) ** j) / gamma(1.0 + j) * tail_constant(j * alpha)
        images = zeta(power, 1.0 + m) + zeta(power, 1.0 - m)
        e -= amplitude * float(circle) ** -power * images
    return e
