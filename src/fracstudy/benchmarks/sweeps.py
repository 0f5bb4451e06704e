"""What is tried: contenders over grids of their parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import product
from typing import Any

from fracparticles.run.case import Case
from fracstudy.benchmarks.contenders import (
    GRADED_FORMS,
    graded,
    lattice,
    lent_exterior,
    moving,
    naive,
    peer,
    plane_peer,
    random_walkers,
    whole_matrix,
)
from fracstudy.benchmarks.problem import Problem
from fracstudy.benchmarks.trial import Contender, Trial
from fracstudy.peers import PEERS, sinc_lattice

__all__ = [
    "graded_trials",
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
    for form, count, reach, scale in product(GRADED_FORMS, counts, reaches, scales):
        if reach >= problem.error_radius:
            make = partial(graded, problem, form, count, reach, scale)
            yield Trial("GPSE", f"one step, graded particles, {form}", "ours", make, points=count)


def matrix_trials(trials: Iterable[Trial], most: float) -> Iterator[Trial]:
    """Yield those trials once more, of up to so many points, each with its whole run as one matrix."""
    for trial in trials:
        if trial.points <= most:
            variant = f"{trial.variant}, matrix"
            yield replace(trial, variant=variant, prepare=partial(whole_matrix, trial.prepare))


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
            moving,
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
                partial(naive, steps=steps), problem, names,
                scheme=scheme, order=order, dt=dt, **grid,
            )  # fmt: skip


def walk_trials(problem: Problem, walkers: Sequence[int], cells: int) -> Iterator[Trial]:
    """Yield the random walk."""
    for count in walkers:
        make = partial(random_walkers, problem, int(count), cells)
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
                partial(peer, prepare_peer),
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
            partial(lent_exterior, problem, half_width, grid["spacing"]),
            points=2.0 * half_width / grid["spacing"] + 1.0,
            **grid,
        )


def plane_peer_trials(
    problem: Problem, spacings: Sequence[float], truncations: Sequence[float], most: float
) -> Iterator[Trial]:
    """Yield the methods of the literature in the plane."""
    from fracstudy.peers.plane import PLANE_PEERS, prepare_plane

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
                partial(plane_peer, prepare_peer),
                points=(2.0 * problem.half_width(grid["truncation"]) / grid["spacing"] + 1.0) ** 2,
                **grid,
            )
