"""A warning if waves grow in a run, from the symbol, the eigenvalues of the operator, and the steps."""

from __future__ import annotations

import warnings

import numpy as np

from fracparticles.errors import StabilityWarning
from fracparticles.lattice.operators import LatticeOperator
from fracparticles.run.case import Case
from fracparticles.schemes.spectrum import eigenvalue_bounds
from fracparticles.schemes.stability import grows, range_in
from fracparticles.time import STEP_POLYNOMIALS

__all__ = ["warn_if_unstable"]

_NO_GROWTH = 1e-3  # exponent of the growth over the run: more is warned of


def warn_if_unstable(case: Case, operator: LatticeOperator) -> None:
    """Warn, with the numbers, if some wave grows: outside the stability interval, or where an eigenvalue is positive.

    The single step of GPSE over the whole run cannot grow. It is taken for its speed, and no limit is computed.

    Warns
    -----
    StabilityWarning
        Names the cause and the growth over the run, or the largest stable step.
    """
    if case.kind.self_timed and case.is_one_step:
        return
    setting = case.setting
    low, high = (setting.rate * end for end in range_in(case.scheme, setting))
    of_the_symbol = grows(low, high)
    if not of_the_symbol:
        low, high = eigenvalue_bounds(case.scheme, setting, operator)
    exponent = case.span * high
    if grows(low, high):
        if exponent > _NO_GROWTH:
            warnings.warn(
                f"{case.scheme} of order {case.order} amplifies some waves at overlap = {case.resolved_overlap:.4g}, "
                f"beta = {case.beta:g}, {_cause(case, of_the_symbol)}whatever the time step: by exp({exponent:.4g}) "
                "over this run. The run is computed as it is. Take a larger overlap, or a lower order.",
                StabilityWarning,
                stacklevel=3,
            )
    elif case.steps:
        polynomial = STEP_POLYNOMIALS[case.resolved_integrator]
        _, exponents = polynomial.log_power(np.array([case.time_step * low]), case.steps)
        if exponents[0] > _NO_GROWTH:
            warnings.warn(
                f"dt = {case.time_step:.6g} lies outside the stability interval of {case.scheme} with "
                f"{case.resolved_integrator}: at most {-polynomial.stability_interval / low:.6g} is stable. "
                "The run is computed as it is. Take a smaller dt.",
                StabilityWarning,
                stacklevel=3,
            )


def _cause(case: Case, of_the_symbol: bool) -> str:
    """The cause of the growth, if it is not the scheme alone."""
    if case.kernel_table is not None:
        return f"with kernel_table = {case.kernel_table:g}, "
    return "" if of_the_symbol else "at the ends of the lattice, "
