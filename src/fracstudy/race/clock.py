"""Measurements of times and memory, and a description of the machine."""

from __future__ import annotations

import json
import os
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import _lru_cache_wrapper, cache, lru_cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numba as nb
import numpy as np
import pyfftw
import scipy.linalg  # noqa: F401  it brings a BLAS of its own, which must be there to be told
from threadpoolctl import threadpool_info, threadpool_limits

if TYPE_CHECKING:
    import xarray as xr

    Measurements = xr.Dataset
else:
    Measurements = Any  # a data set, whose package takes long to import

__all__ = [
    "LONG",
    "Measurements",
    "Timing",
    "conditions",
    "forget_peak",
    "forget_tables",
    "in_fresh_process",
    "machine",
    "measure",
    "measure_warm",
    "one_core",
    "other_load",
    "peak_so_far",
    "timings_dataset",
]

LONG = 0.25
"""Seconds; an action that takes longer is timed once."""
_SHORT = 0.1  # seconds of measurements: with less the load of other processes is not known
_COUNTERS = Path("/proc/stat")
_TICKS = os.sysconf("SC_CLK_TCK")  # of the counters in a second
_LINE = 256  # bytes, more than the first line of the counters has
_LIBRARIES = ("mkl_fft", "numba", "numpy", "pyfftw", "scipy")


@dataclass(frozen=True)
class Timing:
    """The times of an action, in seconds."""

    times: tuple[float, ...]

    @property
    def minimum(self) -> float:
        """The least time."""
        return min(self.times)

    @property
    def median(self) -> float:
        """The median time."""
        return statistics.median(self.times)

    def columns(self, name: str, factor: float = 1.0) -> dict[str, float]:
        """Return columns of a data set: <name>_time and <name>_time_median, times a factor, and the count <name>s."""
        least, middle = factor * self.minimum, factor * self.median
        return {f"{name}_time": least, f"{name}_time_median": middle, f"{name}s": len(self.times)}

    def __add__(self, other: Timing) -> Timing:
        return Timing(self.times + other.times)


def measure(
    action: Callable[[], Any],
    repeats: int = 1,
    seconds: float = float("inf"),
    before: Callable[[], object] | None = None,
) -> tuple[Timing, Any]:
    """Time an action `repeats` times, or fewer if that takes longer than `seconds`; return the last result, too.

    `before` is called before each time, and is not timed.
    """
    times: list[float] = []
    result = None
    began, others = time.perf_counter(), _seconds_of_others()
    for _ in range(repeats):
        result = None  # its memory is free before the next one is made
        if before is not None:
            before()
        start = time.perf_counter()
        result = action()
        times.append(time.perf_counter() - start)
        if sum(times) > seconds:
            break
    _WATCHED["others"] += _seconds_of_others() - others
    _WATCHED["clock"] += time.perf_counter() - began
    return Timing(tuple(times)), result


def measure_warm(
    action: Callable[[], Any], repeats: int = 1, seconds: float = float("inf")
) -> tuple[Timing, Any]:
    """Time an action after a first time that warms it up; for an action longer than `LONG` the first time counts.

    Code that is compiled at a first call, or kept on disk, must be compiled already.
    """
    first, result = measure(action)
    return (first, result) if first.minimum > LONG else measure(action, repeats, seconds)


# Since `one_core`: the seconds of all measurements, and the core seconds of all other processes during them.
_WATCHED = {"clock": 0.0, "others": 0.0}


def _seconds_of_others() -> float:
    """The core seconds of all processes but this one since the start of the system; nan outside Linux."""
    counters = _open_counters()
    if counters is None:
        return float("nan")
    line = os.pread(counters, _LINE, 0).split(b"\n", 1)[0]
    user, nice, system, _idle, _waiting, *interrupts = map(int, line.split()[1:9])
    return (user + nice + system + sum(interrupts)) / _TICKS - time.process_time()


@cache
def _open_counters() -> int | None:
    """Open the counters once for the life of the process, since they are read around each measurement."""
    return os.open(_COUNTERS, os.O_RDONLY) if _COUNTERS.exists() else None


def other_load() -> float:
    """Return the share of a core that other processes took during the measurements since `one_core`; nan if unknown.

    The system counts in ticks of some milliseconds: the sum over many short measurements is right, but not each one.
    """
    if _WATCHED["clock"] < _SHORT:
        return float("nan")
    return max(0.0, _WATCHED["others"] / _WATCHED["clock"])


