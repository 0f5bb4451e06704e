"""Run times of the reference problem of Sec. 4.1: beta = 0.5, C = 160, N = 64001, 20000 RK2 steps.

Four ways to the same discrete solution, p(A dt)^n u0, from the papers' own to ours:

    naive stepping      n steps, sums over all pairs            2 n N^2 pairs; a few steps, extrapolated
    stepping            n steps, sums by FFT                    2 n transform pairs
    series              one Chebyshev series of p^n, by FFT     about sqrt(40 T |lambda|) transform pairs
    floor               the transforms of the series alone, by the fastest library at hand

Wall times, on a machine that does nothing else meanwhile; nothing of this enters the study's runs.
"""

from __future__ import annotations

import os
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numba as nb
import numpy as np
import pyfftw
import scipy.fft

from fracparticles import integrators, stability
from fracparticles.case import Case
from fracparticles.operators import Operator
from fracparticles.schemes import SCHEMES
from fracparticles.solver import initial_strengths, integrate
from fracparticles.spectrum import spectral_interval
from fracparticles.sums.fourier import shares_memory, transform_length

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = [
    "benchmark_table",
    "machine",
    "peak_memory",
    "peak_so_far",
    "reference_benchmark",
    "transform_pairs",
]

Action = Callable[[], Any]

_PAIRS = 40  # transform pairs between two looks at the clock
_LIBRARIES = ("mkl_fft", "numba", "numpy", "pyfftw", "scipy")


def reference_benchmark(
    repeats: int = 5,
    truncation: float = 160.0,
    spacing: float = 0.0111739,
    dt: float = 5e-5,
    green_dt: float = 2.5e-3,
    stepping: Sequence[str] = ("KPSE",),
    naive: Sequence[str] = ("KPSE",),
    naive_seconds: float = 20.0,
    memory: bool = True,
    measured_plans: bool = True,
) -> xr.Dataset:
    """Time DD, FPSE and KPSE of both orders and GPSE on the reference problem.

    Parameters
    ----------
    repeats : int
        Timings of each series after a warm-up; their minimum and median are kept.
    truncation, spacing, dt : float
        The reference problem.
    green_dt : float
        The time step of GPSE.
    stepping, naive : sequence of str
        Schemes, order II, that are also stepped through with fast sums, all steps, and with sums over all pairs.
    naive_seconds : float
        Time for the naive steps of each scheme: as many as fit, one at least. The total is extrapolated.
    memory : bool
        Whether to measure the peak memory, each run in a process of its own.
    measured_plans : bool
        Whether FFTW may also look for its fastest plan, which takes it some seconds.

    Returns
    -------
    xarray.Dataset
        Dimensions `run` and `library`; times in seconds, nan where not measured; the machine in the attributes.
    """
    common = {"beta": 0.5, "truncation": truncation, "spacing": spacing}
    cases = [
        Case(scheme=scheme, order=order, dt=dt, **common)
        for scheme in ("DD", "FPSE", "KPSE")
        for order in (2, 4)
    ] + [Case(scheme="GPSE", dt=green_dt, **common)]
    load = os.getloadavg()[0]
    pairs = transform_pairs(transform_length(2 * cases[0].particles - 1), measured_plans)
    rows = []
    for case in cases:
        row = _time_series(case, repeats, pairs)
        if memory:
            row["peak_memory"] = peak_memory(case)
        if case.order == 2 and case.scheme in stepping:
            row.update(_time_stepping(case))
        if case.order == 2 and case.scheme in naive:
            row.update(_time_naive(case, naive_seconds))
        rows.append(row)
    return _dataset(cases, rows, list(pairs), {"repeats": repeats, "load_average_before": load})


