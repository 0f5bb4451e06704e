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
from fracparticles.peers import PEERS, Solver
from fracparticles.random_walk import cell_counts, cell_masses, walk
from fracparticles.schemes import dvm
from fracparticles.solver import compute, prepare

if TYPE_CHECKING:
    from fracparticles.peers.plane import PlaneSolver

__all__ = [
    "Lattice",
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


class Lattice(Contender):
    """A case whose particles stay on their lattice."""

    def __init__(self, case: Case) -> None:
        ready = prepare(case)
        self.radius = np.abs(case.x) if case.dim == 1 else case.radius
        self.volumes = case.particle_spacing**case.dim
        self.applications = ready.operator_applications
        self.solve = ready.solve  # type: ignore[method-assign]


class _Matrix(Contender):
    """Another contender whose whole run is made one matrix: what its set-up does is do all unit vectors."""

    def __init__(self, make: Callable[[], Contender]) -> None:
        contender = make()
        self.radius, self.volumes = contender.radius, contender.volumes
        self.applications = 1
        units = np.eye(self.radius.size).reshape(-1, *self.radius.shape)
        columns = [contender.solve(unit).reshape(-1) for unit in units]
        self._matrix = np.ascontiguousarray(np.array(columns).T)
        if self.radius.ndim == 1:
            self.solve = self._matrix.dot  # type: ignore[method-assign]

    def solve(self, u0: np.ndarray) -> np.ndarray:
        return (self._matrix @ u0.reshape(-1)).reshape(u0.shape)


class _Naive(Contender):
    """The papers' way: a few of the time steps, sums over all pairs. The solution is that of the same steps by FFT."""

    def __init__(self, case: Case, steps: int) -> None:
        fields = case.model_dump(exclude_none=True, exclude={"truncation"})
        few = {
            "half_width": case.domain,  # C would follow from the final time
            "t_final": case.t_initial + steps * case.time_step,
            "summation": "naive",
            "evaluation": "stepping",
        }
        self._twin, self._ready = case, prepare(Case(**{**fields, **few}))
        self.radius = np.abs(case.x) if case.dim == 1 else case.radius
        self.volumes = case.particle_spacing**case.dim
        self.applications = self._ready.operator_applications // steps * case.steps
        self.scale = case.steps / steps

    def solve(self, u0: np.ndarray) -> np.ndarray:
        return self._ready.solve(u0)

    def error(self, problem: Problem, u: np.ndarray) -> float:
        return problem.error(self.radius, self.volumes, compute(self._twin).u)


class _Particles(Contender):
    """DVM; its solution is the field (7) at the places where the particles began."""

    def __init__(self, case: Case) -> None:
        self._case = case
        self.radius, self.volumes = np.abs(case.x), case.particle_spacing
        self.applications = 2 * case.steps

    def solve(self, u0: np.ndarray) -> np.ndarray:
        case = self._case
        run = dvm.run(
            case.x,
            u0,
            spacing=case.particle_spacing,
            alpha=case.alpha,
            order=case.order,
            overlap=case.epsilon_over_h,
            start=case.t_initial,
            dt=case.time_step,
            steps=case.steps,
        )
        return run.field(case.x)


class _Walk(Contender):
    """Walkers, counted in cells; each cell is compared with its exact mass."""

    def __init__(self, problem: Problem, walkers: int, cells: int) -> None:
        half = problem.error_radius
        self._problem, self._cells = problem, cells
        self.radius, self.volumes = np.empty(walkers), 2.0 * half / cells
        self._masses = cell_masses(
            np.linspace(-half, half, cells + 1), problem.t_final, problem.alpha
        )
        self._generator = np.random.default_rng(1)

    def start(self, problem: Problem) -> np.ndarray:
        origin = np.zeros(self.radius.size)
        return walk(origin, problem.alpha, problem.t_initial, np.random.default_rng(0))

    def solve(self, u0: np.ndarray) -> np.ndarray:
        x = walk(u0, self._problem.alpha, self._problem.time, self._generator)
        return cell_counts(x, self._problem.error_radius, self._cells)[0] / u0.size

    def error(self, problem: Problem, u: np.ndarray) -> float:
        return float(np.abs(u - self._masses).sum() / self._masses.sum())


class _Peer(Contender):
    """A method of the literature on the line."""

    def __init__(self, make: Callable[[], Solver]) -> None:
        solver = make()
        self.radius, self.volumes = np.abs(solver.x), solver.volumes
        self.applications = int(getattr(solver, "applications", 1))
        self.solve = solver.solve  # type: ignore[method-assign]


class _PlanePeer(Contender):
    """A method of the literature in the plane."""

    applications = 1

    def __init__(self, make: Callable[[], PlaneSolver]) -> None:
        solver = make()
        self.radius = np.hypot(solver.axis[:, None], solver.axis)
        self.volumes = solver.spacing**2
        self.solve = solver.solve  # type: ignore[method-assign]


# --- the trials -----------------------------------------------------------------------------------


def _trial(kind: type[Any], problem: Problem, names: tuple[str, str, str], **fields: Any) -> Trial:
    """Return the trial of a case of the problem."""
    case = Case(
        beta=problem.beta,
        dim=problem.dim,
        t_initial=problem.t_initial,
        t_final=problem.t_final,
        **fields,
    )
    return Trial(
        *names,
        partial(kind, case),
        points=case.particles,
        spacing=fields["spacing"],
        truncation=fields["truncation"],
        dt=case.time_step or float("nan"),
    )


def _fits(problem: Problem, truncation: float, spacing: float, most: float) -> bool:
    """Whether a lattice has at least 8 intervals on each side and no more particles than that."""
    half = problem.half_width(truncation) / spacing
    return half >= 8.0 and (2.0 * half + 1.0) ** problem.dim <= most


def _grids(
    problem: Problem, spacings: Sequence[float], truncations: Sequence[float], most: float
) -> Iterator[dict[str, float]]:
    for truncation, spacing in product(truncations, spacings):
        if _fits(problem, truncation, spacing, most):
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
        for grid in _grids(problem, spacings, truncations, most):
            yield _trial(Lattice, problem, names, **fixed, **grid)


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
        yield _trial(Lattice, problem, names, scheme="GPSE", dt=problem.time, **way, **grid)


def matrix_trials(trials: Iterable[Trial], most: float) -> Iterator[Trial]:
    """Yield those trials once more, of up to so many points, each with its whole run as one matrix."""
    for trial in trials:
        if trial.points <= most:
            variant = f"{trial.variant}, matrix"
            yield replace(trial, variant=variant, prepare=partial(_Matrix, trial.prepare))


def tied_step_trials(
    problem: Problem,
    way: Mapping[str, Any],
    spacings: Sequence[float],
    truncations: Sequence[float],
    most: float,
) -> Iterator[Trial]:
    """Yield GPSE as the paper has it, epsilon = 2 h, its steps in one series."""
    names = ("GPSE", f"epsilon = 2 h, {_exterior(**way)}", "ours")
    for grid in _grids(problem, spacings, truncations, most):
        yield _trial(Lattice, problem, names, scheme="GPSE", overlap=2.0, **way, **grid)


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
        dt = problem.time / count * (1.0 + _EXACT_STEPS)
        trial = _trial(
            Lattice, problem, names, integrator=integrator, evaluation=evaluation, dt=dt, **fields
        )
        case = trial.prepare.args[0]  # type: ignore[attr-defined]
        if case.time_step <= case.largest_stable_step:
            yield trial


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
            _Particles,
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
                partial(_Naive, steps=steps), problem, names,
                scheme=scheme, order=order, dt=dt, **grid,
            )  # fmt: skip


def walk_trials(problem: Problem, walkers: Sequence[int], cells: int) -> Iterator[Trial]:
    """Yield the random walk."""
    for count in walkers:
        make = partial(_Walk, problem, int(count), cells)
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
                partial(_Peer, prepare_peer),
                points=2.0 * grid["half_width"] / grid["spacing"] + 1.0,
                spacing=grid["spacing"],
                truncation=truncation,
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
                partial(_PlanePeer, prepare_peer),
                points=(2.0 * problem.half_width(grid["truncation"]) / grid["spacing"] + 1.0) ** 2,
                **grid,
            )
