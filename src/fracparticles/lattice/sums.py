"""How a sum over the particles is done.

On a lattice every sum of the papers is a discrete convolution,

    y_i = sum_j w_{i-j} u_j,

and there are two ways to do it: `fast_convolution`, O(N log N), which is a `FourierConvolution`, for few particles a
`MatrixConvolution`, and `NaiveConvolution`, the papers' own double loop, O(N^2), which is the oracle of the first;
`BoxConvolution` and `NaiveBoxConvolution` on a square or cubic lattice. `BandedConvolution` serves the kernels that
decay like a Gaussian.

Over particles that lie anywhere: `scattered`.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fracparticles.lattice.banded import BandedConvolution
from fracparticles.lattice.box import BOX_SUMMATIONS, BoxConvolution, NaiveBoxConvolution
from fracparticles.lattice.fourier import FourierConvolution, valid_convolution
from fracparticles.lattice.matrix import MatrixConvolution
from fracparticles.lattice.naive import NaiveConvolution
from fracparticles.moving.scattered import (
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
    "MatrixConvolution",
    "NaiveBoxConvolution",
    "NaiveConvolution",
    "NaiveScatteredSum",
    "NeighbourSum",
    "NonuniformFourierSum",
    "ScatteredKernel",
    "ScatteredSum",
    "fast_convolution",
    "scattered_sum",
    "smooth_kernel",
    "valid_convolution",
]

# Up to about here a product with a matrix takes no longer than two transforms, and it is set up in some ten
# microseconds, where their plans take a millisecond.
_FEW = 150

_Convolution = FourierConvolution | MatrixConvolution | NaiveConvolution


def fast_convolution(
    weights: np.ndarray, size: int, parity: int = 1, pad: int = 0
) -> FourierConvolution | MatrixConvolution:
    """Return the faster sum of `size` particles; see `FourierConvolution` for the parameters."""
    kind = MatrixConvolution if size <= _FEW else FourierConvolution
    return kind(weights, size, parity, pad)


SUMMATIONS: dict[str, Callable[..., _Convolution]] = {
    "fft": fast_convolution,
    "naive": NaiveConvolution,
}
