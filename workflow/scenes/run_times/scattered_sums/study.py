"""Sums over scattered particles: the times of both ways as people read them."""

import pandas as pd

from fracstudy.inputs import Inputs, Result


def study(inputs: Inputs) -> Result:
    """List the times of field and flux of scattered particles by both ways, and their difference."""
    sums = inputs.benchmarks["scattered_sums"]
    columns = {
        "N": sums["particles"],
        "non-uniform FFT / ms": 1e3 * sums["transform_time"],
        "ns a particle": 1e9 * sums["transform_time"] / sums["particles"],
        "naive / ms": 1e3 * sums["naive_time"],
        "naive / FFT": sums["naive_time"] / sums["transform_time"],
        "deviation": sums["deviation"],
    }
    return Result(pd.DataFrame(columns))
