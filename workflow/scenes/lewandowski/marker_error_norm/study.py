"""Figs. 14-16: the error norm E(t) of the square profile with S4, S7 and S8."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from fracstudy.panels import Panels
from scenes.lewandowski.square_profile import LOADINGS, SHAPES, SquareRuns, Starts, Trace, delay

__all__ = ["study"]

_LINEAR = 0.95  # correlation of E with t


def study(inputs: Inputs, *, run: SquareRuns, long: SquareRuns, seed: int, seeds: int) -> Result:
    """Follow E(t).

    E grows almost linearly if it falls first, then rises by a tenth at least, and from its least value on has a
    correlation with t of 0.95 or more; the statement holds if that is so for most random starts. It falls
    exponentially rather than like a power if a straight line in t fits log E from t = 1 on better than one in log t.
    `long` is a longer run with S8 that tells these apart further.
    """
    square = SquareRuns.model_validate(run)
    starts = Starts(square, SHAPES, range(seed, seed + seeds), follow=True)
    starts.measured = starts.measured.join(pd.DataFrame([_turn(trace) for trace in starts.runs]))
    findings = [
        _growth("M-F14.grows", "S4", starts),
        _growth("M-F15.grows", "S7", starts),
        _traced(starts),
        _exponential(starts, SquareRuns.model_validate(long)),
    ]
    panels = Panels()
    for trace in starts.runs:
        where = {"loading": trace.loading, "seed": trace.seed}
        panels.add("E", trace.shape, trace.t, trace.error, **where)
    # The printed constant scales F, not the motion of the markers: V is a quotient.
    printed = square.trace("S7", "midpoints", printed=True)
    panels.add("printed", "S7", printed.t, printed.error)
    columns = ["E", "least E at t", "E / least E", "linearity", "empty"]
    table = starts.table(columns, counted=("E grows",))
    midpoints = LOADINGS["midpoints"]
    row = {"S": "S7, printed constant", "loading": midpoints, "runs": 1, "E": printed.error[-1]}
    table = pd.concat([table, pd.DataFrame([row])], ignore_index=True)
    return Result(table, inputs.judged(findings), panels.frame)


def _turn(trace: Trace) -> dict[str, float]:
    """Whether E falls first and then rises by a tenth at least, when it is least, and how it goes on from there."""
    least = int(np.argmin(trace.error))
    grows = bool(least > 0 and trace.error[-1] > 1.1 * trace.error[least])
    t, error = trace.t[least:], trace.error[least:]
    return {
        "E grows": grows,
        "linearity": float(np.corrcoef(t, error)[0, 1]) if grows and t.size > 5 else np.nan,
        "least E at t": t[0],
        "E": error[-1],
        "E / least E": error[-1] / error[0],
    }


def _growth(claim: str, shape: str, starts: Starts) -> Finding:
    measured, at_random = starts.measured, starts.random(shape)
    grows = at_random & measured["E grows"] & (measured["linearity"] >= _LINEAR)
    median = measured[grows].median(numeric_only=True)
    others = measured[(measured["S"] == shape) & (measured["loading"] != "random")]
    ratios = "; ".join(
        f"{LOADINGS[loading]}: E / least E = {ratio:.2f}"
        for loading, ratio in zip(others["loading"], others["E / least E"], strict=True)
    )
    return statement(
        claim,
        grows[at_random].mean() > 0.5,
        f"{grows.sum()} of {at_random.sum()} random starts turn, at t = {median['least E at t']:.2f} (median), and "
        f"then grow with a correlation with t of {median['linearity']:.3f}. {ratios}.",
        "By then E grows for few of the random starts.",
    )


def _traced(starts: Starts) -> Finding:
    """E grows where clusters are and only there: in nine of ten runs with S4 and S7."""
    measured, clustered, turned = starts.measured, starts.clustered, starts.measured["E grows"]
    prone = measured["S"].isin(["S4", "S7"])
    agree = (turned == clustered)[prone]
    near = measured["loading"] != "wide"
    grow, with_them = turned[near], clustered[near]
    rank = measured.loc[near, ["empty", "E / least E"]].rank()
    correlation = float(np.corrcoef(rank["empty"], rank["E / least E"])[0, 1])
    return statement(
        "M-F14.traced",
        with_them.any() and agree.mean() >= 0.9,
        f"E grows where clusters are, and only there, in {agree.sum()} of {agree.size} runs with S4 and S7. "
        f"Started within [-1, 1], E grows in {(grow & with_them).sum()} of {with_them.sum()} runs with clusters and in "
        f"{(grow & ~with_them).sum()} of {(~with_them).sum()} without (S4, S7, S8); the rank correlation of its growth "
        f"with the empty part of the line is {correlation:.2f}.",
        "Clusters explain most of the growth, not all: in some runs E grows without clusters, or does not with them.",
    )


def _exponential(starts: Starts, long: SquareRuns) -> Finding:
    near = [trace for trace in starts.runs if trace.shape == "S8" and trace.loading != "wide"]
    exponential, power = np.array([_misfits(trace) for trace in near]).T
    # Wide enough and with enough markers that the tail beyond the fixed grid, and its gaps, do not count.
    end = long.t_final
    whole = long.trace("S8", "midpoints")
    half = long.having(t_final=0.5 * end).trace("S8", "midpoints", follow=False)
    log_at = [
        float(np.interp(end * part, whole.t, np.log(whole.error))) for part in (0.25, 0.5, 1.0)
    ]
    slopes = np.diff(log_at) / np.log(2.0)
    late = [delay(long.z, trace.end.field(long.z), trace.t[-1]) for trace in (half, whole)]
    better = int((power < exponential).sum())
    stopped = len(starts.stopped)
    halted = f" {stopped} runs stop: F turns negative at a marker." if stopped else ""
    return statement(
        "M-F16.exponential",
        better < 0.5 * len(near),
        f"In {better} of {len(near)} runs a power of t fits E better from t = 1 on, with a misfit of log E of "
        f"{np.median(power):.3f} against {np.median(exponential):.3f} (medians). In a run with "
        f"{long.markers} markers the exponent is {slopes[0]:.2f} over t = {0.25 * end:g} to {0.5 * end:g} and "
        f"{slopes[1]:.2f} to t = {end:g}; F is nearest to the exact solution {late[0][0]:.3f} and {late[1][0]:.3f} "
        f"earlier, which leaves {late[0][1]:.0%} and {late[1][1]:.0%} of E.{halted}",
        "It is closer to a power law: the markers lag behind the exact solution by a nearly fixed time τ, and "
        "f(x, t - τ) - f(x, t) falls like τ t^(-5/4).",
    )


def _misfits(trace: Trace) -> list[float]:
    """How far log E, from t = 1 on, is from a straight line in t, and from one in log t."""
    late = trace.t >= min(1.0, 0.2 * trace.t[-1])
    log_e, t = np.log(trace.error[late]), trace.t[late]
    fits = [np.polyfit(s, log_e, 1, full=True)[1][0] for s in (t, np.log(t))]
    return [float(np.sqrt(fit / t.size)) for fit in fits]
