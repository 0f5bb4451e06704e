"""Where the time of a run goes: the parts of its set-up and of its solve."""

import pandas as pd

from fracstudy.inputs import Inputs, Result
from fracstudy.machine import machine_note
from scenes.run_times.contests import columns

# Columns of the benchmark: what is taken apart -> its parts, in the order in which they are drawn.
PARTS = {
    "setup_time": (
        "kernel values",
        "far field",
        "range of the symbol",
        "time series",
        "plans and the rest",
    ),
    "solve_time": ("lattice sums", "rest of the solve"),
}
_NAMES = {"setup_time": "set-up", "solve_time": "solve"}


def study(inputs: Inputs) -> Result:
    """List set-up, solve and their parts in milliseconds, a row a case; the series holds the parts' shares."""
    data = inputs.benchmarks["time_spent"]
    names = {"case": "run", "N": "particles", "applications": "applications"}
    for whole, parts in PARTS.items():
        names |= {f"{_NAMES.get(part, part)} / ms": part for part in (whole, *parts)}
    table = columns(data, names)
    table["set-up / solve"] = data["setup_time"] / data["solve_time"]
    series = pd.concat([_shares(data, whole) for whole in PARTS])
    return Result(table, (), series.assign(note=machine_note(data)))


def _shares(data: pd.DataFrame, whole: str) -> pd.DataFrame:
    """The parts of one whole, case by case.

    The rest of a solve is a difference of two minima and may come out below zero, where it is next to nothing.
    """
    parts = data[list(PARTS[whole])].clip(lower=0.0)
    shares = parts.div(parts.sum(axis="columns"), axis="index")
    kept = {"run": "case", "particles": "particles", "applications": "applications", whole: "total"}
    cases = data[list(kept)].rename(columns=kept).assign(panel=_NAMES[whole])
    long = cases.join(shares).melt(
        list(cases), var_name="part", value_name="share", ignore_index=False
    )
    return long.sort_index(kind="stable")
