"""Tables of benchmarks as people read them: the reference problem, and sums over scattered particles."""

from __future__ import annotations

import pandas as pd

from fracstudy.inputs import ORDERS, Inputs, Result

__all__ = ["reference_times", "scattered_sums"]


def reference_times(inputs: Inputs) -> Result:
    """List the reference problem's run times, and of the series what its transforms alone take."""
    runs = inputs.benchmarks["reference_times"]
    table = pd.DataFrame(
        {
            "scheme": runs["scheme"],
            "order": runs["order"].map(ORDERS).where(runs["scheme"] != "GPSE", "-"),
            "N": runs["particles"],
            "steps": runs["steps"],
            "operator applications": runs["operator_applications"],
            "set-up / ms": 1e3 * runs["setup_time"],
            "series, min / ms": 1e3 * runs["solve_time"],
            "series, median / ms": 1e3 * runs["solve_time_median"],
            "series / its transforms": runs["own_ratio"],
            "series / fastest transforms": runs["floor_ratio"],
            "transform pair / ms": 1e3 * runs["own_pair_time"],
            "fastest pair / ms": 1e3 * runs["fastest_pair_time"],
            "fastest pair": runs["fastest_pair"],
            "single precision pair / ms": 1e3 * runs["single_pair_time"],
            "cosine pair, half the length / ms": 1e3 * runs["cosine_pair_time"],
            "peak memory / MB": 1e-6 * runs["peak_memory"],
            "stepping / s": runs["stepping_time"],
            "stepping - series, relative": runs["stepping_deviation"],
            "stepping / series": runs["stepping_over_series"],
            "naive steps timed": runs["naive_measured_steps"],
            "naive, extrapolated / s": runs["naive_time"],
            "naive / series": runs["naive_over_series"],
        }
    )
    return Result(table)


def scattered_sums(inputs: Inputs) -> Result:
    """List the times of field and flux of scattered particles by both ways, and their difference."""
    sums = inputs.benchmarks["scattered_sums"]
    table = pd.DataFrame(
        {
            "N": sums["particles"],
            "non-uniform FFT / ms": 1e3 * sums["transform_time"],
            "ns a particle": 1e9 * sums["transform_time"] / sums["particles"],
            "naive / ms": 1e3 * sums["naive_time"],
            "naive / FFT": sums["naive_time"] / sums["transform_time"],
            "deviation": sums["deviation"],
        }
    )
    return Result(table)
