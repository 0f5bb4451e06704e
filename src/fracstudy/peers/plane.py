"""Methods of the literature for u_t = -(-Laplacian)^(alpha/2) u in the plane: one transform or one lattice sum.

The exact symbol on the periodic square of period 2 D is, as on the line,

    u^_k(t) = exp(-t |k|^alpha) u^_k(0),    k = pi m / D,  m in {-N/2, .., N/2}^2.

The others live on the square lattice x_ij = (i h, j h), i, j = -n .. n, and take u for zero beyond it. Their symbol is
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
from dataclasses import dataclass, field
from functools import partial
from math import ceil
from threading import Lock
from typing import NamedTuple

import numpy as np
import pyfftw
from scipy.fft import dct
from scipy.special import factorial, gamma, rgamma, zeta

from fracparticles.arguments import fractional_order, positive_real, real_array
from fracparticles.errors import InvalidInput
from fracparticles.lattice.box import BOX_SUMMATIONS
from fracparticles.lattice.fourier import transform_length
from fracstudy.peers import exact_symbol, fractional_centred, sinc_lattice
from fracstudy.peers.base import check_choice, half_intervals

__all__ = ["PLANE_PEERS", "PlanePeer", "PlaneSolver", "plane_weights", "prepare_plane"]

Squares = Callable[[np.ndarray], np.ndarray]  # theta_1 in [0, pi] -> its part of s

_PLAN = ("FFTW_ESTIMATE",)  # the same plan every time, as in `sums.fourier`

# As on the line, e_m comes from a circle of this many times its length, and of its images these many terms are taken
# off. It has at least this many spreads tau^(1/alpha) of the exponential too: closer the terms are no expansion.
_CIRCLE = 8
_IMAGE_TERMS = 3
_SPREADS = 40


@dataclass(frozen=True)
class PlaneSolver:
    """A peer made ready for one lattice, one alpha and one time. Threads may share it: they take turns.

    Attributes
    ----------
    axis : array, shape (N,)
        The coordinates along either axis, in ascending order.
    spacing : float
        The realised h.
    advance : callable
        u(0) -> u(t), unchecked.
    """

    axis: np.ndarray
    spacing: float
    advance: Callable[[np.ndarray], np.ndarray]
    _lock: Lock = field(init=False, repr=False, default_factory=Lock)

    def solve(self, u0: np.ndarray) -> np.ndarray:
        """Return u at the time prepared for from u0 at time 0, both of shape (N, N).

        Raises
        ------
        InvalidInput
            If u0 is not of that shape, not real, or holds a nan.
        """
        u0, size = real_array("u0", u0), self.axis.size
        if u0.shape != (size, size):
            raise InvalidInput(
                "u0", u0.shape, f"the shape ({size}, {size})", "Give a value at each lattice point."
            )
        with self._lock:
            return self.advance(u0)


class PlanePeer(NamedTuple):
    """A peer in the plane; `prepare` takes alpha, half_width, n (half the number of intervals), time."""

    title: str
    reference: str
    prepare: Callable[[float, float, int, float], PlaneSolver]


def _periodic(alpha: float, half_width: float, n: int, time: float) -> PlaneSolver:
    points = transform_length(2 * n)
    real = pyfftw.empty_aligned((points, points))
    spectrum = pyfftw.empty_aligned((points, points // 2 + 1), dtype=complex)
    forward = pyfftw.FFTW(real, spectrum, axes=(0, 1), flags=_PLAN)
    backward = pyfftw.FFTW(
        spectrum,
        real,
        axes=(0, 1),
        direction="FFTW_BACKWARD",
        flags=(*_PLAN, "FFTW_DESTROY_INPUT"),
    )
    h = 2.0 * half_width / points
    rows = 2.0 * np.pi * np.fft.fftfreq(points, h)
    columns = 2.0 * np.pi * np.fft.rfftfreq(points, h)
    rate = (rows[:, None] ** 2 + columns**2) ** (0.5 * alpha)
    decay = np.exp(-time * rate) / points**2

    def advance(u0: np.ndarray) -> np.ndarray:
        np.copyto(real, u0)
        forward.execute()
        np.multiply(spectrum, decay, out=spectrum)
        backward.execute()
        return real.copy()

    return PlaneSolver((np.arange(points) - points // 2) * h, h, advance)


def _truncated(
    squares: Squares, alpha: float, half_width: float, n: int, time: float
) -> PlaneSolver:
    size, h = 2 * n + 1, half_width / n
    e = plane_weights(squares, alpha, time * h**-alpha, size)
    convolve = BOX_SUMMATIONS["fft"]([e], [None], size, size)
    return PlaneSolver(np.arange(-n, n + 1) * h, h, lambda u0: convolve(u0)[0].copy())


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


PLANE_PEERS: dict[str, PlanePeer] = {
    exact_symbol.NAME: PlanePeer(
        "Exact symbol on a periodic square", exact_symbol.REFERENCE, _periodic
    ),
    sinc_lattice.NAME: PlanePeer(
        sinc_lattice.TITLE,
        "Antil, Dondl & Striet (2020), arXiv:2010.06509; Zhou & Zhang (2023), arXiv:2311.07814",
        partial(_truncated, np.square),
    ),
    fractional_centred.NAME: PlanePeer(
        fractional_centred.TITLE,
        "Hao, Zhang & Du (2021), J. Comput. Phys. 424, 109851",
        partial(_truncated, lambda theta: 4.0 * np.sin(0.5 * theta) ** 2),
    ),
}


def prepare_plane(
    name: str, *, alpha: float, half_width: float, time: float, spacing: float
) -> PlaneSolver:
    """Return a peer made ready: all that does not depend on the initial data is done.

    Parameters
    ----------
    name : str
        One of PLANE_PEERS.
    alpha : float
        Fractional order, 1 < alpha < 2.
    half_width : float
        D: the lattice goes from -D to D along either axis; "exact-symbol" has the period 2 D and leaves D itself out.
    time : float
        The time to go.
    spacing : float
        h; the realised one is half_width / n, and for "exact-symbol" at most this, for a size that transforms fast.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """
    check_choice("name", name, tuple(PLANE_PEERS))
    alpha = fractional_order(alpha)
    half_width, time = positive_real("half_width", half_width), positive_real("time", time)
    n = half_intervals(half_width, positive_real("spacing", spacing), None)
    return PLANE_PEERS[name].prepare(alpha, half_width, n, time)
