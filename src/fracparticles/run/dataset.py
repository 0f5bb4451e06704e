"""The only writer and reader of NetCDF: one run, one file (CF-1.11, ACDD-1.3)."""

from __future__ import annotations

import shutil
import subprocess
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fracparticles import __version__
from fracparticles.errors import InvalidInput
from fracparticles.files import load_netcdf, replacing
from fracparticles.run.case import FUNDAMENTAL, Case
from fracparticles.run.initial import case_of_run
from fracparticles.run.solution import Solution, relative_l1_error
from fracparticles.special.stable import mean_radius

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from fracparticles.moving.dvm import ParticleRun

__all__ = ["read_benchmark", "read_run", "source", "to_dataset", "write"]

REFERENCE = (
    "Lucchesi, Allouch, Le Maitre, Mustapha, Knio (2020), Particle simulation of space-fractional diffusion "
    "equations, Comput. Part. Mech. 7, 491-507, doi:10.1007/s40571-019-00275-8"
)

_LONG_NAMES = {
    "scheme": "particle scheme",
    "order": "order of the kernels",
    "kernel_family": "family of the kernels",
    "beta": "fractional order beta = alpha - 1",
    "truncation": "truncation factor C = D / ((diffusivity t_final)^(1/alpha) R_alpha)",
    "half_width": "half-width D of the lattice",
    "spacing": "particle spacing h asked for",
    "particle_spacing": "particle spacing h realised",
    "overlap": "overlap epsilon / h realised",
    "dt": "time step realised, 0 for the exponential",
    "diffusivity": "diffusivity D",
    "t_initial": "initial time",
    "t_final": "final time",
    "integrator": "time integrator",
    "evaluation": "evaluation of the step polynomial",
    "summation": "sum over particles",
    "exterior": "what lies beyond the lattice",
    "far_terms": "terms that continue the solution beyond the lattice",
    "dim": "space dimension",
    "kernel_table": "step of the kernel table, in units of epsilon",
    "remeshing": "remeshing kernel",
    "remesh_above": "spacing above which DVM remeshes, in units of h",
    "threshold": "share of the greatest strength below which DVM leaves a particle out",
}


def to_dataset(solution: Solution) -> xr.Dataset:
    """Return the data set of a run.

    Dimensions `x`, `y`, `z` as there are; `u` unless the case stores metrics only (for dim > 1 the profiles `u_axis`
    and `u_diagonal` if it stores these); scalar coordinates for every parameter; the scalars `mass_initial`,
    `mass_final`, `operator_applications` and, for a run from the fundamental solution, `relative_l1_error` of
    Eqs. (48), (59). For DVM also the particles and their history.
    """
    import xarray as xr

    case, u = solution.case, solution.u
    volume = case.particle_spacing**case.dim
    total = (
        _mass(u, volume) if solution.particles is None else float(solution.particles.strength.sum())
    )
    data: dict[str, tuple] = {
        "mass_initial": (
            (),
            _mass(solution.u0, volume),
            _describe("total mass, the sum of V u, at t_initial"),
        ),
        "mass_final": ((), total, _describe("total mass, the sum of V u, at t_final")),
        "operator_applications": (
            (),
            np.int64(solution.operator_applications),
            _describe("number of operator applications"),
        ),
    }
    if solution.initial.startswith(FUNDAMENTAL):
        data["relative_l1_error"] = (
            (),
            relative_l1_error(case, u),
            _describe("relative L1 error, Eqs. (48), (59)"),
        )
    for name, (value, meaning) in (getattr(solution, "estimates", None) or {}).items():
        data[name] = ((), float(value), _describe(meaning))
    coordinates: dict[str, tuple] = {
        name: ((), value, _describe(_LONG_NAMES[name])) for name, value in _parameters(case).items()
    }
    fields, axes = _fields(solution)
    data |= fields
    coordinates |= axes
    if solution.particles is not None:
        data |= _particle_variables(solution.particles, case.store)
    return xr.Dataset(
        data,
        coordinates,
        attrs={
            "Conventions": "CF-1.11, ACDD-1.3",
            "title": f"{case.scheme} of order {case.order} for u_t = -D (-Laplacian)^(alpha/2) u, "
            f"alpha = {case.alpha:g}, D = {case.diffusivity:g}",
            "summary": "Final particle strengths of one run and its parameters.",
            "keywords": "fractional diffusion, particle method, particle strength exchange",
            "source": source(),
            "history": "fracparticles.solve(case)",
            "references": REFERENCE,
            "initial_data": solution.initial,
            "case": case_of_run(case, solution.initial).to_json(),
        },
    )


