"""Error against run time: every problem, every contender that can solve it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from fracstudy.race.clock import one_core, timings_dataset
from fracstudy.race.contenders import CONTENDERS
from fracstudy.race.problems import PROBLEMS
from fracstudy.race.trial import BLOCK, LABELS, VARIABLES, run_trials

if TYPE_CHECKING:
    import xarray as xr


def benchmark(
    dim: int,
    problems: Sequence[str],
    beta: Sequence[float],
    rounds: int,
    repeats: int,
    seconds: float,
    contenders: Sequence[str] = tuple(CONTENDERS),
    most: int | None = None,
) -> xr.Dataset:
    """Measure error, set-up, solve, blocks of solves and memory.

    Parameters
    ----------
    dim : int
        Number of dimensions.
    problems : sequence of str
        Their names; those that do not exist in so many dimensions are left out.
    beta : sequence of float
        Fractional orders.
    rounds, repeats, seconds : int, int, float
        See `trial.run_trials`.
    contenders : sequence of str
        All if left out.
    most : int, optional
        Only the first trials of each.
    """
    one_core()
    rivals = [CONTENDERS[name]() for name in contenders]
    rows: list[dict[str, Any]] = []
    for name in problems:
        if dim in PROBLEMS[name].dims:
            for one in beta:
                rows += run_trials(PROBLEMS[name](one, dim), rivals, rounds, repeats, seconds, most)
    title = f"Error against run time in {dim} dimension{'s' if dim > 1 else ''}"
    facts = {"rounds": rounds, "repeats": repeats, "block": BLOCK, "dim": dim}
    return timings_dataset("trial", rows, LABELS, VARIABLES, title, facts)
