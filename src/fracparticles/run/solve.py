"""Run a case to a data set, in one call."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fracparticles import arguments as check
from fracparticles.run.case import Case, a_case
from fracparticles.run.dataset import to_dataset
from fracparticles.run.initial import Initial, resolved
from fracparticles.run.solver import Progress, compute
from fracparticles.run.units import Units, units_of, with_units

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["solve"]


def solve(
    case: Case,
    initial: Initial | None = None,
    *,
    estimate: bool = False,
    units: Units | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Run a case.

    Parameters
    ----------
    case : Case
        The run.
    initial : array, labelled data, callable or path, optional
        Initial strengths of shape `case.shape`; a DataArray, Dataset or Series with u on x, y and z, in any order; a
        function of x (y, z), as its arguments are named; a NetCDF file that holds u; a table or other
        `measured` data. Left out, the run starts from the data that `case.initial` names, by default the fundamental
        solution at `case.t_initial`.
    estimate : bool
        Estimate the error, too, as `estimate_error` does: `estimated_error` and its parts are variables of the result.
    units : Units, optional
        Names of the units of the numbers, for the attributes of the result; left out, those that the data name.
    progress : callable, optional
        Called repeatedly with the share of the run that is done, from 0 to 1.

    Returns
    -------
    xarray.Dataset
        See `dataset.to_dataset`.

    Raises
    ------
    InvalidInput
        If the initial data do not fit the case.
    NonFiniteSolution
        If the run blows up.

    Warns
    -----
    StabilityWarning
        If some wave grows.
    AccuracyWarning
        If an estimate from the strengths shows that they may be far from the solution, see `reliability`; if the data
        are your own and have no time, and t_initial was not given.
    """
    source, estimate = resolved(a_case(case), initial), check.flag("estimate", estimate)
    units = units_of(source, units)
    solution = compute(case, source, progress)
    if estimate:
        from fracparticles.run.estimate import estimates_of  # loads what a run does not need

        result = to_dataset(solution, estimates_of(solution, source))
    else:
        result = to_dataset(solution)
    return with_units(result, units)
