"""Sums over scattered particles: the times of both ways as people read them."""

from fracstudy.inputs import Inputs, Result
from scenes.run_times.contests import columns

_COLUMNS = {
    "N": "particles",
    "non-uniform FFT / ms": "transform_time",
    "ns a particle": "particle_time",
    "naive / ms": "naive_time",
    "naive / FFT": "ratio",
    "deviation": "deviation",
}


def study(inputs: Inputs) -> Result:
    """List the times of field and flux of scattered particles by both ways, and their difference."""
    sums = inputs.benchmarks["scattered_sums"]
    fast = sums["transform_time"]
    made = sums.assign(particle_time=fast / sums["particles"], ratio=sums["naive_time"] / fast)
    return Result(columns(made, _COLUMNS))