def _fields(solution: Solution) -> tuple[dict[str, tuple], dict[str, tuple]]:
    """The strengths that the case stores, and their coordinates."""
    case, u = solution.case, solution.u
    if case.store == "metrics":
        return {}, {}
    x = case.x
    axes = ("x", "y", "z")[: case.dim]
    if case.store == "profile" and case.dim > 1:
        middle: tuple[Any, ...] = (slice(None), *(case.n,) * (case.dim - 1))
        return {
            "u_axis": (("x",), u[middle], _describe("particle strength u at t_final for y = 0")),
            "u_diagonal": (
                ("x",),
                np.einsum("i" * case.dim + "->i", u),
                _describe("particle strength u at t_final for y = x"),
            ),
        }, {"x": (("x",), x, _describe("particle position"))}
    if case.store == "profile":
        kept = np.abs(x) <= 5.0 * mean_radius(case.alpha) * (1.0 + 1e-12)
        x, u = x[kept], u[kept]
    coordinates = {axis: ((axis,), x, _describe("particle position")) for axis in axes}
    # DVM's particles leave the lattice; there is the field that they make.
    what = "field u" if case.kind.moving else "particle strength u"
    return {"u": (axes, u, _describe(f"{what} at t_final"))}, coordinates


def _particle_parameters(case: Case) -> dict[str, object]:
    return {
        "remeshing": case.remeshing or "M4'",
        "remesh_above": 1.5 if case.remesh_above is None else case.remesh_above,
        "threshold": case.threshold or 0.0,
    }


def _particle_variables(run: ParticleRun, store: str) -> dict[str, tuple]:
    """What happened to the particles of DVM, and unless only metrics are stored the particles themselves."""
    history = run.history
    scalars = {
        "remeshings": (np.int64(history.remeshings), "number of remeshings"),
        "largest_spacing": (history.largest_spacing, "largest spacing after any step"),
        "overtaking_steps": (
            np.int64(history.overtaking_steps),
            "steps that changed the order of the particles",
        ),
        "eliminated_particles": (
            np.int64(history.eliminated_count),
            "particles left out below the threshold",
        ),
        "eliminated_strength": (
            history.eliminated_strength,
            "total mass of the particles left out",
        ),
        "lost_strength": (
            history.lost_strength,
            "total mass that remeshing put beyond the lattice",
        ),
        "final_particles": (np.int64(run.x.size), "number of particles at t_final"),
    }
    data: dict[str, tuple] = {
        name: ((), number, _describe(meaning)) for name, (number, meaning) in scalars.items()
    }
    if store == "metrics":
        return data
    data["particle_position"] = (("particle",), run.x, _describe("position at t_final"))
    data["particle_strength"] = (
        ("particle",),
        run.strength,
        _describe("mass of a particle, V u, at t_final"),
    )
    if history.remeshings:
        dimension = ("event",)  # not "remeshing", which is a parameter
        data["remeshing_time"] = (
            dimension,
            np.array(history.remeshing_times),
            _describe("instant of a remeshing"),
        )
        data["spacing_before"] = (
            dimension,
            np.array(history.spacings_before),
            _describe("largest spacing before a remeshing"),
        )
        data["spacing_where"] = (
            dimension,
            np.array(history.spacings_where),
            _describe("middle of that gap"),
        )
    return data


def write(dataset: xr.Dataset, path: str | Path) -> None:
    """Write a data set under a temporary name and rename it when it is whole.

    Raises
    ------
    InvalidInput
        If `path` is there and not a regular file, or the data set holds what NetCDF cannot hold.
    OSError
        If the file cannot be written: a folder without permission, a full disk.
    """
    import xarray as xr

    if not isinstance(dataset, xr.Dataset):
        raise InvalidInput("dataset", type(dataset).__name__, "a Dataset", "Give what solve gives.")
    with replacing(path) as temporary:
        try:
            _to_netcdf(dataset, temporary)
        except Exception as error:  # the libraries raise many kinds
            _refuse_what_does_not_fit(dataset, temporary)
            reason = str(error).splitlines()[0] if str(error) else type(error).__name__
            free = shutil.disk_usage(temporary.parent).free
            raise OSError(f"cannot write {str(path)!r} ({reason}); {free} bytes are free") from None


