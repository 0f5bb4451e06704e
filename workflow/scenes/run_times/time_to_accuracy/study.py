"""The least time to an error: who comes in first, second and third."""

import pandas as pd

from fracstudy.inputs import Inputs, Result
from scenes.run_times.contests import best, trials_of

_PLACES = ("first", "second", "third")


def study(inputs: Inputs, *, errors: list[float]) -> Result:
    """List the three fastest contenders for each race, problem, beta and error: one solve with its set-up.

    With the error in the tail, the unknowns and the memory of the first.
    """
    rows = [
        {"dim": frame.attrs["dim"], "data": data, "beta": beta, "error": e, **_podium(part, e)}
        for frame in inputs.benchmarks.values()
        for (data, beta), part in trials_of(frame).groupby(["problem", "beta"], sort=False)
        for e in errors
    ]
    return Result(pd.DataFrame(rows))


def _podium(trials: pd.DataFrame, error: float) -> dict[str, object]:
    fastest = pd.DataFrame([best(own, error) for _, own in trials.groupby("contender")])
    fastest = fastest.dropna(subset=["total_time"]).sort_values("total_time").reset_index()
    row: dict[str, object] = {}
    for k, place in enumerate(_PLACES):
        there = k < len(fastest)
        row[place] = fastest["name"][k] if there else "none"
        row[f"{place} / ms"] = 1e3 * fastest["total_time"][k] if there else float("nan")
    if len(fastest):
        first = fastest.iloc[0]
        row |= {
            "N of the first": first["points"],
            "memory / kB": 1e-3 * first["peak_memory"],
            "error in the tail": first["tail_error"],
        }
    return row
