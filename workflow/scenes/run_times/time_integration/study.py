"""One operator, every time integrator: what a digit costs in time and in operator applications."""

import pandas as pd

from fracstudy.inputs import Inputs, Result
from fracstudy.machine import machine_note

_SERIES = "Chebyshev series"  # what the others are compared with

_INTEGRATORS = {"euler": "RK1", "rk2": "RK2", "rk4": "RK4"}


def study(inputs: Inputs) -> Result:
    """List the error of the time integration beside the operator applications and the time that it takes.

    Times are minima; that of the series of the same operator is the unit of the last column.
    """
    data = inputs.benchmarks["time_integration"]
    runs = data.assign(integrator=data["integrator"].replace(_INTEGRATORS))
    of_series = runs[runs["integrator"] == _SERIES].set_index("operator")["solve_time"]
    table = pd.DataFrame(
        {
            "operator": runs["operator"],
            "integrator": runs["integrator"],
            "steps": runs["steps"],
            "operator applications": runs["applications"],
            "error of the time integration": runs["error"],
            "solve / ms": 1e3 * runs["solve_time"],
            "time / that of the series": runs["solve_time"] / runs["operator"].map(of_series),
        }
    )
    series = runs[["operator", "integrator", "steps", "applications", "error", "solve_time"]]
    return Result(table, (), series.assign(note=machine_note(data)))
