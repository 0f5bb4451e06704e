"""Initial strengths: the fundamental solution, an array with labels or without, a callable, or a NetCDF file.

Data with coordinates x, y, z are placed by these. They are sorted, transposed and cast where that is safe, and refused
if their points are not those of the case. Data that are a run of this package must be a solution of the same equation
at `t_initial`.
"""

from __future__ import annotations

import hashlib
import math
import os
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from fracparticles.arguments import real_array
from fracparticles.called import AXES, Called
from fracparticles.data.interpolated import Measured
from fracparticles.data.measured import MEASURED, measured
from fracparticles.data.tables import is_table
from fracparticles.errors import AccuracyWarning, InvalidInput, spelled
from fracparticles.files import load_netcdf
from fracparticles.run.agreement import refuse_contradiction, stored_in
from fracparticles.run.case import FUNDAMENTAL, Case
from fracparticles.special.stable import green

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = [
    "Initial",
    "bare_strengths",
    "case_of_run",
    "initial_strengths",
    "of_places",
    "refuse_non_finite",
    "resolved",
]

Initial: TypeAlias = "str | os.PathLike[str] | np.ndarray | xr.DataArray | xr.Dataset | pd.Series | Callable[..., Any]"

_FLOAT64 = np.dtype(float)
_GIVEN = "given, sha256 "  # begins `initial` of a stored case whose data came with the call
# Variable or field of a stored run: the field of the case that must be the same.
_SAYS = {
    "beta": "beta",
    "alpha": "alpha",
    "diffusivity": "diffusivity",
    "dim": "dim",
    "t_final": "t_initial",
}


def initial_strengths(case: Case, initial: Initial | None = None) -> tuple[np.ndarray, str]:
    """Return the initial strengths on `case.positions`, shape `case.shape`, and one line on where they come from.

    Parameters
    ----------
    case : Case
    initial : array, DataArray, Dataset, Series, callable or path, optional
        An array of shape `case.shape`; labelled data with u on the coordinates x (y, z) of the case, in any order; a
        function of the coordinates that its arguments are named after, of arrays or of single numbers, a constant
        included; a NetCDF file with u on these coordinates; `Measured` data, a table or "measured:PATH", which are
        interpolated. Left out, the data are those that `case.initial` names.

    Raises
    ------
    InvalidInput
        If the data do not fit the case in kind, shape or points, or are masked or not finite; if they are a run of
        another equation or at another time; if the case was stored from other data.

    Warns
    -----
    AccuracyWarning
        If the data have no time of their own and `t_initial` was not given.
    """
    source = resolved(case, initial)
    if isinstance(source, str) and source == FUNDAMENTAL:
        case.refuse_point_mass()
        u0 = np.asarray(green(case.radius, case.diffusivity * case.t_initial, case.alpha, case.dim))
        return u0, f"fundamental solution at t = {case.t_initial:g}"
    if isinstance(source, str) and source.startswith(_GIVEN):
        known = "'fundamental' or a file, unless the data come with the call: a stored case cannot hold them"
        raise InvalidInput("initial", source, known, "Pass the data again: fp.solve(case, data).")
    given: Any
    if isinstance(source, str | os.PathLike):
        given, what = _read(Path(source)), f"file {os.fspath(source)}"
    elif callable(source):
        given, what = _evaluated(source, case), "callable"
        if isinstance(source, Measured):
            source.check_lattice(given, case.volumes)
            what = f"file {source.source}" if source.is_file else "measured data"
    else:
        given, what = source, "array"
    u0, has_time = _on_lattice(case, given, what)
    refuse_non_finite(u0, case.x)
    if not np.isfinite(case.integral(np.abs(u0))):
        allowed = "strengths whose sum, the mass, is below 1.8e308"
        shown = f"strengths up to {np.abs(u0).max():.3g} of the volume {np.max(case.volumes):.3g}"
        raise InvalidInput("initial", shown, allowed, "Change the unit of u, or of length.")
    digest = hashlib.sha256(u0.tobytes()).hexdigest()[:16]
    if case.initial.startswith(_GIVEN) and case.initial != _GIVEN + digest:
        raise InvalidInput(
            "initial",
            f"data of sha256 {digest}",
            f"the data that the case was run from, of sha256 {case.initial.removeprefix(_GIVEN)}",
            "Pass these, or make a case without initial.",
        )
    if not has_time and "t_initial" not in case.model_fields_set:
        warnings.warn(
            f"the initial data are your own and t_initial was not given: they are taken as those at t_initial = "
            f"{case.t_initial:g}, so that the run spans t_final - t_initial = {case.span:g}. "
            "Give t_initial.",
            AccuracyWarning,
            stacklevel=4,
        )
    return u0, f"{what}, sha256 {digest}"