def _to_netcdf(dataset: xr.Dataset, path: Path) -> None:
    encoding = {name: {"_FillValue": None} for name in dataset.variables}
    dataset.to_netcdf(path, engine="netcdf4", encoding=encoding)


def _refuse_what_does_not_fit(dataset: xr.Dataset, path: Path) -> None:
    """Name the attribute or the variable that NetCDF cannot hold, if that is why a data set could not be written."""
    import xarray as xr

    def refuse_unless_written(part: xr.Dataset, what: str, value: object) -> None:
        try:
            _to_netcdf(part, path)
        except (TypeError, ValueError, AttributeError, LookupError, OverflowError) as error:
            reason = str(error).splitlines()[0][:120] if str(error) else type(error).__name__
            raise InvalidInput(
                what,
                value,
                f"what a NetCDF file can hold ({reason})",
                "Leave it out, or make text of it.",
            ) from None
        except Exception:  # that of the disk
            return

    holders = [("attribute", dataset.attrs)]
    holders += [
        (f"attribute of {name},", variable.attrs) for name, variable in dataset.variables.items()
    ]
    for what, attributes in holders:
        for name, value in attributes.items():
            refuse_unless_written(xr.Dataset(attrs={name: value}), f"{what} {name!r}", value)
    for name, variable in dataset.variables.items():
        bare = variable.copy(deep=False)
        bare.attrs = {}
        refuse_unless_written(
            xr.Dataset({name: bare}), f"variable {name!r}", f"{variable.dtype} {variable.shape}"
        )


def read_run(path: str | Path) -> xr.Dataset:
    """Read a run's file, closed again.

    Raises
    ------
    InvalidInput
        If the file is missing, not NetCDF, damaged, or not a run of this package.
    """
    dataset = load_netcdf(Path(path))
    if "case" not in dataset.attrs or "mass_final" not in dataset:
        raise InvalidInput(
            "file",
            str(path),
            "a run written by fracparticles",
            "Make one with `fracparticles solve`.",
        )
    return dataset


def read_benchmark(path: str | Path) -> pd.DataFrame:
    """Read a benchmark's file: one row a measurement, the attributes of the file in `attrs`.

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
    spread = (case.diffusivity * case.t_final) ** (1.0 / case.alpha) * mean_radius(case.alpha)
    return {
        "scheme": case.scheme,
        "order": np.int64(case.order),
        "beta": case.beta,
        "truncation": case.domain / spread,
        "half_width": case.domain,
        "spacing": case.spacing,
        "particle_spacing": case.particle_spacing,
        "overlap": case.epsilon_over_h,
        "dt": case.time_step,
        "diffusivity": case.diffusivity,
        "t_initial": case.t_initial,
        "t_final": case.t_final,
        "integrator": case.method,
        "evaluation": "stepping" if case.steps_taken else case.evaluation or "series",
        "summation": case.summation,
        "exterior": case.exterior,
        "dim": np.int64(case.dim),
        **({} if case.far_terms is None else {"far_terms": np.int64(case.far_terms)}),
        **({} if case.kernel_family is None else {"kernel_family": case.kernel_family}),
        **({} if case.kernel_table is None else {"kernel_table": case.kernel_table}),
        **(_particle_parameters(case) if case.kind.moving else {}),
    }


def _mass(u: np.ndarray, volume: float) -> float:
    """sum_i V_i u_i; numpy sums pairwise, so the error is a few ulp."""
    return float(volume * u.sum())


def _describe(long_name: str) -> dict[str, str]:
    return {"long_name": long_name, "units": "1"}


@lru_cache(maxsize=1)
def source() -> str:
    """Return name and version of the package, and the commit of a source checkout in brackets."""
    root = Path(__file__).resolve().parents[2]
    plain = f"fracparticles {__version__}"
    if not (root / ".git").exists():
        return plain
    done = subprocess.run(
        ["git", "-C", str(root), "rev-parse", "--short=12", "HEAD"],
        capture_output=True,
        text=True,
        check=False,
    )
    return f"{plain} ({done.stdout.strip()})" if done.returncode == 0 else plain
