"""How a sum over the particles is done.

On a lattice every sum of the papers is a discrete convolution,

    y_i = sum_j w_{i-j} u_j,

and there are two ways to do it: `FourierConvolution`, O(N log N), and `NaiveConvolution`, the papers'
own double loop, O(N^2), which is the oracle of the first. `BandedConvolution` serves the kernels that
decay like a Gaussian.
"""

from __future__ import annotations

from fracparticles.sums.banded import BandedConvolution
from fracparticles.sums.fourier import FourierConvolution, valid_convolution
from fracparticles.sums.naive import NaiveConvolution

__all__ = [
    "SUMMATIONS",
    "BandedConvolution",
    "FourierConvolution",
    "NaiveConvolution",
    "valid_convolution",
]

SUMMATIONS: dict[str, type[FourierConvolution] | type[NaiveConvolution]] = {
    "fft": FourierConvolution,
    "naive": NaiveConvolution,
}
