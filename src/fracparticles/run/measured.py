"""Measured data: values at points of any spacing, under any names, from a table or a file, interpolated.

Between the points goes a cubic spline, or the monotone cubic of Fritsch and Carlson, which does not overshoot:
whichever is nearer to points that it was not given. The error of the interpolation is stated and not hoped for: every
second point is left out, and then all but every fourth; what both miss, and how much less the first does, says what is
missed with all of them:

    e = e_2 / r,   r = e_4 / e_2,  1 <= r <= 16,   the relative 1-norm of what is missed.

Noise has r = 1, and so have fewer than sixteen points along an axis. The few that are left out of fewer than 32 may be
met by chance: e is then at least the distance of the two cubics; of fewer than eight nothing is known, and e is at
least 1. Beyond the outermost points the data are zero; what may have been there, if it falls like |x|^(-1-alpha) or
faster, is at most the sum of |u| d at the ends, d the distance to the middle of the data, and is stated as well.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fracparticles.arguments import SIZES, finite_array
from fracparticles.errors import AccuracyWarning, InvalidInput, one_of, spelled
from fracparticles.files import load_netcdf
from fracparticles.run.tables import is_table, name_and_unit, read_table

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["MEASURED", "Measured", "measured"]

MEASURED = "measured:"  # before a path: what it holds is interpolated
_FEWEST = 4
_TOO_FEW, _SOME, _MANY = 8, 16, 32  # points along an axis, see the module
_NOTICED = 0.05
_MOST_GAIN = 16.0  # of half the spacing: the order of both cubics is four at most
_LEAST, _MOST = 1e-200, 1e200  # of values and their integrals: slopes and sums of both are numbers
_FIELD = "initial"
_AXES = ("x", "y", "z")

Interpolant = Callable[[Sequence[np.ndarray], np.ndarray, list[np.ndarray]], np.ndarray]


@dataclass(frozen=True)
class Measured:
    """Data at the points of a line, a rectangular grid of the plane or of space; a function of x (y, z).

    Attributes
    ----------
    axes : tuple of arrays
        The points along each axis, ascending.
    values : array
        One for each point of the grid.
    units : tuple of str
        Those of the axes and of the values, as far as the data name them; "" where they do not.
    source : str
        Where they are from.
    is_file : bool
        Whether that is the path of a file.
    """

    axes: tuple[np.ndarray, ...]
    values: np.ndarray
    units: tuple[str, str]
    source: str
    is_file: bool = False

    def __call__(self, *x: Any) -> np.ndarray:
        """Return the interpolated values at points whose coordinates broadcast; zero beyond the data.

        Raises
        ------
        InvalidInput
            If there are more or fewer coordinates than the data have.
        """
        if len(x) != len(self.axes):
            dims = f"data on {len(x)} axes for dim = {len(x)}, and these are on {len(self.axes)}"
            raise InvalidInput(_FIELD, self.source, dims, "Give dim to match.")
        points = [np.asarray(one, dtype=float) for one in x]
        inside = np.ones(np.broadcast_shapes(*(one.shape for one in points)), dtype=bool)
        for one, axis in zip(points, self.axes, strict=True):
            inside &= (one >= axis[0]) & (one <= axis[-1])
        result = _INTERPOLANTS[self.method](self.axes, self.values, points)
        return np.where(inside, result, 0.0)

    @cached_property
    def method(self) -> str:
        """Which interpolation: "cubic spline" or "monotone cubic"."""
        return min(_INTERPOLANTS, key=lambda name: self._errors[name])

    @cached_property
    def interpolation_error(self) -> float:
        """The relative error in the 1-norm between the points; see the module."""
        few, found = min(axis.size for axis in self.axes), self._errors[self.method]
        if few < _TOO_FEW:
            return max(found, float(np.any(self.values)))
        return max(found, self._apart) if few < _MANY else found

    @cached_property
    def beyond(self) -> float:
        """How much of the data may lie beyond the outermost points, at most, as a share of what is between them."""
        size = np.abs(self.values)
        total, outside = _integral(self.axes, size), 0.0
        for k, axis in enumerate(self.axes):
            others = [one for m, one in enumerate(self.axes) if m != k]
            along = _integral(others, np.moveaxis(size, k, -1)) if others else size
            middle = float((axis * along).sum() / along.sum()) if along.sum() > 0.0 else 0.0
            outside += float(along[0]) * (middle - axis[0]) + float(along[-1]) * (axis[-1] - middle)
        return outside / float(total) if total > 0.0 else 0.0

    @property
    def error(self) -> float:
        """The interpolation error and what may lie beyond together."""
        return self.interpolation_error + self.beyond

    @cached_property
    def integral(self) -> float:
        """The integral of the interpolated data, by the trapezoidal rule on a grid eight times as fine."""
        fine = _finer(self.axes)
        return float(_integral(fine, self(*np.meshgrid(*fine, indexing="ij", sparse=True))))

    @property
    def estimates(self) -> dict[str, tuple[float, str]]:
        """What a run states of its data, by name, each with what it is in words."""
        between = f"relative error of the initial data between their points, by a {self.method}"
        return {
            "interpolation_error": (self.interpolation_error, between),
            "beyond_data": (self.beyond, "share of the initial data that may lie beyond them"),
        }

    def check_lattice(self, strengths: np.ndarray, volume: float | np.ndarray) -> None:
        """Refuse a lattice that does not hold the data, or is too coarse for them; warn where the data are.

        Raises
        ------
        InvalidInput
            If the mass on the lattice is off by more than a twentieth of what there is.

        Warns
        -----
        AccuracyWarning
            If the data are too few, or end before they have fallen.
        """
        size = float(_integral(self.axes, np.abs(self.values)))
        apart = abs(float((volume * strengths).sum()) - self.integral)
        if apart > _NOTICED * size:
            allowed = f"data that the lattice holds and resolves: of their mass {apart / size:.2g} is missing there"
            raise InvalidInput(
                _FIELD, self.source, allowed, "Take a wider lattice or a smaller spacing."
            )
        for error, meaning in self.estimates.values():
            if error > _NOTICED:
                warnings.warn(
                    f"{self.source}: {meaning}: about {error:.2g}. Measure at more points, or farther out.",
                    AccuracyWarning,
                    stacklevel=5,
                )

    @cached_property
    def _errors(self) -> dict[str, float]:
        found = {}
        for name, interpolant in _INTERPOLANTS.items():
            found[name] = _left_out(interpolant, self.axes, self.values)
        return found

    @property
    def _apart(self) -> float:
        """How far the two cubics are apart, in the relative 1-norm."""
        fine = _finer(self.axes)
        one, other = (
            of(self.axes, self.values, list(np.meshgrid(*fine, indexing="ij", sparse=True)))
            for of in _INTERPOLANTS.values()
        )
        size = float(_integral(fine, np.abs(one)))
        return float(_integral(fine, np.abs(one - other))) / size if size > 0.0 else 0.0


def measured(data: Any, *, x: str | Sequence[str] | None = None, u: str | None = None) -> Measured:
    """Return measured data as a function, for `initial`.

    Parameters
    ----------
    data : path, DataArray, Dataset, Series, DataFrame, or a tuple of arrays (x, u)
        A table (csv, tsv, txt, dat) of two columns, or three or four for a rectangular grid of the plane or of space,
        the values last; a first line may name them, with units in brackets, "x [m], c (mg/L)": then x, y, z are the
        places and u, or the other one, the values, wherever they stand. A NetCDF file or labelled data: a variable on
        axes of any names, whose units are read.
    x, u : str, optional
        Names of the columns or axes, and of the values, where there are more than these.

    Raises
    ------
    InvalidInput
        If there are fewer than four points along an axis, two in one place, a value that is no finite number, points
        that make no grid, axes in two units; or it is not clear which are the values.
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
    """The names of the axes, one or several."""
    names = (x,) if isinstance(x, str) else x
    listed = isinstance(names, Sequence) and all(isinstance(name, str) for name in names)
    if not (names is None or listed):
        raise InvalidInput("x", x, "a name, or a list of names", "Give these, or leave it out.")
    return None if names is None else tuple(names)


