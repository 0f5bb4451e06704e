"""Time integration of du/dt = A u with a constant operator A.

An explicit Runge-Kutta scheme multiplies the solution by its step polynomial p(A dt) (Eq. 52); n steps give
p(A dt)^n u0. `stepping` takes these steps one by one. `chebyshev` evaluates the same polynomial, or the exponential
exp(A t), as one Chebyshev series on the interval that holds the spectrum of A. `pieces` uses several series where one
would lose digits.
`snapshots` does this for several output times at once.
"""

from __future__ import annotations

from fracparticles.time.chebyshev import ChebyshevSeries, exponential, power
from fracparticles.time.pieces import Flow, exponential_flow, power_flow
from fracparticles.time.polynomial import STEP_POLYNOMIALS, StepPolynomial
from fracparticles.time.snapshots import Snapshots, exponential_snapshots, march, power_snapshots
from fracparticles.time.stepping import single_pass, step

__all__ = [
    "STEP_POLYNOMIALS",
    "ChebyshevSeries",
    "Flow",
    "Snapshots",
    "StepPolynomial",
    "exponential",
    "exponential_flow",
    "exponential_snapshots",
    "march",
    "power",
    "power_flow",
    "power_snapshots",
    "single_pass",
    "step",
]
