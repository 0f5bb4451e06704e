"""Operations and memory of a scheme in a box, n = 2 and 3, with sums by transforms, see `lattice.box`."""

from __future__ import annotations

from math import log2

from fracparticles.lattice.banded import BandedConvolution
from fracparticles.lattice.box import COLUMNS, ROWS
from fracparticles.lattice.fourier import transform_length
from fracparticles.schemes.setting import Setting

__all__ = ["bytes_kept", "operations"]

_VECTORS = 5  # strengths at t_initial and t_final, and three of the Chebyshev recurrence


def operations(name: str, setting: Setting) -> float:
    """Return the floating-point operations of one application on N^n particles, to leading order.

    A real transform of length L >= 2 N - 1 takes 5/2 L log2 L operations, and a complex one twice as many. There is one
    forward transform, and one backward for each weight. Only lines that hold values are transformed: N^(n-1) along the
    last axis, then half as many wave numbers and L / N times as many lines with each axis that follows. FPSE has n
    weights. The sums of its divergence, axis by axis, take 3 M operations for a half band M.
    """
    dim, size, is_flux = setting.dim, setting.size, name == "FPSE"
    length, half = _lengths(size)
    line = 2.5 * length * log2(length)
    transform = size ** (dim - 1) * line
    for axis in range(1, dim):
        transform += half * size ** (dim - 1 - axis) * length ** (axis - 1) * 2.0 * line
    weights = dim if is_flux else 1
    total = (1 + weights) * transform + 2.0 * weights * half * length ** (dim - 1)
    if is_flux:
        # Every factor is a Gaussian of width epsilon times a polynomial; order IV is a sum of products.
        passes = dim * (dim if setting.order == 2 else 2 + 3 * (dim - 1))
        total += passes * 3.0 * BandedConvolution.reach(setting.overlap, 2) * size**dim
    return total


def bytes_kept(name: str, setting: Setting) -> float:
    """Return the memory that a run keeps after its set-up: the arrays of the sums and of the series, in bytes."""
    dim, size, is_flux = setting.dim, setting.size, name == "FPSE"
    weights = dim if is_flux else 1
    length, half = _lengths(size)
    columns = -(-half // COLUMNS) * COLUMNS
    symbols = weights * half ** (dim - 1) * columns
    # The spectrum of the first sum takes the place of that of the strengths.
    spectra = 2 * weights * size ** (dim - 1) * columns
    blocks = 4 * length ** (dim - 1) * COLUMNS + ROWS * (length + 2 * half)
    # The exterior has four sums, on the part of the lattice where no coordinate is negative.
    beyond = 4.0 / 2**dim if setting.is_open else 0.0
    vectors = weights + _VECTORS + beyond  # the sums themselves
    diagonal = 0 if setting.is_open and is_flux else weights
    divergence = (3 if setting.order == 2 else 5) if is_flux else 0
    return 8.0 * (symbols + spectra + blocks + (vectors + diagonal + divergence) * size**dim)


def _lengths(size: int) -> tuple[int, int]:
    """The length of the transforms along an axis, and the number of wave numbers that are kept."""
    length = transform_length(2 * size - 1)
    return length, length // 2 + 1
