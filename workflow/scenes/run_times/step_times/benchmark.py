"""The time of a step where nothing can be kept from the one before: a new step or coefficient, moved particles."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from fracparticles.moving.dvm import DiffusionVelocity
from fracparticles.moving.lagrangian import advance
from fracparticles.run.case import Case
from fracparticles.run.solver import prepare
from fracparticles.schemes import SCHEMES
from fracparticles.time.whole_space import WholeSpace
from fracstudy.race.clock import (
    Measurements,
    forget_tables,
    measure_warm,
    one_core,
    timings_dataset,
)
from fracstudy.race.contenders.exact_symbol import ExactSymbol
from fracstudy.race.problems.fundamental import Fundamental

_STEP = 0.001
_SMALL = 65  # points on which each method takes a step before it is timed
_LABELS = {"method": "method", "dim": "number of dimensions"}
_VARIABLES = {
    "points": ("number of points", "1"),
    "step_time": ("a step with everything that it changes, minimum", "s"),
    "step_time_median": ("the same, median", "s"),
    "steps": ("steps that were timed", "1"),
}


def benchmark(line: int, plane: int, repeats: int) -> Measurements:
    """Time so many steps of 0.001 on the papers' problem, each made anew.

    About the number of points, on the line and along an axis in the plane, is given.
    """
    one_core()
    rows: list[dict[str, Any]] = []
    for dim, points in ((1, line), (2, plane)):
        for _, _, step in _steps(dim, _SMALL):
            step()  # compiles
        for method, count, step in _steps(dim, points):
            forget_tables()
            timing, _ = measure_warm(step, repeats, seconds=1.0)
            rows.append({"method": method, "dim": dim, "points": count, **timing.columns("step")})
    title = "A step where the operator changes, or the particles move"
    return timings_dataset("step", rows, _LABELS, _VARIABLES, title, {"repeats": repeats})


def _steps(dim: int, points: int) -> Iterator[tuple[str, int, Callable[[], Any]]]:
    problem = Fundamental(0.5, dim)
    half_width = 20.0 * problem.width if dim == 1 else 4.0 * problem.width
    even = points + points % 2
    symbol = ExactSymbol()
    ready = symbol.prepare(problem, "", even, half_width)
    u0 = problem.initial(ready.x)
    tau = _STEP * (2.0 * half_width / even) ** -problem.alpha

    def exact() -> Any:
        return symbol.prepare(problem, "", even, half_width).solve(u0)

    def evolve() -> Any:
        return WholeSpace(even, dim, problem.alpha, tau).solve(u0)

    yield "exact symbol, periodic", u0.size, exact
    yield "fp.evolve, 2 terms", u0.size, evolve
    lattice: dict[str, Any] = {
        "beta": problem.beta,
        "dim": dim,
        "half_width": half_width,
        "spacing": 2.0 * half_width / (points - 1),
        "t_final": 0.5 + _STEP,
    }
    for scheme in ("DD", "FPSE", "KPSE"):
        case = Case(scheme=scheme, dt=_STEP, **lattice)
        data = problem.initial(tuple(np.meshgrid(*(case.x,) * dim, indexing="ij", sparse=True)))
        flat = data.reshape(-1)
        yield f"{scheme}, operator made anew", data.size, partial(_applied, case, flat)
    step = (2.0 * lattice["spacing"]) ** problem.alpha  # epsilon = 2 h
    green = Case(scheme="GPSE", dt=step, **{**lattice, "t_final": 0.5 + step})
    yield "GPSE, step made anew", data.size, partial(_one_step, green, data)
    if dim == 1:
        moving = Case(scheme="DVM", dt=_STEP, **lattice)
        for sums, summation in (("", "fft"), (", naive sums", "naive")):
            epsilon = moving.resolved_overlap * moving.particle_spacing
            velocity = DiffusionVelocity(problem.alpha, moving.order, epsilon, summation=summation)
            strength = moving.particle_spacing * data
            step_of_dvm = partial(advance, moving.x, strength, velocity, dt=_STEP, steps=1)
            yield f"DVM, two velocities{sums}", data.size, step_of_dvm


def _applied(case: Case, u: np.ndarray) -> np.ndarray:
    return SCHEMES[case.scheme].operator(case.setting).apply(u)


def _one_step(case: Case, u: np.ndarray) -> np.ndarray:
    return prepare(case).solve(u)
