"""Lattice sums by the real fast Fourier transform, O(N log N)."""

from __future__ import annotations

import numpy as np
import pyfftw
from scipy.fft import irfft, next_fast_len, rfft

from fracparticles._compiled import njit

__all__ = [
    "PLAN",
    "FourierConvolution",
    "complex_length",
    "complex_plans",
    "line_plans",
    "transform_length",
    "valid_convolution",
]

# FFTW_ESTIMATE and not FFTW_MEASURE: at the lengths chosen below its plans take up to a third longer to run (the scene
# `reference_times` times both), but they are made in milliseconds instead of seconds, and they are the same every time,
# so that the same case gives the same bytes.
PLAN = ("FFTW_ESTIMATE",)
_CLOSE = 1.03  # length over the least one: up to this ratio the next power of two is taken
_SHORT = 1000  # least length up to which a short transform counts more than good factors
_FACTOR = 128  # it divides every complex length
# Complex numbers from which a transform in place is faster than one into another array: two arrays leave the cache.
_IN_PLACE = 2**16


class FourierConvolution:
    """y_i = sum_{j=0}^{N-1} w_{i-j} u_j for i = -pad .. N-1+pad, with w_{-m} = parity * w_m.

    The sum is a circular convolution of length 2 M >= 2 N - 1 + 2 pad. Two real numbers in a row are read as a
    complex one, z_p = x_{2p} + i x_{2p+1}. Estimated plans of complex transforms of length M are better than those of
    real transforms of length 2 M: both ways take two thirds of the time. An even w has a real spectrum S_k,
    k = 0 .. M, and multiplies the spectrum Z of z as

        Z_k <- (a_k - b_k sin(pi k / M)) Z_k + i b_k cos(pi k / M) conj(Z_{M-k}),   a_k, b_k = (S_k +- S_{M-k}) / 2;

    an odd w has an imaginary spectrum i S_k, and multiplies as i times this with a_k, b_k = (S_k -+ S_{M-k}) / 2.

    Parameters
    ----------
    weights : array, shape (N + pad,)
        w_m for m = 0 .. N - 1 + pad.
    size : int
        The number N of particles.
    parity : {1, -1}
        Whether w is even or odd.
    pad : int
        The number of lattice points beyond each end that get a value, too.
    """

    def __init__(self, weights: np.ndarray, size: int, parity: int = 1, pad: int = 0) -> None:
        self.size, self.pad = size, pad
        length = complex_length(size + pad)
        numbers = pyfftw.empty_aligned(length, dtype=complex)
        real = numbers.view(float)
        self._before, self._after = real[:pad], real[pad + size :]
        self._particles, self._sums = real[pad : pad + size], real[: size + 2 * pad]

        reach = size - 1 + pad
        real[:] = 0.0
        real[: reach + 1] = weights
        real[2 * length - reach :] = parity * weights[:0:-1]
        self._own, self._mirrored = _factors(real, parity)
        self._multiply = _multiply_even if parity > 0 else _multiply_odd

        self._spectrum, self._forward, self._backward = complex_plans(numbers)

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """Return y, shape (N + 2 pad,): a view of a buffer that the next call overwrites."""
        self._particles[:] = u
        if self.pad:
            self._before.fill(0.0)
        self._after.fill(0.0)
        self._forward.execute()
        self._multiply(self._spectrum, self._own, self._mirrored)
        self._backward.execute()
        return self._sums


