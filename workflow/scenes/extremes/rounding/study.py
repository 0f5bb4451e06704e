"""Rounding: kinds of numbers, sums, the drift of the mass over many steps, and whether the same bits come out."""

from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from fracstudy.probe import frame, probes_of
from scenes.extremes.rounding import bits, drift, numbers


def study(
    inputs: Inputs, *, steps: int, particles: int, threads: list[int], workflow: bool
) -> Result:
    """One row a probe. The mass is followed over so many steps; the sums have so many particles."""
    points = Panels()
    given = {"steps": steps, "particles": particles, "threads": threads, "workflow": workflow}
    table = frame(probes_of(numbers, drift, bits, points=points, **given))
    return Result(table, (), points.frame)
