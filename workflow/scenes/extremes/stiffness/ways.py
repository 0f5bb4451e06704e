"""The ways through a stiff run, each against the eigenvectors of the matrix in forty digits."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from math import ceil
from typing import Any

import mpmath as mp
import numpy as np
import pandas as pd

from fracparticles.errors import InvalidInput
from fracparticles.run.case import Case
from fracparticles.run.solver import prepare
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.spectrum import dense_matrix
from fracparticles.time import STEP_POLYNOMIALS
from fracparticles.time.rkc import ChebyshevStep, stages_for
from fracstudy.panels import Panels
from fracstudy.probe import EPS, HELD, Kind, Probe, off

# Measured, of a Chebyshev series: an application of A is exact to some ulps of |lambda|, and the recurrence adds to it.
_ULPS = 64.0
# FPSE and DPSE are similar to operators with orthogonal modes by a matrix of so large a condition, which magnifies.
_CONDITION = {"FPSE": 30.0, "DPSE": 10.0}
# Beyond, pieces of a series take minutes.
_AFFORDABLE = {"FPSE": 1e7, "DPSE": 1e7, "DD": 1e9}
_STAGES = 50  # of the stabilised steps, at most


@dataclass(frozen=True)
class Stiff:
    """A scheme on a few particles, with the modes of its matrix, T and |lambda|."""

    scheme: str
    fields: dict[str, Any]
    u0: np.ndarray
    lowest: float

    def case(self, **more: Any) -> Case:
        """A run of it."""
        return Case(**self.fields, **more)

    def bound(self, stiffness: float) -> float:
        """T |lambda| eps times the ulps; a piece of a series keeps 1e-10 of its sum, whatever that is."""
        return _CONDITION.get(self.scheme, 1.0) * (_ULPS * EPS * stiffness + 1e-10)


def stiff(scheme: str, half: int) -> Stiff:
    """Return a scheme on 2 `half` + 1 particles with rough data."""
    fields = {"scheme": scheme, "beta": 0.5, "half_width": float(half), "spacing": 1.0}
    fields["t_initial"] = 0.0
    case = Case(**fields, integrator="exponential", t_final=1.0)
    noise = np.random.default_rng(2).uniform(0.0, 1.0, case.particles)
    lowest = case.symbol_range[0] * case.setting.rate
    return Stiff(scheme, fields, np.exp(-np.square(case.x / 4.0)) + noise, lowest)


def exact_modes(one: Stiff) -> Callable[[Callable[[Any], Any]], np.ndarray]:
    """Return f -> f(A) u0 by the eigenvectors of the dense matrix in forty digits."""
    values, modes, coefficients = _modes(one.scheme, tuple(one.fields.items()), tuple(one.u0))

    def of(f: Callable[[Any], Any]) -> np.ndarray:
        with mp.workdps(40):
            terms = [f(value) * c for value, c in zip(values, coefficients, strict=True)]
            return np.array([float(mp.re(x)) for x in modes * mp.matrix(terms)])

    return of


@lru_cache(maxsize=16)
def _modes(
    scheme: str, fields: tuple[tuple[str, Any], ...], u0: tuple[float, ...]
) -> tuple[Any, Any, Any]:
    case = Case(**dict(fields), integrator="exponential", t_final=1.0)
    operator = SCHEMES[scheme].operator(case.setting)
    matrix = mp.matrix(dense_matrix(operator).tolist())
    with mp.workdps(40):
        if operator.symmetric:  # to its last digits
            values, modes = mp.eigsy((matrix + matrix.T) / 2)
            return values, modes, modes.T * mp.matrix(u0)
        values, modes = mp.eig(matrix)
        return values, modes, mp.lu_solve(modes, mp.matrix(u0))


def power_of_step(case: Case) -> Callable[[Any], Any]:
    """Return z -> p(z dt)^n of a run by steps, in as many digits as z has."""
    stages = STEP_POLYNOMIALS[case.resolved_integrator].stages

    def power(z: Any) -> Any:
        z = z * mp.mpf(case.time_step)
        return sum(z**k / mp.factorial(k) for k in range(stages + 1)) ** case.steps

    return power


def probes(
    schemes: list[str], half: int, stiffness: list[float], most: float
) -> tuple[list[Probe], pd.DataFrame]:
    """Exponential, series, stepping and stabilised steps, for each T |lambda|; and the figure."""
    made, panels = [], Panels()
    for scheme, value in product(schemes, stiffness):
        one = stiff(scheme, half)
        of = exact_modes(one)
        for way, run, f, applications, extra in _ways(one, value / -one.lowest):
            if scheme == "KPSE":
                panels.add("applications", way, value, applications)
            if applications > most or value > _AFFORDABLE.get(scheme, np.inf):
                continue
            right = Kind(way, "f(A) u in forty digits", one.bound(value) + extra, "mpmath", HELD)
            name = f"{scheme}, T |lambda| = {value:.0e}"
            made.append(right(name, lambda: deviation_of(run(), of(f))))
            if scheme == "KPSE" and np.isfinite(made[-1].deviation):
                panels.add("error", way, value, max(made[-1].deviation, EPS))
    return made, panels.frame


def deviation_of(u: np.ndarray, exact: np.ndarray) -> tuple[float, str]:
    """Return the deviation from the solution, or against 1e-280 where it has decayed to less, and in words."""
    deviation = off(u, exact, max(float(np.abs(exact).max()), 1e-280))
    return deviation, f"{deviation:.0e}"


def _ways(
    one: Stiff, time: float
) -> Iterator[tuple[str, Callable[[], np.ndarray], Callable[[Any], Any], int, float]]:
    """Yield the way, the run, the function of A that it is, its applications, and what else its bound holds."""
    exponential = one.case(integrator="exponential", t_final=time)
    run = lambda: prepare(exponential).solve(one.u0)
    yield "exponential", run, lambda z: mp.exp(z * time), _applications(exponential), 0.0
    steps = max(2, ceil(time * -one.lowest / 1.8))
    for evaluation in ("series", "stepping"):
        fields = {"integrator": "rk2", "dt": time / steps, "t_final": time}
        case = one.case(**fields, evaluation=evaluation)
        count = 2 * case.steps if evaluation == "stepping" else _applications(case)
        run = lambda: prepare(case).solve(one.u0)
        yield f"rk2, {evaluation}", run, power_of_step(case), count, 0.0
    largest = 0.95 * ChebyshevStep(_STAGES).stability_interval
    number = max(4, ceil(time * -one.lowest / largest))
    stages = stages_for(time * -one.lowest / number)
    rkc, apply = ChebyshevStep(stages), SCHEMES[one.scheme].operator(exponential.setting).apply
    run = lambda: rkc.advance(apply, one.u0, dt=time / number, steps=number)
    power = lambda z: _of_a_step(rkc, z * time / number) ** number
    # The roundings of the stages, some s^2 ulps a step.
    yield "stabilised", run, power, number * stages, number * stages**2 * EPS


def _of_a_step(rkc: ChebyshevStep, z: Any) -> Any:
    """The polynomial of a stabilised step in forty digits, with its own coefficients."""
    before, stage = mp.mpf(1), 1 + rkc._first * z
    for initial, last, last_but_one, rate, initial_rate in rkc._coefficients.tolist():
        new = initial + last * stage + last_but_one * before + z * (rate * stage + initial_rate)
        before, stage = stage, new
    return stage


def _applications(case: Case) -> int:
    try:
        return prepare(case).operator_applications
    except InvalidInput:  # it would take too many
        return 10**9
