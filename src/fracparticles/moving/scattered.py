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
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from pyfftw import empty_aligned
from scipy.fft import next_fast_len, rfft
from scipy.special import erfc

from fracparticles import arguments as check
from fracparticles._compiled import njit
from fracparticles.errors import InvalidInput
from fracparticles.kernels.families import KERNELS, kernel
from fracparticles.moving.equally_spaced import EquallySpacedSum, equal_spacing, transforms
from fracparticles.moving.gridding import (
    WIDTH,
    interpolate,
    spread,
    window_transform,
    window_weights,
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

# exp(-k^2/4), in the transform of every kernel with a Gaussian in it, is 2e-16 at k = 12.
_GAUSSIAN_BAND = 12.0
# exp(-r^2) is 4e-19 at r = 6.5; the order-IV kernels hold exp(-r^2/2), which is that at 9.2.
_GAUSSIAN_REACH = {2: 6.5, 4: 9.2}
_EDGE = 5.5  # erfc(5.5) / 2 < 1e-14: the cut-off is 1 on one side of this, 0 on the other
# How much wider than a set that grew the box is made, so that it is not made anew at every step.
_MARGIN = 1.125
_MOST_MODES = 2**24  # about 1 GiB of buffers
_ACCURACY = 1e-11
_ULP = 2.0**-52
_ORDINARY = (
    1e150  # strengths: divided by the least epsilon, 1e-100, and summed they do not overflow
)
_PAIRS = 2**14  # pairs evaluated together: they stay in the second-level cache


@dataclass(frozen=True)
class ScatteredKernel:
    """A kernel of unit smoothing length.

    Raises `InvalidInput` if the profile is not a function, or one of the others not positive.

    Attributes
    ----------
    profile : callable
        K(r) for an array of signed distances.
    bandwidth : float
        Wavenumber beyond which the transform is zero, to round-off, falling like a Gaussian; infinite if there is none.
    reach : float
        Distance beyond which the kernel is zero, to round-off; infinite if there is none.
    """

    profile: Callable[[np.ndarray], np.ndarray]
    bandwidth: float = math.inf
    reach: float = math.inf

    def __post_init__(self) -> None:
        check.function("profile", self.profile)
        for name in ("bandwidth", "reach"):
            value = getattr(self, name)
            if not (isinstance(value, float) and value == math.inf):
                object.__setattr__(self, name, check.real_between(name, value, 0.0, inside=True))


def smooth_kernel(name: str, alpha: float, order: int = 2) -> ScatteredKernel:
    """Return a kernel of `kernels.families` that is a convolution with the Gaussian of its order: all but E.

    Raises `InvalidInput` if the kernel, its order or alpha does not exist, or the kernel is E.
    """
    check.choice("name", name, [n for n in KERNELS if n != "E"])
    order = check.whole_number("order", order, least=1)

    def profile(r: np.ndarray) -> np.ndarray:
        return np.asarray(kernel(name, r, alpha, order=order))

    profile(np.zeros(1))
    gaussian = math.isinf(KERNELS[name].decay(alpha))
    reach = _GAUSSIAN_REACH[order] if gaussian else math.inf
    return ScatteredKernel(profile, _GAUSSIAN_BAND, reach)


class ScatteredSum(ABC):
    """What every one of the sums offers.

    `accuracy` bounds the error of a field relative to its largest value; 0 if the error of every value is
    relative to its own terms.

    Parameters
    ----------
    kernels : sequence of ScatteredKernel
    epsilon : float
        Smoothing length.
    """

    accuracy = 0.0

    def __init__(self, kernels: Sequence[ScatteredKernel], epsilon: float) -> None:
        self._kernels, self._epsilon = _kernels(kernels), check.scale("epsilon", epsilon)

    def __call__(self, x: np.ndarray, q: np.ndarray, z: np.ndarray | None = None) -> np.ndarray:
        """Return y, shape (kernels, M), a new array: the sums at the points z, or at the particles themselves.

        Raises `InvalidInput` if the arrays do not fit together, a position is not finite, the set is too wide, or the
        sums overflow.
        """
        x, q, z, ordinary = _checked(x, q, z)
        out = np.zeros((len(self._kernels), x.size if z is None else z.size))
        if not (x.size and out.size):
            return out
        if ordinary:
            self._add_to(out, x, q, z)
            return out
        with np.errstate(over="ignore", invalid="ignore"):
            self._add_to(out, x, q, z)
        finite: np.ndarray = check.finite_result("q", out)
        return finite

    @abstractmethod
    def _add_to(
        self, out: np.ndarray, x: np.ndarray, q: np.ndarray, z: np.ndarray | None
    ) -> None: ...


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
    if all(math.isfinite(k.reach) for k in _kernels(kernels)):
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
            margin = 1.0 if self._low > self._high else _MARGIN
            self._make_box(min(low, self._low), max(high, self._high), margin)
        at = self._places(x)
        spread(*at, q, self._particles)
        self._forward.execute()
        np.multiply(self._coefficients, self._modes, out=self._products)
        self._backward.execute()
        if z is not None:
            at = self._places(z)
        interpolate(*at, self._fields, out)

    def _places(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return window_weights((z - self._low) / self._step + WIDTH)

    def _make_box(self, low: float, high: float, margin: float) -> None:
        """Fourier coefficients of the kernels and plans for a set within [low, high], and a little more."""
        scale = _GAUSSIAN_BAND / self._band  # of the cut-off, which must not exceed the band either
        half = 0.5 * margin * (high - low) + scale
        centre = low + 0.5 * (high - low)
        period = 2.0 * (2.0 * half + 2.0 * _EDGE * scale)
        needed = self._band * period / math.pi
        if not needed <= _MOST_MODES:
            widest = 0.25 * math.pi * _MOST_MODES / self._band / _MARGIN
            shown = f"particles from {low:.6g} to {high:.6g}"
            allowed = f"a set no wider than {2.0 * widest:.4g}, for this smoothing length"
            remedy = "Look for a particle that ran away, or take summation='naive'."
            raise InvalidInput("x", shown, allowed, remedy)
        self._low, self._high = centre - half, centre + half
        size = 2 * next_fast_len(math.ceil(0.5 * needed), real=True)  # even: odd ones take longer
        self._step = period / size
        self.accuracy = max(_ACCURACY, size * _ULP)
        r = np.fft.fftfreq(size, 1.0 / size) * self._step
        cut_off = 0.5 * erfc((np.abs(r) - (0.5 * period - _EDGE * scale)) / scale)
        kernels = np.array([cut_off * k.profile(r / self._epsilon) for k in self._kernels])
        window = window_transform(2.0 * math.pi / size * np.arange(size // 2 + 1))
        self._coefficients = rfft(kernels) / (size * self._epsilon * window**2)
        self._particles = empty_aligned(size)
        self._modes, self._forward, self._products, self._backward, self._fields = transforms(
            self._particles, self._coefficients
        )


class _PairSum(ScatteredSum):
    """The sum over the pairs that `_partners` gives, a block of rows at a time."""

    def _add_to(self, out, x, q, z):
        z = x if z is None else z
        x, q, first, last = self._partners(x, q, z)
        count = last - first
        ends = np.cumsum(count)
        row = 0
        while row < z.size:
            done = ends[row] - count[row]
            stop = max(row + 1, int(np.searchsorted(ends, done + _PAIRS, side="right")))
            distance = np.empty(ends[stop - 1] - done)
            _distances(x, z[row:stop], first[row:stop], last[row:stop], self._epsilon, distance)
            for k, y in zip(self._kernels, out, strict=True):
                values = np.ascontiguousarray(k.profile(distance))
                _add_up(values, q, first[row:stop], last[row:stop], y[row:stop])
            row = stop
        out /= self._epsilon

    @abstractmethod
    def _partners(
        self, x: np.ndarray, q: np.ndarray, z: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return x and q in an order in which the partners of z_i are x[first_i:last_i], first and last."""


class NaiveScatteredSum(_PairSum):
    """The sums over all pairs, O(N M)."""

    def _partners(self, x, q, z):
        return x, q, np.zeros(z.size, dtype=np.int64), np.full(z.size, x.size)


class NeighbourSum(_PairSum):
    """The sums over the pairs that are no farther apart than the widest kernel reaches.

    Raises `InvalidInput` if a kernel has no finite reach.
    """

    def __init__(self, kernels: Sequence[ScatteredKernel], epsilon: float) -> None:
        super().__init__(kernels, epsilon)
        self._reach = max(k.reach for k in self._kernels) * self._epsilon
        if not math.isfinite(self._reach):
            allowed = "a finite number for a sum over neighbours"
            raise InvalidInput("reach", math.inf, allowed, "Take another sum.")

    def _partners(self, x, q, z):
        order = np.argsort(x, kind="stable")
        x, q = x[order], q[order]
        first = np.searchsorted(x, z - self._reach, side="left")
        return x, q, first, np.searchsorted(x, z + self._reach, side="right")


def _kernels(kernels: Any) -> list[ScatteredKernel]:
    listed: Any = check.instance("kernels", kernels, (list, tuple), "a list of kernels")
    if not listed:
        raise InvalidInput("kernels", kernels, "one kernel or more", "Give a list of kernels.")
    return [check.instance("kernels", k, ScatteredKernel) for k in listed]


def _checked(x: Any, q: Any, z: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray | None, bool]:
    """The arrays, and whether no sum of them can overflow."""
    x = x if _in_range(x, check.SIZES[1]) else check.positions("x", x, least=0)
    ordinary = _in_range(q, _ORDINARY)
    if not (ordinary and q.shape == x.shape):
        q = check.vector("q", q, x.size, least=0)
    if z is not None:
        z = z if _in_range(z, check.SIZES[1]) else check.positions("z", z, least=0)
        z = np.ascontiguousarray(z)
    return np.ascontiguousarray(x), np.ascontiguousarray(q), z, ordinary


def _in_range(values: Any, largest: float) -> bool:
    """Whether it is an array of numbers of one dimension that are no larger; a nan is not."""
    return (
        type(values) is np.ndarray
        and values.dtype == np.float64
        and values.ndim == 1
        and (not values.size or bool(-largest <= values.min() and values.max() <= largest))
    )


@njit()
def _distances(x, z, first, last, epsilon, out):
    pair = 0
    for i in range(z.size):
        for j in range(first[i], last[i]):
            out[pair] = (z[i] - x[j]) / epsilon
            pair += 1


@njit()
def _add_up(values, q, first, last, out):
    pair = 0
    for i in range(out.size):
        total = 0.0
        for j in range(first[i], last[i]):
            total += values[pair] * q[j]
            pair += 1
        out[i] = total
