"""The fundamental solution: the times of an evaluation as people read them."""

from fracstudy.inputs import Inputs, Result
from scenes.run_times.contests import columns

_COLUMNS = {
    "alpha": "alpha",
    "table of alpha / ms": "table_time",
    "ours / ns a point": "point_time",
    "scipy / ns a point": "scipy_time",
    "scipy / ours": "ratio",
}


def study(inputs: Inputs) -> Result:
    """List the time of a point, ours and scipy's, for each alpha."""
    times = inputs.benchmarks["special_functions"]
    return Result(columns(times.assign(ratio=times["scipy_time"] / times["point_time"]), _COLUMNS))
