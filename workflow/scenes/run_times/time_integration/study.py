"""One operator, every time integrator: what a digit costs in time and in operator applications."""

from fracstudy.inputs import Inputs, Result
from fracstudy.machine import machine_note
from scenes.run_times.contests import columns

_SERIES = "Chebyshev series"  # what the others are compared with

_COLUMNS = {
    "operator": "operator",
    "integrator": "integrator",
    "steps": "steps",
    "operator applications": "applications",
    "error of the time integration": "error",
    "solve / ms": "solve_time",
}
_INTEGRATORS = {"euler": "RK1", "rk2": "RK2", "rk4": "RK4"}


def study(inputs: Inputs) -> Result:
    """List the error of the time integration beside the operator applications and the time that it takes.

    Times are minima; that of the series of the same operator is the unit of the last column.
    """
    data = inputs.benchmarks["time_integration"]
    runs = data.assign(integrator=data["integrator"].replace(_INTEGRATORS))
    of_series = runs[runs["integrator"] == _SERIES].set_index("operator")["solve_time"]
    ratio = runs["solve_time"] / runs["operator"].map(of_series)
    table = columns(runs, _COLUMNS).assign(**{"time / that of the series": ratio})
    series = runs[["operator", "integrator", "steps", "applications", "error", "solve_time"]]
    return Result(table, (), series.assign(note=machine_note(data)))
