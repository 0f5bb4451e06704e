"""What is tried: contenders over grids of their parameters.

The keywords `grid` are `spacings`, `truncations` and the `most` particles: every pair of the first two makes a
lattice, if it reaches over all that is judged, and is neither too small nor too large.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import product
from typing import Any

from fracparticles.errors import InvalidInput
from fracparticles.run.case import Case
from fracstudy.benchmarks import contenders
from fracstudy.benchmarks.problem import Problem
from fracstudy.benchmarks.trial import Ready, Trial
from fracstudy.peers import PEERS, PLANE_PEERS, PlaneSolver, Solver, sinc_lattice

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
    "sweep",
    "tied_step_trials",
    "walk_trials",
]

_SMALLEST = 8.0  # the least half of a lattice in h
_ONE_OF_N = 1.0 + 1e-9  # over the n-th part of the time: a step that is to be one of n equal ones


def sweep(
    problem: Problem,
    kind: str,
    ways: Sequence[Mapping[str, Any]] | None = None,
    as_matrix: float = 0,
    **given: Any,
) -> Iterator[Trial]:
    """Yield the trials of one kind.

    Parameters
    ----------
    problem : Problem
    kind : str
        Of a function of this module, without "_trials".
    ways : sequence of mapping, optional
        Its `way`, one after the other, for a kind that has one.
    as_matrix : float
        Of up to so many points each also runs as one matrix; the limit does not.
    **given
        What else the function takes.

    Raises
    ------
    InvalidInput
        If there is no such kind.
    """
    function = globals().get(f"{kind}_trials")
    if function is None:
        kinds = [name.removesuffix("_trials") for name in __all__ if name != "sweep"]
        raise InvalidInput("kind", kind, f"one of {', '.join(kinds)}", "Choose one of these.")
    for way in [{}] if ways is None else [{"way": way} for way in ways]:
        trials = list(function(problem, **way, **given))
        yield from trials
        yield from matrix_trials((one for one in trials if one.group != "limit"), as_matrix)


def _trial(
    kind: Callable[[Case], Ready], problem: Problem, names: tuple[str, str, str], **fields: Any
) -> Trial:
    """Return the trial of a case of the problem."""
    case = problem.case(**fields)
    step = case.time_step or float("nan")
    grid = fields["spacing"], fields["truncation"]
    return Trial(*names, partial(kind, case), case.particles, *grid, step)


def _smallest(way: Mapping[str, Any]) -> float:
    """What a case asks of a lattice whose far field has several terms, at overlap 2."""
    several = way.get("far_terms", 1) > 1 and way.get("evaluation") != "convolution"
    return 21.0 if several else _SMALLEST


def _grids(
    problem: Problem,
    spacings: Sequence[float],
    truncations: Sequence[float],
    most: float,
    smallest: float = _SMALLEST,
) -> Iterator[dict[str, Any]]:
    for truncation, spacing in product(truncations, spacings):
        width = problem.half_width(truncation)
        half = width / spacing
        fits = half >= smallest and (2.0 * half + 1.0) ** problem.dim <= most
        if fits and width >= problem.error_radius:
            yield {"truncation": truncation, "spacing": spacing}


def scheme_trials(
    problem: Problem,
    schemes: Sequence[str],
    orders: Sequence[int],
    way: Mapping[str, Any],
    **grid: Any,
) -> Iterator[Trial]:
    """Yield DD, FPSE and KPSE, exact in time; `way` is their exterior, its terms and how the exponential is done."""
    for scheme, order in product(schemes, orders):
        names = (scheme, f"order {order}, {_exterior(**way)}, {way['evaluation']}", "ours")
        fixed = {"scheme": scheme, "order": order, "integrator": "exponential", **way}
        for one in _grids(problem, **grid, smallest=_smallest(way)):
            yield _trial(contenders.lattice, problem, names, **fixed, **one)


def _exterior(exterior: str, far_terms: int | None = None, **_: Any) -> str:
    if far_terms is None:
        return exterior
    return f"{exterior}, {far_terms} term{'s' if far_terms > 1 else ''}"


def one_step_trials(problem: Problem, way: Mapping[str, Any], **grid: Any) -> Iterator[Trial]:
    """Yield GPSE over the whole time in one step: epsilon^alpha = D T."""
    how = f", {way['evaluation']}" if "evaluation" in way else ""
    names = ("GPSE", f"one step, {_exterior(**way)}{how}", "ours")
    for one in _grids(problem, **grid):
        yield _trial(
            contenders.lattice, problem, names, scheme="GPSE", dt=problem.time, **way, **one
        )


def tied_step_trials(problem: Problem, way: Mapping[str, Any], **grid: Any) -> Iterator[Trial]:
    """Yield GPSE as the paper has it, epsilon = 2 h, its steps in one series."""
    names = ("GPSE", f"epsilon = 2 h, {_exterior(**way)}", "ours")
    for one in _grids(problem, **grid, smallest=_smallest(way)):
        yield _trial(contenders.lattice, problem, names, scheme="GPSE", overlap=2.0, **way, **one)


def graded_trials(
    problem: Problem, counts: Sequence[int], reaches: Sequence[float], scales: Sequence[float]
) -> Iterator[Trial]:
    """Yield GPSE in one step on graded particles, in all forms, where they reach over all that is judged."""
    for form, count, reach, scale in product(contenders.GRADED_FORMS, counts, reaches, scales):
        if reach >= problem.error_radius:
            make = partial(contenders.graded, problem, form, count, reach, scale)
            yield Trial("GPSE", f"one step, graded particles, {form}", "ours", make, count)


def matrix_trials(trials: Iterable[Trial], most: float) -> Iterator[Trial]:
    """Yield those trials once more, of up to so many points, each with its whole run as one matrix."""
    for trial in trials:
        if trial.points <= most:
            make = partial(contenders.whole_matrix, trial.prepare)
            yield replace(trial, variant=f"{trial.variant}, matrix", prepare=make)


def stepped_trials(
    problem: Problem,
    integrators: Sequence[str],
    evaluations: Sequence[str],
    steps: Sequence[int],
    **fields: Any,
) -> Iterator[Trial]:
    """Yield one lattice with Runge-Kutta steps of several sizes, those that are stable."""
    lattice_is = f"order {fields['order']}, {fields['exterior']}"
    for integrator, evaluation, count in product(integrators, evaluations, steps):
        names = (fields["scheme"], f"{lattice_is}, {integrator} {evaluation}", "ours")
        way = {"integrator": integrator, "evaluation": evaluation}
        own = {**way, "dt": problem.time / count * _ONE_OF_N, **fields}
        case = problem.case(**own)
        if case.time_step <= case.largest_stable_step:
            yield _trial(contenders.lattice, problem, names, **own)


def particle_trials(
    problem: Problem,
    orders: Sequence[int],
    truncation: float,
    spacings: Sequence[float],
    steps: Sequence[int],
) -> Iterator[Trial]:
    """Yield DVM with remeshing by M4'."""
    for order, spacing, count in product(orders, spacings, steps):
        names = ("DVM", f"order {order}, M4' remeshing", "ours")
        fixed = {"scheme": "DVM", "order": order, "dt": problem.time / count * _ONE_OF_N}
        yield _trial(
            contenders.moving, problem, names, **fixed, truncation=truncation, spacing=spacing
        )


