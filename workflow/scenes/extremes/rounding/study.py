"""Rounding: kinds of numbers, sums, the drift of the mass over many steps, and whether the same bits come out."""

from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from fracstudy.probe import frame
from scenes.extremes.rounding import bits, drift, numbers


def study(
    inputs: Inputs, *, steps: int, particles: int, threads: list[int], workflow: bool
) -> Result:
    """One row a probe. The mass is followed over so many steps; the sums have so many particles."""
    points = Panels()
    rows = [
        *numbers.probes(particles),
        *drift.probes(steps, points),
        *bits.probes(threads, workflow),
    ]
    return Result(frame(rows), (), points.frame)
