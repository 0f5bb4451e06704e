"""A run as one dense matrix: what its integrator makes of the strengths, whatever they are."""

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.linalg import expm

from fracparticles.run.case import Case
from fracparticles.schemes.spectrum import scheme_matrix
from fracparticles.time import STEP_POLYNOMIALS


def whole(case: Case, **setting: Any) -> np.ndarray:
    """Return exp(A T), by scipy, or p(A dt)^n with the polynomial of the step, by Horner's rule."""
    a = scheme_matrix(case.scheme, replace(case.setting, **setting))
    if not case.steps:
        return expm(case.span * a)
    one = p = np.eye(len(a))
    for k in range(STEP_POLYNOMIALS[case.resolved_integrator].stages, 0, -1):
        p = one + case.time_step / k * a @ p
    return np.linalg.matrix_power(p, case.steps)