def naive_trials(
    problem: Problem,
    schemes: Sequence[str],
    orders: Sequence[int],
    dt: float,
    steps: int,
    **grid: Any,
) -> Iterator[Trial]:
    """Yield the papers' way: sums over all pairs, midpoint steps, truncated; `steps` of them, the rest extrapolated."""
    make = partial(contenders.naive, steps=steps)
    for scheme, order in product(schemes, orders):
        if scheme == "FD" and order > 2:
            continue
        names = (scheme, f"order {order}, naive sums, RK2 steps", "papers")
        for one in _grids(problem, **grid):
            yield _trial(make, problem, names, scheme=scheme, order=order, dt=dt, **one)


def walk_trials(problem: Problem, walkers: Sequence[int], cells: int) -> Iterator[Trial]:
    """Yield the random walk."""
    for count in walkers:
        make = partial(contenders.random_walkers, problem, int(count), cells)
        yield Trial("random walk", "exact increments", "papers", make, count)


def peer_trials(
    problem: Problem, scales: Sequence[float], scaled_spacings: Sequence[float], **grid: Any
) -> Iterator[Trial]:
    """Yield the methods of the literature; `scales` and `scaled_spacings` are L and h of those without ends."""
    lattices = [(problem.half_width(one["truncation"]), one) for one in _grids(problem, **grid)]
    scaled = [(scale, {"spacing": spacing}) for scale, spacing in product(scales, scaled_spacings)]
    for one in PEERS.values():
        places = scaled if one.scaled else lattices
        for exterior, way, place in product(one.exteriors, one.propagations, places):
            names = (one.name, f"{exterior}, {way}", one.group)
            make = partial(one.prepare, exterior=exterior, propagation=way)
            yield _peer_trial(problem, names, make, *place)


def plane_peer_trials(problem: Problem, **grid: Any) -> Iterator[Trial]:
    """Yield the methods of the literature in the plane."""
    for one in PLANE_PEERS.values():
        # The run as one sum, with what there is beyond the square.
        names = (one.name, f"{one.exteriors[0]}, {one.propagations[-1]}", one.group)
        for place in _grids(problem, **grid):
            half_width = problem.half_width(place["truncation"])
            yield _peer_trial(problem, names, one.prepare_plane, half_width, place)


def _peer_trial(
    problem: Problem,
    names: tuple[str, str, str],
    make: Callable[..., Solver | PlaneSolver],
    half_width: float,
    place: dict[str, Any],
) -> Trial:
    spacing = place["spacing"]
    task = {"alpha": problem.alpha, "time": problem.time, "half_width": half_width}
    points = (2.0 * half_width / spacing + 1.0) ** problem.dim
    return Trial(
        *names, partial(contenders.peer, partial(make, **task, spacing=spacing)), points, **place
    )


def lent_exterior_trials(problem: Problem, **grid: Any) -> Iterator[Trial]:
    """Yield the sinc lattice with our exterior: how much of our lead is the exterior's."""
    names = (sinc_lattice.PEER.name, "our exterior, 3 terms, convolution", "peers")
    for place in _grids(problem, **grid):
        half_width = problem.half_width(place["truncation"])
        make = partial(contenders.lent_exterior, problem, half_width, place["spacing"])
        yield Trial(*names, make, 2.0 * half_width / place["spacing"] + 1.0, **place)
