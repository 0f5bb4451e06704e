"""Contenders tried on a problem: the error of each trial is found once, and trials that matter are timed repeatedly."""

from __future__ import annotations

import tracemalloc
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import compress, islice
from typing import Any

import numpy as np

from fracparticles.errors import FracparticlesError
from fracstudy.errors import quiet
from fracstudy.race.clock import LONG, Timing, forget_tables, measure, measure_warm
from fracstudy.race.contender import Contender, Ready, Trials
from fracstudy.race.problem import Problem

__all__ = ["BLOCK", "LABELS", "VARIABLES", "run_trials"]

BLOCK = 1000
"""Data that are solved at once, if many solves are timed."""
_NOT_YET = Timing(())
# A trial is timed again only if no trial that is as good is faster by these factors: of its own contender, and of all
# contenders. Noise cannot put one ahead that is slower.
_SLACK = 1.5
_FAR = 8.0
# The same factor for the trials that a follower tries: their first times decide, and may have met a slow moment.
_FOLLOWED = 3.0
# Trials within these factors, of the front of their contender and of the front of all, are timed in so many times as
# many rounds: a machine has slow moments.
_LEAD, _BEHIND, _MOMENTS = 1.2, 3.0, 20
_FEW, _SPENT = 3, 0.015  # after so many times, and so many seconds, a trial is not timed again
_MATRIX = 600  # points up to which the whole run may be one matrix
_MOST = 2**17  # numbers in a block

LABELS = {
    "problem": "initial data",
    "contender": "scheme, or method of the literature",
    "variant": "order, exterior, evaluation",
    "group": "ours, schemes of the papers, the papers' way of running them, or peers of the literature",
    "beta": "fractional order beta = alpha - 1",
}
VARIABLES = {
    "parameters": ("what else was chosen", "1"),
    "points": ("number of unknowns", "1"),
    "error": ("relative error, Eq. (48) or (59)", "1"),
    "tail_error": ("greatest relative error between one and two error radii", "1"),
    "setup_time": ("set-up, nothing kept from before, minimum", "s"),
    "setup_time_median": ("set-up, median", "s"),
    "solve_time": ("solve, minimum", "s"),
    "solve_time_median": ("solve, median", "s"),
    "setups": ("set-ups that were timed", "1"),
    "solves": ("solves that were timed", "1"),
    "block_time": ("a further solve in a block of many, minimum", "s"),
    "peak_memory": ("greatest memory of set-up and solve; nan off the front of all", "B"),
    "extrapolated": ("run time over the time that was measured: 1 for a whole run", "1"),
    "failure": ("what went wrong; empty if nothing did", "1"),
}


@dataclass
class _Record:
    contender: Contender
    given: dict[str, Any]
    row: dict[str, Any]
    setups: Timing = _NOT_YET
    solves: Timing = _NOT_YET
    ready: Ready | None = None
    u0: Any = None

    @property
    def times(self) -> tuple[float, float]:
        """The least times of a solve, and of set-up and solve."""
        solve = self.solves.minimum * self.row["extrapolated"]
        return solve, solve + self.setups.minimum

    def finished(self) -> dict[str, Any]:
        row = dict(self.row)
        for name, timing, factor in (
            ("setup", self.setups, 1.0),
            ("solve", self.solves, row.get("extrapolated", 1.0)),
        ):
            if timing.times:
                row |= timing.columns(name, factor)
        return row


def run_trials(
    problem: Problem,
    contenders: Iterable[Contender],
    rounds: int,
    repeats: int,
    seconds: float,
    most: int | None = None,
) -> list[dict[str, Any]]:
    """Run every trial once, then time the set-ups and solves of those that matter in `rounds` rounds; one row a trial.

    A trial matters if it is within a factor of 1.5 of the front of its contender in error and time, is within a factor
    of 8 of the front of all, and takes less than a quarter of a second. Each round goes through all of them, so that
    each is measured at several moments. The best of each contender are timed in up to twenty times as many rounds, in
    fewer if they take longer. The memory is measured for the trials on the front of all.

    Parameters
    ----------
    problem : Problem
    contenders : iterable of Contender
    rounds : int
    repeats, seconds : int, float
        Set-ups and solves in a round, and the seconds after which there are fewer.
    most : int, optional
        The number of trials of each contender; left out, all are run.
    """
    records: list[_Record] = []
    for contender in contenders:
        if contender.takes(problem):
            followed = [one for one in _judged(records) if one.contender.name == contender.follows]
            trials = _again(followed) if followed else contender.trials(problem)
            records += islice(_tried(problem, contender, trials), most)
    judged = _judged(records)
    worth = [record for record in _near_own(judged, _SLACK) if record.times[1] < LONG]
    again = list(compress(worth, _near(worth, judged, 1, _FAR)))
    for k in range(_MOMENTS * rounds):
        if k == rounds:
            leading = _near_own(again, _LEAD)
            again = list(compress(leading, _near(leading, judged, 1, _BEHIND)))
        for record in again:
            if k >= _FEW and k * repeats * record.times[1] > _SPENT:
                continue
            prepare = partial(record.contender.prepare, problem, **record.given)
            setup, ready = measure(prepare, repeats, seconds, before=forget_tables)
            solve, _ = measure(partial(ready.solve, record.u0), repeats, seconds)
            record.setups += setup
            record.solves += solve
    for record in _near_own(worth, slack=1.0):
        record.row["block_time"] = _block_time(record)
    for record in compress(again, _near(again, judged, 1, slack=1.0)):
        record.row["peak_memory"] = _peak_memory(problem, record)
    return [record.finished() for record in records]


