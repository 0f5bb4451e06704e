"""Error against run time: who is ahead, at which error, on which data."""

from collections.abc import Iterator
from typing import Any

import pandas as pd

from fracstudy.inputs import Inputs, Result
from fracstudy.machine import machine_note
from scenes.run_times.contests import best, front, trials_of

_GROUPS = {"ours": "ours", "peers": "peer", "schemes": "scheme of the papers"}


def study(inputs: Inputs, *, errors: list[float], time: str) -> Result:
    """List, for each problem, beta and error, the fastest of ours, of the peers and of the papers' schemes.

    `time` is "total_time", of one solve with its set-up, or "block_time", of one of many.
    """
    (frame,) = inputs.benchmarks.values()
    trials = trials_of(frame).dropna(subset=[time])
    parts = list(trials.groupby(["problem", "beta"], sort=False))
    rows = [
        {"data": problem, "beta": beta, "error": error, **_contest(part, error, time)}
        for (problem, beta), part in parts
        for error in errors
    ]
    drawn = trials.assign(time=trials[time], front=pd.concat([front(p, time) for _, p in parts]))
    columns = ["problem", "beta", "contender", "group", "error", "time", "front", "failed"]
    series = drawn[columns].assign(note=machine_note(frame))
    return Result(pd.DataFrame(rows), (), series)


def _contest(trials: pd.DataFrame, error: float, time: str) -> dict[str, Any]:
    row = dict(_entries(trials, error, time))
    return {**row, "ours / peer": row["ours / ms"] / row["peer / ms"]}


def _entries(trials: pd.DataFrame, error: float, time: str) -> Iterator[tuple[str, Any]]:
    for group, title in _GROUPS.items():
        fastest = best(trials[trials["group"] == group], error, time)
        yield title, fastest["name"]
        yield f"{title}, N", fastest["points"]
        yield f"{title} / ms", 1e3 * fastest[time]
