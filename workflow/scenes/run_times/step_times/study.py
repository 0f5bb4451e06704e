"""The time of a step where the operator changes, or the particles move."""

from fracstudy.inputs import Inputs, Result
from scenes.run_times.contests import columns

_COLUMNS = {
    "dim": "dim",
    "method": "method",
    "N": "points",
    "step, min / ms": "step_time",
    "median / ms": "step_time_median",
}


def study(inputs: Inputs) -> Result:
    """List the steps, and their times over that of the exact symbol."""
    data = inputs.benchmarks["step_times"]
    exact = data[data["method"].str.startswith("exact")].set_index("dim")["step_time"]
    ratio = data["step_time"] / data["dim"].map(exact)
    return Result(columns(data, _COLUMNS).assign(**{"time / exact symbol": ratio}))
