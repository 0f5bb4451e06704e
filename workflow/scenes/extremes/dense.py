"""Dense matrices: what an integrator makes of the strengths, whatever they are, and the form of an exchange."""

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.linalg import expm

from fracparticles.run.case import Case
from fracparticles.schemes.spectrum import scheme_matrix
from fracparticles.time import STEP_POLYNOMIALS


def whole(case: Case, **setting: Any) -> np.ndarray:
    """Return exp(A T), by scipy, or p(A dt)^n with the polynomial of the step."""
    a = scheme_matrix(case.scheme, replace(case.setting, **setting))
    if not case.steps:
        return expm(case.span * a)
    return np.linalg.matrix_power(step(a, case.time_step, case.resolved_integrator), case.steps)


def step(a: np.ndarray, dt: float, integrator: str) -> np.ndarray:
    """Return p(A dt) of a step, by Horner's rule."""
    one = p = np.eye(len(a))
    for k in range(STEP_POLYNOMIALS[integrator].stages, 0, -1):
        p = one + dt / k * a @ p
    return p


def exchange(weights: np.ndarray) -> np.ndarray:
    """Return the matrix of sum_j w_ij (u_j - u_i), in which w_ii has no part."""
    others = weights - np.diag(np.diag(weights))
    return others - np.diag(others.sum(axis=1))
