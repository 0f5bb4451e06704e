"""Rough and extreme data: pulses, noise, strengths at the ends of float64, other units, other kinds of arrays."""

from fracstudy.inputs import Inputs, Result
from fracstudy.probe import frame
from scenes.extremes.rough_data import kinds, linear, principles


def study(
    inputs: Inputs, *, beta: float, schemes: list[str], dims: list[int], half_width: float
) -> Result:
    """One row a probe. `half_width` is that of the lattices on which a point mass spreads."""
    probes = [
        *linear.exact(beta, schemes),
        *linear.sizes(beta, schemes, dims),
        *linear.symmetries(beta, schemes),
        *linear.units(beta, schemes, dims),
        *principles.signs(),
        *principles.bounds(beta, dims),
        *principles.point_masses(beta, half_width),
        *principles.functions(beta, schemes),
        *kinds.probes(beta),
    ]
    return Result(frame(probes))
