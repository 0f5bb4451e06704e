"""The least time to an error: every contender and variant."""

from __future__ import annotations

import pandas as pd

from fracstudy.inputs import Inputs, Result
from fracstudy.machine import machine_note
from scenes.run_times.contests import best, trials_of

__all__ = ["study"]


def study(inputs: Inputs, *, errors: list[float], beta: float) -> Result:
    """List every variant of a benchmark: the error it reaches, and the least time to reach some errors.

    Parameters
    ----------
    inputs : Inputs
        With one benchmark.
    errors : list of float
    beta : float
        The one that is drawn.
    """
    (frame,) = inputs.benchmarks.values()
    trials = trials_of(frame)
    rows, key = [], ["beta", "group", "contender", "variant"]
    for (one, group, contender, variant), part in trials.groupby(key):
        row = {
            "beta": one,
            "contender": contender,
            "variant": variant,
            "group": group,
            "trials": len(part),
            "failed": int(part["failed"].sum()),
            "least error": part["error"].min(),
        }
        for error in errors:
            for time, words in (("solve_time", "in"), ("total_time", "with set-up")):
                row[f"{error:.0e} {words} / ms"] = 1e3 * best(part, error, time)[time]
        rows.append(row)
    shown = trials[trials["beta"] == beta]
    bars = []
    for error in errors:
        for (contender, group), part in shown.groupby(["contender", "group"]):
            fastest = best(part, error, "solve_time")[["name", "solve_time", "extrapolated"]]
            bars.append({"error": error, "contender": contender, "group": group, **fastest})
    series = pd.DataFrame(bars).assign(note=machine_note(frame))
    return Result(pd.DataFrame(rows), (), series)
