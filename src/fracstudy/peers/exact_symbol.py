"""The limit: the exact symbol on a periodic box, one pair of Fourier transforms from 0 to t.

    u^_k(t) = exp(-t |k|^alpha) u^_k(0),    k = pi m / D,  m = -N/2 .. N/2.

Exact in time and, for what the lattice resolves, in space. What is left is the period 2 D: every particle has images,
and the initial data beyond D are missing.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from threading import Lock

import numpy as np
import pyfftw

from fracparticles.arguments import fractional_order, positive_real
from fracparticles.lattice.fourier import transform_length
from fracstudy.peers.base import check_choice, half_intervals

__all__ = [
    "EXTERIORS",
    "NAME",
    "PROPAGATIONS",
    "REFERENCE",
    "TITLE",
    "ExactSymbolSolver",
    "prepare",
]

NAME = "exact-symbol"
TITLE = "Exact symbol on a periodic box"
REFERENCE = "u^(k, t) = exp(-t |k|^alpha) u^(k, 0)"
EXTERIORS = ("periodic",)
PROPAGATIONS = ("exact",)

_PLAN = ("FFTW_ESTIMATE",)  # the same plan every time, as in `sums.fourier`


@dataclass(frozen=True)
class ExactSymbolSolver:
    """The method made ready, see `base.Solver`. Threads may share it: they take turns at its work arrays.

    Attributes
    ----------
    x, volumes : array, shape (N,)
        x_i = -D + i h, i = 0 .. N - 1, and h.
    rate, decay : array, shape (N / 2 + 1,)
        -|k|^alpha and exp(-t |k|^alpha).
    """

    x: np.ndarray
    volumes: np.ndarray
    rate: np.ndarray
    decay: np.ndarray
    _forward: pyfftw.FFTW = field(init=False, repr=False)
    _backward: pyfftw.FFTW = field(init=False, repr=False)
    _lock: Lock = field(init=False, repr=False, default_factory=Lock)

    def __post_init__(self) -> None:
        real = pyfftw.empty_aligned(self.x.size)
        spectrum = pyfftw.empty_aligned(self.rate.size, dtype=complex)
        forward = pyfftw.FFTW(real, spectrum, flags=_PLAN)
        backward = pyfftw.FFTW(spectrum, real, direction="FFTW_BACKWARD", flags=_PLAN)
        object.__setattr__(self, "_forward", forward)
        object.__setattr__(self, "_backward", backward)

    def apply(self, u: np.ndarray) -> np.ndarray:
        """Return -(-Laplacian)^(alpha/2) u of the periodic u."""
        return self._multiplied(u, self.rate)

    def solve(self, u0: np.ndarray) -> np.ndarray:
        """Return u at the time prepared for."""
        return self._multiplied(u0, self.decay)

    def _multiplied(self, u: np.ndarray, symbol: np.ndarray) -> np.ndarray:
        with self._lock:
            np.copyto(self._forward.input_array, u)
            self._forward.execute()
            np.multiply(self._forward.output_array, symbol, out=self._forward.output_array)
            self._backward.execute()
            return self._backward.output_array / u.size


def prepare(
    *,
    alpha: float,
    half_width: float,
    time: float,
    spacing: float | None = None,
    count: int | None = None,
    exterior: str = "periodic",
    propagation: str = "exact",
) -> ExactSymbolSolver:
    """Return the solver.

    Parameters
    ----------
    alpha : float
        Fractional order, 1 < alpha < 2.
    half_width : float
        D: the period is 2 D.
    time : float
        The time to go.
    spacing : float, optional
        The spacing, at most; it is lowered to a number of points that transforms fast.
    count : int, optional
        The number of points instead, even.
    exterior : {"periodic"}
        There is only one.
    propagation : {"exact"}
        There is only one.

    Raises
    ------
    InvalidInput
        If an argument is outside its range.
    """
    check_choice("exterior", exterior, EXTERIORS)
    check_choice("propagation", propagation, PROPAGATIONS)
    alpha = fractional_order(alpha)
    half_width, time = positive_real("half_width", half_width), positive_real("time", time)
    points = 2 * half_intervals(half_width, spacing, count, points=0)
    if spacing is not None:
        points = transform_length(points)
    h = 2.0 * half_width / points
    k = np.arange(points // 2 + 1) * (np.pi / half_width)
    return ExactSymbolSolver(
        x=(np.arange(points) - points // 2) * h,
        volumes=np.full(points, h),
        rate=-(k**alpha),
        decay=np.exp(-time * k**alpha),
    )
