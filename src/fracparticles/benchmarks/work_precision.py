"""Error against run time on the line: the reference problem, every method, every peer."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from fracparticles.benchmarks.clock import one_core, timings_dataset
from fracparticles.benchmarks.contenders import (
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
from fracparticles.benchmarks.problem import Problem
from fracparticles.benchmarks.trial import LABELS, VARIABLES, Trial, run_trials

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["line_trials", "work_precision"]

_SCHEMES = ("DD", "FPSE", "KPSE")


def work_precision(
    beta: Sequence[float],
    rounds: int,
    repeats: int,
    seconds: float,
    **grids: Any,
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
    rows: list[dict[str, Any]] = []
    for one in beta:
        problem = Problem(one)
        trials = list(line_trials(problem, **grids))
        rows += run_trials(problem, trials, rounds, repeats, seconds)
    title = "Error against run time on the line"
    facts = {"rounds": rounds, "repeats": repeats, "t_initial": 0.5, "t_final": 1.5}
    return timings_dataset("trial", rows, LABELS, VARIABLES, title, facts)


def line_trials(
    problem: Problem,
    orders: Sequence[int],
    spacings: Sequence[float],
    truncations: Sequence[float],
    most_particles: float,
    most_matrix: float,
    truncated: dict[str, Any],
    stepped: dict[str, Any],
    particles: dict[str, Any],
    naive: dict[str, Any],
    walkers: dict[str, Any],
    mapped: dict[str, Any],
) -> Iterator[Trial]:
    """Yield the trials.

    Parameters
    ----------
    problem : Problem
    orders : sequence of int
        Of the kernels.
    spacings, truncations : sequence of float
        h and C of every lattice whose exterior is open.
    most_particles, most_matrix : float
        Larger lattices are left out; larger matrices, too.
    truncated : dict
        `orders`, `spacings` and `truncations` of the truncated ones.
    stepped, particles, naive, walkers : dict
        Arguments of `stepped_trials`, `particle_trials`, `naive_trials` and `walk_trials`.
    mapped : dict
        `scales` L and `scaled_spacings` h of the mapped line.
    """
    opened = (spacings, truncations, most_particles)
    closed = (truncated["spacings"], truncated["truncations"], most_particles)
    cut = {"exterior": "truncated"}
    for terms in (1, 3):
        way = {"exterior": "open", "far_terms": terms}
        series = {**way, "evaluation": "series"}
        yield from scheme_trials(problem, _SCHEMES, orders, series, *opened)
        single = list(one_step_trials(problem, way, *opened))
        yield from single
        yield from matrix_trials(single, most_matrix)
        yield from tied_step_trials(problem, way, *opened)
    at_once = {"exterior": "open", "far_terms": 1, "evaluation": "convolution"}
    yield from scheme_trials(problem, _SCHEMES, orders, at_once, *opened)
    cut_series = {**cut, "evaluation": "series"}
    yield from scheme_trials(problem, _SCHEMES, truncated["orders"], cut_series, *closed)
    yield from one_step_trials(problem, cut, *closed)
    yield from tied_step_trials(problem, cut, *closed)
    yield from stepped_trials(problem, **stepped)
    yield from particle_trials(problem, **particles)
    yield from naive_trials(problem, **naive)
    yield from walk_trials(problem, **walkers)
    peers = list(peer_trials(problem, *opened, **mapped))
    yield from peers
    yield from matrix_trials((t for t in peers if t.group == "peers"), most_matrix)
