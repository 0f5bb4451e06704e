"""Error against run time: the problem of the papers on the line or in the plane, every scheme, every peer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from fracstudy.benchmarks.clock import one_core, timings_dataset
from fracstudy.benchmarks.problem import Problem
from fracstudy.benchmarks.sweeps import sweep
from fracstudy.benchmarks.trial import LABELS, VARIABLES, run_trials

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["benchmark"]


def benchmark(
    dim: int,
    beta: Sequence[float],
    rounds: int,
    repeats: int,
    seconds: float,
    sweeps: Mapping[str, Mapping[str, Any]],
) -> xr.Dataset:
    """Measure error, set-up and solve of all contenders.

    Parameters
    ----------
    dim : int
        1 for the line, 2 for the plane.
    beta : sequence of float
        Fractional orders.
    rounds, repeats, seconds : int, int, float
        See `trial.run_trials`.
    sweeps : mapping
        What is tried, by a name for it: the arguments of `sweeps.sweep`.
    """
    one_core()
    problems = [Problem(one, dim) for one in beta]
    # All of them first: what is wrong with them shows before any time is spent.
    trials = [
        [trial for given in sweeps.values() for trial in sweep(problem, **given)]
        for problem in problems
    ]
    rows: list[dict[str, Any]] = []
    for problem, tried in zip(problems, trials, strict=True):
        rows += run_trials(problem, tried, rounds, repeats, seconds)
    title = f"Error against run time {'on the line' if dim == 1 else 'in the plane'}"
    facts = {"rounds": rounds, "repeats": repeats, "t_initial": 0.5, "t_final": 1.5}
    return timings_dataset("trial", rows, LABELS, VARIABLES, title, facts)
