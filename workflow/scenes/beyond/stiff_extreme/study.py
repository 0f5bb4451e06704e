"""Stiff and extreme cases: what the schemes and the integrators do there, against what they must do."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracparticles import time as integrators
from fracparticles.schemes.stability import symbol_range
from fracstudy.inputs import Inputs, Result
from scenes.beyond.stiff_extreme import extremes, limits, stiffness
from scenes.beyond.stiff_extreme.checks import (
    OK,
    RK2,
    UNEXPECTED,
)

__all__ = ["study"]


def study(
    inputs: Inputs, *, beta: float, half_width: float, spacing: float, factors: list[float]
) -> Result:
    """One row a check: the case, what is expected, what was found, and whether they agree.

    The growth factor of RK2 per step, from random strengths, is held against the spectral radius of p(A dt) of (52)
    around the limit (54), for steps of `factors` times it; the operator applications that RK2 needs at its limit are
    held against those of the series.
    """
    base = {"beta": beta, "half_width": half_width, "spacing": spacing}
    growth = limits.growth(base, factors)
    checks = {"stability limit": limits.growth_checks(growth)}
    checks |= {what: of(base) for what, of in _CHECKS.items()}
    rows = [
        {"what": what, "case": case, "expected": expected, "found": found, "verdict": verdict}
        for what, results in checks.items()
        for case, expected, found, agrees, *rest in results
        for verdict in ([*rest, OK] if agrees else [UNEXPECTED])[:1]
    ]
    series = pd.concat([growth, _work(beta)], ignore_index=True)
    return Result(pd.DataFrame(rows), (), series)


_CHECKS = limits.CHECKS | extremes.CHECKS | stiffness.CHECKS


def _work(beta: float) -> pd.DataFrame:
    """Operator applications against T D / h^alpha: RK2 at 0.99 of its limit, its series and the exponential."""
    low, _ = symbol_range("KPSE", beta)
    rows = []
    for scaled_time in 10.0 ** np.arange(1.0, 7.5, 0.5):
        steps, scaled = int(np.ceil(0.5 * -low * scaled_time / 0.99)), low * scaled_time
        series = integrators.power(RK2, 1.0 / steps, steps, scaled, 0.0)
        rows.append(("RK2, stepping", scaled_time, 2 * steps))
        rows.append(("RK2, one series", scaled_time, series.degree))
        rows.append(("exponential", scaled_time, integrators.exponential(1.0, scaled, 0.0).degree))
    return pd.DataFrame(rows, columns=["series", "x", "y"]).assign(panel="work")
