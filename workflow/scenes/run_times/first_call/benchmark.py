"""What a first call costs: a process of its own, from its start to the result."""

import subprocess
import sys
from functools import partial
from typing import Any

from fracstudy.race.clock import Measurements, Timing, measure, one_core, timings_dataset

_DATA = "x = np.linspace(-20.0, 20.0, 400, endpoint=False); u0 = 1.0 / (1.0 + x**2)\n"
_CALLS = {
    "an empty program": "",
    "numpy and scipy.fft alone": "import numpy as np, scipy.fft",
    "exact symbol in numpy and scipy": "import numpy as np\nfrom scipy.fft import irfft, rfft, rfftfreq\n"
    + _DATA
    + "irfft(rfft(u0) * np.exp(-(2.0 * np.pi * rfftfreq(400, 0.1)) ** 1.5), 400)",
    "numba, xarray, pydantic and pyfftw alone": "import numba, pydantic, pyfftw, scipy.special, xarray",
    "fp.evolve": "import numpy as np, fracparticles as fp\n"
    + _DATA
    + "fp.evolve(u0, 0.1, 1.5, 1.0)",
    "fp.green": "import fracparticles as fp\nfp.green([0.0, 1.0], 1.0, 1.5)",
    "fp.solve, GPSE, one step": "import fracparticles as fp\n"
    "fp.solve(fp.Case(scheme='GPSE', beta=0.5, truncation=7.0, spacing=0.4, dt=1.0, exterior='open'))",
    "fp.solve, KPSE 4, series": "import fracparticles as fp\n"
    "fp.solve(fp.Case(scheme='KPSE', order=4, beta=0.5, truncation=20.0, spacing=0.05, dt=2e-4, exterior='open'))",
    "fp.solve, DD 2 in the plane": "import fracparticles as fp\n"
    "fp.solve(fp.Case(scheme='DD', beta=0.5, dim=2, truncation=4.0, spacing=0.2, dt=1e-3))",
}


def benchmark(repeats: int) -> Measurements:
    """Time processes, each program in turn; the first round leaves what is compiled or cached on disk."""
    one_core()
    times = dict.fromkeys(_CALLS, Timing(()))
    for _ in range(repeats):
        for name, program in _CALLS.items():
            times[name] += measure(partial(_run, program))[0]
    rows: list[dict[str, Any]] = [
        {"call": name, **timing.columns("run")} for name, timing in times.items()
    ]
    variables = {
        "run_time": ("from the start of the process to its end, minimum", "s"),
        "run_time_median": ("the same, median", "s"),
        "runs": ("processes that were timed", "1"),
    }
    title = "The first call of a fresh process"
    return timings_dataset(
        "program",
        rows,
        {"call": "what is called"},
        variables,
        title,
        {"repeats": repeats, "other_load": float("nan")},
    )


def _run(program: str) -> None:
    subprocess.run([sys.executable, "-W", "ignore", "-c", program], check=True)
