"""One operator, every time integrator: the error in time alone against run time.

The operators are made once, and what is timed is the way from u(0) to u(T) = exp(A T) u(0) with them:

    Runge-Kutta steps (Euler, midpoint, RK4)       n steps of s operator applications, n from the stability limit up
    RKC2                                           n steps of as many stages as are stable
    expm_multiply                                  scipy's, Al-Mohy & Higham, SIAM J. Sci. Comput. 33 (2011) 488
    Chebyshev series                               of the exponential
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from scipy.linalg import expm
from scipy.sparse.linalg import LinearOperator, expm_multiply

from fracparticles.lattice.operators import Operator
from fracparticles.run.case import Case
from fracparticles.run.solver import initial_strengths
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.spectrum import dense_matrix, spectral_interval
from fracparticles.time import STEP_POLYNOMIALS, exponential, step
from fracparticles.time.rkc import ChebyshevStep, stages_for
from fracstudy.race.clock import Measurements, measure, one_core, timings_dataset

# Integrator, steps, operator applications, run.
Way = tuple[str, int, int, Callable[[], np.ndarray]]

_LABELS = {"operator": "scheme and order", "integrator": "time integrator"}
_VARIABLES = {
    "particles": ("number of points", "1"),
    "steps": ("time steps", "1"),
    "applications": ("operator applications", "1"),
    "error": ("sum |u - exp(A T) u0| / sum |exp(A T) u0|", "1"),
    "solve_time": ("solve, minimum", "s"),
    "solve_time_median": ("solve, median", "s"),
    "solves": ("solves that were timed", "1"),
}


def benchmark(
    beta: float,
    truncation: float,
    spacing: float,
    schemes: Mapping[str, int],
    factors: Sequence[int],
    repeats: int,
    seconds: float,
) -> Measurements:
    """Measure the integrators on some schemes, given with their orders, with the open exterior.

    `factors` are numbers of steps over the least stable one; of RKC2, the numbers of steps themselves. Each solve is
    timed `repeats` times, fewer if that takes longer than `seconds`.
    """
    one_core()
    rows: list[dict[str, Any]] = []
    for scheme, order in schemes.items():
        lattice = {"beta": beta, "truncation": truncation, "spacing": spacing, "exterior": "open"}
        case = Case(scheme=scheme, order=order, integrator="exponential", **lattice)
        operator = SCHEMES[scheme].operator(case.setting)
        interval = spectral_interval(scheme, case.setting, operator, case.steps)
        u0, _ = initial_strengths(case)
        matrix = dense_matrix(operator)
        exact = expm(case.span * matrix) @ u0
        trace = float(np.trace(matrix))
        for way in _ways(operator, interval, case.span, u0, factors, trace):
            integrator, steps, applications, run = way
            run()
            timing, u = measure(run, repeats, seconds)
            row = {
                "operator": f"{scheme} {order}",
                "integrator": integrator,
                "particles": case.particles,
                "steps": steps,
                "applications": applications,
                "error": float(np.abs(u - exact).sum() / np.abs(exact).sum()),
                **timing.columns("solve"),
            }
            rows.append(row)
    title = "Error of the time integration against run time"
    facts = {"beta": beta, "truncation": truncation, "spacing": spacing, "repeats": repeats}
    return timings_dataset("run", rows, _LABELS, _VARIABLES, title, facts)


def _ways(
    operator: Operator,
    interval: tuple[float, float],
    time: float,
    u0: np.ndarray,
    factors: Sequence[int],
    trace: float,
) -> Iterator[Way]:
    stiffness = -interval[0] * time
    for name, polynomial in STEP_POLYNOMIALS.items():
        least = int(np.ceil(stiffness / polynomial.stability_interval))
        for steps in (factor * least for factor in factors):
            run = partial(step, operator, polynomial, time / steps, steps, u0)
            yield name, steps, steps * polynomial.stages, run
    for steps in factors:
        stages = stages_for(stiffness / steps)
        advance = ChebyshevStep(stages).advance
        run = partial(advance, operator.apply, u0, dt=time / steps, steps=steps)
        yield "RKC2", steps, steps * stages, run
    yield "expm_multiply", 1, *_expm_multiply(operator, time, u0, trace)
    series = exponential(time, *interval)
    yield "Chebyshev series", 1, series.degree, partial(series, operator, u0)


def _expm_multiply(
    operator: Operator, time: float, u0: np.ndarray, trace: float
) -> tuple[int, Callable[[], np.ndarray]]:
    """scipy's, with the trace of A that it would have to estimate; counted by a first run.

    Norms are estimated from random vectors: another run may take a few applications more or less.
    """
    calls = 0

    def product(u: np.ndarray) -> np.ndarray:
        nonlocal calls
        calls += 1
        return time * operator.apply(np.ravel(u))

    # For the norms that it estimates it asks for the transpose, too: of A without the exterior A itself.
    matrix = LinearOperator((u0.size, u0.size), matvec=product, rmatvec=product, dtype=float)

    def run() -> np.ndarray:
        return np.asarray(expm_multiply(matrix, u0, traceA=time * trace))

    run()
    return calls, run
