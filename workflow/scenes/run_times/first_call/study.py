"""The first call of a fresh process."""

from fracstudy.inputs import Inputs, Result
from scenes.run_times.contests import columns

_TIMES = {"call": "call", "process, min / s": "run_time", "median / s": "run_time_median"}


def study(inputs: Inputs) -> Result:
    """List what a process takes from start to end, and beyond an empty one."""
    data = inputs.benchmarks["first_call"]
    empty = data.set_index("call")["run_time"]["an empty program"]
    beyond = {"beyond an empty program / s": data["run_time"] - empty}
    return Result(columns(data, _TIMES).assign(**beyond))
