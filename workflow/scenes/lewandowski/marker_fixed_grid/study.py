"""Figs. 8-10: the square profile with S4, S7 and S8 on the fixed grid, and its wiggles."""

from __future__ import annotations

from fracstudy.inputs import Inputs, Result, statement
from fracstudy.panels import Panels
from scenes.lewandowski.square_profile import SHAPES, SquareRuns, Starts

__all__ = ["study"]


def study(inputs: Inputs, *, run: SquareRuns, seed: int, seeds: int) -> Result:
    """Count the maxima of F in |x| < 3 eps: it has wiggles if there is more than one.

    A statement on a shape function holds if it does for most random starts.
    """
    square = SquareRuns.model_validate(run)
    starts = Starts(square, SHAPES, range(seed, seed + seeds))
    measured, clustered = starts.measured, starts.clustered
    wiggly, quartic = measured["maxima"] > 1, measured["S"] == "S4"
    quiet = measured[(measured["loading"] == "midpoints") & quartic].iloc[0]
    mean = {shape: starts.mean(shape) for shape in SHAPES}
    share = {shape: starts.share(shape) for shape in SHAPES}
    with_clusters = (clustered & quartic).sum()
    go_together = with_clusters > 0 and (wiggly >= clustered)[quartic].all()
    findings = [
        statement(
            "M-F8.wiggles",
            go_together and quiet["maxima"] == 1,
            f"With S4, {(wiggly & clustered & quartic).sum()} of {with_clusters} runs with clusters have wiggles; "
            f"started at midpoints there are no clusters at t = {square.t_final:g}, and F "
            f"has {quiet['maxima']:d} maximum.",
            "Wiggles and clusters do not go together.",
        ),
        statement(
            "M-F9.improves",
            mean["S7"] < mean["S4"],
            f"Over the random starts the relative error is {mean['S7']:.3f} with S7 and {mean['S4']:.3f} with S4; "
            f"S7 is better in {_better(starts, 'S7')}.",
            "S7 is no better than S4.",
        ),
        statement(
            "M-F9.same",
            share["S7"] > 0.5,
            f"S7 forms clusters in {share['S7']:.0%} of the random starts, S4 in {share['S4']:.0%}.",
            "Started at the midpoints they have not formed by then; at random they form from the noise.",
        ),
        statement(
            "M-F10.improves",
            mean["S8"] < 0.5 * mean["S4"] and share["S8"] < 0.5,
            f"Over the random starts the relative error with S8 is {mean['S8']:.3f}, {mean['S8'] / mean['S4']:.2f} "
            f"times that with S4; S8 is better in {_better(starts, 'S8')} and forms clusters in {share['S8']:.0%}.",
            "The error is not halved, or there are clusters.",
        ),
    ]
    panels = Panels()
    panels.add("field", "exact", square.z, square.exact)
    for trace in starts.first:
        panels.add("field", trace.shape, square.z, trace.end.field(square.z), loading=trace.loading)
        panels.add("markers", trace.shape, trace.end.x, 0.0, loading=trace.loading)
    table = starts.table(["relative error", "F(0) / f(0)", "maxima", "empty"])
    return Result(table, inputs.judged(findings), panels.frame)


def _better(starts: Starts, shape: str) -> str:
    """How many seeds give a smaller error than with S4."""
    at_random = starts.measured[starts.measured["loading"] == "random"]
    errors = at_random.pivot(index="seed", columns="S", values="relative error")
    errors = errors[[shape, "S4"]].dropna()
    return f"{(errors[shape] < errors['S4']).sum()} of {len(errors)}"
