"""Very long and very short times: the fundamental solution, runs on lattices and graded particles, evolve."""

from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from fracstudy.probe import frame
from scenes.extremes.long_and_short_times import bounded, functions, runs


def study(
    inputs: Inputs,
    *,
    betas: list[float],
    times: list[float],
    ratios: list[float],
    shares: list[float],
    dims: list[int],
) -> Result:
    """One row a probe.

    Parameters
    ----------
    betas, dims : list
        Fractional orders; dimensions.
    times : list of float
        t of the fundamental solution.
    ratios : list of float
        t_f / t_0 of the long runs.
    shares : list of float
        (t_f - t_0) / t_0 of the short ones.
    """
    probes = [
        *functions.probes(betas, times, dims),
        *runs.long_probes(betas, ratios, dims),
        *runs.short_probes(betas, shares, dims),
        *bounded.probes(betas),
    ]
    panels = Panels()
    runs.add_profiles(panels, betas[-1] if len(betas) == 1 else betas[1], ratios)
    return Result(frame(probes), (), panels.frame)