def _of_frame(data: Any) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    """The columns by name and their units, as of a table in a file; an index that is not counted is a column, too."""
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
        allowed = f"a rectangular grid, here of {sides} points, and there are {values.size} values"
        raise InvalidInput(_FIELD, source, allowed, "Put scattered points onto a grid first.")
    unit = _one_unit([units.get(name, "") for name in x], source)
    return _checked(axes, grid, (unit, units.get(u, "")), source)


def _by_their_names(known: list[str]) -> tuple[tuple[str, ...] | None, str | None]:
    """Return which columns are places and which are values, if nobody said: x, y, z and the other one; or the last."""
    axes = [name for name in known if name.lower() in _AXES]
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
    known = all(name.lower() in _AXES for name in names)
    return tuple(sorted(names, key=str.lower)) if known else names


def _one_unit(units: list[str], source: str) -> str:
    """The unit of all axes: a lattice has one."""
    named = list(dict.fromkeys(unit for unit in units if unit and unit != "1"))
    if len(named) > 1:
        one = f"places in one unit, and these are in {spelled(named, ' and ')}"
        raise InvalidInput(_FIELD, source, one, "Convert the data first.")
    return named[0] if named else ""


def _of_labels(data: xr.Dataset, x: tuple[str, ...] | None, u: str | None, source: str) -> Measured:
    """The values are the one variable that varies, the axes its dimensions, with coordinates of their names."""
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


