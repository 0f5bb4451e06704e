"""Moments of a kernel: over the line (16), over the points of a lattice (28), and of the Gaussian in closed form."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from fracparticles import arguments as check
from fracparticles.arguments import FloatArray
from fracparticles.errors import AccuracyWarning, InvalidInput
from fracparticles.pse.shapes import Kernel, kernel_of

__all__ = ["absolute_moment", "gaussian_moment", "lattice_moment", "moment", "nodes_and_weights"]
_BEYOND = 4.0  # radii beyond the reach of a kernel, to which its moments are integrated
_HIGHEST = 60  # order of a moment: z^60 exp(-z^2) is below 1e-16 of its maximum farther away
_SCANNED = 4096  # points; from one to the next a kernel changes its sign at most once
_MOST_POINTS = 2**26  # of lattices
ENOUGH = 0.25  # share of a moment: with less, or with more than its inverse, the result is wrong

# For pieces of length 1: exact for the splines, and to round-off for exp(-z^2) times a polynomial of degree 30.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


def nodes_and_weights(
    kernel: Kernel, breaks: Sequence[float] = ()
) -> tuple[FloatArray, FloatArray]:
    """Return nodes and weights of a Gauss rule, piece by piece, on [-reach, reach] and a little more.

    Beyond its reach a Gaussian is below round-off, but z^k times it is not. `breaks` are places besides those of the
    kernel where the integrand is not smooth.

    Raises `InvalidInput` if the kernel is not one-dimensional.
    """
    kernel = kernel_of(1, kernel)
    inside = [-kernel.reach, *kernel.breaks, kernel.reach]
    ends = [inside[0] - _BEYOND, *inside, inside[-1] + _BEYOND]
    ends = sorted({*ends, *breaks}) if len(breaks) else ends
    edges = np.concatenate(
        [np.linspace(a, b, int(np.ceil(b - a)) + 1)[:-1] for a, b in pairwise(ends)] + [ends[-1:]]
    )
    half = 0.5 * np.diff(edges)[:, None]
    middle = 0.5 * (edges[1:] + edges[:-1])[:, None]
    return (middle + half * _NODES).ravel(), (half * _WEIGHTS).ravel()


def moment(kernel: Kernel, k: int) -> float:
    """M_k = int z^k eta(z) dz  (16), k <= 60, by a Gauss rule on each piece of the kernel.

    Raises `InvalidInput` if k is not a whole number from 0 to 60, or the kernel is not one-dimensional and known
    everywhere.
    """
    k = check.whole_number("k", k, most=_HIGHEST)
    z, w = nodes_and_weights(kernel)
    return float(w @ (z**k * kernel(z)))


def absolute_moment(kernel: Kernel, k: int) -> float:
    """int |z^k eta(z)| dz, k <= 60: the scale against which an error of M_k is judged.

    Errors as for `moment`.
    """
    k = check.whole_number("k", k, most=_HIGHEST)
    z, w = nodes_and_weights(kernel, _sign_changes(kernel_of(1, kernel)))
    return float(w @ np.abs(z**k * kernel(z)))


def _sign_changes(kernel: Kernel) -> list[float]:
    """Zero and the places where eta changes its sign: |z^k eta| is smooth between them."""
    z = np.linspace(-kernel.reach, kernel.reach, _SCANNED)
    sign = np.sign(kernel(z))
    z, sign = z[sign != 0.0], sign[sign != 0.0]
    i = np.flatnonzero(sign[1:] != sign[:-1])
    low, high, left = z[i], z[i + 1], sign[i]
    for _ in range(60):
        middle = 0.5 * (low + high)
        before = np.sign(kernel(middle)) == left
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return [0.0, *low.tolist()]


def lattice_moment(
    kernel: Kernel, k: int, overlap: ArrayLike = 1.0, offset: float = 0.0
) -> FloatArray:
    """M^_k = (1/s) sum_i z_i^k eta(z_i), z_i = (i + offset) / s: the value of M_k that the particles of a lattice give.

    Errors as for `moment`; also if an overlap is not positive, or is so large that a kernel holds too many particles.

    Parameters
    ----------
    kernel : Kernel
        eta.
    k : int
        Order of the moment, at most 60.
    overlap : array_like
        s = eps / h, positive; s = 1 is (28). The result has its shape.
    offset : float
        Distance of the point from the lattice, in h; adding a whole number changes nothing.
    """
    kernel, k = kernel_of(1, kernel), check.whole_number("k", k, most=_HIGHEST)
    s = check.within("overlap", overlap, 0.0, inside=True)
    offset = check.finite_real("offset", offset)
    if abs(offset) > 1.0:
        offset -= round(offset)
    reached = (kernel.reach + _BEYOND) * s.max(initial=0.0)
    if not 2.0 * reached * max(s.size, 1) < _MOST_POINTS:
        allowed = f"at most {_MOST_POINTS} points of lattices"
        raise InvalidInput("overlap", overlap, allowed, "Take smaller ones.")
    n = int(np.ceil(reached)) + 1
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        z = (np.arange(-n, n + 1) + offset) / s[..., None]
        # Far beyond the reach z^k may overflow where eta is 0.
        eta = kernel(z)
        return check.finite_result(
            "overlap", (np.where(eta == 0.0, 0.0, z) ** k * eta).sum(axis=-1) / s
        )


def warn_of_moment(found: FloatArray, places: str, stacklevel: int) -> None:
    """Warn if particles give less than a quarter of the moment that an operator needs, or more than four times as much.

    At the end of a row of particles they give a half.

    Parameters
    ----------
    found : array, shape (M,)
        The moment at each place over its right value.
    places : str
        The name of these places in the message.
    stacklevel : int
        As of `warnings.warn`, for the caller.

    Warns
    -----
    AccuracyWarning
        Says at how many places, and the least and the greatest moment.
    """
    off = (found < ENOUGH) | (found > 1.0 / ENOUGH)
    if off.any():
        warnings.warn(
            f"at {np.count_nonzero(off)} of {off.size} {places} the particles nearby make from {found.min():.2g} to "
            f"{found.max():.2g} of the moment of the kernel that must be 1: the result is wrong there by this factor. "
            "Take a larger epsilon, or volumes that belong to the positions.",
            AccuracyWarning,
            stacklevel=stacklevel + 1,
        )


def gaussian_moment(k: int, dim: int = 1) -> Fraction:
    """int |z|^k pi^(-d/2) exp(-z^2) dz = (d/2) (d/2 + 1) ... (d/2 + k/2 - 1) for even k, 0 for odd k.

    Raises `InvalidInput` if k is not a whole number from 0 to 1000, or the dimension is not 1, 2 or 3.
    """
    k, dim = check.whole_number("k", k, most=1000), check.dimension(dim)
    if k % 2:
        return Fraction(0)
    product = Fraction(1)
    for j in range(k // 2):
        product *= Fraction(dim, 2) + j
    return product
