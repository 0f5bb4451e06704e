r"""Sums over particles that lie anywhere on the line, not on a lattice:

    y_i = sum_j q_j K_eps(z_i - x_j),     K_eps(r) = K(r / eps) / eps,

for one or several kernels K with the same sources x_j, strengths q_j and points z_i. There are three ways:

- `NonuniformFourierSum`, O(N log N), for kernels whose Fourier transform is zero beyond a few / eps, as it is for
  every kernel that is a convolution with a Gaussian. The kernel is cut off smoothly beyond the largest distance
  within the set and continued periodically; then

      y(z) = sum_k c_k q^_k exp(i k z),     q^_k = sum_j q_j exp(-i k x_j),

  with the Fourier coefficients c_k of the kernel is the free-space sum, to round-off. Both sums are non-uniform
  transforms: the particles are spread over a lattice by a window (`moving.gridding`), a real fast Fourier transform
  follows, the window is divided out, and so back. A library of such transforms (finufft) takes complex strengths and
  a lattice half as fine again. The Gaussian in c_k makes that unnecessary, and these sums are four times faster.
  Particles that lie on a lattice already, as after a remeshing, are one convolution (`moving.equally_spaced`).
- `NeighbourSum`, O(N times neighbours), for kernels that are zero, to round-off, beyond a distance. Where the sum
  is small it stays accurate relative to its own terms, not only to the maximum.
- `NaiveScatteredSum`: the papers' own double loop over all pairs, the oracle of the other two.

The same sequence of calls gives the same bytes. Threads may share a sum; a sum by transforms admits one at a time.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence

import numpy as np
from pyfftw import empty_aligned
from scipy.fft import next_fast_len, rfft
from scipy.special import erfc

from fracparticles import arguments as check
from fracparticles.errors import InvalidInput
from fracparticles.moving.equally_spaced import EquallySpacedSum, RowTransforms, equal_spacing
from fracparticles.moving.gridding import (
    WIDTH,
    interpolate,
    spread,
    window_transform,
    window_weights,
)
from fracparticles.moving.pair_sums import NaiveScatteredSum, NeighbourSum
from fracparticles.moving.scattered_base import (
    EDGE,
    GAUSSIAN_BAND,
    MARGIN,
    ScatteredKernel,
    ScatteredSum,
    checked_kernels,
    smooth_kernel,
)

__all__ = [
    "NaiveScatteredSum",
    "NeighbourSum",
    "NonuniformFourierSum",
    "ScatteredKernel",
    "ScatteredSum",
    "scattered_sum",
    "smooth_kernel",
]

_MOST_MODES = 2**24  # about 1 GiB of buffers
_ACCURACY = 1e-11
_ULP = 2.0**-52


def scattered_sum(
    summation: str, kernels: Sequence[ScatteredKernel], epsilon: float
) -> ScatteredSum:
    """Return the sum over scattered particles for these kernels.

    Raises `InvalidInput` if the summation does not exist, or epsilon is not a positive number, or "fft" is asked for a
    kernel that has neither a finite reach nor a finite bandwidth.

    Parameters
    ----------
    summation : {"fft", "naive"}
        "fft" takes the neighbours if every kernel has a finite reach, else the non-uniform transform.
    kernels : sequence of ScatteredKernel
    epsilon : float
        Smoothing length.
    """
    if check.choice("summation", summation, ("fft", "naive")) == "naive":
        return NaiveScatteredSum(kernels, epsilon)
    if all(math.isfinite(k.reach) for k in checked_kernels(kernels)):
        return NeighbourSum(kernels, epsilon)
    return NonuniformFourierSum(kernels, epsilon)


class NonuniformFourierSum(ScatteredSum):
    """The sums by non-uniform fast Fourier transforms, for kernels of finite bandwidth.

    The accuracy is relative to the largest value of each; positions are rounded to an ulp of the box, so that it is
    less in a very wide one. The periodic box is made when it is needed, and made anew, an eighth wider than the set,
    when particles leave it. Sums at particles that lie on a lattice are one convolution.
    """

    accuracy = _ACCURACY

    def __init__(self, kernels: Sequence[ScatteredKernel], epsilon: float) -> None:
        super().__init__(kernels, epsilon)
        for k in self._kernels:
            if not math.isfinite(k.bandwidth):
                allowed = "a finite number for a Fourier sum"
                remedy = "Take summation='naive', or give the kernel its reach."
                raise InvalidInput("bandwidth", k.bandwidth, allowed, remedy)
        self._band = max(k.bandwidth for k in self._kernels) / self._epsilon
        self._low, self._high = math.inf, -math.inf
        self._lattice: EquallySpacedSum | None = None
        self._in_use = threading.Lock()  # box and buffers belong to one call at a time

    def _add_to(self, out, x, q, z):
        with self._in_use:
            self._transform(out, x, q, z)

    def _transform(
        self, out: np.ndarray, x: np.ndarray, q: np.ndarray, z: np.ndarray | None
    ) -> None:
        spacing = equal_spacing(x, _ACCURACY * self._epsilon) if z is None else None
        if spacing is not None:
            if self._lattice is None or not self._lattice.holds(spacing, x.size):
                profiles = [k.profile for k in self._kernels]
                self._lattice = EquallySpacedSum(profiles, self._epsilon, spacing, x.size)
            self._lattice.add_to(out, q)
            return
        ends = [x.min(), x.max(), *(() if z is None else (z.min(), z.max()))]
        low, high = min(ends), max(ends)
        if not (self._low <= low and high <= self._high):
            margin = 1.0 if self._low > self._high else MARGIN
            self._make_box(min(low, self._low), max(high, self._high), margin)
        at = self._places(x)
        spread(*at, q, self._particles)
        fields = self._transforms.fields()
        if z is not None:
            at = self._places(z)
        interpolate(*at, fields, out)

    def _places(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return window_weights((z - self._low) / self._step + WIDTH)

    def _make_box(self, low: float, high: float, margin: float) -> None:
        """Fourier coefficients of the kernels and plans for a set within [low, high], and a little more."""
        scale = GAUSSIAN_BAND / self._band  # of the cut-off, which must not exceed the band either
        half = 0.5 * margin * (high - low) + scale
        centre = low + 0.5 * (high - low)
        period = 2.0 * (2.0 * half + 2.0 * EDGE * scale)
        needed = self._band * period / math.pi
        if not needed <= _MOST_MODES:
            widest = 0.25 * math.pi * _MOST_MODES / self._band / MARGIN
            shown = f"particles from {low:.6g} to {high:.6g}"
            allowed = f"a set no wider than {2.0 * widest:.4g}, for this smoothing length"
            remedy = "Look for a particle that ran away, or take summation='naive'."
            raise InvalidInput("x", shown, allowed, remedy)
        self._low, self._high = centre - half, centre + half
        size = 2 * next_fast_len(math.ceil(0.5 * needed), real=True)  # even: odd ones take longer
        self._step = period / size
        self.accuracy = max(_ACCURACY, size * _ULP)
        r = np.fft.fftfreq(size, 1.0 / size) * self._step
        cut_off = 0.5 * erfc((np.abs(r) - (0.5 * period - EDGE * scale)) / scale)
        kernels = np.array([cut_off * k.profile(r / self._epsilon) for k in self._kernels])
        window = window_transform(2.0 * math.pi / size * np.arange(size // 2 + 1))
        self._particles = empty_aligned(size)
        coefficients = rfft(kernels) / (size * self._epsilon * window**2)
        self._transforms = RowTransforms(self._particles, coefficients)
