"""Run times of the reference problem of Sec. 4.1: beta = 0.5, C = 160, N = 64001, 20000 RK2 steps.

Four ways to the same discrete solution, p(A dt)^n u0, from the papers' own to ours:

    naive stepping      n steps, sums over all pairs            2 n N^2 pairs; a step, extrapolated
    stepping            n steps, sums by FFT                    2 n transform pairs; some steps, extrapolated
    series              one Chebyshev series of p^n, by FFT     about sqrt(40 T |lambda|) transform pairs
    floor               the transforms of the series alone, by the fastest library at hand

and, of the transform pair that all is made of, what other kinds of it would cost.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from importlib import import_module
from itertools import product
from typing import Any

import numpy as np
import pyfftw
import scipy.fft

from fracparticles.lattice.fourier import complex_length, complex_plans
from fracparticles.run.case import Case
from fracparticles.run.solver import initial_strengths, prepare
from fracstudy.errors import off
from fracstudy.race import clock
from fracstudy.race.contenders.schemes import few_steps

Action = Callable[[], Any]

_SLOW = {"fft": "stepping", "naive": "naive"}  # summation, and what stepping with it is called
_PAIRS = 20  # transform pairs between two looks at the clock
_OWN = "FFTW, two real numbers as a complex one"
# What half the data would need: a pair in single precision, or of one half of an even field.
_SINGLE, _COSINE = "single precision", "cosine transform of an even field"


def benchmark(
    repeats: int,
    truncation: float,
    spacing: float,
    dt: float,
    green_dt: float,
    stepped: Sequence[str],
    timed_steps: Mapping[str, int],
    measured_plans: bool,
) -> clock.Measurements:
    """Time DD, FPSE and KPSE of both orders and GPSE, by steps of `green_dt`, on the reference problem, one core.

    The series are timed `repeats` times after a warm-up. The schemes `stepped`, order II, are also stepped through:
    `timed_steps` says how many steps are timed by summation, "fft" and "naive", and the time of all is extrapolated.
    FFTW may take some seconds to look for its fastest plan if `measured_plans` says so. Times that were not measured
    are nan in the data set.
    """
    clock.one_core()
    common = {"beta": 0.5, "truncation": truncation, "spacing": spacing}
    schemes = product(("DD", "FPSE", "KPSE"), (2, 4))
    cases = [Case(scheme=scheme, order=order, dt=dt, **common) for scheme, order in schemes]
    cases.append(Case(scheme="GPSE", dt=green_dt, **common))
    pairs = transform_pairs(2 * complex_length(cases[0].particles), measured_plans)
    rows = []
    for case in cases:
        row = _time_series(case, repeats, pairs)
        if case.order == 2 and case.scheme in stepped:
            for summation, name in _SLOW.items():
                row |= _time_steps(case, name, summation, timed_steps[summation])
                row[f"{name}_over_series"] = row[f"{name}_time"] / row["solve_time"]
        rows.append(row)
    title = "Run times of the reference problem"
    facts = {"repeats": repeats, "case": cases[0].to_json()}
    return clock.timings_dataset("run", rows, _LABELS, _VARIABLES, title, facts)


def transform_pairs(length: int, measured_plans: bool = True) -> dict[str, Action]:
    """Return one real transform and its inverse, of this length on one core, for each library at hand.

    On zeros, which stay zeros however often they are transformed: the time does not depend on the data.
    """
    estimate, half, zeros = "FFTW_ESTIMATE", length // 2 + 1, np.zeros(length)
    pairs: dict[str, Action] = {
        _OWN: _complex_pair(length // 2),
        "FFTW": _fftw_pair(length, estimate),
        "FFTW, in place": _fftw_pair(length, estimate, in_place=True),
        "scipy.fft": lambda: scipy.fft.irfft(scipy.fft.rfft(zeros), n=length, overwrite_x=True),
        _SINGLE: _fftw_pair(length, estimate, single=True),
    }
    if measured_plans:
        pairs["FFTW, measured"] = _fftw_pair(length, "FFTW_MEASURE")
        pairs["FFTW, measured, in place"] = _fftw_pair(length, "FFTW_MEASURE", in_place=True)
    even, cosines = pyfftw.zeros_aligned(half), pyfftw.zeros_aligned(half)
    cosine = pyfftw.FFTW(even, cosines, direction="FFTW_REDFT00", flags=(estimate,))
    pairs[_COSINE] = lambda: (cosine.execute(), cosine.execute())
    try:
        mkl_fft = import_module("mkl_fft")
    except ImportError:  # not a dependency
        return pairs
    x, spectrum = np.zeros(length), np.zeros(half, dtype=complex)
    pairs["MKL"] = lambda: mkl_fft.irfft(mkl_fft.rfft(x, out=spectrum), n=length, out=x)
    return pairs


def _complex_pair(length: int) -> Action:
    _, forward, backward = complex_plans(pyfftw.zeros_aligned(length, dtype=complex))
    return lambda: (forward.execute(), backward.execute())


def _fftw_pair(length: int, effort: str, in_place: bool = False, single: bool = False) -> Action:
    kinds = (np.float32, np.complex64) if single else (float, complex)
    spectrum = pyfftw.zeros_aligned(length // 2 + 1, dtype=kinds[1])
    real = spectrum.view(kinds[0])[:length]
    if not in_place:
        real = pyfftw.zeros_aligned(length, dtype=kinds[0])
    forward = pyfftw.FFTW(real, spectrum, flags=(effort,))
    destroy = (effort, "FFTW_DESTROY_INPUT")
    backward = pyfftw.FFTW(spectrum, real, direction="FFTW_BACKWARD", flags=destroy)
    real[:] = 0.0  # a measured plan overwrites its arrays
    spectrum[:] = 0.0
    return lambda: (forward.execute(), backward.execute())


def _time_series(case: Case, repeats: int, pairs: dict[str, Action]) -> dict[str, Any]:
    """Time the series and, in turn with it, the transforms of each library."""
    u0, _ = initial_strengths(case)
    prepare(case).solve(u0)  # compiles what is not compiled yet
    setup = solve = clock.Timing(())
    least = dict.fromkeys(pairs, np.inf)
    for _ in range(repeats):
        clock.forget_tables()
        once, ready = clock.measure(partial(prepare, case))
        setup += once
        solve += clock.measure(partial(ready.solve, u0))[0]
        for name, pair in pairs.items():
            many, _ = clock.measure(partial(_repeat, pair))
            least[name] = min(least[name], many.minimum / _PAIRS)
    single, cosine = least.pop(_SINGLE), least.pop(_COSINE)
    fastest = min(least, key=lambda name: least[name])
    return {
        "scheme": case.scheme,
        "order": case.order,
        "dt": case.time_step,
        "particles": case.particles,
        "steps": case.steps,
        "transform_length": 2 * complex_length(case.particles),
        "operator_applications": ready.operator_applications,
        "setup_time": setup.minimum,
        "solve_time": solve.minimum,
        "solve_time_median": solve.median,
        "fastest_pair": fastest,
        "fastest_pair_time": least[fastest],
        "own_pair_time": least[_OWN],
        "single_pair_time": single,
        "cosine_pair_time": cosine,
        "floor_ratio": solve.minimum / (ready.operator_applications * least[fastest]),
        "own_ratio": solve.minimum / (ready.operator_applications * least[_OWN]),
    }


def _repeat(pair: Action) -> None:
    for _ in range(_PAIRS):
        pair()


def _time_steps(case: Case, name: str, summation: str, most: int) -> dict[str, float]:
    """Time so many steps, or all if there are fewer, and extrapolate; compare with the series for as long."""
    steps = min(most, case.steps)
    small = few_steps(_changed(case, truncation=100.0 * case.spacing), 1, summation)
    prepare(small).solve(initial_strengths(small)[0])  # compiles
    few = few_steps(case, steps, summation)
    stepped, (u0, _) = prepare(few), initial_strengths(case)
    time, u = clock.measure(partial(stepped.solve, u0))
    series = prepare(_changed(few, summation="fft", evaluation="series")).solve(u0)
    return {
        f"{name}_measured_steps": steps,
        f"{name}_step_time": time.minimum / steps,
        f"{name}_time": time.minimum / steps * case.steps,
        f"{name}_applications": stepped.operator_applications / steps * case.steps,
        f"{name}_deviation": off(series, u),
    }


def _changed(case: Case, **fields: Any) -> Case:
    return Case(**{**case.model_dump(), **fields})


_LABELS = {"scheme": "particle scheme", "order": "kernel order", "dt": "time step"}
# Those of stepping are nan for the schemes left out.
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
    "stepping_measured_steps": ("steps by FFT that were timed", "1"),
    "stepping_time": ("all steps, sums by FFT, extrapolated: mean of those timed times n", "s"),
    "stepping_applications": ("operator applications of all steps", "1"),
    "stepping_deviation": ("max |u_stepping - u_series| / max |u_stepping| after those timed", "1"),
    "naive_measured_steps": ("naive steps that were timed", "1"),
    "naive_step_time": ("one naive step, mean of those timed", "s"),
    "naive_time": ("all naive steps, extrapolated: step time times n", "s"),
    "stepping_over_series": ("stepping time over series time", "1"),
    "naive_over_series": ("extrapolated naive time over series time", "1"),
}
