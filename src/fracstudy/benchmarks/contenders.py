"""The contenders made ready: our schemes, the papers' way, the methods of the literature."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from fracparticles.graded.field import green_step_of_field
from fracparticles.graded.particles import FORMS, graded_particles, green_step
from fracparticles.moving.random_walk import cell_counts, cell_masses, walk
from fracparticles.run.case import Case
from fracparticles.run.solver import advect, compute, matrix_of, prepare
from fracparticles.time.propagator import propagator
from fracstudy.benchmarks.problem import Problem
from fracstudy.benchmarks.trial import Contender
from fracstudy.peers import Solver, sinc_lattice
from fracstudy.peers.base import half_intervals

if TYPE_CHECKING:
    from fracstudy.peers.plane import PlaneSolver

__all__ = [
    "GRADED_FORMS",
    "graded",
    "lattice",
    "lent_exterior",
    "moving",
    "naive",
    "peer",
    "plane_peer",
    "random_walkers",
    "whole_matrix",
]

# The form in which not the sums over graded particles take the step but the field between them.
_FIELD = "interpolated"
GRADED_FORMS = (*FORMS, _FIELD)


def lattice(case: Case) -> Contender:
    """Return a case whose particles stay on their lattice."""
    ready = prepare(case)
    return Contender(*_points(case), ready.solve, ready.operator_applications)


def naive(case: Case, steps: int) -> Contender:
    """The papers' way: a few of the time steps, sums over all pairs. The solution is that of all steps by FFT."""
    fields = case.model_dump(exclude_none=True, exclude={"truncation"})
    few = {
        "half_width": case.domain,  # C would follow from the final time
        "t_final": case.t_initial + steps * case.time_step,
        "summation": "naive",
        "evaluation": "stepping",
    }
    ready = prepare(Case(**{**fields, **few}))
    radius, volume = _points(case)
    problem = Problem(case.beta, case.dim, case.t_initial, case.t_final)
    return Contender(
        radius,
        volume,
        ready.solve,
        applications=ready.operator_applications // steps * case.steps,
        scale=case.steps / steps,
        judge=lambda _: problem.error(radius, volume, compute(case).u),
    )


def _points(case: Case) -> tuple[np.ndarray, float]:
    radius = np.abs(case.x) if case.dim == 1 else case.radius
    return radius, case.particle_spacing**case.dim


def moving(case: Case) -> Contender:
    """DVM; its solution is the field (7) at the places where the particles began."""

    def solve(u0: np.ndarray) -> np.ndarray:
        return advect(case, u0).field(case.x)

    return Contender(*_points(case), solve, applications=2 * case.steps)


def graded(problem: Problem, form: str, count: int, reach: float, scale: float) -> Contender:
    """One Green step on graded particles, or of the field between them."""
    x, volumes = graded_particles(count, reach, scale)
    if form == _FIELD:
        matrix = green_step_of_field(count, reach, scale, problem.alpha, problem.time)
    else:
        matrix = green_step(x, volumes, problem.alpha, problem.time, form)
    return Contender(np.abs(x), volumes, matrix.dot)


def random_walkers(problem: Problem, walkers: int, cells: int) -> Contender:
    """Walkers, counted in cells; each cell is compared with its exact mass."""
    half, alpha = problem.error_radius, problem.alpha
    masses = cell_masses(np.linspace(-half, half, cells + 1), problem.t_final, alpha)
    generator = np.random.default_rng(1)

    def solve(x: np.ndarray) -> np.ndarray:
        moved = walk(x, alpha, problem.time, generator)
        return cell_counts(moved, half, cells)[0] / walkers

    return Contender(
        np.empty(walkers),
        2.0 * half / cells,
        solve,
        draw=lambda: walk(np.zeros(walkers), alpha, problem.t_initial, np.random.default_rng(0)),
        judge=lambda shares: float(np.abs(shares - masses).sum() / masses.sum()),
    )


def peer(make: Callable[[], Solver]) -> Contender:
    """A method of the literature on the line."""
    solver = make()
    applications = int(getattr(solver, "applications", 1))
    return Contender(np.abs(solver.x), solver.volumes, solver.solve, applications)


def lent_exterior(problem: Problem, half_width: float, spacing: float) -> Contender:
    """The sinc lattice as one lattice sum, its exterior continued by three terms as ours."""
    n = half_intervals(half_width, spacing, None)
    h = half_width / n
    tau = problem.time * h**-problem.alpha
    run = propagator(
        lambda theta: np.exp(tau * sinc_lattice.symbol(theta, problem.alpha)),
        problem.alpha, tau, n, "open", terms=3,
    )  # fmt: skip
    return Contender(np.abs(np.arange(-n, n + 1) * h), h, run.apply)


def plane_peer(make: Callable[[], PlaneSolver]) -> Contender:
    """A method of the literature in the plane."""
    solver = make()
    radius = np.hypot(solver.axis[:, None], solver.axis)
    return Contender(radius, solver.spacing**2, solver.solve)


def whole_matrix(make: Callable[[], Contender]) -> Contender:
    """Another contender whose whole run is made one matrix: its set-up solves for all unit vectors."""
    contender = make()
    shape = contender.radius.shape
    matrix = matrix_of(contender.solve, shape)

    def solve(u0: np.ndarray) -> np.ndarray:
        return (matrix @ u0.reshape(-1)).reshape(shape)

    line = len(shape) == 1
    return Contender(contender.radius, contender.volumes, matrix.dot if line else solve)
