"""The same bits: from run to run, from process to process, from any number of threads, from one job or two at once."""

import hashlib
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from fracparticles.run.case import Case
from fracparticles.run.solver import compute
from fracstudy.probe import HELD, Kind, Probe

_LINE = {"beta": 0.5, "half_width": 10.0, "spacing": 0.1}
_OPEN = {**_LINE, "exterior": "open", "integrator": "exponential"}
CASES: dict[str, dict[str, Any]] = {
    "DD, series": {"scheme": "DD", **_LINE, "integrator": "exponential"},
    "FPSE, open": {"scheme": "FPSE", **_OPEN},
    "KPSE, steps": {"scheme": "KPSE", **_LINE, "dt": 0.01, "evaluation": "stepping"},
    "KPSE, naive": {"scheme": "KPSE", **_LINE, "summation": "naive", "integrator": "exponential"},
    "GPSE": {"scheme": "GPSE", **_LINE},
    "KPSE, convolution": {"scheme": "KPSE", **_OPEN, "evaluation": "convolution"},
    "KPSE, square": {"scheme": "KPSE", **_OPEN, "spacing": 0.5, "dim": 2},
    "DD, square": {"scheme": "DD", **_OPEN, "spacing": 0.1, "dim": 2, "evaluation": "convolution"},
    "FD": {"scheme": "FD", **_LINE, "integrator": "exponential"},
    "DVM, transform": {"scheme": "DVM", **_LINE, "dt": 0.02},
    "DVM, naive": {"scheme": "DVM", **_LINE, "dt": 0.1, "t_final": 0.7, "summation": "naive"},
    "graded, exchange": {"scheme": "GPSE", "beta": 0.5, "half_width": 1e6, "spacing": 0.05, "graded_scale": 2.0,
                         "graded_form": "exchange"},
    "graded, field": {"scheme": "GPSE", "beta": 0.5, "half_width": 1e6, "spacing": 0.2, "graded_scale": 2.0},
}  # fmt: skip
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def digests() -> dict[str, str]:
    """The digest of the strengths of each case."""
    return {
        name: hashlib.sha256(compute(Case(**fields)).u.tobytes()).hexdigest()[:16]
        for name, fields in CASES.items()
    }


def _elsewhere(threads: int, seed: int = 0) -> dict[str, str]:
    """The same from a process of its own, with so many threads."""
    program = (
        "import warnings; warnings.simplefilter('ignore')\n"
        "from scenes.extremes.rounding.bits import digests\n"
        "print(*map('='.join, digests().items()), sep=';')"
    )
    paths = [str(Path(__file__).parents[3]), *filter(None, sys.path)]
    own = {"PYTHONHASHSEED": str(seed), "PYTHONPATH": os.pathsep.join(paths)}
    own |= {name: str(threads) for name in _THREADS}
    done = subprocess.run(
        [sys.executable, "-c", program],
        env=os.environ | own,
        capture_output=True,
        text=True,
        check=True,
        timeout=300,
    )
    return dict(part.split("=") for part in done.stdout.strip().split(";"))


def probes(threads: list[int], workflow: bool) -> Iterator[Probe]:
    """One row a case and what is changed; a deviation is one that has other bits."""
    first = digests()
    others = {"a second time": digests()}
    others |= {
        f"{n} thread{'s' if n > 1 else ''}, another process": _elsewhere(n, seed)
        for seed, n in enumerate(threads)
    }
    same = Kind("bits", "the same bits", must=HELD)
    for what, found in others.items():
        for name, digest in first.items():
            yield same(f"{name}, {what}", _compared, digest, found[name])
    if workflow:
        yield from _workflows()


def _compared(one: Any, other: Any) -> tuple[float, str]:
    return float(one != other), "the same" if one == other else "others"


def _workflows() -> Iterator[Probe]:
    """Two runs and their table, by one job after the other and by two at once."""
    from scenes.extremes.faults.workflows import Project

    same = Kind("bits", "the same bytes", must=HELD)
    with TemporaryDirectory() as name:
        alone, at_once = (Project(Path(name) / f"j{jobs}", Path.cwd()).end(jobs) for jobs in (1, 2))
        for path, data in alone.items():
            kind, file = Path(path).parts[0], Path(path).name
            yield same(f"{kind}: {file}, -j1 and -j2", _compared, data, at_once.get(path))
