"""The measured run times against the goals that were set before they were measured."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from fracstudy.inputs import Inputs, Result
from scenes.run_times.contests import best, trials_of
from scenes.run_times.cost_growth.study import exponent

_RACES = {
    "work_precision": "line",
    "work_precision_plane": "plane",
    "work_precision_space": "space",
}
_AT_LEAST = ("naive",)
_OURS = ("ours", "schemes")
_GROWING = {"setup_time": "set-up", "application_time": "an application"}
_DOUBLE = 8.0  # bytes


def study(inputs: Inputs, *, goals: dict[str, float], errors: list[float]) -> Result:
    """List what was asked, by the name of the goal, and what was measured."""
    rows = [*_races(inputs, errors), *_reference(inputs.benchmarks["reference_times"])]
    calls = inputs.benchmarks["first_call"].set_index("call")["run_time"]
    rows += [
        (f"process with {call} / s", "first call", calls[call])
        for call in calls.index
        if call.startswith("fp.")
    ]
    rows += _growth(inputs.benchmarks["cost_growth"])
    return Result(pd.DataFrame([_held(*row, goals[row[1]]) for row in rows]))


def _races(inputs: Inputs, errors: list[float]) -> Iterator[tuple[str, str, float]]:
    for name, where in _RACES.items():
        trials = trials_of(inputs.benchmarks[name])
        judged = []
        for problem, part in trials.groupby("problem", sort=False):
            each = [one for _, one in part.groupby("beta")]
            ratio = max(behind(one, errors, one["group"].isin(_OURS)) for one in each)
            yield f"{where}, {problem}: our time / least time", "ahead", ratio
            judged += [behind(one, errors, one["contender"] == "evolve") for one in each]
        yield f"{where}, the worst of these: fp.evolve, judged / least time", "ahead", max(judged)


def _reference(runs: pd.DataFrame) -> Iterator[tuple[str, str, float]]:
    for scheme, part in runs.groupby("scheme"):
        ratio = part["floor_ratio"].max()
        yield f"printed lattice, {scheme}: solve / fastest transforms", "transforms", ratio
    fourth = runs.loc[runs["order"] == 4, "solve_time"].max()
    yield "printed lattice, order IV: slowest solve / s", "printed lattice", fourth
    kpse = runs[(runs["scheme"] == "KPSE") & (runs["order"] == 2)]
    what = "printed setting, KPSE II: naive time / ours"
    yield what, "naive", kpse["naive_over_series"].iloc[0]


def _growth(runs: pd.DataFrame) -> Iterator[tuple[str, str, float]]:
    """The greatest exponents of time against the number of particles, and the most memory that a lattice takes."""
    for dim, part in runs.groupby("dim"):
        each = [one.sort_values("particles") for _, one in part.groupby("kind")]
        for column, what in _GROWING.items():
            steepest = max(exponent(*one[["particles", column]].to_numpy().T) for one in each)
            yield f"{dim} dimension{'s' * (dim > 1)}: exponent of {what}", "growth", steepest
    largest = runs.loc[runs.groupby(["dim", "kind"])["particles"].idxmax()]
    for exterior in ("truncated", "open"):
        held = largest.loc[largest["kind"].str.endswith(exterior), "memory_per_particle"] / _DOUBLE
        yield f"{exterior}, largest lattices: doubles a particle", f"memory {exterior}", held.max()


def _held(what: str, name: str, got: float, goal: float) -> dict[str, Any]:
    met = got >= goal if name in _AT_LEAST else got <= goal
    return {
        "goal": what,
        "asked": f"at {'least' if name in _AT_LEAST else 'most'} {goal:g}",
        "measured": float(got),
        "met": "yes" if met else "no",
    }


def behind(trials: pd.DataFrame, errors: list[float], own: pd.Series) -> float:
    """Return the largest ratio of the least time of our `own` to that of all, over the errors that anybody reaches.

    Infinite if somebody reaches an error that these do not.
    """
    ratios = []
    for error in errors:
        all_of = best(trials, error)
        ours = best(trials[own], error)
        if not np.isnan(all_of["total_time"]):
            ratio = ours["total_time"] / all_of["total_time"]
            ratios.append(np.inf if np.isnan(ratio) else ratio)
    return max(ratios, default=float("nan"))
