"""The only writer and reader of NetCDF: one run, one file (CF-1.11, ACDD-1.3)."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from fracparticles import __version__
from fracparticles.data.tables import not_a_table
from fracparticles.errors import InvalidInput, reason_of
from fracparticles.files import load_netcdf, replacing, seal, uninterrupted
from fracparticles.graded.field import INTERPOLATED
from fracparticles.run.agreement import refuse_contradiction, stored_in
from fracparticles.run.case import FUNDAMENTAL, Case
from fracparticles.run.complaints import label_of
from fracparticles.run.initial import case_of_run
from fracparticles.run.solution import Solution, relative_l1_error
from fracparticles.special.stable import mean_radius

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from fracparticles.moving.dvm import ParticleRun
    from fracparticles.run.estimate import ErrorEstimate

__all__ = [
    "along",
    "described",
    "read_benchmark",
    "read_run",
    "scalar",
    "source",
    "to_dataset",
    "write",
]

REFERENCE = (
    "Lucchesi, Allouch, Le Maitre, Mustapha, Knio (2020), Particle simulation of space-fractional diffusion "
    "equations, Comput. Part. Mech. 7, 491-507, doi:10.1007/s40571-019-00275-8"
)

# Additions to the label of a field, for the scalar coordinate of this name.
_REALISED = {
    "spacing": ", asked for",
    "particle_spacing": ", realised",
    "overlap": ", realised",
    "dt": ", realised; zero for the exponential",
}

Variables = dict[str, tuple]


def to_dataset(solution: Solution, estimates: Sequence[ErrorEstimate] = ()) -> xr.Dataset:
    """Return the data set of a run, with an estimate of its error at each output time if there is one.

    The dimensions are `x`, `y`, `z`, as many as the case has. There is `u` unless the case stores only metrics; a
    profile in dim > 1 is stored as `u_axis` and `u_diagonal`. Every parameter is a scalar coordinate. The scalars are
    `mass_initial`, `mass_final`, `operator_applications` and, for a run from the fundamental solution, the
    `relative_l1_error` of Eqs. (48), (59). In a case with `times`, u, the error and `mass` have the dimension `t`. DVM
    adds its particles and their history, graded particles add their volumes.

    Parameters
    ----------
    solution : Solution
    estimates : sequence of ErrorEstimate
        One for each output time, or none at all.
    """
    import xarray as xr

    case, particles = solution.case, solution.particles
    total = case.integral(solution.u) if particles is None else float(particles.strength.sum())
    applications = np.int64(solution.operator_applications)
    data: Variables = {
        "mass_initial": scalar(
            case.integral(solution.u0), "total mass, the sum of V u, at t_initial"
        ),
        "mass_final": scalar(total, "total mass, the sum of V u, at t_final"),
        "operator_applications": scalar(applications, "number of operator applications"),
    }
    if solution.initial.startswith(FUNDAMENTAL):
        data["relative_l1_error"] = _errors(solution)
    if solution.outputs is not None:
        data["mass"] = along("t", solution.outputs.mass, "total mass, the sum of V u")
    for name, (value, meaning) in solution.estimates.items():
        data[name] = scalar(float(value), meaning)
    data |= _estimated(solution, estimates)
    coordinates = {name: scalar(value, _label(name)) for name, value in _parameters(case).items()}
    fields, axes = _fields(solution)
    data |= fields
    coordinates |= axes
    if solution.outputs is not None:
        coordinates["t"] = along("t", solution.outputs.times, "output time")
    if particles is not None:
        data |= _particle_variables(particles, case.store)
    return xr.Dataset(
        data,
        coordinates,
        attrs={
            "Conventions": "CF-1.11, ACDD-1.3",
            "title": f"{case.scheme} of order {case.order} for u_t = -D (-Laplacian)^(alpha/2) u, "
            f"alpha = {case.alpha:g}, D = {case.diffusivity:g}",
            "summary": f"{'Final particle' if case.times is None else 'Particle'} strengths of one run and its "
            "parameters.",
            "keywords": "fractional diffusion, particle method, particle strength exchange",
            "source": source(),
            "history": "fracparticles.solve(case)",
            "references": REFERENCE,
            "initial_data": solution.initial,
            "case": case_of_run(case, solution.initial).to_json(),
        },
    )


def _fields(solution: Solution) -> tuple[Variables, Variables]:
    """Return the strengths that the case stores, and their coordinates."""
    case, u, x, kept = solution.case, solution.u, solution.case.x, slice(None)
    first: tuple[str, ...] = ()
    if case.store == "metrics":
        return {}, {}
    when, place = " at t_final", "particle position"
    if solution.outputs is not None:
        u, first, when = solution.outputs.u, ("t",), ""
    strength = f"particle strength u{when}"
    if case.store == "profile" and case.dim > 1:
        middle: tuple[Any, ...] = (..., slice(None), *(case.n,) * (case.dim - 1))
        diagonal = np.einsum("..." + "i" * case.dim + "->...i", u)
        profiles = {
            "u_axis": ((*first, "x"), u[middle], described(f"{strength} for y = 0")),
            "u_diagonal": ((*first, "x"), diagonal, described(f"{strength} for y = x")),
        }
        return profiles, {"x": along("x", x, place)}
    if case.store == "profile":
        kept = np.abs(x) <= 5.0 * mean_radius(case.alpha) * (1.0 + 1e-12)
        x, u = x[kept], u[..., kept]
    axes = ("x", "y", "z")[: case.dim]
    coordinates = {axis: along(axis, x, place) for axis in axes}
    # The particles of DVM leave the lattice: u is the field that they make on it.
    what = f"field u{when}" if case.kind.moving else strength
    fields = {"u": ((*first, *axes), u, described(what))}
    if case.is_graded:
        fields["volume"] = along("x", np.asarray(case.volumes)[kept], "particle volume V")
    return fields, coordinates


def _errors(solution: Solution) -> tuple:
    """Return the error against the fundamental solution, at each output time."""
    meaning, outputs = "relative L1 error, Eqs. (48), (59)", solution.outputs
    if outputs is None:
        return scalar(relative_l1_error(solution.case, solution.u), meaning)
    pairs = zip(outputs.times, outputs.u, strict=True)
    errors = [relative_l1_error(solution.case.until(time), u) for time, u in pairs]
    return along("t", errors, meaning)


def _estimated(solution: Solution, estimates: Sequence[ErrorEstimate]) -> Variables:
    """Return the estimated error and its parts, at each output time."""
    if not estimates:
        return {}
    within = f"within |x| <= {estimates[-1].within:.6g}"
    meanings = {
        "total": ("estimated_error", f"estimated relative error in the 1-norm, {within}"),
        "spacing": ("estimated_error_spacing", "what spacing, order and overlap leave of it"),
        "domain": ("estimated_error_domain", "what the ends of the lattice leave of it"),
        "time": ("estimated_error_time", "what the time steps leave of it"),
        "data": ("estimated_error_data", "what measured data leave of it"),
        "reference": ("estimated_error_reference", "by how much the estimate may be off"),
    }
    found: Variables = {}
    for part, (name, meaning) in meanings.items():
        values = [float(getattr(one, part)) for one in estimates]
        several = solution.outputs is not None
        found[name] = along("t", values, meaning) if several else scalar(values[0], meaning)
    return found


def _particle_variables(run: ParticleRun, store: str) -> Variables:
    """Return the history of the particles of DVM, and, unless only metrics are stored, the particles themselves."""
    was = run.history
    overtaking, eliminated = np.int64(was.overtaking_steps), np.int64(was.eliminated_count)
    data = {
        "remeshings": scalar(np.int64(was.remeshings), "number of remeshings"),
        "largest_spacing": scalar(was.largest_spacing, "largest spacing after any step"),
        "overtaking_steps": scalar(overtaking, "steps that changed the order of the particles"),
        "eliminated_particles": scalar(eliminated, "particles left out below the threshold"),
        "eliminated_strength": scalar(
            was.eliminated_strength, "total mass of the particles left out"
        ),
        "lost_strength": scalar(
            was.lost_strength, "total mass that remeshing put beyond the lattice"
        ),
        "final_particles": scalar(np.int64(run.x.size), "number of particles at t_final"),
    }
    if store == "metrics":
        return data
    mass = "mass of a particle, V u, at t_final"
    data["particle_position"] = along("particle", run.x, "position at t_final")
    data["particle_strength"] = along("particle", run.strength, mass)
    if was.remeshings:
        # The dimension is not "remeshing", which is a parameter.
        before, where = "largest spacing before a remeshing", "middle of that gap"
        data["remeshing_time"] = along("event", was.remeshing_times, "instant of a remeshing")
        data["spacing_before"] = along("event", was.spacings_before, before)
        data["spacing_where"] = along("event", was.spacings_where, where)
    return data


def write(dataset: xr.Dataset, path: str | Path) -> None:
    """Write a data set under a temporary name, seal it (see `files`) and rename it when it is whole.

    Parameters
    ----------
    dataset : xarray.Dataset
        As `solve` returns it.
    path : path
        The file; one that is there is replaced.

    Raises
    ------
    InvalidInput
        If `path` is there and not a regular file, or has the name of a table, or the data set is empty, or has an
        attribute or a variable that NetCDF cannot hold.
    OSError
        If the file cannot be written: a folder without permission, a full disk.
    """
    import xarray as xr

    if not isinstance(dataset, xr.Dataset):
        raise InvalidInput("dataset", type(dataset).__name__, "a Dataset", "Give what solve gives.")
    if not dataset.variables:  # it would replace what is there by nothing
        raise InvalidInput(
            "dataset", "an empty one", "one with variables", "Give what solve gives."
        )
    with replacing(path) as temporary:
        not_a_table(path, "path")
        try:
            _to_netcdf(dataset, temporary)
            seal(temporary)
        except Exception as error:  # the libraries raise many kinds
            _refuse_what_does_not_fit(dataset, temporary)
            try:
                room = f"{shutil.disk_usage(temporary.parent).free} bytes are free"
            except OSError:
                room = "its folder is gone"
            raise OSError(f"cannot write {str(path)!r} ({reason_of(error)}); {room}") from None


def _to_netcdf(dataset: xr.Dataset, path: Path) -> None:
    encoding = {name: {"_FillValue": None} for name in dataset.variables}
    with uninterrupted():
        dataset.to_netcdf(path, engine="netcdf4", encoding=encoding)


def _refuse_what_does_not_fit(dataset: xr.Dataset, path: Path) -> None:
    """Refuse the attribute or the variable that NetCDF cannot hold, if this is why a data set was not written."""
    import xarray as xr

    def refuse_unless_written(part: xr.Dataset, what: str, value: object) -> None:
        try:
            _to_netcdf(part, path)
        except (TypeError, ValueError, AttributeError, LookupError, OverflowError) as error:
            held = f"what a NetCDF file can hold ({reason_of(error)})"
            raise InvalidInput(what, value, held, "Leave it out, or make text of it.") from None
        except Exception:  # an error of the disk
            return

    holders = [("attribute", dataset.attrs)]
    holders += [
        (f"attribute of {name},", variable.attrs) for name, variable in dataset.variables.items()
    ]
    for what, attributes in holders:
        for name, value in attributes.items():
            shown = "None" if value is None else value
            refuse_unless_written(xr.Dataset(attrs={name: value}), f"{what} {name!r}", shown)
    for name, variable in dataset.variables.items():
        bare = variable.copy(deep=False)
        bare.attrs = {}
        refuse_unless_written(
            xr.Dataset({name: bare}), f"variable {name!r}", f"{variable.dtype} {variable.shape}"
        )


def read_run(path: str | Path) -> xr.Dataset:
    """Read the file of a run or of a solved problem, and close it.

    Raises
    ------
    InvalidInput
        If the file is missing, not NetCDF, damaged, or not a run of this package; or if its scalars are not those of
        its case.
    """
    if not isinstance(path, str | os.PathLike):
        raise InvalidInput("file", path, "the path of a file", "Give such a path.")
    dataset = load_netcdf(Path(os.fsdecode(path)))
    if stored_in(dataset) is None or "mass_final" not in dataset:
        remedy = "Make one with `fracparticles solve`."
        raise InvalidInput("file", str(path), "a run written by fracparticles", remedy)
    refuse_contradiction("file", dataset, str(path))
    return dataset


def read_benchmark(path: str | Path) -> pd.DataFrame:
    """Read the file of a benchmark: one row for each measurement, the attributes of the file in `attrs`.

    Raises
    ------
    InvalidInput
        If there is no readable NetCDF file.
    """
    data = load_netcdf(Path(path))
    frame = data.to_dataframe().reset_index(drop=True)
    frame.attrs = dict(data.attrs)
    return frame


def _parameters(case: Case) -> dict[str, object]:
    """Return each parameter as it was taken, with the defaults resolved; those without a value are left out."""
    spread = (case.diffusivity * case.t_final) ** (1.0 / case.alpha) * mean_radius(case.alpha)
    parameters = {
        "scheme": case.scheme,
        "order": np.int64(case.order),
        "beta": case.beta,
        "truncation": case.reach / spread,
        "half_width": case.reach,
        "spacing": case.spacing,
        "particle_spacing": case.particle_spacing,
        "overlap": case.resolved_overlap,
        "dt": case.time_step,
        "diffusivity": case.diffusivity,
        "t_initial": case.t_initial,
        "t_final": case.t_final,
        "integrator": case.resolved_integrator,
        "evaluation": "stepping" if case.steps_taken else case.evaluation or "series",
        "summation": "matrix" if case.is_graded else case.summation,
        "exterior": case.exterior,
        "dim": np.int64(case.dim),
        "far_terms": case.far_terms and np.int64(case.far_terms),
        "kernel_family": case.kernel_family,
        "kernel_table": case.kernel_table,
        "graded_scale": case.graded_scale,
        "graded_form": (case.graded_form or INTERPOLATED) if case.is_graded else None,
        **(case.redistribution if case.kind.moving else {}),
    }
    return {name: value for name, value in parameters.items() if value is not None}


def _label(name: str) -> str:
    fields = Case.model_fields
    return label_of(fields[name.removeprefix("particle_")]) + _REALISED.get(name, "")


def scalar(value: object, long_name: str) -> tuple:
    """Return a number or a word as a variable without a dimension."""
    return (), value, described(long_name)


def along(dimension: str, values: ArrayLike, long_name: str) -> tuple:
    """Return numbers as a variable with one dimension."""
    return (dimension,), np.asarray(values), described(long_name)


def described(long_name: str) -> dict[str, str]:
    """Return the attributes of a variable."""
    return {"long_name": long_name, "units": "1"}


@lru_cache(maxsize=1)
def source() -> str:
    """Return name and version of the package, and the commit of a source checkout in brackets."""
    root = Path(__file__).resolve().parents[2]
    plain = f"fracparticles {__version__}"
    if not (root / ".git").exists():
        return plain
    try:
        done = subprocess.run(
            ["git", "-C", str(root), "rev-parse", "--short=12", "HEAD"],
            capture_output=True,
            text=True,
            check=True,
        )
    except (OSError, subprocess.CalledProcessError):  # no git, or not its folder
        return plain
    return f"{plain} ({done.stdout.strip()})"
