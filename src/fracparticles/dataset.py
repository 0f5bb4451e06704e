"""The only writer and reader of NetCDF: one run, one file (CF-1.11, ACDD-1.3)."""

from __future__ import annotations

import os
import subprocess
import tempfile
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fracparticles import __version__
from fracparticles.case import FUNDAMENTAL, Case
from fracparticles.errors import InvalidInput
from fracparticles.special.stable import mean_radius

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from fracparticles.schemes.dvm import ParticleRun
    from fracparticles.solver import Solution

__all__ = ["read_benchmark", "read_run", "read_strengths", "to_dataset", "write"]

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
    "diffusivity": "diffusivity",
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

    from fracparticles.solver import relative_l1_error

    case, u = solution.case, solution.u
    volume = case.particle_spacing**case.dim
    total = (
        _mass(u, volume) if solution.particles is None else float(solution.particles.strength.sum())
    )
    data: dict[str, tuple] = {
        "mass_initial": ((), _mass(solution.u0, volume), _describe("total strength at t_initial")),
        "mass_final": ((), total, _describe("total strength at t_final")),
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
            "title": f"{case.scheme} of order {case.order} for u_t = -(-Laplacian)^(alpha/2) u, alpha = {case.alpha:g}",
            "summary": "Final particle strengths of one run and its parameters.",
            "keywords": "fractional diffusion, particle method, particle strength exchange",
            "source": f"fracparticles {__version__}{_commit()}",
            "history": "fracparticles.solve(case)",
            "references": REFERENCE,
            "initial_data": solution.initial,
            "case": case.to_json(),
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
            "u_axis": (("x",), u[middle], _describe("u at t_final for y = 0")),
            "u_diagonal": (
                ("x",),
                np.einsum("i" * case.dim + "->i", u),
                _describe("u at t_final for y = x"),
            ),
        }, {"x": (("x",), x, _describe("particle position"))}
    if case.store == "profile":
        kept = np.abs(x) <= 5.0 * mean_radius(case.alpha) * (1.0 + 1e-12)
        x, u = x[kept], u[kept]
    coordinates = {axis: ((axis,), x, _describe("particle position")) for axis in axes}
    what = "field" if case.scheme == "DVM" else "particle strength"
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
            "total strength of the particles left out",
        ),
        "lost_strength": (
            history.lost_strength,
            "total strength that remeshing put beyond the lattice",
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
        _describe("strength U = V u at t_final"),
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
    """Write a data set under a temporary name and rename it when it is whole."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(
        prefix=f".{path.stem[:40]}-", suffix=".nc", dir=path.parent
    )
    os.close(handle)
    encoding = {name: {"_FillValue": None} for name in dataset.variables}
    try:
        dataset.to_netcdf(temporary, engine="netcdf4", encoding=encoding)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def read_run(path: str | Path) -> xr.Dataset:
    """Read a run's file, closed again.

    Raises
    ------
    InvalidInput
        If the file is missing, not NetCDF, damaged, or not a run of this package.
    """
    dataset = _load(Path(path))
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
    data = _load(Path(path))
    frame = data.to_dataframe().reset_index(drop=True)
    frame.attrs = dict(data.attrs)
    return frame


def read_strengths(path: Path, case: Case) -> np.ndarray:
    """Read initial strengths u(x) from a NetCDF file whose x are those of the case.

    Raises
    ------
    InvalidInput
        If the file cannot be read, holds no u(x), or lies on another lattice.
    """
    dataset = _load(path)
    axes = ("x", "y", "z")[: case.dim]
    if "u" not in dataset or dataset["u"].dims != axes or not set(axes) <= set(dataset.coords):
        raise InvalidInput(
            "initial",
            str(path),
            f"a NetCDF file with u({', '.join(axes)}) and the coordinates {', '.join(axes)}",
            "Store these.",
        )
    u, lattice = dataset["u"].values, [dataset[axis].values for axis in axes]
    if any(array.dtype.kind not in "iuf" for array in (u, *lattice)):
        raise InvalidInput("initial", str(path), "real numbers as x and u", "Store numbers.")
    u = u.astype(float)
    h = case.particle_spacing
    if u.shape != case.shape or any(np.abs(x - case.x).max() > 1e-9 * h for x in lattice):
        x = lattice[0]
        raise InvalidInput(
            "initial",
            str(path),
            f"u on the {case.particles} points of case.positions, h = {h:.9g} and |x| <= {case.domain:.9g}",
            f"The file has {u.size} points with |x| <= {np.abs(x).max(initial=0.0):.9g}: set half_width and "
            "spacing to match, or interpolate the data onto case.positions.",
        )
    if not np.isfinite(u).all():
        raise InvalidInput("initial", str(path), "finite strengths", "Mend the data.")
    return u


def _load(path: Path) -> xr.Dataset:
    import xarray as xr

    try:
        return xr.load_dataset(path, engine="netcdf4")
    except FileNotFoundError:
        raise InvalidInput("file", str(path), "an existing file", "Check the path.") from None
    except Exception as error:  # the library raises many kinds for damaged files
        reason = str(error).splitlines()[0][:120] if str(error) else type(error).__name__
        raise InvalidInput(
            "file", str(path), f"a readable NetCDF file ({reason})", "Write or copy it again."
        ) from None


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
        **(_particle_parameters(case) if case.scheme == "DVM" else {}),
    }


def _mass(u: np.ndarray, volume: float) -> float:
    """sum_i V_i u_i; numpy sums pairwise, so the error is a few ulp."""
    return float(volume * u.sum())


def _describe(long_name: str) -> dict[str, str]:
    return {"long_name": long_name, "units": "1"}


@lru_cache(maxsize=1)
def _commit() -> str:
    """The commit of a source checkout, in brackets; nothing for an installed package."""
    root = Path(__file__).resolve().parents[2]
    if not (root / ".git").exists():
        return ""
    done = subprocess.run(
        ["git", "-C", str(root), "rev-parse", "--short=12", "HEAD"],
        capture_output=True,
        text=True,
        check=False,
    )
    return f" ({done.stdout.strip()})" if done.returncode == 0 else ""
