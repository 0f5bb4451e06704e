"""Error against run time: who is ahead, at which error, with and without the set-up."""

from __future__ import annotations

from typing import Any

import pandas as pd

from fracstudy.inputs import Inputs, Result
from fracstudy.machine import machine_note
from scenes.run_times.contests import best, front, trials_of

__all__ = ["study"]

_TIMES = ("solve_time", "total_time")
_DRAWN = ["beta", "contender", "variant", "group", "error", *_TIMES, "extrapolated", "failed"]


def study(inputs: Inputs, *, errors: list[float]) -> Result:
    """List, for each beta and error, the fastest of ours, of the peers, of the papers' way, and the limit.

    One benchmark, of the line or of the plane.
    """
    (frame,) = inputs.benchmarks.values()
    trials = trials_of(frame)
    betas = list(trials.groupby("beta"))
    rows = [_contest(part, beta, error) for beta, part in betas for error in errors]
    series = trials[_DRAWN].copy()
    for time in _TIMES:
        series[f"on front of {time}"] = pd.concat([front(part, time) for _, part in betas])
    return Result(pd.DataFrame(rows), (), series.assign(note=machine_note(frame)))


def _contest(trials: pd.DataFrame, beta: float, error: float) -> dict[str, Any]:
    solve, whole = (
        {group: best(part, error, time) for group, part in _groups(trials).items()}
        for time in _TIMES
    )
    row: dict[str, Any] = {"beta": beta, "error at most": error}
    sides = {"ours": "ours", "peer": "peers"}
    for name, group in sides.items():
        row[name] = solve[group]["name"]
        row[f"{name}, N"] = solve[group]["particles"]
        row[f"{name} / ms"] = 1e3 * solve[group]["solve_time"]
    row["ours / peer"] = solve["ours"]["solve_time"] / solve["peers"]["solve_time"]
    row["the papers' way / s"] = solve["papers"]["solve_time"]
    row["the papers' way / ours"] = solve["papers"]["solve_time"] / solve["ours"]["solve_time"]
    row["limit / ms"] = 1e3 * solve["limit"]["solve_time"]
    for name, group in sides.items():
        row[f"{name}, with set-up"] = whole[group]["name"]
        row[f"{name}, with set-up / ms"] = 1e3 * whole[group]["total_time"]
    ratio = whole["ours"]["total_time"] / whole["peers"]["total_time"]
    return {**row, "ours / peer, with set-up": ratio}


def _groups(trials: pd.DataFrame) -> dict[str, pd.DataFrame]:
    return {
        group: trials[trials["group"] == group] for group in ("ours", "peers", "papers", "limit")
    }