# --- interpolation ---------------------------------------------------------------------------------------


def _spline(axes: Sequence[np.ndarray], values: np.ndarray, x: list[np.ndarray]) -> np.ndarray:
    from scipy.interpolate import CubicSpline

    return _by_axes(CubicSpline, axes, values, x)


def _monotone(axes: Sequence[np.ndarray], values: np.ndarray, x: list[np.ndarray]) -> np.ndarray:
    from scipy.interpolate import PchipInterpolator

    return _by_axes(PchipInterpolator, axes, values, x)


_INTERPOLANTS: dict[str, Interpolant] = {"monotone cubic": _monotone, "cubic spline": _spline}


def _by_axes(
    kind: Any, axes: Sequence[np.ndarray], values: np.ndarray, x: list[np.ndarray]
) -> np.ndarray:
    """Interpolate along one axis after the other, where the points are a grid; or else point by point."""
    if len(axes) == 1:
        return np.asarray(kind(axes[0], values)(np.clip(x[0], axes[0][0], axes[0][-1])))
    clipped = [np.clip(one, axis[0], axis[-1]) for one, axis in zip(x, axes, strict=True)]
    if all(one.ndim == len(axes) and one.size == one.shape[k] for k, one in enumerate(clipped)):
        for k, one in enumerate(clipped):
            values = kind(axes[k], values, axis=k)(one.ravel())
        return np.asarray(values)
    flat = [one.ravel() for one in np.broadcast_arrays(*clipped)]
    shape = np.broadcast_shapes(*(one.shape for one in clipped))
    found = [
        _by_axes(kind, axes, values, [np.reshape(one[p], (1,) * len(axes)) for one in flat]).item()
        for p in range(flat[0].size)
    ]
    return np.array(found).reshape(shape)


def _left_out(interpolant: Interpolant, axes: Sequence[np.ndarray], values: np.ndarray) -> float:
    """Return the error that the points left out say; see the module. The ends are always kept."""
    missed = []
    for stride in (2, 4):
        kept = [np.unique([*range(0, axis.size, stride), axis.size - 1]) for axis in axes]
        if any(one.size < 2 for one in kept):
            break
        coarse = [axis[one] for axis, one in zip(axes, kept, strict=True)]
        points = (
            list(np.meshgrid(*axes, indexing="ij", sparse=True)) if len(axes) > 1 else [axes[0]]
        )
        guess = interpolant(coarse, values[np.ix_(*kept)], points)
        missed.append(float(_integral(axes, np.abs(guess - values))))
    size = float(_integral(axes, np.abs(values)))
    if not missed or size == 0.0:
        return 0.0 if size == 0.0 else 1.0
    # Half of the points were not left out, where nothing is missed: the others stand for all.
    error = 2.0 * missed[0] / size
    enough = len(missed) == 2 and min(axis.size for axis in axes) >= _SOME
    gain = missed[1] / missed[0] if enough and missed[0] > 0.0 else 1.0
    return error / min(max(gain, 1.0), _MOST_GAIN)


def _finer(axes: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Return eight times as many points along each axis."""
    return [
        np.interp(np.arange(8 * axis.size - 7) / 8.0, np.arange(axis.size), axis) for axis in axes
    ]


def _integral(axes: Sequence[np.ndarray], values: np.ndarray) -> Any:
    """Return the integral over the first axes by the trapezoidal rule."""
    for axis in axes:
        values = np.trapezoid(values, axis, axis=0)
    return values
