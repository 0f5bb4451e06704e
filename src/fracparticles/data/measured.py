"""Measured data: values at points of any spacing, under any names, from a table, a file, labelled data or arrays.

They are read into a `Measured`, see `interpolated`: a function of x (y, z) that states its own error.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fracparticles.arguments import SIZES, finite_array
from fracparticles.called import AXES
from fracparticles.data.interpolated import Measured
from fracparticles.data.tables import is_table, name_and_unit, read_table
from fracparticles.errors import InvalidInput, one_of, spelled
from fracparticles.files import load_netcdf

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["MEASURED", "measured"]

MEASURED = "measured:"  # before a path: the data in the file are interpolated
_FEWEST = 4  # points along an axis
# The sizes of values and of their integrals: slopes and sums of both do not overflow.
_LEAST, _MOST = 1e-200, 1e200
_FIELD = "initial"  # the argument that messages name


def measured(data: Any, *, x: str | Sequence[str] | None = None, u: str | None = None) -> Measured:
    """Return measured data as a function, for `initial`.

    Parameters
    ----------
    data : path, DataArray, Dataset, Series, DataFrame, or a tuple of arrays (x, u)
        A table (csv, tsv, txt, dat) of two columns, or three or four for a rectangular grid of the plane or of space,
        the values last. A first line, or the remark above the numbers, may name the columns, with units in brackets,
        "x [m], c (mg/L)". Then x, y, z are the places, and u, or the other column, has the values, in any order. In a
        NetCDF file or labelled data: a variable on axes of any names, with units.
    x, u : str, optional
        Names of the columns or axes, and of the values, if there are more than these.

    Raises
    ------
    InvalidInput
        If there are fewer than four points along an axis, or two points in one place; if a value is not finite; if the
        points make no grid; if the axes have two units; or if it is not clear which column or variable has the values.
    """
    names = _names(x)
    if not isinstance(u, str | None):
        raise InvalidInput("u", u, "the name of the values", "Give one, or leave it out.")
    if isinstance(data, str | os.PathLike):
        source = str(os.fspath(data))
        path = Path(source.removeprefix(MEASURED))
        if is_table(path):
            found = _of_columns(*read_table(path), names, u, str(path))
        else:
            found = _of_labels(load_netcdf(path), names, u, str(path))
        return replace(found, source=source, is_file=True)
    kind = type(data).__name__
    if isinstance(data, tuple) and len(data) in (2, 3, 4):
        columns = {f"column {k}": np.ravel(finite_array(_FIELD, one)) for k, one in enumerate(data)}
        return _of_columns(columns, {}, None, None, "arrays")
    if kind == "DataFrame":
        return _of_columns(*_of_frame(data), names, u, kind)
    if kind == "Series":
        columns = {"x": np.asarray(data.index), "u": np.asarray(data)}
        return _of_columns(columns, {}, None, None, kind)
    if kind in ("DataArray", "Dataset"):
        dataset = data if kind == "Dataset" else data.to_dataset(name=data.name or "u")
        return _of_labels(
            dataset, names, u or (kind == "DataArray" and (data.name or "u")) or None, kind
        )
    allowed = "a file, a table, labelled data, or a tuple of arrays (x, u)"
    raise InvalidInput(_FIELD, kind, allowed, "Give one of these.")


def _names(x: Any) -> tuple[str, ...] | None:
    """Return the names of the axes, one or several."""
    names = (x,) if isinstance(x, str) else x
    listed = isinstance(names, Sequence) and all(isinstance(name, str) for name in names)
    if not (names is None or listed):
        raise InvalidInput("x", x, "a name, or a list of names", "Give these, or leave it out.")
    return None if names is None else tuple(names)


def _of_frame(data: Any) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    """Return the columns by name and their units, as for a table in a file; an index of its own is a column as well."""
    from pandas import RangeIndex

    if not isinstance(data.index, RangeIndex):
        data = data.rename_axis(data.index.name or "index").reset_index()
    split = [name_and_unit(str(heading)) for heading in data.columns]
    names = [name for name, _ in split]
    if len(set(names)) < len(names):
        different = "columns of different names"
        raise InvalidInput(_FIELD, "DataFrame", different, f"It has {spelled(names, ' and ')}.")
    columns = {name: data.iloc[:, k].to_numpy() for k, name in enumerate(names)}
    return columns, dict(split)


# --- reading ---------------------------------------------------------------------------------------------


def _of_columns(
    columns: dict[str, np.ndarray],
    units: dict[str, str],
    x: tuple[str, ...] | None,
    u: str | None,
    source: str,
) -> Measured:
    for name in (*(x or ()), *([u] if u else [])):
        if name not in columns:
            raise one_of("x and u", name, columns, source)
    known = list(columns)
    if x is None and u is None:
        x, u = _by_their_names(known)
    elif x is None:
        x = _in_order(name for name in known if name != u)
    elif u is None:
        rest = [name for name in known if name not in x]
        u = rest[0] if len(rest) == 1 else None
    if x is None or u is None or len(x) not in (1, 2, 3):
        allowed = f"one to three columns of places and one of values, and it has {spelled(known, ' and ')}"
        raise InvalidInput(_FIELD, source, allowed, "Say which: fp.measured(data, x=..., u=...).")
    places = [finite_array(_FIELD, columns[name]) for name in x]
    values = finite_array(_FIELD, columns[u])
    if any(place.size != values.size for place in places):
        sizes = spelled((f"{name}: {columns[name].size}" for name in (*x, u)), ", ")
        long = f"columns of one length, a row for each value, and there are {sizes}"
        remedy = "Give each value its place: np.meshgrid(..., indexing='ij') makes those of a grid."
        raise InvalidInput(_FIELD, source, long, remedy)
    axes = [np.unique(place) for place in places]
    shape = tuple(axis.size for axis in axes)
    index = tuple(np.searchsorted(axis, place) for axis, place in zip(axes, places, strict=True))
    grid = np.full(shape, np.nan)
    grid[index] = values
    if len(axes) == 1 and values.size > grid.size:
        seen, counts = np.unique(places[0], return_counts=True)
        twice = f"each point once, and {x[0]} = {seen[counts > 1][0]:g} is there twice"
        raise InvalidInput(_FIELD, source, twice, "Take the mean, or leave one out.")
    if values.size != grid.size or np.isnan(grid).any():
        sides = " x ".join(map(str, shape))
        grids = f"a rectangular grid of {spelled(map(repr, x), ' and ')}, here of {sides} points"
        remedy = (
            f"Say which columns are meant, fp.measured(data, x={x[0]!r}, u={u!r}), or put scattered points onto a grid "
            "first."
        )
        counted = f"{grids}, and there are {values.size} values"
        raise InvalidInput(_FIELD, source, counted, remedy)
    unit = _one_unit([units.get(name, "") for name in x], source)
    return _checked(axes, grid, (unit, units.get(u, "")), source)


def _by_their_names(known: list[str]) -> tuple[tuple[str, ...] | None, str | None]:
    """Return which columns are places and which has the values: x, y, z and the other one, or the last as values."""
    axes = [name for name in known if name.lower() in AXES]
    others = [name for name in known if name not in axes]
    if axes and others:
        return _in_order(axes), others[0] if len(others) == 1 else None
    if len(known) not in (2, 3, 4):
        return None, None
    values = next((name for name in known if name.lower() == "u"), known[-1])
    return _in_order(name for name in known if name != values), values


def _in_order(names: Iterable[str]) -> tuple[str, ...]:
    """Return x, y, z in this order, and others as they come."""
    names = tuple(names)
    known = all(name.lower() in AXES for name in names)
    return tuple(sorted(names, key=str.lower)) if known else names


def _one_unit(units: list[str], source: str) -> str:
    """Return the unit of all axes: a lattice has only one."""
    named = list(dict.fromkeys(unit for unit in units if unit and unit != "1"))
    if len(named) > 1:
        one = f"places in one unit, and these are in {spelled(named, ' and ')}"
        raise InvalidInput(_FIELD, source, one, "Convert the data first.")
    return named[0] if named else ""


def _of_labels(data: xr.Dataset, x: tuple[str, ...] | None, u: str | None, source: str) -> Measured:
    """Return the data of the one variable that varies, with its dimensions as axes, and coordinates of their names."""
    if u is None:
        candidates = [str(n) for n, one in data.data_vars.items() if 1 <= one.squeeze().ndim <= 3]
        if "u" in candidates:
            candidates = ["u"]
        if len(candidates) != 1:
            held = f"one variable of values, and it has {spelled(candidates, ' and ') or 'none'}"
            raise InvalidInput(_FIELD, source, held, "Say which: fp.measured(data, u=...).")
        u = candidates[0]
    if u not in data.variables:
        raise one_of("u", u, map(str, data.variables), source)
    values = data[u].squeeze()
    dims = [str(dim) for dim in values.dims]
    if x is not None and sorted(x) != sorted(dims):
        raise InvalidInput(
            "x", x, f"the dimensions of {u}, {spelled(dims, ' and ')}", "Name these."
        )
    if not 1 <= len(dims) <= 3:
        raise InvalidInput(_FIELD, source, f"{u} on one to three axes", f"It has {len(dims)}.")
    order = list(x) if x is not None else list(_in_order(dims))
    missing = [dim for dim in dims if dim not in data.coords]
    if missing:
        raise InvalidInput(_FIELD, source, f"coordinates of {u} along {missing[0]}", "Store them.")
    axes = [finite_array(_FIELD, data[dim].values) for dim in order]
    array = finite_array(_FIELD, values.transpose(*order).values)
    for k, axis in enumerate(axes):
        sort = np.argsort(axis, kind="stable")
        axes[k], array = axis[sort], np.take(array, sort, k)
        if (np.diff(axes[k]) == 0.0).any():
            raise InvalidInput(
                _FIELD, source, f"each point once along {order[k]}", "Mend the data."
            )
    unit, unit_of_u = (
        _one_unit([str(data[name].attrs.get("units", "")) for name in names], source)
        for names in (order, [u])
    )
    return _checked(axes, array, (unit, unit_of_u), source)


def _checked(axes: list[np.ndarray], values: np.ndarray, units: Any, source: str) -> Measured:
    for axis in axes:
        if axis.size < _FEWEST:
            few = f"at least {_FEWEST} points along an axis, and there are {axis.size}"
            raise InvalidInput(_FIELD, source, few, "Measure at more points.")
        if np.abs(axis).max() > SIZES[1] or np.diff(axis).min() < SIZES[0]:
            sizes = f"places up to {SIZES[1]:g}, at least {SIZES[0]:g} apart"
            raise InvalidInput(_FIELD, source, sizes, "Take another unit of length.")
    greatest, volume = float(np.abs(values).max()), np.prod([axis[-1] - axis[0] for axis in axes])
    if (
        greatest > 0.0
        and not _LEAST < greatest * min(1.0, volume) <= greatest * max(1.0, volume) < _MOST
    ):
        between = f"values whose integral is from {_LEAST:g} to {_MOST:g}, and they go up to {greatest:.3g}"
        raise InvalidInput(_FIELD, source, between, "Take another unit of u, or of length.")
    return Measured(tuple(axes), values, units, source)
