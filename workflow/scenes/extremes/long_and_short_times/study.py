"""Very long and very short times: the fundamental solution, runs on lattices and graded particles, evolve."""

from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from fracstudy.probe import frame, probes_of
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
    """One row a probe, for fractional orders `betas` in `dims` dimensions.

    `times` are t of the fundamental solution, `ratios` t_f / t_0 of the long runs, `shares` (t_f - t_0) / t_0 of the
    short ones.
    """
    given = {"betas": betas, "times": times, "ratios": ratios, "shares": shares, "dims": dims}
    probes = probes_of(functions, runs, bounded, **given)
    panels = Panels()
    runs.add_profiles(panels, betas[-1] if len(betas) == 1 else betas[1], ratios)
    return Result(frame(probes), (), panels.frame)
