"""Several output times of one run: the forms in which they are given, and the runs that compute them.

The steps of a run end at each output time. From one to the next they are equal, at most dt, and one Chebyshev series,
or one march, serves all. Where a step is part of the scheme (GPSE, whose kernel is that of its step) or the run is a
single pair of transforms, each output is a run of its own from t_initial on; outputs with equal steps share a run. A
`case` here is a `Case`; the type is not imported, since `Case` is made with these functions.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from math import ceil
from typing import Any

import numpy as np

from fracparticles.arguments import plain
from fracparticles.errors import InvalidInput

__all__ = ["Outputs", "legs", "parts", "steps_in", "with_times"]

_STEP_SLACK = 1e-9  # a time span of n (1 + 1e-9) steps still takes n steps
_SAME = 1e-9  # relative difference up to which two steps count as equal
_ALLOWED = "numbers in ascending order, those of the output times"


@dataclass(frozen=True)
class Outputs:
    """The results of a run with several output times.

    Attributes
    ----------
    times : tuple of float
        The m output times; the last is t_final.
    u : array, shape (m, N, .., N)
        The strengths at each time; for DVM the field.
    mass : array, shape (m,)
        The total at each time.
    """

    times: tuple[float, ...]
    u: np.ndarray
    mass: np.ndarray


def with_times(fields: dict[str, Any]) -> dict[str, Any]:
    """Return the fields of a case with `times` as a tuple, and the last of them as t_final.

    Raises
    ------
    InvalidInput
        If they are not ascending numbers, or if t_final is given and is not the last of them.
    """
    given = fields.get("times")
    if given is None:
        return fields
    listed = np.asarray(given).tolist() if hasattr(given, "dtype") else given
    if isinstance(listed, str) or not isinstance(listed, Iterable):
        raise InvalidInput("times", given, _ALLOWED, "Give a list of them.")
    each = [plain(one) for one in listed]
    if not each or any(isinstance(one, bool) or not isinstance(one, int | float) for one in each):
        raise InvalidInput("times", given, _ALLOWED, "Give a list of them.")
    times = tuple(float(one) for one in each)
    if any(not late > early for early, late in pairwise(times)):
        raise InvalidInput("times", times, _ALLOWED, "Sort them; each once.")
    if fields.get("t_final") not in (None, times[-1]):
        last = f"nothing or {times[-1]:g} with these times: the run ends at the last of them"
        raise InvalidInput("t_final", fields["t_final"], last, "Leave it out, or add it to times.")
    return {**fields, "times": times, "t_final": times[-1]}


def steps_in(span: float, dt: float) -> int:
    """Return the number of equal steps of at most dt in a span."""
    return max(1, ceil(span / dt * (1 - _STEP_SLACK)))


def legs(case: Any) -> list[tuple[float, int]]:
    """Return the step from each output time to the next, and the number of these steps.

    A scheme whose step is part of it has one step for all times; the times are then multiples of it, see `parts`.
    """
    if case.times is None:
        return [(case.time_step, case.steps)]
    if case.kind.self_timed:
        dt = case.time_step
        counts = [round((time - case.t_initial) / dt) for time in case.times]
        return [(dt, int(n)) for n in np.diff([0, *counts])]
    spans = np.diff([case.t_initial, *case.times]).tolist()
    counts = [steps_in(span, case.resolved_dt) for span in spans]
    return [(span / n, n) for span, n in zip(spans, counts, strict=True)]


def parts(case: Any) -> list[Any]:
    """Return the runs, all on the same lattice, that compute the output times of a run; itself if one run is enough.

    Raises
    ------
    InvalidInput
        If one of them is not allowed, because its step is too short for the spacing.
    """
    if case.times is None or not (case.kind.self_timed or case.evaluation == "convolution"):
        return [case]
    each = [case.until(time) for time in case.times]
    if case.evaluation == "convolution" or case.is_graded:
        return each
    groups: list[list[Any]] = []
    for one in each:
        for group in groups:
            if abs(one.time_step - group[0].time_step) <= _SAME * one.time_step:
                group.append(one)
                break
        else:
            groups.append([one])
    if len(groups) == 1:
        return [case]
    return [
        group[0] if len(group) == 1 else case.until(*(one.t_final for one in group))
        for group in groups
    ]
