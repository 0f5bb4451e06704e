"""How a sum over the particles is done.

On a lattice every sum of the papers is a discrete convolution,

    y_i = sum_j w_{i-j} u_j,

and there are two ways to do it: `FourierConvolution`, O(N log N), and `NaiveConvolution`, the papers'
own double loop, O(N^2), which is the oracle of the first; `BoxConvolution` and `NaiveBoxConvolution` on a square
or cubic lattice. `BandedConvolution` serves the kernels that decay like a Gaussian.

Over particles that lie anywhere: `scattered`.
"""

from __future__ import annotations

from fracparticles.sums.banded import BandedConvolution
from fracparticles.sums.box import BOX_SUMMATIONS, BoxConvolution, NaiveBoxConvolution
from fracparticles.sums.fourier import FourierConvolution, valid_convolution
from fracparticles.sums.naive import NaiveConvolution
from fracparticles.sums.scattered import (
    NaiveScatteredSum,
    NeighbourSum,
    NonuniformFourierSum,
    ScatteredKernel,
    ScatteredSum,
    scattered_sum,
    smooth_kernel,
)

__all__ = [
    "BOX_SUMMATIONS",
    "SUMMATIONS",
    "BandedConvolution",
    "BoxConvolution",
    "FourierConvolution",
    "NaiveBoxConvolution",
    "NaiveConvolution",
    "NaiveScatteredSum",
    "NeighbourSum",
    "NonuniformFourierSum",
    "ScatteredKernel",
    "ScatteredSum",
    "scattered_sum",
    "smooth_kernel",
    "valid_convolution",
]

SUMMATIONS: dict[str, type[FourierConvolution] | type[NaiveConvolution]] = {
    "fft": FourierConvolution,
    "naive": NaiveConvolution,
}
