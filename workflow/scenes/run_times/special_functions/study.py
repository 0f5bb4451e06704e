"""The fundamental solution: the times of an evaluation as people read them."""

import pandas as pd

from fracstudy.inputs import Inputs, Result


def study(inputs: Inputs) -> Result:
    """List the time of a point, ours and scipy's, for each alpha."""
    times = inputs.benchmarks["special_functions"]
    columns = {
        "alpha": times["alpha"],
        "table of alpha / ms": 1e3 * times["table_time"],
        "ours / ns a point": 1e9 * times["point_time"],
        "scipy / ns a point": 1e9 * times["scipy_time"],
        "scipy / ours": times["scipy_time"] / times["point_time"],
    }
    return Result(pd.DataFrame(columns))
