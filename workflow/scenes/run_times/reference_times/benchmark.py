"""Run times of the reference problem of Sec. 4.1: beta = 0.5, C = 160, N = 64001, 20000 RK2 steps.

Four ways to the same discrete solution, p(A dt)^n u0, from the papers' own to ours:

    naive stepping      n steps, sums over all pairs            2 n N^2 pairs; a few steps, extrapolated
    stepping            n steps, sums by FFT                    2 n transform pairs
    series              one Chebyshev series of p^n, by FFT     about sqrt(40 T |lambda|) transform pairs
    floor               the transforms of the series alone, by the fastest library at hand

and, of the transform pair that all is made of, what other kinds of it would cost.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np
import pyfftw
import scipy.fft

from fracparticles.lattice.fourier import shares_memory, transform_length
from fracparticles.run.case import Case
from fracparticles.run.solver import Prepared, compute, initial_strengths, prepare
from fracstudy.benchmarks.clock import (
    forget_tables,
    in_fresh_process,
    measure,
    one_core,
    peak_so_far,
    timings_dataset,
)

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["benchmark", "transform_pairs"]

Action = Callable[[], Any]

_PAIRS = 40  # transform pairs between two looks at the clock
_OTHER_KINDS = ("single precision", "cosine transform of an even field")


def benchmark(
    repeats: int,
    truncation: float,
    spacing: float,
    dt: float,
    green_dt: float,
    stepping: Sequence[str],
    naive: Sequence[str],
    naive_steps: int,
    memory: bool,
    measured_plans: bool,
) -> xr.Dataset:
    """Time DD, FPSE and KPSE of both orders and GPSE on the reference problem, one core.

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
    naive_steps : int
        Naive steps that are timed; the total is extrapolated.
    memory : bool
        Whether to measure the peak memory, each run in a process of its own.
    measured_plans : bool
        Whether FFTW may also look for its fastest plan, which takes it some seconds.

    Returns
    -------
    xarray.Dataset
        Dimension `run`; times in seconds, nan where not measured.
    """
    one_core()
    common = {"beta": 0.5, "truncation": truncation, "spacing": spacing}
    cases = [
        Case(scheme=scheme, order=order, dt=dt, **common)
        for scheme in ("DD", "FPSE", "KPSE")
        for order in (2, 4)
    ] + [Case(scheme="GPSE", dt=green_dt, **common)]
    pairs = transform_pairs(transform_length(2 * cases[0].particles - 1), measured_plans)
    rows = []
    for case in cases:
        row = _time_series(case, repeats, pairs)
        if memory:
            row["peak_memory"] = in_fresh_process(peak_of, case.to_json())
        if case.order == 2 and case.scheme in stepping:
            row.update(_time_stepping(case))
        if case.order == 2 and case.scheme in naive:
            row.update(_time_naive(case, naive_steps))
        for slow in ("stepping", "naive"):
            row[f"{slow}_over_series"] = row.get(f"{slow}_time", np.nan) / row["solve_time"]
        rows.append(row)
    title = "Run times of the reference problem"
    facts = {"repeats": repeats, "case": cases[0].to_json()}
    return timings_dataset("run", rows, _LABELS, _VARIABLES, title, facts)


def peak_of(case: str) -> float:
    """Return the peak memory of this process, in bytes, after the run of a case given as JSON."""
    compute(Case.from_json(case))
    return peak_so_far()


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
    pairs |= _other_kinds(length)
    try:
        mkl_fft = import_module("mkl_fft")
    except ImportError:  # not a dependency
        return pairs
    spectrum = np.zeros(length // 2 + 1, dtype=complex)
    pairs["MKL"] = lambda: mkl_fft.irfft(mkl_fft.rfft(x, out=spectrum), n=length, out=x)
    return pairs


def _other_kinds(length: int) -> dict[str, Action]:
    """Return the pairs that half the data would need: in single precision, or of one half of an even field."""
    single = pyfftw.zeros_aligned(length, dtype=np.float32)
    spectrum = pyfftw.zeros_aligned(length // 2 + 1, dtype=np.complex64)
    forward = pyfftw.FFTW(single, spectrum, flags=("FFTW_ESTIMATE",))
    backward = pyfftw.FFTW(
        spectrum, single, direction="FFTW_BACKWARD", flags=("FFTW_ESTIMATE", "FFTW_DESTROY_INPUT")
    )
    half, cosines = pyfftw.zeros_aligned(length // 2 + 1), pyfftw.zeros_aligned(length // 2 + 1)
    cosine = pyfftw.FFTW(half, cosines, direction="FFTW_REDFT00", flags=("FFTW_ESTIMATE",))
    return {
        _OTHER_KINDS[0]: lambda: (forward.execute(), backward.execute()),
        _OTHER_KINDS[1]: lambda: (cosine.execute(), cosine.execute()),
    }


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


def _time_series(case: Case, repeats: int, pairs: dict[str, Action]) -> dict[str, Any]:
    """Time the series and, in turn with it, the transforms of each library."""
    u0, _ = initial_strengths(case)
    ready = prepare(case)
    ready.solve(u0)  # compiles what is not compiled yet
    setups: list[float] = []
    solves: list[float] = []
    pair_times: dict[str, list[float]] = {name: [] for name in pairs}
    for _ in range(repeats):
        forget_tables()
        setup, ready = measure(lambda: prepare(case))
        setups += setup.times
        solves += measure(lambda: ready.solve(u0))[0].times  # noqa: B023
        for name, pair in pairs.items():
            many, _ = measure(lambda: [pair() for _ in range(_PAIRS)])  # noqa: B023
            pair_times[name].append(many.minimum / _PAIRS)
    least = {name: min(times) for name, times in pair_times.items()}
    others = {name: least.pop(name) for name in _OTHER_KINDS}
    length = transform_length(2 * case.particles - 1)
    own = least["FFTW, in place" if shares_memory(length) else "FFTW"]
    fastest = min(least, key=lambda name: least[name])
    floor = ready.operator_applications * least[fastest]
    return {
        "scheme": case.scheme,
        "order": case.order,
        "dt": case.time_step,
        "particles": case.particles,
        "steps": case.steps,
        "transform_length": length,
        "operator_applications": ready.operator_applications,
        "setup_time": min(setups),
        "solve_time": min(solves),
        "solve_time_median": float(np.median(solves)),
        "fastest_pair": fastest,
        "fastest_pair_time": least[fastest],
        "own_pair_time": own,
        "single_pair_time": others[_OTHER_KINDS[0]],
        "cosine_pair_time": others[_OTHER_KINDS[1]],
        "floor_ratio": min(solves) / floor,
        "own_ratio": min(solves) / (ready.operator_applications * own),
    }


def _time_stepping(case: Case) -> dict[str, float]:
    """Time all steps with fast sums, and compare with the series."""
    u0, _ = initial_strengths(case)
    series = prepare(case).solve(u0)
    stepped = prepare(_changed(case, evaluation="stepping"))
    time, u = measure(lambda: stepped.solve(u0))
    return {
        "stepping_time": time.minimum,
        "stepping_applications": stepped.operator_applications,
        "stepping_deviation": float(np.abs(u - series).max() / np.abs(u).max()),
    }


def _time_naive(case: Case, steps: int) -> dict[str, float]:
    """Time so many steps with sums over all pairs of particles, and extrapolate."""

    def naive(case: Case) -> Prepared:
        end = case.t_initial + steps * case.time_step
        return prepare(
            _changed(
                case, summation="naive", evaluation="stepping", t_final=end,
                truncation=None, half_width=case.domain,
            )
        )  # fmt: skip

    small = _changed(case, truncation=100.0 * case.spacing)
    naive(small).solve(initial_strengths(small)[0])  # compiles
    u0, _ = initial_strengths(case)
    ready = naive(case)
    time, _ = measure(lambda: ready.solve(u0))
    return {
        "naive_measured_steps": steps,
        "naive_step_time": time.minimum / steps,
        "naive_time": time.minimum / steps * case.steps,
    }


def _changed(case: Case, **fields: Any) -> Case:
    return Case(**{**case.model_dump(), **fields})


_LABELS = {"scheme": "particle scheme", "order": "kernel order", "dt": "time step"}
# Those of stepping and naive stepping are nan for the schemes left out.
_VARIABLES = {
    "particles": ("number of particles N", "1"),
    "steps": ("number of time steps n", "1"),
    "transform_length": ("length of the real transforms", "1"),
    "operator_applications": ("operator applications of the series", "1"),
    "setup_time": ("set-up, nothing kept from before, minimum", "s"),
    "solve_time": ("solve by the series, minimum", "s"),
    "solve_time_median": ("solve by the series, median", "s"),
    "fastest_pair": ("library of the fastest pair of real transforms", "1"),
    "fastest_pair_time": ("a real transform and its inverse by the fastest library, minimum", "s"),
    "own_pair_time": ("the same pair as planned for the solve, minimum", "s"),
    "single_pair_time": ("the same pair in single precision, minimum", "s"),
    "cosine_pair_time": ("two cosine transforms of half the length, minimum", "s"),
    "floor_ratio": ("solve time over operator applications times the fastest pair", "1"),
    "own_ratio": ("solve time over that of the same transforms as planned for the solve", "1"),
    "peak_memory": ("peak resident memory of a process that runs the case", "byte"),
    "stepping_time": ("all steps, sums by FFT, once", "s"),
    "stepping_applications": ("operator applications of stepping", "1"),
    "stepping_deviation": ("max |u_stepping - u_series| / max |u_stepping|", "1"),
    "naive_measured_steps": ("naive steps that were timed", "1"),
    "naive_step_time": ("one naive step, mean of those timed", "s"),
    "naive_time": ("all naive steps, extrapolated: step time times n", "s"),
    "stepping_over_series": ("stepping time over series time", "1"),
    "naive_over_series": ("extrapolated naive time over series time", "1"),
}
