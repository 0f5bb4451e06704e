"""The contenders: our schemes, the papers' way, the methods of the literature, and the limit."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from fracparticles.benchmarks.problem import Problem
from fracparticles.benchmarks.trial import Contender, Trial
from fracparticles.case import Case
from fracparticles.graded import FORMS, graded_particles, green_step
from fracparticles.graded_field import green_step_of_field
from fracparticles.peers import PEERS, Solver, sinc_lattice
from fracparticles.peers.base import half_intervals
from fracparticles.propagator import propagator
from fracparticles.random_walk import cell_counts, cell_masses, walk
from fracparticles.solver import advect, compute, matrix_of, prepare

if TYPE_CHECKING:
    from fracparticles.peers.plane import PlaneSolver

__all__ = [
    "graded_trials",
    "lattice",
    "lent_exterior_trials",
    "matrix_trials",
    "naive_trials",
    "one_step_trials",
    "particle_trials",
    "peer_trials",
    "plane_peer_trials",
    "scheme_trials",
    "stepped_trials",
    "tied_step_trials",
    "walk_trials",
]

_EXACT_STEPS = 1e-9  # relative: a step that is to be one of n equal ones
_FIELD = "interpolated"  # graded particles whose field takes the step


# --- the contenders -------------------------------------------------------------------------------


def lattice(case: Case) -> Contender:
    """Return a case whose particles stay on their lattice."""
    ready = prepare(case)
    return Contender(*_points(case), ready.solve, ready.operator_applications)


def _naive(case: Case, steps: int) -> Contender:
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


def _particles(case: Case) -> Contender:
    """DVM; its solution is the field (7) at the places where the particles began."""

    def solve(u0: np.ndarray) -> np.ndarray:
        return advect(case, u0).field(case.x)

    return Contender(*_points(case), solve, applications=2 * case.steps)


def _graded(problem: Problem, form: str, count: int, reach: float, scale: float) -> Contender:
    """One Green step on graded particles, or of the field between them."""
    x, volumes = graded_particles(count, reach, scale)
    if form == _FIELD:
        matrix = green_step_of_field(count, reach, scale, problem.alpha, problem.time)
    else:
        matrix = green_step(x, volumes, problem.alpha, problem.time, form)
    return Contender(np.abs(x), volumes, matrix.dot)


def _walk(problem: Problem, walkers: int, cells: int) -> Contender:
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


def _peer(make: Callable[[], Solver]) -> Contender:
    """A method of the literature on the line."""
    solver = make()
    applications = int(getattr(solver, "applications", 1))
    return Contender(np.abs(solver.x), solver.volumes, solver.solve, applications)


def _lent_exterior(problem: Problem, half_width: float, spacing: float) -> Contender:
    """The sinc lattice as one lattice sum, its exterior continued by three terms as ours."""
    n = half_intervals(half_width, spacing, None)
    h = half_width / n
    tau = problem.time * h**-problem.alpha
    run = propagator(
        lambda theta: np.exp(tau * sinc_lattice.symbol(theta, problem.alpha)),
        problem.alpha, tau, n, "open", terms=3,
    )  # fmt: skip
    return Contender(np.abs(np.arange(-n, n + 1) * h), h, run.apply)


def _plane_peer(make: Callable[[], PlaneSolver]) -> Contender:
    """A method of the literature in the plane."""
    solver = make()
    radius = np.hypot(solver.axis[:, None], solver.axis)
    return Contender(radius, solver.spacing**2, solver.solve)


def _matrix(make: Callable[[], Contender]) -> Contender:
    """Another contender whose whole run is made one matrix: its set-up solves for all unit vectors."""
    contender = make()
    shape = contender.radius.shape
    matrix = matrix_of(contender.solve, shape)

    def solve(u0: np.ndarray) -> np.ndarray:
        return (matrix @ u0.reshape(-1)).reshape(shape)

    line = len(shape) == 1
    return Contender(contender.radius, contender.volumes, matrix.dot if line else solve)


# --- the trials -----------------------------------------------------------------------------------


def _trial(
    kind: Callable[[Case], Contender],
    problem: Problem,
    names: tuple[str, str, str],
    **fields: Any,
) -> Trial:
    """Return the trial of a case of the problem."""
    case = _case(problem, fields)
    return Trial(
        *names,
        partial(kind, case),
        points=case.particles,
        spacing=fields["spacing"],
        truncation=fields["truncation"],
        dt=case.time_step or float("nan"),
    )


def _case(problem: Problem, fields: Mapping[str, Any]) -> Case:
    return Case(
        beta=problem.beta,
        dim=problem.dim,
        t_initial=problem.t_initial,
        t_final=problem.t_final,
        **fields,
    )


def _least_half(way: Mapping[str, Any]) -> float:
    """The least half of a lattice in h: what a case asks of one whose far field has several terms, at overlap 2."""
    several = way.get("far_terms", 1) > 1 and way.get("evaluation") != "convolution"
    return 21.0 if several else 8.0


def _fits(problem: Problem, truncation: float, spacing: float, most: float, least: float) -> bool:
    """Whether a lattice reaches over all that is judged, and is neither too small nor too large."""
    width = problem.half_width(truncation)
    half = width / spacing
    covers = width >= problem.error_radius
    return covers and half >= least and (2.0 * half + 1.0) ** problem.dim <= most


def _grids(
    problem: Problem,
    spacings: Sequence[float],
    truncations: Sequence[float],
    most: float,
    least: float = 8.0,
) -> Iterator[dict[str, float]]:
    for truncation, spacing in product(truncations, spacings):
        if _fits(problem, truncation, spacing, most, least):
            yield {"truncation": truncation, "spacing": spacing}


def scheme_trials(
    problem: Problem,
    schemes: Sequence[str],
    orders: Sequence[int],
    way: Mapping[str, Any],
    spacings: Sequence[float],
    truncations: Sequence[float],
    most: float,
) -> Iterator[Trial]:
    """Yield DD, FPSE and KPSE, exact in time; `way` is their exterior, its terms and how the exponential is done."""
    for scheme, order in product(schemes, orders):
        names = (scheme, f"order {order}, {_exterior(**way)}, {way['evaluation']}", "ours")
        fixed = {"scheme": scheme, "order": order, "integrator": "exponential", **way}
        for grid in _grids(problem, spacings, truncations, most, _least_half(way)):
            yield _trial(lattice, problem, names, **fixed, **grid)


def _exterior(exterior: str, far_terms: int | None = None, **_: Any) -> str:
    if far_terms is None:
        return exterior
    return f"{exterior}, {far_terms} term{'s' if far_terms > 1 else ''}"


def one_step_trials(
    problem: Problem,
    way: Mapping[str, Any],
    spacings: Sequence[float],
    truncations: Sequence[float],
    most: float,
) -> Iterator[Trial]:
    """Yield GPSE over the whole time in one step: epsilon^alpha = D T."""
    how = f", {way['evaluation']}" if "evaluation" in way else ""
    names = ("GPSE", f"one step, {_exterior(**way)}{how}", "ours")
    for grid in _grids(problem, spacings, truncations, most):
        yield _trial(lattice, problem, names, scheme="GPSE", dt=problem.time, **way, **grid)


def graded_trials(
    problem: Problem, counts: Sequence[int], reaches: Sequence[float], scales: Sequence[float]
) -> Iterator[Trial]:
    """Yield GPSE in one step on graded particles, in all forms, where they reach over all that is judged."""
    for form, count, reach, scale in product((*FORMS, _FIELD), counts, reaches, scales):
        if reach >= problem.error_radius:
            make = partial(_graded, problem, form, count, reach, scale)
            yield Trial("GPSE", f"one step, graded particles, {form}", "ours", make, points=count)


def matrix_trials(trials: Iterable[Trial], most: float) -> Iterator[Trial]:
    """Yield those trials once more, of up to so many points, each with its whole run as one matrix."""
    for trial in trials:
        if trial.points <= most:
            variant = f"{trial.variant}, matrix"
            yield replace(trial, variant=variant, prepare=partial(_matrix, trial.prepare))


def tied_step_trials(
    problem: Problem,
    way: Mapping[str, Any],
    spacings: Sequence[float],
    truncations: Sequence[float],
    most: float,
) -> Iterator[Trial]:
    """Yield GPSE as the paper has it, epsilon = 2 h, its steps in one series."""
    names = ("GPSE", f"epsilon = 2 h, {_exterior(**way)}", "ours")
    for grid in _grids(problem, spacings, truncations, most, _least_half(way)):
        yield _trial(lattice, problem, names, scheme="GPSE", overlap=2.0, **way, **grid)


def stepped_trials(
    problem: Problem,
    integrators: Sequence[str],
    evaluations: Sequence[str],
    steps: Sequence[int],
    **fields: Any,
) -> Iterator[Trial]:
    """Yield one lattice with Runge-Kutta steps of several sizes, those that are stable."""
    for integrator, evaluation, count in product(integrators, evaluations, steps):
        names = (
            fields["scheme"],
            f"order {fields['order']}, {fields['exterior']}, {integrator} {evaluation}",
            "ours",
        )
        own = {
            "integrator": integrator,
            "evaluation": evaluation,
            "dt": problem.time / count * (1.0 + _EXACT_STEPS),
            **fields,
        }
        case = _case(problem, own)
        if case.time_step <= case.largest_stable_step:
            yield _trial(lattice, problem, names, **own)


def particle_trials(
    problem: Problem,
    orders: Sequence[int],
    truncation: float,
    spacings: Sequence[float],
    steps: Sequence[int],
) -> Iterator[Trial]:
    """Yield DVM with remeshing by M4'."""
    for order, spacing, count in product(orders, spacings, steps):
        yield _trial(
            _particles,
            problem,
            ("DVM", f"order {order}, M4' remeshing", "ours"),
            scheme="DVM",
            order=order,
            truncation=truncation,
            spacing=spacing,
            dt=problem.time / count * (1.0 + _EXACT_STEPS),
        )


