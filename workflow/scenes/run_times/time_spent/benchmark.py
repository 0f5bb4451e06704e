"""Where the time of a run goes: the parts of the set-up, the sums over the particles, and the rest."""

import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from functools import partial, wraps
from typing import Any
from unittest.mock import patch

import numpy as np

from fracparticles.kernels.families import kernel
from fracparticles.lattice.exterior import far_field
from fracparticles.lattice.exterior_box import box_far_field
from fracparticles.run.case import Case
from fracparticles.run.solver import Prepared, initial_strengths, prepare
from fracparticles.schemes.spectrum import spectral_interval
from fracparticles.time import exponential_flow, power_flow
from fracstudy.race.clock import (
    Measurements,
    Timing,
    forget_tables,
    measure,
    one_core,
    timings_dataset,
)

# The parts of a set-up and the functions that do them; a part within a part counts for itself.
_FUNCTIONS: dict[str, tuple[Callable[..., Any], ...]] = {
    "kernel values": (kernel,),
    "far field": (far_field, box_far_field),
    "range of the symbol": (spectral_interval,),
    "time series": (exponential_flow, power_flow),
}
_OTHER = "plans and the rest"
_SOLVES = 5  # solves for every set-up
_LABELS = {"run": "what is run"}
_VARIABLES = {
    "particles": ("number of particles", "1"),
    "applications": ("operator applications of a solve", "1"),
    "setup_time": ("set-up, nothing kept from before, minimum", "s"),
    **{name: (f"of the set-up: {name}", "s") for name in (*_FUNCTIONS, _OTHER)},
    "solve_time": ("solve, minimum", "s"),
    "lattice sums": ("of the solve: the sums over the particles, one of them times their number", "s"),
    "rest of the solve": ("of the solve: all else", "s"),
}  # fmt: skip


def benchmark(cases: Mapping[str, Mapping[str, Any]], repeats: int) -> Measurements:
    """Take the time of runs apart, of the cases by a name for each; the least of `repeats` is kept."""
    one_core()
    rows = [_row(name, Case(**fields), repeats) for name, fields in cases.items()]
    title = "Where the time of a run goes"
    return timings_dataset("case", rows, _LABELS, _VARIABLES, title, {"repeats": repeats})


def _row(name: str, case: Case, repeats: int) -> dict[str, Any]:
    u0, _ = initial_strengths(case)
    prepare(case).solve(u0)  # compiles what is not compiled yet
    best: dict[str, Any] = {"setup_time": np.inf}
    solve = one_sum = Timing(())
    for _ in range(repeats):
        forget_tables()
        setup, parts, ready = _watched_setup(case)
        if setup < best["setup_time"]:
            best = {"setup_time": setup, **parts, _OTHER: setup - sum(parts.values())}
        operator: Any = ready.operator
        # In turn, so that a clock that slows down meanwhile slows both.
        for _ in range(_SOLVES):
            solve += measure(partial(ready.solve, u0))[0]
            # The solve by one pair of transforms is one sum, and nothing beside it.
            if operator is not None:
                one_sum += measure(partial(operator.convolve, u0))[0]
    one = one_sum if one_sum.times else solve
    sums = one.minimum * ready.operator_applications
    return {
        "run": name,
        "particles": case.particles,
        "applications": ready.operator_applications,
        **best,
        "solve_time": solve.minimum,
        "lattice sums": sums,
        "rest of the solve": solve.minimum - sums,
    }


def _watched_setup(case: Case) -> tuple[float, dict[str, float], Prepared]:
    """The time of a set-up, that of its parts without the parts within them, and the case made ready."""
    spent = dict.fromkeys(_FUNCTIONS, 0.0)
    within: list[float] = []  # of each part that is under way, the time of the parts within it

    def watched(part: str, function: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(function)
        def call(*arguments: Any, **options: Any) -> Any:
            within.append(0.0)
            start = time.perf_counter()
            try:
                return function(*arguments, **options)
            finally:
                whole = time.perf_counter() - start
                spent[part] += whole - within.pop()
                if within:
                    within[-1] += whole

        return call

    with ExitStack() as stack:
        for part, functions in _FUNCTIONS.items():
            for function in functions:
                stack.enter_context(_replaced(function, watched(part, function)))
        timing, ready = measure(partial(prepare, case))
    return timing.minimum, spent, ready


@contextmanager
def _replaced(function: Callable[..., Any], by: Callable[..., Any]) -> Iterator[None]:
    """Replace a function of the library wherever one of its modules looks it up."""
    modules = [module for name, module in sys.modules.items() if name.startswith("fracparticles.")]
    with ExitStack() as stack:
        for module in modules:
            for name, value in vars(module).items():
                if value is function:
                    stack.enter_context(patch.object(module, name, by))
        yield