def _factors(weights: np.ndarray, parity: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a_k - b_k sin(pi k / M), k = 0 .. M, and b_k cos(pi k / M), k = 0 .. M / 2, of 2 M weights of a circle.

    It goes step by step, so that no more than three arrays of M numbers exist beside the transform.
    """
    length = weights.size // 2
    transform = rfft(weights)
    symbol = (transform.real if parity > 0 else transform.imag) / length
    del transform
    own = 0.5 * (symbol + parity * symbol[::-1])
    half_difference = 0.5 * (symbol - parity * symbol[::-1])
    del symbol
    angle = np.pi / length * np.arange(length + 1)
    mirrored = half_difference[: length // 2 + 1] * np.cos(angle[: length // 2 + 1])
    np.sin(angle, out=angle)
    angle *= half_difference
    own -= angle
    return own, mirrored


def complex_plans(numbers: np.ndarray) -> tuple[np.ndarray, pyfftw.FFTW, pyfftw.FFTW]:
    """Return the array of the spectrum, and the plans of the transforms there and back.

    For many numbers the array of the spectrum is that of the numbers themselves.
    """
    spectrum = numbers if numbers.size >= _IN_PLACE else pyfftw.empty_aligned(numbers.size, complex)
    back = {"direction": "FFTW_BACKWARD", "flags": PLAN}
    return (
        spectrum,
        pyfftw.FFTW(numbers, spectrum, flags=PLAN),
        pyfftw.FFTW(spectrum, numbers, **back),
    )


def line_plans(real: np.ndarray, spectrum: np.ndarray) -> tuple[pyfftw.FFTW, pyfftw.FFTW]:
    """Return the plans of the transforms of the last axis of `real`, there and back; the way back spoils `spectrum`."""
    back = {"direction": "FFTW_BACKWARD", "flags": (*PLAN, "FFTW_DESTROY_INPUT")}
    return pyfftw.FFTW(real, spectrum, flags=PLAN), pyfftw.FFTW(spectrum, real, **back)


def transform_length(least: int) -> int:
    """Return an even length >= least whose only prime factors are 2, 3, 5 and 7 and whose transforms are fast.

    It is the next power of two if that is close. Otherwise it is a multiple of 50, except for short sums: FFTW's
    estimated plans of such lengths take 10 to 30 % less time than those of their neighbours. It is even, because the
    real transforms of odd lengths take two to three times as long.
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


def complex_length(least: int) -> int:
    """Return a length >= least whose complex transforms are fast.

    It is the next power of two if that is close, or else the next multiple of 128 whose only prime factors are 2, 3, 5
    and 7. FFTW's estimated plans of these lengths take half to two thirds of the time of most of their neighbours.
    """
    power = max(_FACTOR, 1 << (least - 1).bit_length())
    if power <= _CLOSE * least:
        return power
    length = -(-least // _FACTOR) * _FACTOR
    while not _is_smooth(length):
        length += _FACTOR
    return length


def valid_convolution(u: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Return sum_k u_k w_{i-k} along the last axis of u where every term exists, w.size - u.shape[-1] + 1 values.

    It is meant for sums that are computed once. A circular convolution as long as w is enough: it wraps around only in
    the part that is not returned.
    """
    length = next_fast_len(w.size, real=True)
    return irfft(rfft(u, length) * rfft(w, length), length)[..., u.shape[-1] - 1 : w.size]


@njit()
def _multiply_even(z, own, mirrored):
    length = z.size
    for k in range(length // 2 + 1):
        m = length - k if k > 0 else 0
        first, second, q = z[k], z[m], mirrored[k]
        p, r = own[k], own[m]
        z[k] = complex(p * first.real + q * second.imag, p * first.imag + q * second.real)
        z[m] = complex(r * second.real + q * first.imag, r * second.imag + q * first.real)


@njit()
def _multiply_odd(z, own, mirrored):
    length = z.size
    for k in range(length // 2 + 1):
        m = length - k if k > 0 else 0
        first, second, q = z[k], z[m], mirrored[k]
        p, r = own[k], own[m]
        # For M - k the factor of the mirrored number has the other sign; 0 and M / 2 are their own images.
        z[m] = complex(q * first.real - r * second.imag, r * second.real - q * first.imag)
        z[k] = complex(-p * first.imag - q * second.real, p * first.real + q * second.imag)
