"""Run time and memory against the number of particles, on lines, squares and cubes of the same spacing.

A run takes a set-up (kernel values, their transforms, for the open exterior its sums) and then as many applications of
the operator as the time series has terms. Each is measured by itself, and the peak memory with it.
"""

import os
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from fracparticles.run.case import Case
from fracparticles.run.solver import Prepared, prepare
from fracparticles.schemes import SCHEMES
from fracstudy.race import clock

_BETA = 0.5
_START, _END = 0.5, 1.5
# The same whatever the size, so that the domain grows with N: a solve then takes the same number of operator
# applications. The same for all dimensions, since no time depends on how well the data are resolved.
_SPACING = 0.2
_TINY = 17  # particles in each direction, the fewest that a case may have: all is loaded and compiled, arrays are small
_SHORT = 1e-6  # span of a run of three applications, which holds all arrays that a longer one holds, on any lattice

_DIMENSIONS = {"line": 1, "square": 2, "cube": 3}
_LABELS = {"kind": "scheme, order and exterior", "dim": "space dimension"}
_VARIABLES = {
    "particles": ("number of particles N", "1"),
    "setup_time": ("set-up, nothing kept from before, minimum", "s"),
    "application_time": ("one application of the operator by FFT, one core, minimum", "s"),
    "applications": ("operator applications of a solve from t = 0.5 to 1.5", "1"),
    "solve_time": ("solve, exact in time, minimum", "s"),
    "naive_time": ("one application by sums over all pairs, one core, minimum", "s"),
    "peak_memory": ("peak resident memory of a process that runs this and the smaller", "byte"),
    "memory_per_particle": (
        "peak memory beyond that of 17 in each direction, per particle",
        "byte",
    ),
    "machine_memory": ("memory of the machine", "byte"),
}


def benchmark(
    lines: Sequence[int],
    squares: Sequence[int],
    cubes: Sequence[int],
    kinds: Mapping[str, Sequence[str]],
    naive_particles: float,
    most_solved: float,
    repeats: int,
    seconds: float,
    memory: bool,
) -> clock.Measurements:
    """Measure set-up, application, solve and peak memory at beta = 0.5 and h = 0.2, from t = 0.5 to 1.5.

    `lines`, `squares` and `cubes` are particles in each direction, odd; `kinds` says what is measured on a "line", a
    "square" and a "cube": scheme, order and exterior, "KPSE-12-open". Sums of truncated lattices are also done over all
    pairs for up to `naive_particles`, whole solves for up to `most_solved`. A timing is repeated `repeats` times, fewer
    if that takes longer than `seconds`. For the `memory` each dimension and kind has a process of its own.
    """
    machine_memory = float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    limits = {"naive_particles": naive_particles, "most_solved": most_solved, "memory": memory}
    often = repeats, seconds
    rows = []
    for (shape, dim), sizes in zip(_DIMENSIONS.items(), (lines, squares, cubes), strict=True):
        for kind in kinds.get(shape, ()):
            task = kind, dim, [_TINY, *sorted(sizes)], limits, often
            measured = (
                clock.in_fresh_process(measure_sizes, *task) if memory else measure_sizes(*task)
            )
            least = measured[0]["peak_memory"]
            for row in measured[1:]:
                row["memory_per_particle"] = (row["peak_memory"] - least) / row["particles"]
                rows.append({"kind": kind, "dim": dim, "machine_memory": machine_memory, **row})
    # Of the processes that measured, not of this one.
    taken = {
        name: np.fmax.reduce([row[name] for row in rows]) for name in clock.conditions() if rows
    }
    facts = {"repeats": repeats, "beta": _BETA, "spacing": _SPACING, **taken}
    title = "Run time and memory against the number of particles"
    return clock.timings_dataset("run", rows, _LABELS, _VARIABLES, title, facts)


def measure_sizes(
    kind: str, dim: int, sizes: Sequence[int], limits: Mapping[str, float], often: tuple[int, float]
) -> list[dict[str, Any]]:
    """Measure one kind on lattices of several sizes, the smallest first: one row a size, see `benchmark`.

    The smallest makes a short run: an open exterior would be too close for the whole one. The peak memory, nan if it
    is not wanted, is that of the process so far.
    """
    clock.one_core()
    clock.forget_peak()
    rows = []
    for number, size in enumerate(sizes):
        case = _case(kind, dim, size, _END if number else _START + _SHORT)
        row: dict[str, Any] = {"particles": case.particles}
        if case.particles <= limits["naive_particles"] and case.exterior == "truncated":
            row["naive_time"] = _naive_time(case, *often)
        row |= _run_times(case, limits["most_solved"], *often)
        row["peak_memory"] = clock.peak_so_far() if limits["memory"] else float("nan")
        rows.append({**row, **clock.conditions()})
    return rows


def _case(kind: str, dim: int, size: int, end: float) -> Case:
    scheme, order, exterior = kind.split("-")
    # A little less, so that the smallest lattice is not refused for round-off.
    lattice = {"half_width": (size // 2) * _SPACING, "spacing": _SPACING * (1.0 - 1e-12)}
    scheme_is = {"scheme": scheme, "order": int(order), "exterior": exterior}
    times = {"t_initial": _START, "t_final": end, "integrator": "exponential"}
    return Case(beta=_BETA, dim=dim, **lattice, **scheme_is, **times)


def _strengths(case: Case) -> np.ndarray:
    """Strengths with the tail of the fundamental solution, which itself takes longer to compute than a run."""
    return (1.0 + np.square(case.radius)) ** (-0.5 * (case.dim + case.alpha))


def _naive_time(case: Case, repeats: int, seconds: float) -> float:
    setting = case.model_copy(update={"summation": "naive"}).setting
    operator = SCHEMES[case.scheme].operator(setting)
    u = _strengths(case).reshape(-1)
    return clock.measure(partial(operator.apply, u), repeats, seconds)[0].minimum


def _run_times(case: Case, most_solved: float, repeats: int, seconds: float) -> dict[str, Any]:
    """Times of set-up, application and solve; afterwards all arrays of a run have been there at once."""
    u = _strengths(case)
    setup, ready = _set_up(case, repeats, seconds)
    assert ready.operator is not None
    apply = partial(ready.operator.combine, u.reshape(-1), np.zeros(u.size), 1.0)
    row = {
        "setup_time": setup.minimum,
        "application_time": clock.measure(apply, repeats, seconds)[0].minimum,
        "applications": ready.operator_applications,
    }
    if case.particles <= most_solved:
        row["solve_time"] = clock.measure(partial(ready.solve, u), repeats, seconds)[0].minimum
    else:
        brief = case.model_copy(update={"t_final": _START + _SHORT})
        prepare(brief, ready.operator).solve(u)
    return row


def _set_up(case: Case, repeats: int, seconds: float) -> tuple[clock.Timing, Prepared]:
    """Prepare a case, each time as if it were the first."""
    clock.forget_tables()
    timing, ready = clock.measure(partial(prepare, case))
    while len(timing.times) < repeats and sum(timing.times) < seconds:
        del ready  # before the next one takes its memory
        clock.forget_tables()
        again, ready = clock.measure(partial(prepare, case))
        timing += again
    return timing, ready
