"""Sums over a square (n = 2) or cubic (n = 3) lattice: by fast Fourier transform and by the double loop.

Sources and results lie on concentric cubes of S^n and T^n lattice points,

    y_i = sum_j w_{i-j} u_j.

A weight is even in every coordinate, or odd in one of them and even in the others (a component of a vector
kernel). It is given for the offsets m = 0 .. (S + T)/2 - 1 in each coordinate.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pyfftw
from scipy.fft import dct, dst

from fracparticles._compiled import njit, prange
from fracparticles.lattice.fourier import PLAN, line_plans, transform_length

__all__ = ["COLUMNS", "ROWS", "BoxConvolution", "NaiveBoxConvolution"]

# Lines that are transformed together, along the last axis and along the others: enough for whole cache lines to be
# copied, few enough to stay in the cache.
ROWS = 16
COLUMNS = 8
_SHORTEST = 4  # length L: one point lies between 0 and L / 2, for sine transforms


class BoxConvolution:
    """The sums of one or several weights over the same sources, O(N log N).

    It is a circular convolution of length L >= S + T - 1 in each coordinate. The padding is never stored as a whole:
    the last axis is transformed row by row, and the other axes for a few wave numbers of the last at a time. Only the
    part that belongs to the cube is kept, so that the memory is about that of the sources.

    Parameters
    ----------
    weights : sequence of array, each of shape ((S + T)/2,) * n
        w_m for m >= 0.
    odd_axes : sequence of int or None
        The coordinate in which each weight is odd; None if it is even in all.
    sources, targets : int
        S and T, both odd.
    """

    def __init__(
        self,
        weights: Sequence[np.ndarray],
        odd_axes: Sequence[int | None],
        sources: int,
        targets: int,
    ) -> None:
        dim = weights[0].ndim
        self._dim, self._sources, self._targets = dim, sources, targets
        length = transform_length(max(_SHORTEST, sources + targets - 1))
        half = length // 2 + 1
        self._symbols = [_symbol(w, odd, length) for w, odd in zip(weights, odd_axes, strict=True)]
        self._odd_axes = [_axis_of_three(odd, dim) for odd in odd_axes]
        # Where the sources begin, and where the results begin: one of the two cubes begins at 0.
        self._from = max(0, (targets - sources) // 2)
        self._to = max(0, (sources - targets) // 2)

        self._line = pyfftw.zeros_aligned((ROWS, length))
        self._line_spectrum = pyfftw.empty_aligned((ROWS, half), dtype=complex)
        self._forward_line, self._backward_line = line_plans(self._line, self._line_spectrum)
        lines = (length,) * (dim - 1)
        self._block = pyfftw.zeros_aligned((*lines, COLUMNS), dtype=complex)
        self._product = pyfftw.empty_aligned((*lines, COLUMNS), dtype=complex)
        self._forward_block = _plans(self._block, self._from, sources, "FFTW_FORWARD")
        self._backward_block = _plans(self._product, self._to, targets, "FFTW_BACKWARD")[::-1]

        wave_numbers = -(-half // COLUMNS) * COLUMNS
        self._spectrum = np.zeros((*(sources,) * (dim - 1), wave_numbers), dtype=complex)
        # The first result takes the place of the sources: wave numbers are copied before they are overwritten.
        self._spectra = [
            self._spectrum
            if sources == targets and not number
            else np.zeros((*(targets,) * (dim - 1), wave_numbers), dtype=complex)
            for number in range(len(weights))
        ]
        self._half = half
        self._out = np.empty((len(weights), *(targets,) * dim))

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """Return the sums, shape (weights, T, .., T): a buffer that the next call overwrites.

        Parameters
        ----------
        u : array, shape (S, .., S)
        """
        self._transform_lines(u)
        held = (slice(self._from, self._from + self._sources),) * (self._dim - 1)
        wanted = (slice(self._to, self._to + self._targets),) * (self._dim - 1)
        for first in range(0, self._half, COLUMNS):
            columns = slice(first, first + COLUMNS)
            self._block.fill(0.0)
            self._block[held] = self._spectrum[..., columns]
            for plan in self._forward_block:
                plan.execute()
            for symbol, odd, spectrum in zip(
                self._symbols, self._odd_axes, self._spectra, strict=True
            ):
                _multiply(
                    _as_planes(self._block),
                    _as_planes(symbol)[..., columns],
                    odd,
                    _as_planes(self._product),
                )
                for plan in self._backward_block:
                    plan.execute()
                spectrum[..., columns] = self._product[wanted]
        for spectrum, out in zip(self._spectra, self._out, strict=True):
            self._transform_back(spectrum, out)
        return self._out

    def _transform_lines(self, u: np.ndarray) -> None:
        lines = u.reshape(-1, self._sources)
        spectrum = self._spectrum.reshape(-1, self._spectrum.shape[-1])
        self._line.fill(0.0)
        for first in range(0, lines.shape[0], ROWS):
            some = lines[first : first + ROWS]
            self._line[: some.shape[0], self._from : self._from + self._sources] = some
            self._forward_line.execute()
            spectrum[first : first + ROWS, : self._half] = self._line_spectrum[: some.shape[0]]

    def _transform_back(self, spectrum: np.ndarray, out: np.ndarray) -> None:
        spectrum = spectrum.reshape(-1, spectrum.shape[-1])
        lines = out.reshape(-1, self._targets)
        for first in range(0, lines.shape[0], ROWS):
            some = lines[first : first + ROWS]
            self._line_spectrum[: some.shape[0]] = spectrum[first : first + ROWS, : self._half]
            self._backward_line.execute()
            some[:] = self._line[: some.shape[0], self._to : self._to + self._targets]


def _plans(block: np.ndarray, first: int, count: int, direction: str) -> list[pyfftw.FFTW]:
    """Transforms of a block in place, axis by axis from the last; only lines that hold sources are transformed."""
    options = {"direction": direction, "flags": PLAN}
    whole = pyfftw.FFTW(block, block, axes=(0,), **options)
    if block.ndim == 2:
        return [whole]
    planes = block[first : first + count]
    return [pyfftw.FFTW(planes, planes, axes=(1,), **options), whole]


def _symbol(weights: np.ndarray, odd: int | None, length: int) -> np.ndarray:
    """Return the transform of w over L^n for wave numbers 0 .. L/2, by cosine and sine transforms.

    For an even w the transform is real. For an odd w it is imaginary, and its imaginary part is returned. Offsets that
    occur in the transform but not in the sums have weight zero.
    """
    half = length // 2 + 1
    w = np.zeros((half,) * weights.ndim)
    reach = min(weights.shape[0], half)
    part = (slice(0, reach),) * weights.ndim
    w[part] = weights[part]
    for axis in range(weights.ndim):
        if axis == odd:
            inner = (slice(None),) * axis + (slice(1, -1),)
            sines = -dst(w[inner], type=1, axis=axis)
            w = np.zeros_like(w)
            w[inner] = sines
        else:
            w = dct(w, type=1, axis=axis, overwrite_x=True)
    padded = -(-half // COLUMNS) * COLUMNS
    symbol = np.zeros((*(half,) * (weights.ndim - 1), padded))
    symbol[..., :half] = w / float(length) ** weights.ndim
    return symbol


def _as_planes(block: np.ndarray) -> np.ndarray:
    return block if block.ndim == 3 else block[None]


def _axis_of_three(odd: int | None, dim: int) -> int:
    """The axis of `_as_planes` in which a weight is odd; -1 if there is none."""
    return -1 if odd is None else odd + 3 - dim


@njit()
def _multiply(block, symbol, odd, out):
    """out = block times the symbol at the wave number folded into 0 .. L/2; `odd` is an axis, or outside 0 .. 2."""
    planes, rows, columns = block.shape
    for p in range(planes):
        plane = min(p, planes - p)
        sign_p = -1.0 if odd == 0 and plane != p else 1.0
        for q in range(rows):
            row = min(q, rows - q)
            sign = -sign_p if odd == 1 and row != q else sign_p
            for k in range(columns):
                value = sign * symbol[plane, row, k]
                z = block[p, q, k]
                if 0 <= odd <= 2:
                    out[p, q, k] = complex(-z.imag * value, z.real * value)
                else:
                    out[p, q, k] = complex(z.real * value, z.imag * value)


class NaiveBoxConvolution:
    """The sums of `BoxConvolution`, term by term, on all cores; it is the oracle of that class. Same parameters."""

    def __init__(
        self,
        weights: Sequence[np.ndarray],
        odd_axes: Sequence[int | None],
        sources: int,
        targets: int,
    ) -> None:
        self._weights = [np.ascontiguousarray(_as_planes(w), dtype=float) for w in weights]
        self._shift = (targets - sources) // 2
        self._dim = weights[0].ndim
        self._odd_axes = [_axis_of_three(odd, self._dim) for odd in odd_axes]
        self._out = np.empty((len(weights), *(targets,) * self._dim))

    def __call__(self, u: np.ndarray) -> np.ndarray:
        """Return the sums, shape (weights, T, .., T): a buffer that the next call overwrites."""
        flat = self._dim == 2
        for w, odd, out in zip(self._weights, self._odd_axes, self._out, strict=True):
            _sum_over_pairs(_as_planes(u), w, odd, flat, self._shift, _as_planes(out))
        return self._out


@njit(parallel=True)
def _sum_over_pairs(u, weights, odd, flat, shift, out):
    planes, rows, columns = out.shape
    for line in prange(planes * rows):
        p = line // rows
        q = line % rows
        for r in range(columns):
            total = 0.0
            for a in range(u.shape[0]):
                dp = 0 if flat else p - shift - a
                for b in range(u.shape[1]):
                    dq = q - shift - b
                    for c in range(u.shape[2]):
                        dr = r - shift - c
                        w = weights[abs(dp), abs(dq), abs(dr)]
                        if (odd == 0 and dp < 0) or (odd == 1 and dq < 0) or (odd == 2 and dr < 0):
                            w = -w
                        total += w * u[a, b, c]
            out[p, q, r] = total
