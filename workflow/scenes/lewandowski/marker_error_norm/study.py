"""Figs. 14-16: the error norm E(t) of the square profile with S4, S7 and S8."""

from typing import Any

import numpy as np
import pandas as pd

from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from scenes.lewandowski import square_profile
from scenes.lewandowski.square_profile import INFINITE, LOADINGS, SHAPES, SquareRuns, Starts, Trace

_LINEAR = 0.95  # correlation of E with t


def study(inputs: Inputs, *, run: SquareRuns, long: SquareRuns, seed: int, seeds: int) -> Result:
    """Follow E(t).

    E grows if it falls first, then rises by a tenth at least. How well a straight line fits E, or log E, is told by the
    part of the variance that it leaves. `long` is a longer run with S8 that tells an exponential from a power of t.
    Random starts are judged with half as many others beside them.
    """
    square = SquareRuns.model_validate(run)
    starts = _followed(square, range(seed, seed + seeds))
    others = _numbers(_followed(square, range(seed + seeds, seed + seeds + (seeds + 1) // 2)))
    infinite = Starts(square, [INFINITE.name], range(seed, seed + 3), follow=True)
    of_infinite = [_turn(trace)["E grows"] for trace in infinite.runs if trace.loading == "random"]
    numbers = _numbers(starts)
    numbers["M-F14.traced"]["infinite"] = np.mean(of_infinite)
    law = _law(starts, SquareRuns.model_validate(long))
    findings = [*square_profile.with_other_seeds(numbers, others), law]
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


def _followed(square: SquareRuns, seeds: range) -> Starts:
    starts = Starts(square, SHAPES, seeds, follow=True)
    starts.measured = starts.measured.join(pd.DataFrame([_turn(trace) for trace in starts.runs]))
    return starts


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


def _numbers(starts: Starts) -> dict[str, dict[str, Any]]:
    """What is measured of these starts for each claim."""
    found, clustered = starts.measured, starts.clustered
    near = found["loading"] != "wide"
    grows = found["E grows"][near]
    rank = found.loc[near, ["empty", "E / least E"]].rank()
    s8 = [trace for trace in starts.runs if trace.shape == "S8" and trace.loading != "wide"]
    left = [_left(trace.t, np.log(trace.error)) for trace in s8]
    return {
        "M-F14.grows": _growth("S4", starts),
        "M-F14.traced": {
            "with_clusters": _part(grows[clustered[near]]),
            "without": _part(grows[~clustered[near]]),
            "number": int(grows.size),
            "correlation": np.nan_to_num(np.corrcoef(rank.T)[0, 1]),
        },
        "M-F15.grows": _growth("S7", starts),
        "M-F16.exponential": {"left": np.median(left), "most": max(left), "number": len(s8)},
    }


def _growth(shape: str, starts: Starts) -> dict[str, float]:
    """In which part of the random starts E grows, and how far that is from a straight line."""
    found = starts.measured[starts.random(shape)]
    grow = found[found["E grows"]]
    left = 1.0 - grow["linearity"].median() ** 2
    return {
        "share": found["E grows"].mean(),
        "left": 1.0 if np.isnan(left) else left,
        "linear": (grow["linearity"] >= _LINEAR).sum() / len(found),
        "turn": found["least E at t"].median(),
    }


def _part(true: pd.Series) -> float:
    return float(true.mean()) if len(true) else 0.0


def _left(t: np.ndarray, y: np.ndarray) -> float:
    """The part of the variance of y that a straight line in t leaves."""
    return float(1.0 - np.corrcoef(t, y)[0, 1] ** 2)


def _law(starts: Starts, long: SquareRuns) -> Finding:
    """An exponential against a power of t: how far from either log E is, from t = 1 on."""
    near = [trace for trace in starts.runs if trace.shape == "S8" and trace.loading != "wide"]
    exponential, power = np.array([_misfits(trace) for trace in near]).T
    # Wide enough and with enough markers that the tail beyond the fixed grid, and its gaps, do not count.
    end = long.t_final
    whole = long.trace("S8", "midpoints")
    half = long.having(t_final=0.5 * end).trace("S8", "midpoints", follow=False)
    log_at = np.interp(end * np.array([0.1, 0.25, 0.5, 1.0]), whole.t, np.log(whole.error))
    late = [
        square_profile.delay(long.z, trace.end.field(long.z), trace.t[-1])
        for trace in (half, whole)
    ]
    return measured(
        "M-F16.law",
        ratio=np.median(exponential / power),
        better=np.mean(power < exponential),
        number=len(near),
        exponents=np.diff(log_at)[1:] / np.log(2.0),
        rates=-np.diff(log_at) / (end * np.array([0.15, 0.25, 0.5])),
        late=[tau for tau, _ in late],
        end=end,
    )


def _misfits(trace: Trace) -> list[float]:
    """How far log E, from t = 1 on, is from a straight line in t, and from one in log t."""
    late = trace.t >= min(1.0, 0.2 * trace.t[-1])
    log_e, t = np.log(trace.error[late]), trace.t[late]
    fits = [np.polyfit(s, log_e, 1, full=True)[1][0] for s in (t, np.log(t))]
    return [float(np.sqrt(fit / t.size)) for fit in fits]
