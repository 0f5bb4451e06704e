"""The reference problem: its run times as people read them."""

from fracstudy.inputs import ORDERS, Inputs, Result
from scenes.run_times.contests import columns

# Column of the table -> that of the benchmark.
_COLUMNS = {
    "scheme": "scheme",
    "order": "order",
    "N": "particles",
    "steps": "steps",
    "operator applications": "operator_applications",
    "set-up / ms": "setup_time",
    "series, min / ms": "solve_time",
    "series, median / ms": "solve_time_median",
    "series / its transforms": "own_ratio",
    "series / fastest transforms": "floor_ratio",
    "transform pair / ms": "own_pair_time",
    "fastest pair / ms": "fastest_pair_time",
    "fastest pair": "fastest_pair",
    "single precision pair / ms": "single_pair_time",
    "cosine pair, half the length / ms": "cosine_pair_time",
    "steps timed": "stepping_measured_steps",
    "stepping, extrapolated / s": "stepping_time",
    "stepping - series, relative": "stepping_deviation",
    "stepping / series": "stepping_over_series",
    "naive steps timed": "naive_measured_steps",
    "naive, extrapolated / s": "naive_time",
    "naive / series": "naive_over_series",
}


def study(inputs: Inputs) -> Result:
    """List the reference problem's run times, and of the series what its transforms alone take."""
    runs = inputs.benchmarks["reference_times"]
    orders = runs["order"].map(ORDERS).where(runs["scheme"] != "GPSE", "-")
    return Result(columns(runs.assign(order=orders), _COLUMNS))
