"""Error against run time in the plane: the problem of Sec. 5, every scheme, the peers that exist there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from fracstudy.benchmarks.clock import one_core, timings_dataset
from fracstudy.benchmarks.problem import Problem
from fracstudy.benchmarks.sweeps import (
    matrix_trials,
    naive_trials,
    one_step_trials,
    plane_peer_trials,
    scheme_trials,
    tied_step_trials,
)
from fracstudy.benchmarks.trial import LABELS, VARIABLES, Trial, run_trials

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["benchmark", "plane_trials"]


def benchmark(beta: float, rounds: int, repeats: int, seconds: float, **grids: Any) -> xr.Dataset:
    """Measure error, set-up and solve of all contenders in the plane.

    Parameters
    ----------
    beta : float
        Fractional order.
    rounds, repeats, seconds : int, int, float
        See `trial.run_trials`.
    **grids
        See `plane_trials`.
    """
    one_core()
    problem = Problem(beta, dim=2)
    rows = run_trials(problem, list(plane_trials(problem, **grids)), rounds, repeats, seconds)
    title = "Error against run time in the plane"
    facts = {"rounds": rounds, "repeats": repeats, "t_initial": 0.5, "t_final": 1.5}
    return timings_dataset("trial", rows, LABELS, VARIABLES, title, facts)


def plane_trials(
    problem: Problem,
    opened: Mapping[str, Any],
    truncated: Mapping[str, Any],
    fpse: Mapping[str, Any],
    naive: Mapping[str, Any],
    peers: Mapping[str, Any],
    matrices: float,
) -> Iterator[Trial]:
    """Yield the trials.

    Parameters
    ----------
    problem : Problem
    opened, truncated : mapping
        `orders` of DD and KPSE, `spacings`, `truncations` and the `most` particles of lattices with either exterior.
    fpse : mapping
        Likewise of FPSE, truncated: it has the orders 2 and 4 in the plane.
    naive, peers : mapping
        Arguments of `naive_trials` and `plane_peer_trials`.
    matrices : float
        GPSE in one step and the peers on up to so many points also run as one matrix.
    """
    for exterior, block in (("open", opened), ("truncated", truncated)):
        orders = block["orders"]
        grid = {name: value for name, value in block.items() if name != "orders"}
        way = {"exterior": exterior}
        series = {**way, "evaluation": "series"}
        yield from scheme_trials(problem, ("DD", "KPSE"), orders, series, **grid)
        single = list(one_step_trials(problem, way, **grid))
        yield from single
        yield from matrix_trials(single, matrices)
        yield from tied_step_trials(problem, way, **grid)
    series = {"exterior": "truncated", "evaluation": "series"}
    yield from scheme_trials(problem, ("FPSE",), way=series, **fpse)
    yield from naive_trials(problem, **naive)
    rivals = list(plane_peer_trials(problem, **peers))
    yield from rivals
    yield from matrix_trials((t for t in rivals if t.group == "peers"), matrices)
