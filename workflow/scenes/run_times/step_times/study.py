"""The time of a step where the operator changes, or the particles move."""

import pandas as pd

from fracstudy.inputs import Inputs, Result


def study(inputs: Inputs) -> Result:
    """List the steps, and their times over that of the exact symbol."""
    data = inputs.benchmarks["step_times"]
    exact = data[data["method"].str.startswith("exact")].set_index("dim")["step_time"]
    table = pd.DataFrame(
        {
            "dim": data["dim"],
            "method": data["method"],
            "N": data["points"],
            "step, min / ms": 1e3 * data["step_time"],
            "median / ms": 1e3 * data["step_time_median"],
            "time / exact symbol": data["step_time"] / data["dim"].map(exact),
        }
    )
    return Result(table)