def naive_trials(
    problem: Problem,
    schemes: Sequence[str],
    orders: Sequence[int],
    dt: float,
    steps: int,
    spacings: Sequence[float],
    truncations: Sequence[float],
    most: float,
) -> Iterator[Trial]:
    """Yield the papers' way: sums over all pairs, midpoint steps, truncated; `steps` of them, the rest extrapolated."""
    for scheme, order in product(schemes, orders):
        if scheme == "FD" and order > 2:
            continue
        names = (scheme, f"order {order}, naive sums, RK2 steps", "papers")
        for grid in _grids(problem, spacings, truncations, most):
            yield _trial(
                partial(_naive, steps=steps), problem, names,
                scheme=scheme, order=order, dt=dt, **grid,
            )  # fmt: skip


def walk_trials(problem: Problem, walkers: Sequence[int], cells: int) -> Iterator[Trial]:
    """Yield the random walk."""
    for count in walkers:
        make = partial(_walk, problem, int(count), cells)
        yield Trial("random walk", "exact increments", "papers", make, points=count)


def peer_trials(
    problem: Problem,
    spacings: Sequence[float],
    truncations: Sequence[float],
    most: float,
    scales: Sequence[float],
    scaled_spacings: Sequence[float],
) -> Iterator[Trial]:
    """Yield the methods of the literature; `scales` and `scaled_spacings` are L and h of the mapped line."""
    for name, module in PEERS.items():
        group = "limit" if name == "exact-symbol" else "peers"
        mapped = name == "mapped-fourier"
        if mapped:
            grids = [{"half_width": L, "spacing": h} for L, h in product(scales, scaled_spacings)]
        else:
            grids = [
                {"half_width": problem.half_width(grid["truncation"]), **grid}
                for grid in _grids(problem, spacings, truncations, most)
            ]
        for exterior, propagation, grid in product(module.EXTERIORS, module.PROPAGATIONS, grids):
            truncation = grid.get("truncation", float("nan"))
            prepare_peer = partial(
                module.prepare,
                alpha=problem.alpha,
                half_width=grid["half_width"],
                spacing=grid["spacing"],
                time=problem.time,
                exterior=exterior,
                propagation=propagation,
            )
            yield Trial(
                name,
                f"{exterior}, {propagation}",
                group,
                partial(_peer, prepare_peer),
                points=2.0 * grid["half_width"] / grid["spacing"] + 1.0,
                spacing=grid["spacing"],
                truncation=truncation,
            )