def _judged(records: Iterable[_Record]) -> list[_Record]:
    return [record for record in records if np.isfinite(record.row.get("error", np.nan))]


def _again(records: Iterable[_Record]) -> Trials:
    """Yield the keywords of the trials near the front of one contender."""
    for record in _near_own(records, _FOLLOWED):
        yield record.given


def _tried(problem: Problem, contender: Contender, trials: Trials) -> Iterator[_Record]:
    """Run the trials of a contender, and send it the error of each."""
    given = next(trials)
    _first(problem, contender, given)  # it takes the costs that a process has only once
    with suppress(StopIteration):
        while True:
            record = _first(problem, contender, given)
            yield record
            given = trials.send(record.row.get("error", float("nan")))


def _first(problem: Problem, contender: Contender, given: dict[str, Any]) -> _Record:
    """Return a trial with its errors, and the times of a first set-up and of a second solve."""
    parameters = {name: value for name, value in given.items() if name != "variant"}
    row = {
        "problem": problem.name,
        "beta": problem.beta,
        "contender": contender.name,
        "variant": given["variant"],
        "group": contender.group,
        "parameters": ", ".join(f"{k} {v:.6g}" if isinstance(v, float) else f"{k} {v}" for k, v in parameters.items()),
        "failure": "",
    }  # fmt: skip
    record = _Record(contender, given, row)
    try:
        with quiet():
            prepare = partial(contender.prepare, problem, **given)
            setup, ready = measure(prepare, before=forget_tables)
            u0 = problem.kept("initial", ready.x)
            solve, u = measure_warm(partial(ready.solve, u0))
            u = u if ready.result is None else ready.result(u0)
    except FracparticlesError as failure:
        row["failure"] = str(failure).splitlines()[0]
        return record
    row |= {
        "points": ready.points,
        "extrapolated": ready.scale,
        "error": problem.error(ready.x, ready.volumes, u),
        "tail_error": problem.tail_error(ready.x, u),
    }
    record.setups, record.solves = setup, solve
    record.ready, record.u0 = ready, u0
    return record


def _block_time(record: _Record) -> float:
    """The time of one of many solves: of a block by the contender, or by a product with the matrix of the run."""
    ready, u0 = record.ready, record.u0
    assert ready is not None
    if not ready.linear or ready.scale != 1.0:
        return float("nan")
    count = min(BLOCK, max(1, _MOST // ready.points))
    block = np.broadcast_to(u0, (count, *u0.shape)).copy()
    times = []
    if ready.batched:
        times.append(measure(partial(ready.solve, block))[0].minimum)
    if ready.points <= _MATRIX:
        times.append(_matrix_time(count, ready.points))
    return min(times, default=record.solves.minimum * count) / count


@lru_cache(maxsize=_MATRIX)
def _matrix_time(count: int, points: int) -> float:
    """The time of the product of a block and a matrix, measured once, since it is the same for all methods."""
    block, matrix = np.zeros((count, points)), np.zeros((points, points))
    return measure_warm(partial(np.dot, block, matrix), 5)[0].minimum


def _peak_memory(problem: Problem, record: _Record) -> float:
    """The peak memory that numpy allocates, in bytes."""
    forget_tables()
    tracemalloc.start()
    try:
        record.contender.prepare(problem, **record.given).solve(record.u0)
        return float(tracemalloc.get_traced_memory()[1])
    finally:
        tracemalloc.stop()


def _near_own(records: Iterable[_Record], slack: float) -> list[_Record]:
    """The records near the front of their contender, in the time of a solve or in that of set-up and solve."""
    by_contender: dict[str, list[_Record]] = {}
    for record in records:
        by_contender.setdefault(record.contender.name, []).append(record)
    return [
        record
        for own in by_contender.values()
        for record in compress(own, _near(own, own, 0, slack) | _near(own, own, 1, slack))
    ]


def _near(
    records: Sequence[_Record], others: Sequence[_Record], which: int, slack: float
) -> np.ndarray:
    """For each record, whether none of the others with an error as small is faster by more than `slack`.

    The records are among the others. `which` is 0 for the time of a solve, and 1 for that of set-up and solve.
    """
    errors = np.array([other.row["error"] for other in others])
    order = np.argsort(errors)
    least = np.minimum.accumulate(np.array([other.times[which] for other in others])[order])
    as_good = np.searchsorted(errors[order], [record.row["error"] for record in records], "right")
    return np.array([record.times[which] for record in records]) <= slack * least[as_good - 1]
