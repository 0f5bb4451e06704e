"""Stiff problems, T |lambda| up to 1e10: what each way of the time integration does, and whether it is right."""

from fracstudy.inputs import Inputs, Result
from fracstudy.probe import frame, probes_of
from scenes.extremes.stiffness import ends, ways


def study(
    inputs: Inputs, *, schemes: list[str], half: int, stiffness: list[float], most: float
) -> Result:
    """One row a probe, of `schemes` on 2 `half` + 1 particles, for each T |lambda| of `stiffness`.

    Ways that need more than `most` applications of the operator are counted, not run. For the figure, applications and
    error of each way.
    """
    found, series = ways.probes(schemes, half, stiffness, most)
    probes = [*found, *probes_of(ends, schemes=schemes, half=half, stiffness=stiffness)]
    return Result(frame(probes), (), series)
