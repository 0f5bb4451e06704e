"""Run a case on arrays: `compute` runs it from its data; see `prepared` for many data, `advection` for DVM."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np

from fracparticles import arguments as check
from fracparticles.data.interpolated import Measured
from fracparticles.moving.lagrangian import Observer
from fracparticles.run.advection import advect, advect_to_outputs
from fracparticles.run.case import Case, a_case
from fracparticles.run.doubts import warn_if_doubtful
from fracparticles.run.initial import Initial, initial_strengths, resolved
from fracparticles.run.prepared import Prepared, in_range, matrix_of, prepare
from fracparticles.run.reliability import estimates
from fracparticles.run.solution import Solution
from fracparticles.run.times import Outputs

__all__ = [
    "Prepared",
    "Progress",
    "advect",
    "compute",
    "initial_strengths",
    "matrix_of",
    "prepare",
]

Progress = Callable[[float], None]
"""Called with the share of a run that is done."""


def compute(
    case: Case, initial: Initial | None = None, progress: Progress | None = None
) -> Solution:
    """Run a case and return its arrays. This is `solve` without the data set, with the same errors and warnings."""
    a_case(case)
    if progress is not None:
        check.function("progress", progress)
    source = resolved(case, initial)
    u0, origin = initial_strengths(case, source)
    particles = outputs = None
    if case.kind.moving:
        every = advect_to_outputs(case, u0, progress and _by_time(case, progress))
        particles, applications = every[-1], every[-1].history.velocity_evaluations
        u = particles.field(case.x)
        if case.times is not None:
            fields = np.array([one.field(case.x) for one in every[:-1]] + [u])
            totals = np.array([float(one.strength.sum()) for one in every])
            outputs = Outputs(case.times, fields, totals)
    else:
        ready = prepare(case)
        if progress is not None and ready.operator is not None:
            ready.operator.watch = _by_applications(ready.operator_applications, progress)
        u, applications = in_range(ready.run, u0)
        if case.times is not None:
            outputs = Outputs(case.times, u, np.array([case.integral(one) for one in u]))
            u = u[-1]
    found = estimates(case, u0, u, source, None if outputs is None else outputs.u)
    if isinstance(source, Measured):
        found |= source.estimates
    warn_if_doubtful(case, u0, u, found)
    return Solution(case, case.x, u0, u, applications, origin, particles, found, outputs)


def _by_time(case: Case, progress: Progress) -> Observer:
    """Return an observer of moving particles, which reports the share of the time that has passed."""
    return lambda time, *_: progress((time - case.t_initial) / case.span)


def _by_applications(expected: int, progress: Progress) -> Callable[[], None]:
    """Return a function to call after each application, which reports the share of those expected."""
    count = itertools.count(1)
    return lambda: progress(min(1.0, next(count) / expected))
