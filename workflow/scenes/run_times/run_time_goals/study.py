"""The measured run times against the goals that were set before they were measured."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from fracstudy.inputs import Inputs, Result
from scenes.run_times.contests import best, trials_of

__all__ = ["off_the_front", "study"]

_SAME = 1.001  # two errors within this ratio are told apart by nothing but the norm's own sum


def study(inputs: Inputs, *, goals: dict[str, float], errors: list[float]) -> Result:
    """List what was asked, by the name of the goal, and what was measured; `errors` are those of the Pareto front."""
    line = trials_of(inputs.benchmarks["work_precision"])
    reference = inputs.benchmarks["reference_times"]
    middle = line[(line["beta"] == 0.5) & (line["group"] == "ours")]
    by_series = middle["contender"].isin(["DD", "FPSE", "KPSE"])
    series = middle[by_series & middle["variant"].str.endswith(" series")]
    kpse = reference[(reference["scheme"] == "KPSE") & (reference["order"] == 2)]
    fourth = reference.loc[reference["order"] == 4, "solve_time"]
    whole = best(middle, 1e-9, "total_time")
    chebyshev = "the same by a Chebyshev series of DD, FPSE or KPSE, error 1e-8, solve / ms"
    set_up = "set-up of our run with the least set-up and solve, error 1e-9 / ms"
    printed = "printed lattice, h = 0.0112 and C = 160, order IV, slowest scheme, solve / s"
    naive = "printed setting, KPSE of order II: the naive algorithm, its steps extrapolated, over ours, one core"
    rows = [
        ("beta = 0.5, error 1e-8, solve / ms", "error 1e-8", _least(middle, 1e-8)),
        ("beta = 0.5, error 1e-9, solve / ms", "error 1e-9", _least(middle, 1e-9)),
        (chebyshev, "error 1e-8", _least(series, 1e-8)),
        ("the same, error 1e-9, solve / ms", "error 1e-9", _least(series, 1e-9)),
        (set_up, "set-up", 1e3 * whole["setup_time"]),
        (printed, "printed lattice", fourth.max()),
        (naive, "naive", kpse["naive_over_series"].iloc[0]),
    ]
    span = f"the worst of all errors from {errors[0]:g} to {errors[-1]:g}"
    for beta, part in line.groupby("beta"):
        what = f"beta = {beta:g}: our fastest over the fastest of all, {span}"
        rows.append((what, "front", off_the_front(part, errors)))
    return Result(pd.DataFrame([_held(*row, goals[row[1]]) for row in rows]))


def _held(what: str, name: str, got: float, goal: float) -> dict[str, Any]:
    at_least = name == "naive"
    met = got >= goal if at_least else got <= goal
    return {
        "goal": what,
        "asked": f"at {'least' if at_least else 'most'} {goal:g}",
        "measured": float(got),
        "met": "yes" if met else "no",
    }


def _least(trials: pd.DataFrame, error: float) -> float:
    """In milliseconds."""
    return 1e3 * float(best(trials, error, "solve_time")["solve_time"])


def off_the_front(trials: pd.DataFrame, errors: list[float]) -> float:
    """The largest ratio, over all errors from the first to the last, of our least time to the least of all.

    Either least time, as a function of the error allowed, steps down at the errors of the trials: these and the ends
    are all that there is to look at. An error of ours that is the same but for its last digits counts as reached: two
    contenders that are one but for round-off are not apart. Infinite, if somebody gets to an error that ours do not.
    """
    done = trials[~trials["failed"]].sort_values("error")
    error = done["error"].to_numpy()
    ours = np.where(done["group"] == "ours", done["solve_time"], np.inf)
    least = np.minimum.accumulate(done["solve_time"].to_numpy())
    ours = np.minimum.accumulate(ours)
    allowed = np.union1d(errors, error[(error > errors[-1]) & (error < errors[0])])
    last, ours_last = (
        np.searchsorted(error, allowed * slack, side="right") - 1 for slack in (1.0, _SAME)
    )
    reached = last >= 0
    ratios = ours[ours_last[reached]] / least[last[reached]]
    return float(ratios.max()) if len(ratios) else np.nan
