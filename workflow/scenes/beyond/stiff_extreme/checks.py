"""A check of a stiff or extreme case, and the runs and limits that checks are made of."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from fracparticles import time as integrators
from fracparticles.errors import AccuracyWarning, StabilityWarning
from fracparticles.run.case import Case
from fracparticles.run.solution import Solution
from fracparticles.run.solver import compute
from fracparticles.schemes import SCHEMES, Setting
from fracparticles.schemes.spectrum import dense_matrix

__all__ = [
    "BLOWS_UP",
    "OK",
    "RK2",
    "SAME",
    "SCHEMES_SHOWN",
    "UNEXPECTED",
    "Base",
    "Check",
    "computed",
    "falls_four_times",
    "largest_difference",
    "matrix_of",
    "same",
    "stable_step",
]

SCHEMES_SHOWN = ("DD", "FPSE", "KPSE")
RK2 = integrators.STEP_POLYNOMIALS["rk2"]
# The round-off of a run adds up over some thousand operations on quantities of the size of the largest strength.
SAME = 1e-10

Base = dict[str, float]
# Case, what is expected, what was found, whether they agree; the verdict if they do, unless it is OK.
Check = tuple[Any, ...]
OK, BLOWS_UP, UNEXPECTED = "ok", "blows up as predicted", "not as expected"


def same(case: str, expected: str, u: np.ndarray, v: np.ndarray, of: str = "peak") -> Check:
    """Return the check that u is v to round-off."""
    difference = largest_difference(u, v)
    found = f"largest difference {difference:.1e} of the {of}"
    return case, expected, found, difference < SAME


def falls_four_times(case: str, expected: str, errors: list[float]) -> Check:
    """Return the check of second order, for h halved."""
    ratio = errors[0] / errors[1]
    found = f"{errors[0]:.2e} to {errors[1]:.2e}, {ratio:.2f} times"
    return case, expected, found, abs(ratio - 4.0) < 0.4


def computed(initial: Any = None, **fields: Any) -> Solution:
    """Compute a case whose step may be unstable, and whose data rough, on purpose."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", StabilityWarning)
        warnings.simplefilter("ignore", AccuracyWarning)
        return compute(Case(store="metrics", **fields), initial)


def stable_step(scheme: str, **fields: Any) -> float:
    """Return the largest stable step of a case, (54)."""
    return Case(scheme=scheme, dt=1e-6, **fields).largest_stable_step


def matrix_of(setting: Setting, scheme: str) -> np.ndarray:
    """Return the matrix A of a scheme."""
    return dense_matrix(SCHEMES[scheme].operator(setting))


def largest_difference(a: np.ndarray, b: np.ndarray) -> float:
    """Return max |a - b| / max |b|."""
    return float(np.abs(a - b).max() / np.abs(b).max())
