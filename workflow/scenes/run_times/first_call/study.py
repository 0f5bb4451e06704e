"""The first call of a fresh process."""

import pandas as pd

from fracstudy.inputs import Inputs, Result


def study(inputs: Inputs) -> Result:
    """List what a process takes from start to end, and beyond an empty one."""
    data = inputs.benchmarks["first_call"].set_index("call")
    empty = data["process_time"]["an empty program"]
    table = pd.DataFrame(
        {
            "call": data.index,
            "process, min / s": data["process_time"],
            "median / s": data["process_time_median"],
            "beyond an empty program / s": data["process_time"] - empty,
        }
    )
    return Result(table)
