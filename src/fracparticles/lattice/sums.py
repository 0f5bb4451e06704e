"""The sums over the particles, and the choice between the ways to compute them.

On a lattice every sum of the papers is a discrete convolution,

    y_i = sum_j w_{i-j} u_j,

and there are two ways to compute it. `fast_convolution`, O(N log N), is a `FourierConvolution`, or for few particles
a `MatrixConvolution`. `NaiveConvolution`, O(N^2), is the papers' own double loop and the oracle of the fast one. On a
square or cubic lattice the two are `BoxConvolution` and `NaiveBoxConvolution`. `BandedConvolution` serves kernels that
decay like a Gaussian.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fracparticles.lattice.box import BoxConvolution, NaiveBoxConvolution
from fracparticles.lattice.direct import MatrixConvolution, NaiveConvolution
from fracparticles.lattice.fourier import FourierConvolution

__all__ = ["BOX_SUMMATIONS", "SUMMATIONS", "fast_convolution", "sums_of_weights"]

# Particles up to which a product with a matrix takes no longer than two transforms. The matrix is set up in some ten
# microseconds, the plans of the transforms in a millisecond.
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
BOX_SUMMATIONS: dict[str, type[BoxConvolution] | type[NaiveBoxConvolution]] = {
    "fft": BoxConvolution,
    "naive": NaiveBoxConvolution,
}


def sums_of_weights(w: np.ndarray, parity: int, size: int) -> np.ndarray:
    """Return sum_j w_{i-j} over the particles present for each of the `size` particles, shape (size,).

    The weights are added up from the small far ones to the large near ones, to lose no digits. Weights that are not
    given are zero.
    """
    tail = np.zeros(size)
    tail[1 : w.size] = w[1:size]
    one_sided = np.cumsum(tail)
    return w[0] * (1 + parity) / 2 + parity * one_sided[::-1] + one_sided