def lent_exterior_trials(
    problem: Problem, spacings: Sequence[float], truncations: Sequence[float], most: float
) -> Iterator[Trial]:
    """Yield the sinc lattice with our exterior: how much of our lead is the exterior's."""
    for grid in _grids(problem, spacings, truncations, most):
        half_width = problem.half_width(grid["truncation"])
        yield Trial(
            sinc_lattice.NAME,
            "our exterior, 3 terms, convolution",
            "peers",
            partial(_lent_exterior, problem, half_width, grid["spacing"]),
            points=2.0 * half_width / grid["spacing"] + 1.0,
            **grid,
        )


def plane_peer_trials(
    problem: Problem, spacings: Sequence[float], truncations: Sequence[float], most: float
) -> Iterator[Trial]:
    """Yield the methods of the literature in the plane."""
    from fracparticles.peers.plane import PLANE_PEERS, prepare_plane

    for name in PLANE_PEERS:
        limit = name == "exact-symbol"
        for grid in _grids(problem, spacings, truncations, most):
            prepare_peer = partial(
                prepare_plane,
                name,
                alpha=problem.alpha,
                half_width=problem.half_width(grid["truncation"]),
                spacing=grid["spacing"],
                time=problem.time,
            )
            yield Trial(
                name,
                "periodic, exact" if limit else "truncated, convolution",
                "limit" if limit else "peers",
                partial(_plane_peer, prepare_peer),
                points=(2.0 * problem.half_width(grid["truncation"]) / grid["spacing"] + 1.0) ** 2,
                **grid,
            )