def resolved(case: Case, initial: Initial | None = None) -> Initial:
    """Return the initial data of a run: those of the call, or else those that the case names; a table as `Measured`."""
    source = of_places(case.initial if initial is None else initial, case.dim)
    path = os.fspath(source) if isinstance(source, str | os.PathLike) else ""
    return measured(path) if path.startswith(MEASURED) or is_table(path) else source


def of_places(initial: Initial, dim: int) -> Initial:
    """Return initial data of which a function is called with the coordinates that its arguments are named after.

    Raises
    ------
    InvalidInput
        If it is a function of other variables, or of more.
    """
    if not callable(initial) or isinstance(initial, Measured):
        return initial
    return Called("initial", initial, AXES[:dim])


def bare_strengths(u0: Any, shape: tuple[int, ...]) -> np.ndarray:
    """Return strengths of a shape as a float64 array; an array that is one already is returned itself.

    Raises
    ------
    InvalidInput
        If they are of another shape or kind, masked or labelled.
    """
    # The usual case first: it takes a tenth of the time of the others.
    if type(u0) is np.ndarray and u0.dtype is _FLOAT64 and u0.shape == shape:
        return u0
    if type(u0) is not np.ndarray and _labels(u0) is not None:
        bare = "a bare array, whose order is that of case.positions"
        remedy = (
            "Pass the labelled data to fp.solve, which takes them by their labels, or their values."
        )
        raise InvalidInput("initial", type(u0).__name__, bare, remedy)
    if isinstance(u0, tuple) and len(u0) == len(shape) + 1:
        pair = "an array, and not a tuple of places and values"
        raise InvalidInput("initial", "tuple", pair, "Have them interpolated: fp.measured((x, u)).")
    u0 = _real(u0)
    if u0.shape != shape:
        shaped = f"an array of shape {shape}, one strength for each particle of the lattice"
        remedy = "Evaluate the data on case.positions."
        raise InvalidInput("initial", f"array of shape {u0.shape}", shaped, remedy)
    return u0


def refuse_non_finite(u0: np.ndarray, x: np.ndarray) -> None:
    """Refuse strengths that are nan or infinite; x are the positions along one axis.

    Raises
    ------
    InvalidInput
        Names the first place.
    """
    if np.isfinite(u0).all():
        return
    where = ", ".join(f"{part:g}" for part in x[np.argwhere(~np.isfinite(u0))[0]])
    remedy = "Mend the data, or shift a singularity off the lattice."
    raise InvalidInput("initial", f"not finite at x = {where}", "finite strengths", remedy)


def case_of_run(case: Case, origin: str) -> Case:
    """Return the case with an `initial` that says where its data came from; `origin` is that of `initial_strengths`.

    Data that came with the call are named by their digest. Without them, or with others, the case is then refused.
    """
    if origin.startswith(FUNDAMENTAL):
        return case
    what, _, digest = origin.rpartition(", sha256 ")
    initial = what.removeprefix("file ") if what.startswith("file ") else _GIVEN + digest
    if initial == FUNDAMENTAL or (initial.startswith(_GIVEN) and what.startswith("file ")):
        initial = os.path.join(".", initial)  # so that it is read as the name of a file
    return case if initial == case.initial else case.model_copy(update={"initial": initial})


