"""Two runs side by side: their parameters, their results, and the distance of their strengths.

The distance is taken over the particles that the lattices share, and the output times that the runs share,

    sum |u - v| / sum |u|   and   max |u - v| / max |u|,

with u of the first run and v of the second.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fracparticles.errors import spelled
from fracparticles.run.agreement import stored_in
from fracparticles.run.dataset import read_run

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["compare", "comparison", "distance"]

_SAME_PLACE = 1e-9  # share of a spacing, and of the last time: nearer points are the same
_NO_UNIT = "1"  # the name of no unit
_UNITS = {"x": "length", "t_final": "time", "u": "u"}  # the variables with units: what these are of
_NOT_TOLD = ("initial", "store", "times")  # fields of a case that are not shown: other rows tell

Row = tuple[str, str, str]


def compare(first: str, second: str) -> None:
    """Print in what two runs differ: parameters, results, strengths at the particles that they share.

    Parameters
    ----------
    first, second : str
        Files that `fracparticles solve` or `fp.write` wrote.
    """
    runs = read_run(first), read_run(second)
    rows = [("", first, second), *comparison(*runs)]
    widths = [max(len(row[column]) for row in rows) for column in range(2)]
    for name, one, other in rows:
        print(f"{name:{widths[0]}}  {one:{widths[1]}}  {other}".rstrip())
    if len(rows) == 1:
        print("no difference in parameters and results")
    if any(run.attrs.get("reproducible", "yes") != "yes" for run in runs):
        print("coefficients that are functions are in no file: whether they differ is not known")
    print(distance(*runs))


def comparison(first: xr.Dataset, second: xr.Dataset) -> list[Row]:
    """Return the differences of two runs: the name, and the values in the first and in the second.

    Compared are the parameters and scalar results, the initial data, coefficients that are texts, and units.
    """
    one, other = _told(first), _told(second)
    each = [(name, one.get(name), other.get(name)) for name in dict.fromkeys([*one, *other])]
    return [(name, *_shown(a, b)) for name, a, b in each if not _equal(a, b)]


def distance(first: xr.Dataset, second: xr.Dataset) -> str:
    """Return the distance of the strengths of two runs in a line; see the module."""
    if "u" not in first or "u" not in second:
        return "u: a file holds no strengths to compare; run the case with --store field"
    u, v = _with_times(first), _with_times(second)
    if u.dims != v.dims:
        return f"u: not on the same axes, {spelled(u.dims, ', ')} and {spelled(v.dims, ', ')}"
    for name, one, other in zip(_UNITS, _units(first), _units(second), strict=True):
        if one != other and _NO_UNIT not in (one, other):
            return f"u: not in the same units, {_UNITS[name]} is in {one} and in {other}"
    v = v.reindex(t=u.t, method="nearest", tolerance=_SAME_PLACE * float(np.abs(u.t).max()))
    if "ring" in u.dims:  # they are counted, and have no places of their own
        if u.shape[1:] != v.shape[1:] or first.half_width != second.half_width:
            return "u: not on the same rings"
    else:
        for axis in u.dims[1:]:
            near = _SAME_PLACE * float(np.diff(u[axis]).min())
            v = v.reindex({axis: u[axis]}, method="nearest", tolerance=near)
    shared = np.isfinite(v.values)
    if not shared.any():
        return "u: the runs share no time and place"
    one, other = u.values[shared], v.values[shared]
    apart = np.abs(one - other)
    where = f"u: at {shared.sum()} shared values of {u.size} and {second.u.size}"
    if not apart.any():
        return f"{where} no difference"
    total, greatest = np.abs(one).sum(), np.abs(one).max()
    if total == 0.0:
        return f"{where} max |u - v| = {apart.max():.3g}, and u is zero there"
    return (
        f"{where} sum |u - v| / sum |u| = {apart.sum() / total:.3g}, "
        f"max |u - v| / max |u| = {apart.max() / greatest:.3g}"
    )


def _with_times(run: xr.Dataset) -> xr.DataArray:
    """u with its output times as the first axis; a run without them has its final time only."""
    return run.u if "t" in run.u.dims else run.u.expand_dims(t=[float(run.t_final)])


def _told(run: xr.Dataset) -> dict[str, Any]:
    """The scalars of a run, the other fields of its case or problem, its initial data and its units."""
    told = _scalars(run)
    stored = stored_in(run) or {}
    told |= {
        name: value for name, value in stored.items() if name not in (*run.variables, *_NOT_TOLD)
    }
    told["initial_data"] = run.attrs.get("initial_data")
    return told | {
        f"unit of {_UNITS[name]}": unit for name, unit in zip(_UNITS, _units(run), strict=True)
    }


def _units(run: xr.Dataset) -> list[str]:
    """The units of the variables of `_UNITS`."""
    return [
        str(run[name].attrs.get("units", _NO_UNIT)) if name in run.variables else _NO_UNIT
        for name in _UNITS
    ]


def _scalars(run: xr.Dataset) -> dict[str, Any]:
    scalars = [*run.coords.values(), *run.data_vars.values()]
    return {str(one.name): one.item() for one in scalars if one.ndim == 0}


def _equal(one: Any, other: Any) -> bool:
    return one == other or (one != one and other != other)  # nan is a value like another


def _shown(one: Any, other: Any) -> tuple[str, str]:
    """Six digits of each value, or all digits if six are the same."""
    first, second = (
        "-" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)
        for value in (one, other)
    )
    return (first, second) if first != second else (repr(one), repr(other))
