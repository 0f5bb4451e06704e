"""The field (7) of strengths on a lattice."""

from __future__ import annotations

import numpy as np

from fracparticles.lattice.banded import BandedConvolution

__all__ = ["smoothed_field"]


def smoothed_field(u: np.ndarray, overlap: float) -> np.ndarray:
    """Return u_epsilon of (7) on the lattice, the strengths smoothed with the Gaussian (8), in the shape of u.

    It is sum_j V_j u_j eta_epsilon(x_i - x_j) over the particles present, with eta_m = (s sqrt(pi))^-1 exp(-m^2 / s^2)
    along each axis.

    Parameters
    ----------
    u : array, shape (N,) * dim
        The strengths.
    overlap : float
        s = epsilon / h.
    """
    m = np.arange(BandedConvolution.reach(overlap, 2) + 1) / overlap
    smooth = BandedConvolution(np.exp(-m * m) / (overlap * np.sqrt(np.pi)), parity=1)
    for axis, count in enumerate(u.shape):
        u = smooth.along(u, axis, count)
    return u
