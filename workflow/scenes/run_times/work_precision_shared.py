"""Error against run time: who is ahead, at which error, with and without the set-up."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from fracstudy.inputs import Inputs, Result
from fracstudy.machine import machine_note

__all__ = ["best", "front", "time_to_accuracy", "trials_of", "work_precision"]

_OURS, _PEERS, _PAPERS, _LIMIT = "ours", "peers", "papers", "limit"


def work_precision(inputs: Inputs) -> Result:
    """List, for each beta and error, the fastest of ours, of the peers, of the papers' way, and the limit.

    Parameters of the scene: `errors`, a list. One benchmark, of the line or of the plane.
    """
    trials = trials_of(inputs)
    rows = [
        _contest(part, beta, error)
        for beta, part in trials.groupby("beta")
        for error in inputs.parameters["errors"]
    ]
    columns = ["beta", "family", "variant", "group", "error", "solve_time", "total_time"]
    series = trials[[*columns, "extrapolated", "failed"]].copy()
    for time in ("solve_time", "total_time"):
        on_front = [front(part, time) for _, part in trials.groupby("beta")]
        series[f"on front of {time}"] = pd.concat(on_front)
    return Result(pd.DataFrame(rows), (), series.assign(note=_note(inputs)))


def time_to_accuracy(inputs: Inputs) -> Result:
    """List every method of a benchmark: the error it reaches, and the least time to reach some errors.

    Parameters of the scene: `errors`, a list; `beta`, the one that is drawn.
    """
    trials, errors = trials_of(inputs), inputs.parameters["errors"]
    rows = []
    for (beta, group, family, variant), part in trials.groupby(
        ["beta", "group", "family", "variant"], sort=True
    ):
        row = {
            "beta": beta,
            "method": family,
            "variant": variant,
            "group": group,
            "trials": len(part),
            "failed": int(part["failed"].sum()),
            "least error": part["error"].min(),
        }
        for error in errors:
            fastest = best(part, error, "solve_time")
            row[f"{error:.0e} in / ms"] = np.nan if fastest is None else 1e3 * fastest["solve_time"]
            whole = best(part, error, "total_time")
            row[f"{error:.0e} with set-up / ms"] = (
                np.nan if whole is None else 1e3 * whole["total_time"]
            )
        rows.append(row)
    shown = trials[trials["beta"] == float(inputs.parameters["beta"])]
    bars = [
        {"error": error, "family": family, "group": group, **_fastest(part, error)}
        for error in errors
        for (family, group), part in shown.groupby(["family", "group"])
    ]
    return Result(pd.DataFrame(rows), (), pd.DataFrame(bars).assign(note=_note(inputs)))


def trials_of(inputs: Inputs, name: str | None = None) -> pd.DataFrame:
    """Return the trials of a benchmark, of the only one if it is not named, with their total time and failures."""
    if name is None:
        (frame,) = inputs.benchmarks.values()
    else:
        frame = inputs.benchmarks[name]
    return frame.assign(
        total_time=frame["setup_time"] + frame["solve_time"],
        failed=~np.isfinite(frame["error"]) | (frame["failure"].astype(str) != ""),
    )


def best(trials: pd.DataFrame, error: float, time: str) -> pd.Series | None:
    """Return the trial of least `time` whose error is at most `error`; None if there is none."""
    reached = trials[~trials["failed"] & (trials["error"] <= error)]
    return reached.loc[reached[time].idxmin()] if len(reached) else None


def front(trials: pd.DataFrame, time: str) -> pd.Series:
    """Return which trials are on the Pareto front: none is as fast and has a smaller error."""
    ordered = trials[~trials["failed"]].sort_values([time, "error"])
    so_far = ordered["error"].cummin().shift(fill_value=np.inf)
    return (ordered["error"] < so_far).reindex(trials.index, fill_value=False)


def _contest(trials: pd.DataFrame, beta: float, error: float) -> dict[str, Any]:
    row: dict[str, Any] = {"beta": beta, "error at most": error}
    solve, whole = {}, {}
    for group in (_OURS, _PEERS, _PAPERS, _LIMIT):
        part = trials[trials["group"] == group]
        solve[group], whole[group] = (
            best(part, error, "solve_time"),
            best(part, error, "total_time"),
        )
    for group, name in ((_OURS, "ours"), (_PEERS, "peer")):
        row |= _described(name, solve[group])
    row["ours / peer"] = _ratio(solve[_OURS], solve[_PEERS], "solve_time")
    row["the papers' way / s"] = _value(solve[_PAPERS], "solve_time")
    row["the papers' way / ours"] = _ratio(solve[_PAPERS], solve[_OURS], "solve_time")
    row["limit / ms"] = 1e3 * _value(solve[_LIMIT], "solve_time")
    for group, name in ((_OURS, "ours"), (_PEERS, "peer")):
        row[f"{name}, with set-up"] = _name(whole[group])
        row[f"{name}, with set-up / ms"] = 1e3 * _value(whole[group], "total_time")
    row["ours / peer, with set-up"] = _ratio(whole[_OURS], whole[_PEERS], "total_time")
    return row


def _described(name: str, trial: pd.Series | None) -> dict[str, Any]:
    return {
        name: _name(trial),
        f"{name}, N": _value(trial, "particles"),
        f"{name} / ms": 1e3 * _value(trial, "solve_time"),
    }


def _name(trial: pd.Series | None) -> str:
    return "none" if trial is None else f"{trial['family']}, {trial['variant']}"


def _value(trial: pd.Series | None, column: str) -> float:
    return np.nan if trial is None else float(trial[column])


def _ratio(a: pd.Series | None, b: pd.Series | None, column: str) -> float:
    return _value(a, column) / _value(b, column)


def _fastest(part: pd.DataFrame, error: float) -> dict[str, Any]:
    trial = best(part, error, "solve_time")
    return {
        "variant": _name(trial),
        "solve_time": _value(trial, "solve_time"),
        "setup_time": _value(trial, "setup_time"),
        "extrapolated": _value(trial, "extrapolated") > 1.0,
    }


def _note(inputs: Inputs) -> str:
    (frame,) = inputs.benchmarks.values()
    return machine_note(frame)
