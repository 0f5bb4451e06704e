"""Rough and extreme data: pulses, noise, strengths at the ends of float64, other units, other kinds of arrays."""

from fracstudy.inputs import Inputs, Result
from fracstudy.probe import frame, probes_of
from scenes.extremes.rough_data import kinds, linear, principles


def study(
    inputs: Inputs, *, beta: float, schemes: list[str], dims: list[int], half_width: float
) -> Result:
    """One row a probe. `half_width` is that of the lattices on which a point mass spreads."""
    given = {"beta": beta, "schemes": schemes, "dims": dims, "half_width": half_width}
    return Result(frame(probes_of(linear, principles, kinds, **given)))
