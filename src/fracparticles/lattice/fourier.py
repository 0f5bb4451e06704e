"""Lattice sums by the real fast Fourier transform, O(N log N)."""

from __future__ import annotations

import numpy as np
import pyfftw
from scipy.fft import irfft, next_fast_len, rfft

from fracparticles._compiled import njit

__all__ = [
    "PLAN",
    "FourierConvolution",
    "line_plans",
    "shares_memory",
    "transform_length",
    "valid_convolution",
]

# FFTW_ESTIMATE and not FFTW_MEASURE: at the lengths chosen below its plans take about a tenth longer to run
# (`benchmarks.reference`), but they are made in milliseconds instead of seconds, and they are the same every time, so
# that the same case gives the same bytes.
PLAN = ("FFTW_ESTIMATE",)
_CLOSE = 1.03  # a power of two is taken up to this ratio
_LONG = 10**6
_SHORT = 1000  # up to here the next length counts more than its factors


class FourierConvolution:
    """y_i = sum_{j=0}^{N-1} w_{i-j} u_j for i = -pad .. N-1+pad, with w_{-m} = parity * w_m.

    The sum is a circular convolution of length L >= 2 N - 1 + 2 pad. An even w has a real spectrum, an odd
    one an imaginary spectrum: either is kept as one real array.

    Parameters
    ----------
    weights : array, shape (N + pad,)
        w_m for m = 0 .. N - 1 + pad.
    size : int
        The number N of particles.
    parity : {1, -1}
        Whether w is even or odd.
    pad : int
        How many lattice points beyond each end get a value too.
    """

    def __init__(self, weights: np.ndarray, size: int, parity: int = 1, pad: int = 0) -> None:
        self.size, self.pad = size, pad
        length = transform_length(2 * (size + pad) - 1)
        self._real, self._spectrum = _buffers(length)
        self._forward, self._backward = line_plans(self._real, self._spectrum)
        self._particles = self._real[pad : pad + size]
        self._before, self._after = self._real[:pad], self._real[pad + size :]
        self._sums = self._real[: size + 2 * pad]
        reach = size - 1 + pad
        self._real[:] = 0.0
        self._real[: reach + 1] = weights
        self._real[length - reach :] = parity * weights[:0:-1]
        self._forward.execute()
        part = self._spectrum.real if parity > 0 else self._spectrum.imag
        self._symbol = part / length
        self._multiply = _multiply_real if parity > 0 else _multiply_imaginary

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """Return y, shape (N + 2 pad,): a view of a buffer that the next call overwrites."""
        self._particles[:] = u
        if self.pad:
            self._before.fill(0.0)
        self._after.fill(0.0)
        self._forward.execute()
        self._multiply(self._spectrum, self._symbol)
        self._backward.execute()
        return self._sums


def line_plans(real: np.ndarray, spectrum: np.ndarray) -> tuple[pyfftw.FFTW, pyfftw.FFTW]:
    """Return the transforms of the last axis of `real`, there and back; the way back spoils the spectrum."""
    back = {"direction": "FFTW_BACKWARD", "flags": (*PLAN, "FFTW_DESTROY_INPUT")}
    return pyfftw.FFTW(real, spectrum, flags=PLAN), pyfftw.FFTW(spectrum, real, **back)


def transform_length(least: int) -> int:
    """Return an even length >= least whose only prime factors are 2, 3, 5 and 7 and whose transforms are fast.

    The next power of two if it is close; else, of the lengths that the factors allow, a multiple of 50, except
    for short sums. FFTW's estimated plans of such lengths take 10 to 30 % less time than those of their
    neighbours. Even, because the real transforms of odd lengths take two to three times as long.
    """
    power = max(2, 1 << (least - 1).bit_length())
    if power <= _CLOSE * least:
        return power
    stride = 50 if least > _SHORT else 2
    length = -(-least // stride) * stride
    while not _is_smooth(length):
        length += stride
    return length


def _is_smooth(length: int) -> bool:
    for prime in (2, 3, 5, 7):
        while length % prime == 0:
            length //= prime
    return length == 1


def shares_memory(length: int) -> bool:
    """Return whether the real array and its spectrum share their memory: powers of two and long ones are faster so.

    Beyond the caches it halves the traffic.
    """
    return length & (length - 1) == 0 or length >= _LONG


def _buffers(length: int) -> tuple[np.ndarray, np.ndarray]:
    spectrum = pyfftw.empty_aligned(length // 2 + 1, dtype=complex)
    if shares_memory(length):
        return spectrum.view(float)[:length], spectrum
    return pyfftw.empty_aligned(length), spectrum


def valid_convolution(u: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Return sum_k u_k w_{i-k} along the last axis of u where every term exists, w.size - u.shape[-1] + 1 values.

    For sums that are done once. A circular convolution no longer than w will do: it wraps around in the other
    part only.
    """
    length = next_fast_len(w.size, real=True)
    return irfft(rfft(u, length) * rfft(w, length), length)[..., u.shape[-1] - 1 : w.size]


@njit()
def _multiply_real(spectrum, symbol):
    for k in range(spectrum.size):
        spectrum[k] = complex(spectrum[k].real * symbol[k], spectrum[k].imag * symbol[k])


@njit()
def _multiply_imaginary(spectrum, symbol):
    for k in range(spectrum.size):
        spectrum[k] = complex(-spectrum[k].imag * symbol[k], spectrum[k].real * symbol[k])
