"""The reference problem: its run times as people read them."""

import pandas as pd

from fracstudy.inputs import ORDERS, Inputs, Result

# Column of the table -> that of the benchmark, and its unit in the table.
_COLUMNS = {
    "scheme": ("scheme", None),
    "order": ("order", None),
    "N": ("particles", None),
    "steps": ("steps", None),
    "operator applications": ("operator_applications", None),
    "set-up / ms": ("setup_time", 1e3),
    "series, min / ms": ("solve_time", 1e3),
    "series, median / ms": ("solve_time_median", 1e3),
    "series / its transforms": ("own_ratio", None),
    "series / fastest transforms": ("floor_ratio", None),
    "transform pair / ms": ("own_pair_time", 1e3),
    "fastest pair / ms": ("fastest_pair_time", 1e3),
    "fastest pair": ("fastest_pair", None),
    "single precision pair / ms": ("single_pair_time", 1e3),
    "cosine pair, half the length / ms": ("cosine_pair_time", 1e3),
    "peak memory / MB": ("peak_memory", 1e-6),
    "stepping / s": ("stepping_time", None),
    "stepping - series, relative": ("stepping_deviation", None),
    "stepping / series": ("stepping_over_series", None),
    "naive steps timed": ("naive_measured_steps", None),
    "naive, extrapolated / s": ("naive_time", None),
    "naive / series": ("naive_over_series", None),
}


def study(inputs: Inputs) -> Result:
    """List the reference problem's run times, and of the series what its transforms alone take."""
    runs = inputs.benchmarks["reference_times"]
    orders = runs["order"].map(ORDERS).where(runs["scheme"] != "GPSE", "-")
    runs = runs.assign(order=orders)
    columns = {
        words: runs[name] if unit is None else unit * runs[name]
        for words, (name, unit) in _COLUMNS.items()
    }
    return Result(pd.DataFrame(columns))