def _evaluated(function: Callable[..., Any], case: Case) -> Any:
    """The values of the callable at the particles; if it takes single numbers only, it is called for each."""
    positions = case.positions
    try:
        values = function(*positions)
    except Exception as error:
        error.add_note(
            "It was raised by the initial data, a callable, for the arrays case.positions."
        )
        if not isinstance(error, TypeError | ValueError):
            raise
        try:
            points = np.broadcast_arrays(*positions)
            each = zip(*(part.reshape(-1).tolist() for part in points), strict=True)
            values = np.array([function(*point) for point in each]).reshape(case.shape)
        except Exception as other:
            error.add_note(f"For single numbers: {type(other).__name__}: {other}")
            raise error from None
    if _labels(values) is not None:
        return values
    values = _real(values)
    # A constant, or one along an axis: functions of the sparse `case.positions` may return these.
    along = case.dim > 1 and values.ndim == case.dim
    if values.ndim == 0 or (along and set(values.shape) <= {1, case.shape[0]}):
        return np.broadcast_to(values, case.shape)
    return values


def _on_lattice(case: Case, given: Any, what: str) -> tuple[np.ndarray, bool]:
    """The strengths, a new array of `case.shape`, and whether the data say at which time they are."""
    data = _labels(given)
    if data is None:
        return np.array(bare_strengths(given, case.shape)), False
    name = what.removeprefix("file ") if what.startswith("file ") else type(given).__name__
    refuse_contradiction("initial", data, name)
    data = _at_its_time(data, case.t_initial, name)
    told = _told(data)
    _check_equation(case, told, name)
    axes = AXES[: case.dim]
    wanted = f"u({', '.join(axes)}) and the coordinates {', '.join(axes)}"
    if "u" not in data.variables:
        held = ", ".join(map(str, data.variables)) or "nothing"
        raise InvalidInput("initial", name, wanted, f"It holds {held}.")
    u = data["u"]
    others = [dim for dim in u.dims if dim not in axes]
    sizes = ", ".join(f"{dim}: {size}" for dim, size in u.sizes.items())
    if not set(axes) <= set(u.dims) or any(u.sizes[dim] != 1 for dim in others):
        remedy = f"The dimensions of u are ({sizes}): select one of the others, name the axes so."
        only = f"{wanted}, and other dimensions of length one only"
        raise InvalidInput("initial", name, only, remedy)
    missing = ", ".join(axis for axis in axes if axis not in data.variables)
    if missing:
        raise InvalidInput("initial", name, wanted, f"Store {missing}, which u does not have.")
    u = u.squeeze(others, drop=True).transpose(*axes)
    strengths = u.values
    for axis, label in enumerate(axes):
        strengths = np.take(strengths, _order(case, data[label].values, label, name), axis)
    return np.array(bare_strengths(strengths, case.shape)), "t_final" in told


def _at_its_time(data: xr.Dataset, t: float, name: str) -> xr.Dataset:
    """The data at time t, if they hold several output times."""
    if "t" not in data.dims or "t" not in data.variables or data.sizes["t"] == 1:
        return data
    times = data["t"].values.tolist()
    here = [k for k, time in enumerate(times) if math.isclose(time, t, rel_tol=1e-9)]
    if not here:
        held = (
            f"data at t_initial = {t:.9g}, and these are at {spelled(map('{:.9g}'.format, times))}"
        )
        raise InvalidInput("initial", name, held, "Set t_initial to one of these.")
    return data.isel(t=here[0])


