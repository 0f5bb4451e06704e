"""Problems beyond one Fourier transform: the least time of each contender to an error, and who is first."""

from collections.abc import Iterator, Sequence
from typing import Any

import pandas as pd

from fracstudy.inputs import Inputs, Result
from fracstudy.machine import machine_note
from scenes.run_times.contests import best, front

FIRST = "the first"  # the row of a problem that says who is


def study(inputs: Inputs, *, errors: list[float]) -> Result:
    """A row for each problem and contender, and one for each problem with the first to each error."""
    data = inputs.benchmarks["problem_times"]
    trials = data.assign(name=data["contender"], failed=~(data["error"] < float("inf")))
    rows = [
        row
        for problem, part in trials.groupby("problem", sort=False)
        for row in _rows(str(problem), part, errors)
    ]
    parts = trials.groupby(["problem", "contender"], sort=False)
    drawn = trials.assign(front=pd.concat([front(part, "time") for _, part in parts]))
    columns = ["problem", "contender", "group", "size", "error", "time", "front"]
    return Result(pd.DataFrame(rows), (), drawn[columns].assign(note=machine_note(data)))


def _rows(problem: str, part: pd.DataFrame, errors: Sequence[float]) -> Iterator[dict[str, Any]]:
    for contender, own in part.groupby("contender", sort=False):
        least = own.loc[own["error"].idxmin()]
        yield {
            "problem": problem,
            "contender": contender,
            "group": least["group"],
            "size": least["size"],
            "error": least["error"],
            "time / ms": 1e3 * least["time"],
            **{f"to {e:.0e} / ms": 1e3 * best(own, e, "time")["time"] for e in errors},
        }
    winners = {e: best(part, e, "time") for e in errors}
    yield {
        "problem": problem,
        "contender": FIRST,
        **{f"to {e:.0e} / ms": 1e3 * winner["time"] for e, winner in winners.items()},
        **{f"first to {e:.0e}": winner["name"] for e, winner in winners.items()},
    }
