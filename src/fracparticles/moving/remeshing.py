r"""Redistribution of scattered particles onto the lattice x_p = p h:

    U_p = sum_j U_j W((x_p - x_j) / h),

with an interpolation function W of two spacings' reach, or four: every particle is split among four lattice points, or
eight. The lattice goes on as far as that takes, so that moments are conserved whatever the positions:

- `M4'`: 1 - 5/2 r^2 + 3/2 r^3 for r = |x| <= 1, (2 - r)^2 (1 - r) / 2 for 1 <= r <= 2. Continuous slope; keeps
  sum_j U_j x_j^m for m = 0, 1, 2. Monaghan, J. Comput. Phys. 60 (1985) 253.
- `Lambda3`: (1 - r^2) (2 - r) / 2 for r <= 1, (1 - r) (2 - r) (3 - r) / 6 for 1 <= r <= 2: cubic Lagrange
  interpolation through four points (Everett's formula). Continuous, its slope is not; keeps m = 0, 1, 2, 3.
  Cottet & Koumoutsakos, Vortex Methods (Cambridge University Press, 2000), Section 7.2; in the spirit of
  Schoenberg, Quart. Appl. Math. 4 (1946) 45, who asked which W reproduce polynomials.

- `Lambda6,4`: of degree 9 between the lattice points, four spacings to either side. There its derivatives up to the
  fourth are those of the central differences of seven points, and so continuous; keeps m = 0, .., 6. Cottet,
  Etancelin, Perignon & Picard, ESAIM: M2AN 48 (2014) 1029.

All turn negative somewhere: remeshed strengths can have either sign.

What a remeshing leaves behind: particles rho h apart that represent a constant come back with strengths that are not,

    U_p / U = (1 / rho) sum_m W^(2 pi m / rho) exp(2 pi i p m / rho),

and of these waves the long ones, m (1 - 1 / rho) << 1, stay. W^ vanishes at 2 pi m, of an order that its moments say,
but far out only its smoothness makes it small: with a corner, W^ ~ m^-2, they add up to a defect of some per cent of
the strengths wherever a particle meets a lattice point. For rho = 1.05 the greatest is 3 % with M4', 4 % with Lambda3
and 1e-5 with Lambda6,4.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from fracparticles import arguments as check
from fracparticles._compiled import njit
from fracparticles.errors import InvalidInput

__all__ = ["REMESHINGS", "Elimination", "eliminate", "interpolation_function", "remesh"]

REACH = {"M4'": 2, "Lambda3": 2, "Lambda6,4": 4}  # of W to either side, in spacings
REMESHINGS = tuple(REACH)
# Of Lambda6,4 between k and k + 1: the coefficients of the powers of r - k, times 720.
_SIX_FOUR = [
    [720, 0, -980, 0, 280, -17605, 60145, -78085, 45675, -10150],
    [0, -540, 540, 195, -195, 10548, -36084, 46851, -27405, 6090],
    [0, 108, -54, -120, 60, -3509, 12027, -15617, 9135, -2030],
    [0, -12, 4, 15, -5, 500, -1718, 2231, -1305, 290],
]
# The same of the powers of k + 1 - r: about the nearer end no digits are lost.
_BACKWARDS = [
    [(-1) ** m * sum(math.comb(n, m) * row[n] for n in range(m, 10)) for m in range(10)]
    for row in _SIX_FOUR
]
_NINTH = np.array([_SIX_FOUR, _BACKWARDS], dtype=float)
# Lattice points from the origin: beyond, places are rounded by more than 1e-7 of a spacing.
_FARTHEST = 2**31
_MOST_POINTS = 2**26  # between the particles: one farther out has run away
ULPS = 2.0 * float(np.finfo(float).eps)


@dataclass(frozen=True)
class Elimination:
    """Particles that were kept, and what was left out.

    Attributes
    ----------
    x, strength : array, shape (N,)
        The particles kept.
    count : int
        How many particles were left out, not counting those of no strength at all.
    eliminated : float
        Their total strength: the total before less the total after.
    """

    x: np.ndarray
    strength: np.ndarray
    count: int
    eliminated: float


def interpolation_function(name: str, r: Any) -> np.ndarray:
    """Return W(r) at signed distances r, in spacings.

    Raises `InvalidInput` if there is no interpolation function of that name, or r is not real.
    """
    return np.asarray(check.elementwise(_weights, check.real_array("r", r), _index(name)))


def eliminate(x: Any, strength: Any, threshold: float) -> Elimination:
    """Leave out the particles with |U_i| <= threshold max_j |U_j|.

    With threshold 0 those of no strength at all, which also means that it underflowed.

    Raises `InvalidInput` if the arrays do not fit together or are not finite, the threshold is not in [0, 1), no
    particle has any strength, or the total overflows.
    """
    x = check.positions("x", x, least=0)
    strength = check.vector("strength", strength, x.size, least=0)
    below_one = float(np.nextafter(1.0, 0.0))
    check.real_between("threshold", threshold, 0.0, below_one, remedy="Give a small fraction.")
    size = np.abs(strength)
    largest = size.max(initial=0.0)
    if not largest > 0.0:
        allowed = "at least one strength other than zero"
        remedy = "Check the initial data, and whether they underflow."
        raise InvalidInput("strength", "no particle with a strength", allowed, remedy)
    kept = size > threshold * largest
    if kept.all():
        return Elimination(x, strength, 0, 0.0)
    gone = strength[~kept]
    return Elimination(x[kept], strength[kept], int(np.count_nonzero(gone)), total_of(gone))


def total_of(strength: np.ndarray) -> float:
    """Return the sum of strengths.

    Raises `InvalidInput` if it overflows.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        return float(check.finite_result("strength", strength.sum()))


