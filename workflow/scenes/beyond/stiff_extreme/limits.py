"""At the stability limit: growth and overflow of steps, and the series of the same polynomial."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from fracparticles import time as integrators
from fracparticles.errors import NonFiniteSolution
from fracparticles.run.case import Case
from fracparticles.run.solver import initial_strengths
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.spectrum import dense_matrix
from scenes.beyond.stiff_extreme.checks import (
    BLOWS_UP,
    OK,
    RK2,
    SCHEMES_SHOWN,
    Base,
    Check,
    computed,
    matrix_of,
    same,
    stable_step,
)

__all__ = ["CHECKS", "growth", "growth_checks"]

_STEPS = 600  # of a growth measurement: 1.5^600 does not overflow yet


def growth(base: Base, factors: list[float]) -> pd.DataFrame:
    """Return the measured growth factor of the last fifty of 600 steps, and the spectral radius of p(A dt)."""
    rows = []
    for scheme in SCHEMES_SHOWN:
        case = Case(scheme=scheme, dt=1e-6, **base)
        operator = SCHEMES[scheme].operator(case.setting)
        eigenvalues = np.linalg.eigvals(dense_matrix(operator))
        start = np.random.default_rng(0).standard_normal(operator.size)
        for factor in factors:
            dt = factor * case.largest_stable_step
            u = integrators.step(operator, RK2, dt, _STEPS - 50, start)
            v = integrators.step(operator, RK2, dt, 50, u)
            measured = (np.linalg.norm(v) / np.linalg.norm(u)) ** (1.0 / 50.0)
            predicted = np.abs(_polynomial(eigenvalues * dt)).max()
            rows.append((scheme, factor, measured, predicted))
    return pd.DataFrame(rows, columns=["series", "x", "y", "predicted"]).assign(panel="growth")


def growth_checks(growth: pd.DataFrame) -> Iterator[Check]:
    """Yield a check of the `growth` of each scheme below and above its limit."""
    for scheme, part in growth.groupby("series"):
        for side, here in (("below", part[part["x"] < 1.0]), ("above", part[part["x"] > 1.0])):
            deviation = (here["y"] - here["predicted"]).abs().max()
            yield (
                f"{scheme}, RK2, dt = {here['x'].min():g} to {here['x'].max():g} of the limit",
                f"growth per step {here['predicted'].min():.4f} to {here['predicted'].max():.4f}",
                f"{here['y'].min():.4f} to {here['y'].max():.4f}",
                # The slow modes decay like 1 / n, so that 50 of 600 steps tell the factor to a few 1e-3.
                deviation < 5e-3,
                OK if side == "below" else BLOWS_UP,
            )


def _overflow(base: Base) -> Iterator[Check]:
    """1.2 times the limit: the step of overflow from the modes of A, stepping and series."""
    for scheme in SCHEMES_SHOWN:
        dt = 1.2 * stable_step(scheme, **base)
        fields = {**base, "scheme": scheme, "dt": dt, "t_final": 0.5 + dt * 4000}
        case = Case(evaluation="stepping", **fields)
        values, modes = np.linalg.eig(matrix_of(case.setting, scheme))
        coefficients = np.linalg.solve(modes, initial_strengths(case)[0])
        amplitude = np.abs(coefficients) * np.abs(modes).max(axis=0)
        factor = np.log(np.abs(_polynomial(values * case.time_step)))
        room = np.log(np.finfo(float).max) - np.log(np.maximum(amplitude, np.finfo(float).tiny))
        growing = factor > 0.0
        step = float((room[growing] / factor[growing]).min())
        stepping, series = (_message(evaluation=e, **fields) for e in ("stepping", "series"))
        found = int(stepping.split("after step ")[1].split()[0]) if stepping else 0
        yield (
            f"{scheme}, RK2, dt = 1.2 of the limit",
            f"NonFiniteSolution near step {step:.0f}, from stepping and from the series",
            f"after step {found} ({'raised' if series else 'not raised'} by the series)",
            abs(found - step) < 0.05 * step and bool(series),
            BLOWS_UP,
        )


def _polynomial(z: np.ndarray) -> np.ndarray:
    return 1.0 + z + 0.5 * z**2


def _message(**fields: Any) -> str:
    try:
        computed(**fields)
    except NonFiniteSolution as error:
        return str(error)
    return ""


def _edge_of_stability(base: Base) -> Iterator[Check]:
    """RK1, RK2 and RK4 at 0.999 of their limit: the Chebyshev series is the same polynomial."""
    for scheme, method in product(SCHEMES_SHOWN, ("euler", "rk2", "rk4")):
        fields = {**base, "integrator": method, "t_final": 20.5}
        dt = 0.999 * stable_step(scheme, **fields)
        stepped, series = (
            computed(scheme=scheme, evaluation=e, dt=dt, **fields) for e in ("stepping", "series")
        )
        case = f"{scheme}, {method}, dt = 0.999 of the limit, {stepped.case.steps} steps"
        expected = "the same discrete solution"
        yield same(case, expected, series.u, stepped.u)


CHECKS: dict[str, Callable[[Base], Iterator[Check]]] = {
    "overflow": _overflow,
    "series and stepping": _edge_of_stability,
}
