"""Error against run time for the problems that one Fourier transform cannot do: ours and peers, one core."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

from fracstudy.errors import quiet
from fracstudy.race.clock import measure_warm, one_core, timings_dataset
from scenes.run_times.problem_times.contest import Contest
from scenes.run_times.problem_times.interval import eigenvalue, leaving
from scenes.run_times.problem_times.line import drawn_back, variable_diffusivity
from scenes.run_times.problem_times.plane import carried_round
from scenes.run_times.problem_times.two_blobs import competing, drawn_together
from scenes.run_times.problem_times.two_widths import two_widths

if TYPE_CHECKING:
    import xarray as xr

CONTESTS: dict[str, Callable[[float], Contest]] = {
    "variable diffusivity": variable_diffusivity,
    "Ornstein-Uhlenbeck": drawn_back,
    "eigenvalue": eigenvalue,
    "Getoor": leaving,
    "widths 0.01 and 1": partial(two_widths, narrow=1e-2),
    "widths 0.0001 and 1": partial(two_widths, narrow=1e-4),
    "drawn together, 0.01": partial(drawn_together, narrow=1e-2),
    "drawn together, 0.0001": partial(drawn_together, narrow=1e-4),
    "competing, 0.01": partial(competing, narrow=1e-2),
    "competing, 0.0001": partial(competing, narrow=1e-4),
    "carried round": carried_round,
}


def benchmark(
    alpha: float,
    contests: Mapping[str, Mapping[str, Sequence[Sequence[float]]]],
    repeats: int,
    seconds: float,
    most: int | None = None,
) -> xr.Dataset:
    """Measure every trial, set-up and solve together, after one that warms up what is short.

    With a single repeat, which has no say in a time, what compiles before is left out, too.

    Parameters
    ----------
    alpha : float
        Fractional order, 1 < alpha < 2.
    contests : mapping
        Contest -> contender -> grids, the arguments of its `solve`.
    repeats, seconds : int, float
        At most so many timings of a trial, and no more than take so long; the least is kept.
    most : int, optional
        Only the first grids of each contender.

    Returns
    -------
    xarray.Dataset
        Dimension `trial`.
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