def forget_tables() -> None:
    """Empty the tables that the package keeps from call to call, and the plans that FFTW keeps.

    A set-up is then measured as the first one of a process.
    """
    pyfftw.forget_wisdom()
    for table in _tables(len(sys.modules)):
        table.cache_clear()


@lru_cache(maxsize=1)
def _tables(modules: int) -> list[_lru_cache_wrapper[Any]]:
    """The tables of the loaded modules, found again when the number of modules has changed."""
    return [
        kept
        for name, module in list(sys.modules.items())
        if name.startswith("fracparticles.")
        for kept in vars(module).values()
        # A cache without a largest size, such as the list of schemes, is not a table.
        if isinstance(kept, _lru_cache_wrapper) and kept.cache_parameters()["maxsize"]
    ]


def one_core() -> None:
    """Begin a benchmark: keep numba's parallel loops and BLAS to one thread, and watch other processes anew."""
    _WATCHED.update(clock=0.0, others=0.0)
    threadpool_limits(1)
    nb.set_num_threads(1)


def peak_so_far() -> float:
    """Return the peak resident memory of this process, in bytes; nan outside Linux.

    It is VmHWM and not ru_maxrss, which a process inherits from the one that starts it.
    """
    status = Path("/proc/self/status")
    if not status.exists():
        return float("nan")
    lines = status.read_text().splitlines()
    return 1024.0 * float(next(line.split()[1] for line in lines if line.startswith("VmHWM")))


def forget_peak() -> None:
    """Let the peak of `peak_so_far` begin anew, from the memory of now: imports may have needed more."""
    with suppress(OSError):  # outside Linux
        Path("/proc/self/clear_refs").write_text("5")


def in_fresh_process(function: Callable[..., Any], *arguments: Any) -> Any:
    """Return function(*arguments) from a process of its own, with a peak memory of its own; all data must be plain."""
    program = (
        "import json, sys\n"
        "sys.path[:], arguments = json.loads(sys.argv[1])\n"
        f"from {function.__module__} import {function.__name__} as function\n"
        "print(json.dumps(function(*arguments)))\n"
    )
    given = json.dumps([sys.path, arguments])  # the path: the packages of scenes are found there
    command = [sys.executable, "-c", program, given]
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True)
    return json.loads(done.stdout)


def conditions() -> dict[str, float]:
    """Return the conditions of this process: its threads, and the load by other processes."""
    blas = [pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"]
    threads = {"threads_numba": nb.get_num_threads(), "threads_blas": max(blas, default=0)}
    return {**threads, "other_load": other_load()}


def machine() -> dict[str, Any]:
    """Return a description of the machine and its software, as attributes of a data set."""
    facts: dict[str, Any] = {
        "cpu": _cpu_model(),
        "cores": len(os.sched_getaffinity(0)),
        **conditions(),
        "load_average": os.getloadavg()[0],
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


def timings_dataset(
    dimension: str,
    rows: Sequence[Mapping[str, Any]],
    labels: Mapping[str, str],
    variables: Mapping[str, tuple[str, str]],
    title: str,
    facts: Mapping[str, Any],
) -> Measurements:
    """Return measurements as a data set, with one element of `dimension` for each row.

    Parameters
    ----------
    dimension : str
        Name of the dimension.
    rows : sequence of mapping
        The measurements; a missing number becomes nan, and a missing text empty.
    labels : mapping
        The coordinates: name and long name.
    variables : mapping
        The variables: name, and long name and unit.
    title : str
    facts : mapping
        More attributes, such as the repeats; the package, its version and commit, and those of the machine are
        added. For measurements in another process its `conditions` must be given here.
    """
    import xarray as xr

    from fracparticles.run.dataset import source

    def values(name: str) -> np.ndarray:
        given = [row.get(name) for row in rows]
        if any(isinstance(value, str) for value in given):
            return np.array(["" if value is None else str(value) for value in given], dtype=object)
        return np.array([np.nan if value is None else value for value in given])

    return xr.Dataset(
        {
            name: ((dimension,), values(name), {"long_name": long_name, "units": units})
            for name, (long_name, units) in variables.items()
        },
        {
            name: ((dimension,), values(name), {"long_name": long_name})
            for name, long_name in labels.items()
        },
        attrs={
            "Conventions": "CF-1.11, ACDD-1.3",
            "title": title,
            "summary": "Wall times on one machine, one core; see the long names.",
            "source": source(),
            **machine(),
            **facts,
        },
    )
