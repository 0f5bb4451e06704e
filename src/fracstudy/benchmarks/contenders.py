"""The contenders made ready: our schemes, the papers' way, the methods of the literature."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fracparticles.graded.field import GRADED_FORMS, graded_step
from fracparticles.graded.particles import graded_particles
from fracparticles.moving.random_walk import cell_counts, cell_masses, walk
from fracparticles.run.case import Case
from fracparticles.run.solver import advect, compute, matrix_of, prepare
from fracparticles.time.propagator import propagator
from fracstudy.benchmarks.problem import Problem
from fracstudy.benchmarks.trial import Ready
from fracstudy.peers import PlaneSolver, Solver, sinc_lattice

__all__ = [
    "GRADED_FORMS",
    "graded",
    "lattice",
    "lent_exterior",
    "moving",
    "naive",
    "naive_steps",
    "peer",
    "random_walkers",
    "whole_matrix",
]


def lattice(case: Case) -> Ready:
    """Return a case whose particles stay on their lattice."""
    run = prepare(case)
    return Ready(*_points(case), run.solve, run.operator_applications)


def naive(case: Case, steps: int) -> Ready:
    """The papers' way: a few of the time steps, sums over all pairs. The solution is that of all steps by FFT."""
    run = prepare(naive_steps(case, steps))
    points = _points(case)
    problem = Problem(case.beta, case.dim, case.t_initial, case.t_final)
    return Ready(
        *points,
        run.solve,
        applications=run.operator_applications // steps * case.steps,
        scale=case.steps / steps,
        judge=lambda _: problem.error(*points, compute(case).u),
    )


def naive_steps(case: Case, steps: int) -> Case:
    """Return the same lattice with so many of the time steps, sums over all pairs."""
    fields = case.model_dump(exclude_none=True, exclude={"truncation"})
    few = {
        "half_width": case.reach,  # C would follow from the final time
        "t_final": case.t_initial + steps * case.time_step,
        "summation": "naive",
        "evaluation": "stepping",
    }
    return Case(**{**fields, **few})


def _points(case: Case) -> tuple[np.ndarray, np.ndarray | float]:
    return case.radius, case.volumes


def moving(case: Case) -> Ready:
    """DVM; its solution is the field (7) at the places where the particles began."""

    def solve(u0: np.ndarray) -> np.ndarray:
        return advect(case, u0).field(case.x)

    return Ready(*_points(case), solve, applications=2 * case.steps)


def graded(problem: Problem, form: str, count: int, reach: float, scale: float) -> Ready:
    """One Green step on graded particles, or of the field between them."""
    x, volumes = graded_particles(count, reach, scale)
    matrix = graded_step(count, reach, scale, problem.alpha, problem.time, form)
    return Ready(np.abs(x), volumes, matrix.dot)


def random_walkers(problem: Problem, walkers: int, cells: int) -> Ready:
    """Walkers, counted in cells; each cell is compared with its exact mass."""
    half, alpha = problem.error_radius, problem.alpha
    masses = cell_masses(np.linspace(-half, half, cells + 1), problem.t_final, alpha)
    generator = np.random.default_rng(1)

    def solve(x: np.ndarray) -> np.ndarray:
        moved = walk(x, alpha, problem.time, generator)
        return cell_counts(moved, half, cells)[0] / walkers

    return Ready(
        np.empty(walkers),
        2.0 * half / cells,
        solve,
        draw=lambda: walk(np.zeros(walkers), alpha, problem.t_initial, np.random.default_rng(0)),
        judge=lambda shares: float(np.abs(shares - masses).sum() / masses.sum()),
    )


def peer(make: Callable[[], Solver | PlaneSolver]) -> Ready:
    """A method of the literature, on the line or in the plane."""
    solver = make()
    plane = isinstance(solver, PlaneSolver)
    radius = np.hypot(solver.x[:, None], solver.x) if plane else np.abs(solver.x)
    return Ready(radius, solver.volumes, solver.solve, int(getattr(solver, "applications", 1)))


def lent_exterior(problem: Problem, half_width: float, spacing: float) -> Ready:
    """The sinc lattice as one lattice sum, its exterior continued by three terms as ours."""
    alpha, n = problem.alpha, max(1, round(half_width / spacing))
    h = half_width / n
    tau = problem.time * h**-alpha

    def amplification(theta: np.ndarray) -> np.ndarray:
        return np.exp(tau * sinc_lattice.symbol(theta, alpha))

    run = propagator(amplification, alpha, tau, n, "open", terms=3)
    return Ready(np.abs(np.arange(-n, n + 1) * h), h, run.apply)


def whole_matrix(make: Callable[[], Ready]) -> Ready:
    """Another contender whose whole run is made one matrix: its set-up solves for all unit vectors."""
    one = make()
    shape = one.radius.shape
    matrix = matrix_of(one.solve, shape)

    def solve(u0: np.ndarray) -> np.ndarray:
        return (matrix @ u0.reshape(-1)).reshape(shape)

    return Ready(one.radius, one.volumes, matrix.dot if len(shape) == 1 else solve)
