"""Figs. 8-10: the square profile with S4, S7 and S8 on the fixed grid, and its wiggles."""

from typing import Any

from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels, pick
from scenes.lewandowski.square_profile import INFINITE, SHAPES, SquareRuns, Starts, with_other_seeds


def study(inputs: Inputs, *, run: SquareRuns, seed: int, seeds: int) -> Result:
    """Count the maxima of F in |x| < 3 eps: it has wiggles if there is more than one.

    What random starts do is judged by their mean, and by that of as many others.
    """
    square = SquareRuns.model_validate(run)
    starts = Starts(square, SHAPES, range(seed, seed + seeds))
    again = range(seed + seeds, seed + 2 * seeds)
    first = _numbers(square, starts, range(seed, seed + seeds))
    second = _numbers(square, Starts(square, SHAPES, again), again)
    panels = Panels()
    panels.add("field", "exact", square.z, square.exact)
    for trace in starts.first:
        panels.add("field", trace.shape, square.z, trace.end.field(square.z), loading=trace.loading)
        panels.add("markers", trace.shape, trace.end.x, 0.0, loading=trace.loading)
    table = starts.table(["relative error", "F(0) / f(0)", "maxima", "empty"])
    return Result(table, inputs.judged(with_other_seeds(first, second)), panels.frame)


def _numbers(square: SquareRuns, starts: Starts, seeds: range) -> dict[str, dict[str, Any]]:
    """What is measured of these starts for each claim."""
    found, clustered = starts.measured, starts.clustered
    mean = {shape: starts.mean(shape) for shape in SHAPES}
    quiet = pick(found, loading="midpoints").set_index("S")
    level = quiet["relative error"]
    infinite = Starts(square, [INFINITE.name], seeds)
    with_clusters = {
        "S4": found["maxima"][clustered & (found["S"] == "S4")],
        INFINITE.name: infinite.measured["maxima"][infinite.clustered],
    }
    return {
        "M-F8.deterministic": {"error": level["S8"]},
        "M-F8.wiggles": {
            "maxima": {name: maxima.min() if len(maxima) else 0 for name, maxima in with_clusters.items()},
            "without": quiet["maxima"]["S4"],
            "number": len(with_clusters["S4"]),
        },
        "M-F9.improves": {"ratio": mean["S7"] / mean["S4"], "better": _better(starts, "S7")},
        "M-F9.same": {"share": starts.share("S7")},
        "M-F10.improves": {
            "ratio": {f"over {name}": mean["S8"] / mean[name] for name in ("S4", "S7")},
            "better": _better(starts, "S8"),
        },
        "M-F10.crucial": {
            "range": max(mean.values()) / min(mean.values()),
            "midpoints": level.max() / level.min(),
        },
    }  # fmt: skip


def _better(starts: Starts, shape: str) -> float:
    """The part of the seeds that give a smaller error than with S4."""
    at_random = pick(starts.measured, loading="random")
    errors = at_random.pivot(index="seed", columns="S", values="relative error")
    errors = errors[[shape, "S4"]].dropna()
    return float((errors[shape] < errors["S4"]).mean())