def _order(case: Case, x: np.ndarray, label: str, name: str) -> np.ndarray:
    """The indices that sort the points of an axis, which must be those of the case to the precision of their type."""
    lattice, h = case.x, case.particle_spacing
    allowed = (
        f"u on the {case.particles} points of case.positions, {lattice.size} along {label}, h = {h:.9g} and "
        f"|{label}| <= {case.reach:.9g}"
    )
    remedy = (
        "Set half_width and spacing to match, or have the data interpolated: fp.measured(data), "
        "--initial measured:FILE."
    )
    if x.dtype.kind not in "iuf" or x.ndim != 1 or not np.isfinite(x).all():
        raise InvalidInput("initial", name, f"finite real numbers as {label}", "Store numbers.")
    if x.size != lattice.size:
        counted = f"It has {x.size} points along {label}. {remedy}"
        raise InvalidInput("initial", name, allowed, counted)
    order = np.argsort(x, kind="stable")
    apart = np.asarray(case.volumes) if case.is_graded else np.asarray(h)  # of neighbours
    deviation = np.abs(x[order].astype(np.float64) - lattice) / apart
    rounding = 0.0 if x.dtype.kind != "f" else float(np.finfo(x.dtype).eps) * case.reach / apart
    wrong = (deviation > np.maximum(1e-9, rounding)) | (deviation >= 0.25)
    if wrong.any():
        worst = int(np.where(wrong, deviation, 0.0).argmax())
        raise InvalidInput(
            "initial",
            name,
            allowed,
            f"Sorted, its points are up to {deviation[worst]:.3g} h off these: {label} = "
            f"{float(x[order[worst]])!r} for {float(lattice[worst])!r}. {remedy}",
        )
    return order


def _check_equation(case: Case, told: dict[str, float], name: str) -> None:
    """A run goes on where another ended only if both solve the same equation."""
    for said, field in _SAYS.items():
        if said not in told or math.isclose(told[said], getattr(case, field), rel_tol=1e-9):
            continue
        raise InvalidInput(
            "initial",
            name,
            f"data of {field} = {getattr(case, field):.9g}, as the case has it, and these are a run of {said} = "
            f"{told[said]:.9g}",
            f"Set {field} = {told[said]:.9g}. If the numbers alone are meant, pass a bare array, run.u.values.",
        )


def _told(data: xr.Dataset) -> dict[str, float]:
    """The fields of `_SAYS` that the data hold as scalar variables, or else in the case stored with them."""
    stored = stored_in(data) or {}
    told = {name: stored.get(name) for name in _SAYS}
    for name in _SAYS:
        if name in data.variables and data.variables[name].size == 1:
            told[name] = data.variables[name].values.item()
    if "t" in data.variables and data.variables["t"].size == 1:
        told["t_final"] = data.variables["t"].values.item()  # one of the output times
    return {
        name: float(value)
        for name, value in told.items()
        if isinstance(value, int | float) and math.isfinite(value)
    }


def _labels(given: Any) -> xr.Dataset | None:
    """The data as a data set if they have labels; None for bare data. No package is imported that did not make them."""
    pandas = sys.modules.get("pandas")
    if pandas is not None and isinstance(given, pandas.DataFrame):
        series = "an array, or a Series of u with x as its index"
        remedy = "Take a column, or have it interpolated: fp.measured(frame)."
        raise InvalidInput("initial", "DataFrame", series, remedy)
    if pandas is not None and isinstance(given, pandas.Series):
        if isinstance(given.index, pandas.RangeIndex):  # counted, not labelled
            return None
        from xarray import DataArray

        given = DataArray(given.to_numpy(), {"x": given.index.to_numpy()}, "x")
    xarray = sys.modules.get("xarray")
    if xarray is None:
        return None
    if isinstance(given, xarray.DataArray):
        coordinates = {n: part.variable for n, part in given.coords.items() if n != "u"}
        return xarray.Dataset({"u": given.variable}, coordinates)
    return given if isinstance(given, xarray.Dataset) else None


def _read(path: Path) -> xr.Dataset:
    return load_netcdf(path, ("u", *AXES, "t", *_SAYS))


def _real(values: Any) -> np.ndarray:
    """The values as float64. An array of float64 is not checked: a later check names the place that is not finite."""
    if type(values) is np.ndarray and values.dtype == np.float64:
        return values
    return real_array("initial", values)
