"""The powers by which solutions fall: the gamma_j of |x|^(-n-gamma_j), see `tails`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fracparticles import arguments as check
from fracparticles.errors import InvalidInput

__all__ = ["MOST_TERMS", "SAME", "later_exponents", "powers", "tail_exponents"]

MOST_TERMS = 6
SAME = 1e-9  # exponents nearer to each other than this count as one
# The least distance of an exponent from an even number and from the next exponent. The amplitude of a term that is left
# out is proportional to this distance. The error of six terms in space was measured as 1e-10 / distance of the maximum;
# it is larger near alpha = 2, where all exponents are nearly even and nearly equal.
_NEARLY = 1e-2
_STEEPEST = 30.0  # the largest power of a tail: nothing is left of steeper ones


def tail_exponents(alpha: float, terms: int) -> np.ndarray:
    """Return the first gamma_j of the tails |x|^(-n-gamma_j) of the fundamental solution, also displaced or widened.

    They are j alpha + 2 m with j >= 1, ascending. Those within 0.01 of an even number are left out, since even ones
    belong to no tail; alpha itself may be as near as 1e-9. Of two that differ by less than 0.01 the lower is kept.
    """
    found: list[float] = []
    for e in sorted(j * alpha + 2.0 * m for j in range(1, 2 * terms + 2) for m in range(terms + 1)):
        new = not found or e - found[-1] >= _NEARLY
        if new and _from_even(e) >= (SAME if e == alpha else _NEARLY):
            found.append(e)
    return np.array(found[:terms])


def powers(tail: Sequence[float], dim: int) -> np.ndarray:
    """Return the gamma of the powers p = n + gamma by which the user says that the data fall.

    Raises
    ------
    InvalidInput
        If there are more than six powers, or if one is not above n, is n plus an even integer, or is above 30.
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
    """Return the gamma, ascending up to `greatest`, by which a solution falls whose data fell by the gamma `before`.

    They are the gamma of the data, and the 0, 2, 4 of the moments, plus j alpha, without the even ones, which belong
    to no tail.
    """
    starts, most = [0.0, 2.0, 4.0, *before], int(greatest / alpha) + 1
    found: list[float] = []
    for exponent in sorted(start + j * alpha for start in starts for j in range(most + 1)):
        new = not found or exponent - found[-1] > SAME
        if new and exponent <= greatest + SAME and _from_even(exponent) >= SAME:
            found.append(exponent)
    return np.array(found)
