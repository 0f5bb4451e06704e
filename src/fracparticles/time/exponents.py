"""The powers by which solutions fall: the gamma_j of |x|^(-n-gamma_j), see `tails`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fracparticles import arguments as check
from fracparticles.errors import InvalidInput

__all__ = ["MOST_TERMS", "SAME", "later_exponents", "powers", "tail_exponents"]

MOST_TERMS = 6
SAME = 1e-9  # exponents nearer than this are one
# Measured: six terms in space leave 1e-10 / distance of the maximum, and more near two, where all are nearly even and
# nearly one. The amplitude of a term that is left out is proportional to the distance.
_NEARLY = 1e-2
_STEEPEST = 30.0  # power of a tail: of steeper ones nothing is left


def tail_exponents(alpha: float, terms: int) -> np.ndarray:
    """Return the first gamma_j of the tail |x|^(-n-gamma_j) of the fundamental solution and what is moved or widened.

    They are j alpha + 2 m with j >= 1, ascending, but for those that are even, which belong to no tail, or within 0.01
    of it; alpha itself may be as near as 1e-9. Of two that are nearly one there is the lower.
    """
    found: list[float] = []
    for e in sorted(j * alpha + 2.0 * m for j in range(1, 2 * terms + 2) for m in range(terms + 1)):
        new = not found or e - found[-1] >= _NEARLY
        if new and _from_even(e) >= (SAME if e == alpha else _NEARLY):
            found.append(e)
    return np.array(found[:terms])


def powers(tail: Sequence[float], dim: int) -> np.ndarray:
    """Return the gamma of the powers p = n + gamma by which somebody's data fall.

    Raises
    ------
    InvalidInput
        If there are more than six, or one is not above n, is n plus an even integer, or above 30.
    """
    exponents = check.vector("tail", tail, least=0) - dim
    good = (exponents > 0.0) & (exponents + dim <= _STEEPEST)
    if (
        exponents.size > MOST_TERMS
        or not good.all()
        or min(map(_from_even, exponents), default=1.0) < SAME
    ):
        allowed = f"at most {MOST_TERMS} powers from {dim} to {_STEEPEST:g}, none of them {dim} plus an even integer"
        remedy = "Leave it out, or take a wide lattice with terms=0."
        raise InvalidInput("tail", tail, allowed, remedy)
    return exponents


def _from_even(exponent: float) -> float:
    """Return the distance to the nearest even integer."""
    return abs(exponent - 2.0 * round(0.5 * exponent))


def later_exponents(
    before: Sequence[float] | np.ndarray, alpha: float, greatest: float
) -> np.ndarray:
    """Return the gamma up to the greatest by which a solution falls whose data fell by those before, ascending.

    They are j alpha more than those, or than the 0, 2, 4 of the moments, but for even ones, which belong to no tail.
    """
    starts, most = [0.0, 2.0, 4.0, *before], int(greatest / alpha) + 1
    found: list[float] = []
    for exponent in sorted(start + j * alpha for start in starts for j in range(most + 1)):
        new = not found or exponent - found[-1] > SAME
        if new and exponent <= greatest + SAME and _from_even(exponent) >= SAME:
            found.append(exponent)
    return np.array(found)
