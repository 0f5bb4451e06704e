"""Lattices that do not suit: of odd numbers of particles, too coarse, too narrow, beside the data."""

from fracstudy.inputs import Inputs, Result
from fracstudy.probe import frame, probes_of
from scenes.extremes.geometry import lattices, sums


def study(
    inputs: Inputs,
    *,
    beta: float,
    sizes: dict[str, list[int]],
    orders: list[int],
    overlaps: list[float],
    half: dict[int, list[int]],
    beyond: list[int],
    points: dict[int, list[int]],
    schemes: dict[int, list[str]],
    half_widths: dict[int, float],
) -> Result:
    """One row a probe; the series are true errors of runs over the estimate that is the worst for its limit.

    `sizes` are those of the sums, by what they are; `half` the intervals on either side, by dimension, of the matrices,
    `beyond` those of the sums beyond the ends; `points` an axis those of `evolve`; `schemes`, by dimension, those whose
    lattices are made unsuitable.
    """
    errors = lattices.Errors()
    of_sums = {
        "sizes": sizes,
        "orders": orders,
        "overlaps": overlaps,
        "half": half,
        "beyond": beyond,
    }
    of_runs = {"schemes": schemes, "half_widths": half_widths, "points": points, "errors": errors}
    probes = probes_of(sums, lattices, beta=beta, **of_sums, **of_runs)
    return Result(frame(probes), (), errors.frame)