def remesh(x: Any, strength: Any, spacing: float, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and strengths on the lattice x_p = p h, as far as the particles reach.

    From as far before the first particle's cell as W reaches to as far after the last's, strengths of zero included.
    Particles on the lattice keep their strengths to the last bit.

    Raises `InvalidInput` if the function does not exist, the arrays are empty, not finite or do not fit together, or a
    particle lies so far out that the lattice would not fit into memory.

    Parameters
    ----------
    x, strength : array, shape (N,)
        Particles in any order; they may coincide.
    spacing : float
        Lattice spacing h.
    name : {"M4'", "Lambda3", "Lambda6,4"}
        Interpolation function.
    """
    which, spacing = _index(name), check.scale("spacing", spacing)
    x = check.positions("x", x)
    strength = check.vector("strength", strength, x.size)
    cell = x / spacing
    low, high = cell.min(), cell.max()
    shown = f"particles from {x.min():.6g} to {x.max():.6g}"
    if not high - low < _MOST_POINTS:
        allowed = f"particles less than {_MOST_POINTS * spacing:.4g} apart, for a lattice of the spacing {spacing:.4g}"
        raise InvalidInput("x", shown, allowed, "Look for a particle that ran away.")
    if not (abs(low) < _FARTHEST and abs(high) < _FARTHEST):
        allowed = f"places nearer to zero than {_FARTHEST * spacing:.4g}, for a lattice of the spacing {spacing:.4g}"
        raise InvalidInput("x", shown, allowed, "Move the origin.")
    reach = REACH[name]
    first = int(np.floor(low)) + 1 - reach
    total = np.zeros(int(np.floor(high)) + reach + 1 - first)
    _distribute(cell, strength, first, which, reach, total)
    return np.arange(first, first + total.size) * spacing, check.finite_result("strength", total)


def _index(name: str) -> int:
    return REMESHINGS.index(check.choice("remeshing", name, REMESHINGS))


@njit(inline="always")
def _weight(r, which):
    if which == 2:
        if r >= 4.0:
            return 0.0
        k = int(r)
        side = int(r - k > 0.5)
        distance, value = abs(r - (k + side)), 0.0
        for power in range(9, -1, -1):
            value = value * distance + _NINTH[side, k, power]
        return value / 720.0
    if r >= 2.0:
        return 0.0
    if which == 0:
        if r <= 1.0:
            return 1.0 - r * r * (2.5 - 1.5 * r)
        return 0.5 * (2.0 - r) ** 2 * (1.0 - r)
    if r <= 1.0:
        return 0.5 * (1.0 - r * r) * (2.0 - r)
    return (1.0 - r) * (2.0 - r) * (3.0 - r) / 6.0


@njit()
def _weights(r, which, out):
    for i in range(r.size):
        out[i] = _weight(abs(r[i]), which)


@njit()
def _distribute(cell, strength, first, which, reach, total):
    for j in range(cell.size):
        left = np.floor(cell[j])
        fraction = cell[j] - left
        # p h / h may miss p by an ulp, which would leak a little to the neighbours of p each time.
        slack = ULPS * abs(cell[j])
        if fraction <= slack:
            fraction = 0.0
        elif fraction >= 1.0 - slack:
            fraction = 1.0
        p = int(left) - first
        for a in range(reach):
            total[p - a] += strength[j] * _weight(a + fraction, which)
            total[p + 1 + a] += strength[j] * _weight((a + 1.0) - fraction, which)
