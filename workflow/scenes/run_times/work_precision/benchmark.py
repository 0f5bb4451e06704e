"""Error against run time: every problem, every contender that can solve it."""

from collections.abc import Sequence
from typing import Any

from fracstudy.race.clock import Measurements, one_core, timings_dataset
from fracstudy.race.contenders import CONTENDERS
from fracstudy.race.problems import PROBLEMS
from fracstudy.race.trial import BLOCK, LABELS, VARIABLES, run_trials


def benchmark(
    dim: int,
    problems: Sequence[str],
    beta: Sequence[float],
    rounds: int,
    repeats: int,
    seconds: float,
    contenders: Sequence[str] = tuple(CONTENDERS),
    most: int | None = None,
) -> Measurements:
    """Measure error, set-up, solve, blocks of solves and memory, see `trial.run_trials`.

    Problems that do not exist in so many dimensions are left out; only the first `most` trials of each contender are
    made if that is given.
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
