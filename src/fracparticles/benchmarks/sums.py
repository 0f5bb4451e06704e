"""Run times of the sums beyond the line: lattices of two and three dimensions, and scattered particles.

A lattice takes a set-up (kernel values, transforms of the weights, for the open exterior its sums) and then as many
applications of the operator as the series has terms. Both, and the peak memory, are measured against N. Wall times, on
a machine that does nothing else meanwhile; nothing of this enters the study's runs.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fracparticles.benchmark import machine, peak_so_far
from fracparticles.case import Case
from fracparticles.schemes import SCHEMES
from fracparticles.solver import integrate
from fracparticles.special import mean_radius
from fracparticles.sums import scattered_sum, smooth_kernel

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["box_benchmark", "box_table", "measure", "scattered_benchmark", "scattered_table"]

_BETA = 0.5
_TRUNCATION = 4.0
_TIME = 1.5  # of the lattice's half-width, Eq. (46)
_SPAN = 1e-3  # of the runs whose memory is measured: a few operator applications
_OVERLAP = 2.0
_TINY = 17  # particles in each direction: everything is loaded, the arrays are small

_BOX_VARIABLES = {
    "particles": ("number of particles", "1"),
    "setup_time": ("set-up of the operator, minimum", "s"),
    "application_time": ("one application of the operator by FFT, minimum", "s"),
    "naive_time": ("one application by sums over all pairs, on `threads_naive` cores, once", "s"),
    "peak_memory": ("peak resident memory of a process that runs the case", "byte"),
    "memory_per_particle": (
        "peak memory beyond that of a run on 17 in each direction, over the particles",
        "byte",
    ),
}
_SCATTERED_VARIABLES = {
    "transform_time": ("both sums by the non-uniform FFT, one core, minimum", "s"),
    "naive_time": ("both sums over all pairs, one core, minimum", "s"),
    "deviation": ("largest deviation of the two, over the largest value", "1"),
}


def box_benchmark(
    squares: Sequence[int] = (161, 321, 641, 1025),
    cubes: Sequence[int] = (33, 65, 129),
    kinds: Sequence[str] = ("KPSE-4-truncated", "KPSE-4-open", "FPSE-2-truncated"),
    naive_particles: float = 4e4,
    repeats: int = 5,
    seconds: float = 0.3,
    memory: bool = True,
) -> xr.Dataset:
    """Time the set-up and the application of operators on square and cubic lattices at beta = 0.5, C = 4.

    Parameters
    ----------
    squares, cubes : sequence of int
        Particles in each direction; one of 17 comes first, which compiles and shows what the programme itself takes.
    kinds : sequence of str
        Scheme, order and exterior.
    naive_particles : float
        The largest truncated lattice whose sums are also done over all pairs.
    repeats, seconds : int, float
        A timing is repeated so often, but no longer than that.
    memory : bool
        Whether to measure the peak memory: each kind then has a process of its own.
    """
    rows = []
    for dim, sizes in ((2, squares), (3, cubes)):
        for kind in kinds:
            cases = [_case(kind, dim, size) for size in sorted({_TINY, *sizes})]
            way = _measure_apart if memory else measure
            texts = [case.to_json() for case in cases]
            measured = way(texts, naive_particles, repeats, seconds, memory)
            least = measured[0]["peak_memory"]
            for case, row in zip(cases, measured, strict=True):
                if case.shape[0] in sizes:
                    row["memory_per_particle"] = (row["peak_memory"] - least) / case.particles
                    rows.append({"kind": kind, "dim": dim, **row})
    labels = {"kind": "scheme, order and exterior", "dim": "space dimension"}
    title = "Run times of operators on squares and cubes"
    return _dataset("run", rows, labels, _BOX_VARIABLES, title, repeats)


def _case(kind: str, dim: int, size: int) -> Case:
    """Return a run of a few operator applications on `size` particles in each direction."""
    scheme, order, exterior = kind.split("-")
    alpha = 1.0 + _BETA
    half_width = _TRUNCATION * _TIME ** (1.0 / alpha) * mean_radius(alpha)
    return Case(
        scheme=scheme,
        order=int(order),
        exterior=exterior,
        beta=_BETA,
        dim=dim,
        half_width=half_width,
        spacing=2.0 * half_width / (size - 1) * (1.0 - 1e-12),
        t_initial=_TIME - _SPAN,
        t_final=_TIME,
        integrator="exponential",
    )


def measure(
    cases: Sequence[str], naive_particles: float, repeats: int, seconds: float, memory: bool
) -> list[dict[str, float]]:
    """Measure cases, given as JSON, one after the other: the smallest first, which compiles what is not compiled yet.

    The peak memory, if wanted, is that of the process so far.
    """
    return [
        _measure_one(case, naive_particles, repeats, seconds, memory)
        for case in map(Case.from_json, cases)
    ]


def _measure_one(
    case: Case, naive_particles: float, repeats: int, seconds: float, memory: bool
) -> dict[str, float]:
    scheme = SCHEMES[case.scheme]
    setup_time, operator = _least_time(lambda: scheme.operator(case.setting), repeats, seconds)
    u = np.exp(-np.square(case.radius)).reshape(-1)
    application_time, _ = _least_time(lambda: operator.apply(u), repeats, seconds)
    integrate(case, operator, u)  # all arrays of a run are there at once
    row = {
        "particles": case.particles,
        "setup_time": setup_time,
        "application_time": application_time,
        "peak_memory": peak_so_far() if memory else np.nan,
    }
    if case.particles <= naive_particles and case.exterior == "truncated":
        oracle = scheme.operator(case.model_copy(update={"summation": "naive"}).setting)
        row["naive_time"], _ = _least_time(lambda: oracle.apply(u), 1, seconds)
    return row


def _measure_apart(*arguments: Any) -> list[dict[str, float]]:
    """`measure` in a fresh process, whose peak memory is its own."""
    program = (
        "import json, sys\n"
        "from fracparticles.benchmark_sums import measure\n"
        "print(json.dumps(measure(*json.loads(sys.argv[1]))))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, json.dumps(arguments)],
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(done.stdout)


def scattered_benchmark(
    particles: Sequence[int] = (1000, 4000, 16000, 64000, 250000, 1000000),
    naive_particles: float = 4000,
    repeats: int = 5,
    seconds: float = 0.3,
) -> xr.Dataset:
    """Time field (7) and flux (19) of particles anywhere on the line, as DVM needs them, by both ways.

    Parameters
    ----------
    particles : sequence of int
        Numbers of particles.
    naive_particles : float
        The largest number for which the sums are also done over all pairs.
    repeats, seconds : int, float
        A timing is repeated so often, but no longer than that.
    """
    kernels = [smooth_kernel(name, 1.0 + _BETA, 2) for name in ("eta", "F")]
    rows: list[dict[str, Any]] = []
    for n in particles:
        rng = np.random.default_rng(0)
        x = np.sort(rng.uniform(0.0, 1.0, n))
        q = np.exp(-np.square(6.0 * (x - 0.5))) / n
        fast = scattered_sum("fft", kernels, _OVERLAP / n)
        y = fast(x, q)  # makes its box
        transform_time, _ = _least_time(lambda: fast(x, q), repeats, seconds)  # noqa: B023
        row = {"particles": n, "transform_time": transform_time}
        if n <= naive_particles:
            naive = scattered_sum("naive", kernels, _OVERLAP / n)
            naive(x[:2], q[:2])  # compiles
            row["naive_time"], exact = _least_time(lambda: naive(x, q), repeats, seconds)  # noqa: B023
            row["deviation"] = (np.abs(y - exact).max(axis=1) / np.abs(exact).max(axis=1)).max()
        rows.append(row)
    labels = {"particles": "number of particles"}
    title = "Run times of sums over scattered particles"
    return _dataset("size", rows, labels, _SCATTERED_VARIABLES, title, repeats)


def _least_time(action: Callable[[], Any], repeats: int, seconds: float) -> tuple[float, Any]:
    """The least time of an action in so many repeats, fewer if they take too long, and its result."""
    least, result, begin = np.inf, None, time.perf_counter()
    for _ in range(repeats):
        result = None  # before the next one takes its memory
        start = time.perf_counter()
        result = action()
        now = time.perf_counter()
        least = min(least, now - start)
        if now - begin > seconds:
            break
    return least, result


def _dataset(
    dimension: str,
    rows: Sequence[dict[str, Any]],
    labels: dict[str, str],
    variables: dict[str, tuple[str, str]],
    title: str,
    repeats: int,
) -> xr.Dataset:
    import xarray as xr

    return xr.Dataset(
        {
            name: (
                (dimension,),
                np.array([row.get(name, np.nan) for row in rows]),
                {"long_name": long_name, "units": units},
            )
            for name, (long_name, units) in variables.items()
        },
        {
            name: ((dimension,), [row[name] for row in rows], {"long_name": long_name})
            for name, long_name in labels.items()
        },
        attrs={
            "Conventions": "CF-1.11, ACDD-1.3",
            "title": title,
            "summary": "Wall times on one machine; see the long names.",
            "repeats": repeats,
            **machine(),
        },
    )


def box_table(data: xr.Dataset) -> pd.DataFrame:
    """Return the benchmark of the lattices as people read it, one row a lattice."""
    import pandas as pd

    size = np.rint(data["particles"].values ** (1.0 / data["dim"].values)).astype(int)
    return pd.DataFrame(
        {
            "operator": data["kind"].values,
            "N": [f"{n}^{dim}" for n, dim in zip(size, data["dim"].values, strict=True)],
            "set-up / s": data["setup_time"].values,
            "application / ms": 1e3 * data["application_time"].values,
            "ns a particle": 1e9 * (data["application_time"] / data["particles"]).values,
            "naive / s": data["naive_time"].values,
            "naive / FFT": (data["naive_time"] / data["application_time"]).values,
            "peak memory / MB": 1e-6 * data["peak_memory"].values,
            "bytes a particle": data["memory_per_particle"].values,
        }
    )


def scattered_table(data: xr.Dataset) -> pd.DataFrame:
    """Return the benchmark of the scattered sums as people read it, one row a number of particles."""
    import pandas as pd

    return pd.DataFrame(
        {
            "N": data["particles"].values,
            "non-uniform FFT / ms": 1e3 * data["transform_time"].values,
            "ns a particle": 1e9 * (data["transform_time"] / data["particles"]).values,
            "naive / ms": 1e3 * data["naive_time"].values,
            "naive / FFT": (data["naive_time"] / data["transform_time"]).values,
            "deviation": data["deviation"].values,
        }
    )
