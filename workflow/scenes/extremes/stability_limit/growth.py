"""Runs that grow: whether they say so, at the predicted rate and, where they overflow, at the predicted step."""

import re
import warnings
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

from fracparticles.errors import NonFiniteSolution, StabilityWarning
from fracparticles.run.case import Case
from fracparticles.run.solver import initial_strengths, prepare
from fracparticles.schemes.spectrum import scheme_matrix
from fracstudy.probe import EPS, HELD, WARNED, Kind, Probe, quiet
from scenes.extremes.dense import whole

_EVALUATIONS = ("stepping", "series")


def words(half: int, factors: list[float]) -> Iterator[Probe]:
    """A hundred steps at factors of the limit: above it a warning, below it none, and the power of the dense matrix."""
    # The round-off of 100 steps, on what is amplified by cond(modes), some 1e3; a series keeps 1e-10 of its sum.
    below = Kind("a word", "p(A dt)^100 u, no word", 1e-8, "dense matrix", HELD)
    above = replace(below, expected="p(A dt)^100 u, a warning", must=WARNED)
    every = product(("DD", "FPSE", "KPSE"), ("euler", "rk2", "rk4"), factors, _EVALUATIONS)
    for scheme, integrator, factor, evaluation in every:
        fields = {"scheme": scheme, "beta": 0.5, "integrator": integrator} | _few(half)
        dt = factor * Case(**fields, dt=1.0).largest_stable_step
        case = Case(**fields, dt=dt, t_final=100.0 * dt, evaluation=evaluation)
        name = f"{scheme}, {integrator}, {evaluation}, dt = {factor:g} a"
        yield (above if factor > 1.0 else below)(name, _against_powers, case, factor > 1.0)


def _few(half: float) -> dict[str, Any]:
    return {"half_width": float(half), "spacing": 1.0, "t_initial": 0.0}


def hidden(half: int) -> Iterator[Probe]:
    """Growth that the symbol of the exact kernels does not show: of the ends, of a table, of what is not conservative.

    FPSE of order 10: the ends make a positive eigenvalue. KPSE of order 12: negative weights push the lowest below the
    symbol, so that dt = a is unstable. FPSE with a coarse table: its symbol is positive. Scheme (29): the ends.
    """
    exact: dict[str, Any] = {"integrator": "exponential"} | _few(half)
    wide = {"scheme": "KPSE", "order": 12, "beta": 0.98, "overlap": 8.0} | _few(2.5 * half)
    a = Case(**wide, dt=1.0).largest_stable_step
    steep = {"scheme": "KPSE", "order": 12, "beta": 0.999, "overlap": 1.0, "t_final": 3.0}
    ends = {"scheme": "FPSE", "order": 10, "beta": 0.98, "overlap": 3.0, "t_final": 3e5}
    table = {"scheme": "FPSE", "order": 4, "beta": 0.5, "kernel_table": 1.0, "t_final": 300.0}
    # T |lambda| eps is below 1e-9, times the condition of the modes of FPSE, some hundred.
    expected = "the function of the dense matrix, a warning"
    grows = Kind("hidden growth", expected, 1e-6, "dense matrix", WARNED)
    for name, case in {
        "FPSE, order 10, s = 3, the ends": Case(**ends, **exact),
        "KPSE, order 12, s = 8, dt = a": Case(**wide, dt=a, t_final=300.0 * a),
        "FPSE, order 4, table of step 1": Case(**table, **exact),
        "scheme (29)": Case(scheme="PSE29", beta=0.5, t_final=300.0, **exact),
        "KPSE, order 12, s = 1, positive symbol": Case(**steep, **exact),
    }.items():
        yield grows(name, _against_the_matrix, case)


def overflow() -> Iterator[Probe]:
    """At 1.2 a the strengths overflow where the modes of A say: log(max float / |c_k v_k|) / log |p(lambda_k dt)|.

    Stepping looks at the strengths every 16 steps; the series knows the growth of the shortest wave, not how much of it
    there is, so that it names an earlier step, never a later one.
    """
    for scheme, evaluation in product(("DD", "FPSE", "KPSE"), _EVALUATIONS):
        fields = {"scheme": scheme, "beta": 0.5, "half_width": 5.0, "spacing": 0.2}
        dt = 1.2 * Case(**fields, dt=1e-6).largest_stable_step
        case = Case(**fields, dt=dt, t_final=0.5 + 4000.0 * dt, evaluation=evaluation)
        step = _step_of_overflow(case)
        # The 16 steps between two looks, of some 500.
        told = Kind("overflow", f"an error at step {step:.1g}", 0.08, "dense matrix")
        yield told(f"{scheme}, rk2, {evaluation}, dt = 1.2 a", _overflow, case, step)


def _against_powers(case: Case, above: bool) -> tuple[float, str]:
    deviation, found = _against_the_matrix(case)
    if not above:
        with warnings.catch_warnings():
            warnings.simplefilter("error", StabilityWarning)  # a false alarm is an error
            prepare(case)
    return deviation, found


def _against_the_matrix(case: Case) -> tuple[float, str]:
    """The run from rough data, against exp(A T) or p(A dt)^n of the dense matrix."""
    u0 = np.random.default_rng(1).standard_normal(case.particles)
    exact = whole(case) @ u0
    u = prepare(case).solve(u0)
    size = float(np.abs(exact).max())
    return float(np.abs(u - exact).max()) / size, f"|u| grows {size / np.abs(u0).max():.0e} times"


def _step_of_overflow(case: Case) -> float:
    values, modes = np.linalg.eig(scheme_matrix(case.scheme, case.setting))
    z = values * case.time_step
    coefficients = np.linalg.solve(modes, initial_strengths(case)[0])
    amplitude = np.maximum(np.abs(coefficients) * np.abs(modes).max(axis=0), EPS * 1e-3)
    factor = np.log(np.abs(1.0 + z + 0.5 * z * z))
    growing = factor > 1e-6
    left = np.log(np.finfo(float).max) - np.log(amplitude)
    return float((left[growing] / factor[growing]).min())


def _overflow(case: Case, expected: float) -> tuple[float, str]:
    try:
        with quiet(StabilityWarning):
            prepare(case).solve(initial_strengths(case)[0])
    except NonFiniteSolution as error:
        found = int(re.findall(r"step (\d+)", str(error))[0])
    else:
        return np.inf, "no error"
    early = max(0.0, found / expected - 1.0)
    deviation = early if case.evaluation == "series" else abs(found / expected - 1.0)
    return deviation, f"an error at step {found:.1g}"
