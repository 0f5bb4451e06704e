"""The only writer and reader of NetCDF: one run, one file (CF-1.11, ACDD-1.3)."""

from __future__ import annotations

import os
import subprocess
import tempfile
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fracparticles import __version__
from fracparticles.case import FUNDAMENTAL, Case
from fracparticles.errors import InvalidInput
from fracparticles.special.stable import mean_radius

if TYPE_CHECKING:
    import xarray as xr

    from fracparticles.solver import Solution

__all__ = ["read_run", "read_strengths", "to_dataset", "write"]

REFERENCE = (
    "Lucchesi, Allouch, Le Maitre, Mustapha, Knio (2020), Particle simulation of space-fractional diffusion "
    "equations, Comput. Part. Mech. 7, 491-507, doi:10.1007/s40571-019-00275-8"
)

_LONG_NAMES = {
    "scheme": "particle scheme",
    "order": "order of the kernels",
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
}


def to_dataset(solution: Solution) -> xr.Dataset:
    """Return the data set of a run.

    Dimension `x`; `u` unless the case stores metrics only; scalar coordinates for every parameter; the scalars
    `mass_initial`, `mass_final`, `operator_applications` and, for a run from the fundamental solution,
    `relative_l1_error` of Eq. (48).
    """
    import xarray as xr

    from fracparticles.solver import relative_l1_error

    case, x, u = solution.case, solution.x, solution.u
    h = case.particle_spacing
    data: dict[str, tuple] = {
        "mass_initial": ((), _mass(solution.u0, h), _describe("total strength at t_initial")),
        "mass_final": ((), _mass(u, h), _describe("total strength at t_final")),
        "operator_applications": (
            (),
            np.int64(solution.operator_applications),
            _describe("number of operator applications"),
        ),
    }
    if solution.initial.startswith(FUNDAMENTAL):
        data["relative_l1_error"] = (
            (),
            relative_l1_error(case, x, u),
            _describe("relative L1 error over 5 R_alpha, Eq. (48)"),
        )
    coordinates: dict[str, tuple] = {
        name: ((), value, _describe(_LONG_NAMES[name])) for name, value in _parameters(case).items()
    }
    if case.store != "metrics":
        kept = np.abs(x) <= 5.0 * mean_radius(case.alpha) * (1.0 + 1e-12)
        if case.store == "field":
            kept[:] = True
        data["u"] = (("x",), u[kept], _describe("particle strength at t_final"))
        coordinates["x"] = (("x",), x[kept], _describe("particle position"))
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


def read_strengths(path: Path, case: Case) -> np.ndarray:
    """Read initial strengths u(x) from a NetCDF file whose x are those of the case.

    Raises
    ------
    InvalidInput
        If the file cannot be read, holds no u(x), or lies on another lattice.
    """
    dataset = _load(path)
    if "u" not in dataset or dataset["u"].dims != ("x",) or "x" not in dataset.coords:
        raise InvalidInput(
            "initial", str(path), "a NetCDF file with u(x) and the coordinate x", "Store these two."
        )
    x, u = dataset["x"].values, dataset["u"].values
    if x.dtype.kind not in "iuf" or u.dtype.kind not in "iuf":
        raise InvalidInput("initial", str(path), "real numbers as x and u", "Store numbers.")
    x, u = x.astype(float), u.astype(float)
    h = case.particle_spacing
    if x.shape != case.x.shape or np.abs(x - case.x).max() > 1e-9 * h:
        raise InvalidInput(
            "initial",
            str(path),
            f"u on the {case.particles} points of case.x, h = {h:.9g} and |x| <= {case.domain:.9g}",
            f"The file has {x.size} points with |x| <= {np.abs(x).max(initial=0.0):.9g}: set half_width and "
            "spacing to match, or interpolate the data onto case.x.",
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
        "evaluation": case.evaluation,
        "summation": case.summation,
        "exterior": case.exterior,
    }


def _mass(u: np.ndarray, h: float) -> float:
    """sum_i V_i u_i; numpy sums pairwise, so the error is a few ulp."""
    return float(h * u.sum())


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
