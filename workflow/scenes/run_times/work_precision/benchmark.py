"""Error against run time on the line: the reference problem, every method, every peer."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from fracstudy.benchmarks.clock import one_core, timings_dataset
from fracstudy.benchmarks.problem import Problem
from fracstudy.benchmarks.sweeps import (
    graded_trials,
    lent_exterior_trials,
    matrix_trials,
    naive_trials,
    one_step_trials,
    particle_trials,
    peer_trials,
    scheme_trials,
    stepped_trials,
    tied_step_trials,
    walk_trials,
)
from fracstudy.benchmarks.trial import LABELS, VARIABLES, Trial, run_trials

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["benchmark", "line_trials"]

_SCHEMES = ("DD", "FPSE", "KPSE")
_Grid = Mapping[str, Any]


def benchmark(
    beta: Sequence[float], rounds: int, repeats: int, seconds: float, **grids: Any
) -> xr.Dataset:
    """Measure error, set-up and solve of all contenders on the line.

    Parameters
    ----------
    beta : sequence of float
        Fractional orders.
    rounds, repeats, seconds : int, int, float
        See `trial.run_trials`.
    **grids
        See `line_trials`.
    """
    one_core()
    problems = [Problem(one) for one in beta]
    # All of them first: what is wrong with them shows before any time is spent.
    trials = [list(line_trials(problem, **grids)) for problem in problems]
    rows: list[dict[str, Any]] = []
    for problem, one in zip(problems, trials, strict=True):
        rows += run_trials(problem, one, rounds, repeats, seconds)
    title = "Error against run time on the line"
    facts = {"rounds": rounds, "repeats": repeats, "t_initial": 0.5, "t_final": 1.5}
    return timings_dataset("trial", rows, LABELS, VARIABLES, title, facts)


def line_trials(
    problem: Problem,
    at_once: _Grid,
    series: _Grid,
    truncated: _Grid,
    graded: _Grid,
    stepped: _Grid,
    particles: _Grid,
    naive: _Grid,
    walkers: _Grid,
    peers: _Grid,
    matrices: float,
) -> Iterator[Trial]:
    """Yield the trials.

    Parameters
    ----------
    problem : Problem
    at_once : mapping
        `orders`, `spacings`, `truncations` and the `most` particles of runs that are one lattice sum, open.
    series : mapping
        Likewise of those by a Chebyshev series, open; GPSE with its step tied to h is among them.
    truncated : mapping
        Likewise of truncated lattices, by a series.
    graded, stepped, particles, naive, walkers, peers : mapping
        Arguments of `graded_trials`, `stepped_trials`, `particle_trials`, `naive_trials`, `walk_trials` and
        `peer_trials`; the lattices of the peers are those of `lent_exterior_trials`, too.
    matrices : float
        GPSE in one step and the peers of up to so many points also run as one matrix.
    """
    grid = {name: value for name, value in at_once.items() if name != "orders"}
    for terms in (1, 3):
        way = {"exterior": "open", "far_terms": terms}
        summed = {**way, "evaluation": "convolution"}
        yield from one_step_trials(problem, way, **grid)
        single = list(one_step_trials(problem, summed, **grid))
        yield from single
        yield from matrix_trials(single, matrices)
        # What the further terms of the exterior are worth is shown by KPSE; the others have them.
        schemes = _SCHEMES if terms == 3 else ("KPSE",)
        yield from _scheme_and_tied_trials(problem, schemes, way, **series)
    yield from scheme_trials(problem, _SCHEMES, way=summed, **at_once)
    yield from _scheme_and_tied_trials(problem, _SCHEMES, {"exterior": "truncated"}, **truncated)
    yield from graded_trials(problem, **graded)
    yield from stepped_trials(problem, **stepped)
    yield from particle_trials(problem, **particles)
    yield from naive_trials(problem, **naive)
    yield from walk_trials(problem, **walkers)
    lattices = {name: peers[name] for name in ("spacings", "truncations", "most")}
    rivals = [*peer_trials(problem, **peers), *lent_exterior_trials(problem, **lattices)]
    yield from rivals
    yield from matrix_trials((t for t in rivals if t.group == "peers"), matrices)


def _scheme_and_tied_trials(
    problem: Problem, schemes: Sequence[str], way: _Grid, orders: Sequence[int], **grid: Any
) -> Iterator[Trial]:
    yield from scheme_trials(problem, schemes, orders, {**way, "evaluation": "series"}, **grid)
    yield from tied_step_trials(problem, way, **grid)