def transform_pairs(length: int, measured_plans: bool = True) -> dict[str, Action]:
    """Return one real transform and its inverse, of this length on one core, for each library at hand.

    On zeros, which stay zeros however often they are transformed: the time does not depend on the data.
    """
    x = np.zeros(length)
    pairs: dict[str, Action] = {
        "FFTW": _fftw_pair(length, "FFTW_ESTIMATE", in_place=False),
        "FFTW, in place": _fftw_pair(length, "FFTW_ESTIMATE", in_place=True),
        "scipy.fft": lambda: scipy.fft.irfft(scipy.fft.rfft(x), n=length, overwrite_x=True),
    }
    if measured_plans:
        pairs["FFTW, measured"] = _fftw_pair(length, "FFTW_MEASURE", in_place=False)
        pairs["FFTW, measured, in place"] = _fftw_pair(length, "FFTW_MEASURE", in_place=True)
    try:
        mkl_fft = import_module("mkl_fft")
    except ImportError:  # not a dependency
        return pairs
    spectrum = np.zeros(length // 2 + 1, dtype=complex)
    pairs["MKL"] = lambda: mkl_fft.irfft(mkl_fft.rfft(x, out=spectrum), n=length, out=x)
    return pairs


def _fftw_pair(length: int, effort: str, in_place: bool) -> Action:
    spectrum = pyfftw.zeros_aligned(length // 2 + 1, dtype=complex)
    real = spectrum.view(float)[:length] if in_place else pyfftw.zeros_aligned(length)
    forward = pyfftw.FFTW(real, spectrum, flags=(effort,))
    backward = pyfftw.FFTW(
        spectrum, real, direction="FFTW_BACKWARD", flags=(effort, "FFTW_DESTROY_INPUT")
    )
    real[:] = 0.0  # a measured plan overwrites its arrays
    spectrum[:] = 0.0

    def pair() -> None:
        forward.execute()
        backward.execute()

    return pair


def peak_memory(case: Case) -> float:
    """Return the peak resident memory, in bytes, of a fresh process that runs the case; nan outside Linux."""
    program = (
        "import sys\n"
        "from fracparticles.benchmark import peak_so_far\n"
        "from fracparticles.case import Case\n"
        "from fracparticles.solver import compute\n"
        "compute(Case.from_json(sys.argv[1]))\n"
        "print(peak_so_far())\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, case.to_json()], capture_output=True, text=True, check=True
    )
    return float(done.stdout)


def peak_so_far() -> float:
    """Return the peak resident memory of this process, in bytes; nan outside Linux.

    VmHWM and not ru_maxrss, which a process inherits from the one that starts it.
    """
    status = Path("/proc/self/status")
    if not status.exists():
        return float("nan")
    lines = status.read_text().splitlines()
    return 1024.0 * float(next(line.split()[1] for line in lines if line.startswith("VmHWM")))


def _time_series(case: Case, repeats: int, pairs: dict[str, Action]) -> dict[str, Any]:
    """Time the series and, in turn with it, the transforms of each library."""

    def set_up() -> Operator:
        stability._symbol_range.cache_clear()  # the range of the symbol is part of the set-up
        operator = SCHEMES[case.scheme].operator(case.setting)
        spectral_interval(case, operator)
        return operator

    u0, _ = initial_strengths(case)
    operator = set_up()
    _, applications = integrate(case, operator, u0)  # compiles what is not compiled yet
    setups, solves = [], []
    pair_times: dict[str, list[float]] = {name: [] for name in pairs}
    for _ in range(repeats):
        setups.append(_clock(set_up))
        solves.append(_clock(lambda: integrate(case, operator, u0)))
        for name, pair in pairs.items():
            pair_times[name].append(_clock(lambda: [pair() for _ in range(_PAIRS)]) / _PAIRS)  # noqa: B023
    pair_minimum = {name: min(times) for name, times in pair_times.items()}
    length = transform_length(2 * case.particles - 1)
    own = "FFTW, in place" if shares_memory(length) else "FFTW"
    floor = applications * min(pair_minimum.values())
    return {
        "particles": case.particles,
        "steps": case.steps,
        "transform_length": length,
        "operator_applications": applications,
        "setup_time": min(setups),
        "solve_time": min(solves),
        "solve_time_median": statistics.median(solves),
        "pair_time": list(pair_minimum.values()),
        "floor_time": floor,
        "floor_ratio": min(solves) / floor,
        "own_ratio": min(solves) / (applications * pair_minimum[own]),
    }


def _time_stepping(case: Case) -> dict[str, float]:
    """Time all steps with fast sums, and compare with the series."""
    u0, _ = initial_strengths(case)
    operator = SCHEMES[case.scheme].operator(case.setting)
    series, _ = integrate(case, operator, u0)
    stepped = case.model_copy(update={"evaluation": "stepping"})
    start = time.perf_counter()
    u, applications = integrate(stepped, operator, u0)
    return {
        "stepping_time": time.perf_counter() - start,
        "stepping_applications": applications,
        "stepping_deviation": float(np.abs(u - series).max() / np.abs(u).max()),
    }


def _time_naive(case: Case, seconds: float) -> dict[str, float]:
    """Time steps with sums over all pairs of particles, on all cores, one at a time."""
    polynomial = integrators.STEP_POLYNOMIALS[case.method]

    def steps_of(case: Case, seconds: float) -> tuple[int, float]:
        naive = case.model_copy(update={"summation": "naive"})
        operator = SCHEMES[case.scheme].operator(naive.setting)
        u, _ = initial_strengths(case)
        done, start = 0, time.perf_counter()
        while True:
            u, _ = integrators.step(operator, polynomial, case.time_step, 1, u)
            done, spent = done + 1, time.perf_counter() - start
            # Another step would not fit.
            if spent + spent / done > seconds:
                return done, spent / done

    steps_of(case.model_copy(update={"truncation": 100.0 * case.spacing}), 0.0)  # compiles
    done, step_time = steps_of(case, seconds)
    return {
        "naive_measured_steps": done,
        "naive_step_time": step_time,
        "naive_extrapolated_time": step_time * case.steps,
    }


def _clock(action: Action) -> float:
    start = time.perf_counter()
    action()
    return time.perf_counter() - start


# Name -> long name and unit. Those of stepping and naive stepping are nan for the schemes left out.
_VARIABLES = {
    "particles": ("number of particles N", "1"),
    "steps": ("number of time steps n", "1"),
    "transform_length": ("length of the real transforms", "1"),
    "operator_applications": ("operator applications of the series", "1"),
    "setup_time": ("set-up: weights, transform plans, range of the symbol; minimum", "s"),
    "solve_time": ("solve by the series, minimum", "s"),
    "solve_time_median": ("solve by the series, median", "s"),
    "floor_time": ("operator applications times the fastest transform pair", "s"),
    "floor_ratio": ("solve time over floor time", "1"),
    "own_ratio": ("solve time over that of the same transforms as planned for the solve", "1"),
    "peak_memory": ("peak resident memory of a process that runs the case", "byte"),
    "stepping_time": ("all steps, sums by FFT, once", "s"),
    "stepping_applications": ("operator applications of stepping", "1"),
    "stepping_deviation": ("max |u_stepping - u_series| / max |u_stepping|", "1"),
    "naive_measured_steps": ("naive steps that were timed", "1"),
    "naive_step_time": ("one naive step, mean of those timed", "s"),
    "naive_extrapolated_time": ("all naive steps, extrapolated: step time times n", "s"),
    "stepping_over_series": ("stepping time over series time", "1"),
    "naive_over_stepping": ("extrapolated naive time over stepping time", "1"),
    "naive_over_series": ("extrapolated naive time over series time", "1"),
}


def _dataset(
    cases: Sequence[Case],
    rows: Sequence[dict[str, Any]],
    libraries: Sequence[str],
    facts: dict[str, Any],
) -> xr.Dataset:
    import xarray as xr

    values = {name: np.array([row.get(name, np.nan) for row in rows]) for name in _VARIABLES}
    values["stepping_over_series"] = values["stepping_time"] / values["solve_time"]
    values["naive_over_stepping"] = values["naive_extrapolated_time"] / values["stepping_time"]
    values["naive_over_series"] = values["naive_extrapolated_time"] / values["solve_time"]
    data: dict[str, tuple] = {
        name: (("run",), values[name], {"long_name": long_name, "units": units})
        for name, (long_name, units) in _VARIABLES.items()
    }
    data["pair_time"] = (
        ("run", "library"),
        np.array([row["pair_time"] for row in rows]),
        {"long_name": "a real transform and its inverse, one core, minimum", "units": "s"},
    )
    return xr.Dataset(
        data,
        {
            "scheme": (("run",), [case.scheme for case in cases], {"long_name": "particle scheme"}),
            "order": (("run",), [case.order for case in cases], {"long_name": "kernel order"}),
            "dt": (("run",), [case.time_step for case in cases], {"long_name": "time step"}),
            "library": (("library",), list(libraries), {"long_name": "transform library"}),
        },
        attrs={
            "Conventions": "CF-1.11, ACDD-1.3",
            "title": "Run times of the reference problem",
            "summary": "Wall times on one machine; see the long names. Naive totals are extrapolated.",
            "case": cases[0].to_json(),
            **facts,
            **machine(),
        },
    )


def machine() -> dict[str, Any]:
    """Return what the times were measured on, as attributes of a data set."""
    facts: dict[str, Any] = {
        "cpu": _cpu_model(),
        "cores": len(os.sched_getaffinity(0)),
        "threads_series_and_stepping": 1,
        "threads_naive": nb.get_num_threads(),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
    }
    for library in _LIBRARIES:
        try:
            facts[library] = version(library)
        except PackageNotFoundError:
            facts[library] = "not installed"
    return facts


def _cpu_model() -> str:
    description = Path("/proc/cpuinfo")
    if description.exists():
        for line in description.read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


def benchmark_table(data: xr.Dataset) -> pd.DataFrame:
    """Return the benchmark as people read it, one row a run."""
    import pandas as pd

    best = data["pair_time"].argmin("library")
    columns = {
        "scheme": data["scheme"],
        "order": data["order"],
        "N": data["particles"],
        "steps": data["steps"],
        "operator applications": data["operator_applications"],
        "set-up / ms": 1e3 * data["setup_time"],
        "series, min / ms": 1e3 * data["solve_time"],
        "series, median / ms": 1e3 * data["solve_time_median"],
        "transform length": data["transform_length"],
        "fastest pair / ms": 1e3 * data["pair_time"].min("library"),
        "fastest library": data["library"][best],
        "series / its transforms": data["own_ratio"],
        "series / fastest transforms": data["floor_ratio"],
        "peak memory / MB": 1e-6 * data["peak_memory"],
        "stepping / s": data["stepping_time"],
        "stepping - series, relative": data["stepping_deviation"],
        "naive steps timed": data["naive_measured_steps"],
        "naive / s per step": data["naive_step_time"],
        "naive, extrapolated / s": data["naive_extrapolated_time"],
        "stepping / series": data["stepping_over_series"],
        "naive / stepping": data["naive_over_stepping"],
        "naive / series": data["naive_over_series"],
    }
    return pd.DataFrame({name: column.values for name, column in columns.items()})
