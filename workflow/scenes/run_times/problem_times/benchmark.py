"""Error against run time for the problems that one Fourier transform cannot do: ours and peers, one core."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial

from fracstudy.errors import quiet
from fracstudy.race.clock import Measurements, measure_warm, one_core, timings_dataset
from scenes.run_times.problem_times.contest import Contest
from scenes.run_times.problem_times.interval import eigenvalue, leaving
from scenes.run_times.problem_times.line import drawn_back, variable_diffusivity
from scenes.run_times.problem_times.plane import carried_round
from scenes.run_times.problem_times.two_blobs import competing, drawn_together, two_widths

CONTESTS: dict[str, Callable[[float], Contest]] = {
    "variable diffusivity": variable_diffusivity,
    "Ornstein-Uhlenbeck": drawn_back,
    "eigenvalue": eigenvalue,
    "Getoor": leaving,
    "carried round": carried_round,
}
for _narrow in (0.01, 0.0001):
    CONTESTS |= {
        f"widths {_narrow} and 1": partial(two_widths, narrow=_narrow),
        f"drawn together, {_narrow}": partial(drawn_together, narrow=_narrow),
        f"competing, {_narrow}": partial(competing, narrow=_narrow),
    }


def benchmark(
    alpha: float,
    contests: Mapping[str, Mapping[str, Sequence[Sequence[float]]]],
    repeats: int,
    seconds: float,
    most: int | None = None,
) -> Measurements:
    """Measure every trial, set-up and solve together, after one that warms up what is short; the least time is kept.

    `contests` has, by contest and contender, the grids: the arguments of its `solve`; only the first `most` of them if
    given. A trial has `repeats` timings, fewer if they take longer than `seconds`. With a single one, which has no say
    in a time, what compiles before is left out, too.
    """
    one_core()
    rows = []
    with quiet():  # coarse trials are to be seen
        for name, entries in contests.items():
            contest = CONTESTS[name](alpha)
            for who, grids in entries.items():
                group, solve = contest.contenders[who]
                if repeats > 1:
                    solve(*grids[0])  # compiles
                for grid in grids[:most]:
                    time, (size, answer) = measure_warm(partial(solve, *grid), repeats, seconds)
                    found = {"size": size, "error": contest.error(answer), "time": time.minimum}
                    rows.append({"problem": name, "contender": who, "group": group, **found})
    title = "Error against run time for problems beyond one Fourier transform"
    facts = {"repeats": repeats, "alpha": alpha}
    return timings_dataset("trial", rows, _LABELS, _VARIABLES, title, facts)


_LABELS = {"problem": "problem", "contender": "method", "group": "ours or a peer"}
_VARIABLES = {
    "size": ("number of unknowns", "1"),
    "error": ("error against the exact solution, relative to its greatest value or its mass", "1"),
    "time": ("one run, set-up and solve, minimum", "s"),
}
