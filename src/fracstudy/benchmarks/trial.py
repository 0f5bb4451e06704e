"""One contender with one choice of its parameters: how it is set up, solved, judged and timed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from fracparticles.errors import FracparticlesError
from fracstudy.benchmarks.clock import Timing, forget_tables, measure
from fracstudy.benchmarks.problem import Problem

__all__ = ["LABELS", "VARIABLES", "Ready", "Trial", "run_trials"]

_NOT_YET = Timing(())
_SLACK = 2.0  # a trial is timed again if no other one of its variant is so much faster and as good
_LONG = 0.25  # seconds; what takes longer is timed once


@dataclass(frozen=True)
class Ready:
    """A contender made ready for one grid: all that does not depend on the initial data is done.

    Attributes
    ----------
    radius : array
        |x| of its points.
    volumes : array or float
        What each of them stands for.
    solve : callable
        From the initial data to the solution at the final time.
    applications : int
        How often a solve applies the operator, or evaluates its velocity.
    scale : float
        The time of a run over that of `solve`: more than 1 where only some of the time steps are taken.
    draw : callable, optional
        The initial data of a contender that does not start from the fundamental solution at its points.
    judge : callable, optional
        The error of what `solve` returns, where that is not the solution at the points at the final time.
    """

    radius: np.ndarray
    volumes: np.ndarray | float
    solve: Callable[[Any], Any]
    applications: int = 1
    scale: float = 1.0
    draw: Callable[[], Any] | None = None
    judge: Callable[[Any], float] | None = None

    def start(self, problem: Problem) -> Any:
        """Return the initial data."""
        return problem.initial(self.radius) if self.draw is None else self.draw()

    def error(self, problem: Problem, u: Any) -> float:
        """Return the relative error of what `solve` returned."""
        if self.judge is not None:
            return self.judge(u)
        return problem.error(self.radius, self.volumes, u)


@dataclass(frozen=True)
class Trial:
    """One contender with one choice of its parameters.

    Attributes
    ----------
    contender : str
        A scheme, or a method of the literature.
    variant : str
        Which of the contender's: order, exterior, time integration.
    group : {"ours", "papers", "peers", "limit"}
    prepare : callable
        The set-up.
    points : float
        About how many.
    spacing, truncation, dt : float
        nan where there is none.
    """

    contender: str
    variant: str
    group: str
    prepare: Callable[[], Ready] = field(repr=False)
    points: float
    spacing: float = float("nan")
    truncation: float = float("nan")
    dt: float = float("nan")


LABELS = {
    "contender": "scheme, or method of the literature",
    "variant": "order of the kernels, exterior, time integration",
    "group": "ours, the papers' way, peers of the literature, or the limit",
    "beta": "fractional order beta = alpha - 1",
}
VARIABLES = {
    "spacing": ("spacing of the points h", "1"),
    "truncation": ("truncation factor C", "1"),
    "dt": ("time step", "1"),
    "particles": ("number of points, or of walkers", "1"),
    "applications": ("operator applications of a solve", "1"),
    "error": ("relative error, Eq. (48) or (59)", "1"),
    "setup_time": ("set-up, nothing kept from before, minimum", "s"),
    "setup_time_median": ("set-up, median", "s"),
    "solve_time": ("solve, minimum", "s"),
    "solve_time_median": ("solve, median", "s"),
    "setups": ("set-ups that were timed", "1"),
    "solves": ("solves that were timed", "1"),
    "extrapolated": ("run time over the time that was measured: 1 for a whole run", "1"),
    "failure": ("what went wrong; empty if nothing did", "1"),
}


@dataclass
class _Record:
    trial: Trial
    row: dict[str, Any]
    setups: Timing = _NOT_YET
    solves: Timing = _NOT_YET
    u0: Any = None

    @property
    def times(self) -> tuple[float, float]:
        """The least times of a solve and of set-up and solve."""
        solve = self.solves.minimum * self.row["extrapolated"]
        return solve, solve + self.setups.minimum

    def finished(self) -> dict[str, Any]:
        row = dict(self.row)
        scale = row.get("extrapolated", 1.0)
        for name, timing, factor in (("setup", self.setups, 1.0), ("solve", self.solves, scale)):
            if timing.times:
                row |= timing.columns(name, factor)
        return row


def run_trials(
    problem: Problem, trials: Sequence[Trial], rounds: int, repeats: int, seconds: float
) -> list[dict[str, Any]]:
    """Run every trial once, then time those that matter in `rounds` rounds, each with its set-up; one row a trial.

    A trial matters if it is on the front of its variant in error and time, or within a factor of 2 of it, and does not
    take a quarter of a second. The rounds go through all of them, so that each is measured at several moments.

    Parameters
    ----------
    problem : Problem
    trials : sequence of Trial
    rounds : int
        Set-ups a trial.
    repeats, seconds : int, float
        Solves a set-up, fewer if they take longer than that.
    """
    warm = {(trial.contender, trial.variant): trial for trial in reversed(trials)}
    for trial in warm.values():  # each variant does once what a process does once
        _first(problem, trial)
    records = [_first(problem, trial) for trial in trials]
    worth = [record for record in _near_front(records) if record.times[1] < _LONG]
    for _ in range(rounds):
        for record in worth:
            forget_tables()
            setup, ready = measure(record.trial.prepare)
            solve, _ = measure(partial(ready.solve, record.u0), repeats, seconds)
            record.setups += setup
            record.solves += solve
    return [record.finished() for record in records]


def _first(problem: Problem, trial: Trial) -> _Record:
    """The error, and the times of a first set-up and of a second solve."""
    said = ("contender", "variant", "group", "spacing", "truncation", "dt")
    row = {name: getattr(trial, name) for name in said}
    record = _Record(trial, {**row, "beta": problem.beta, "failure": ""})
    try:
        forget_tables()
        setup, ready = measure(trial.prepare)
        u0 = ready.start(problem)
        solve, u = measure(partial(ready.solve, u0))
        if solve.minimum < _LONG:  # the first was the warm-up
            solve, u = measure(partial(ready.solve, u0))
        error = ready.error(problem, u)
    except FracparticlesError as failure:
        record.row["failure"] = str(failure).splitlines()[0]
        return record
    record.row |= {
        "particles": np.size(ready.radius),
        "applications": ready.applications,
        "extrapolated": ready.scale,
        "error": error,
    }
    record.setups, record.solves, record.u0 = setup, solve, u0
    return record


def _near_front(records: Iterable[_Record]) -> list[_Record]:
    variants: dict[tuple[str, str], list[_Record]] = {}
    for record in records:
        if np.isfinite(record.row.get("error", np.nan)):
            key = (record.trial.contender, record.trial.variant)
            variants.setdefault(key, []).append(record)
    return [
        record
        for variant in variants.values()
        for record in variant
        if not all(_beaten(record, variant, which) for which in (0, 1))
    ]


def _beaten(record: _Record, others: Iterable[_Record], which: int) -> bool:
    return any(
        other.row["error"] <= record.row["error"]
        and _SLACK * other.times[which] < record.times[which]
        for other in others
    )
