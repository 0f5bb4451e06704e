"""Which method to use when: the contests that decide it, each by measurement; and the goals set beforehand."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from fracstudy.inputs import Inputs, Result
from scenes.run_times.work_precision_shared import best, trials_of

__all__ = ["run_time_goals", "which_method"]

_LINE, _PLANE = "work_precision", "work_precision_plane"
_TIE = 1.2  # two times within this ratio are told apart by nothing but noise
_SAME = 1.001  # two errors within this ratio are told apart by nothing but the norm's own sum


def which_method(inputs: Inputs) -> Result:
    """Hold, for each situation, the method to take against the best peer and against the papers' way.

    Parameters of the scene: `situations`, a list of mappings with `situation` and `take`, words; `benchmark`, `beta`
    and `error`; `time`, "solve_time" or "total_time"; and `family` and `variant`, which the method's must contain; and
    `against`, which the rival's variant must end with, for a situation that not all of them can serve.
    """
    rows = [_contest(inputs, **situation) for situation in inputs.parameters["situations"]]
    return Result(pd.DataFrame(rows))


def _contest(
    inputs: Inputs,
    situation: str,
    take: str,
    benchmark: str,
    beta: float,
    error: float,
    time: str,
    family: str,
    variant: str,
    against: str = "",
) -> dict[str, Any]:
    trials = trials_of(inputs, benchmark)
    trials = trials[trials["beta"] == beta]
    ours = trials[trials["group"] == "ours"]
    own = ours[(ours["family"] == family) & ours["variant"].str.contains(variant, regex=False)]
    taken = best(own, error, time)
    names = trials["family"] + ", " + trials["variant"]
    rivals = trials["group"].isin(["peers", "limit"]) & names.str.endswith(against)
    peer = best(trials[rivals], error, time)
    papers = best(trials[trials["group"] == "papers"], error, time)
    ratio = _time(taken, time) / _time(peer, time)
    return {
        "situation": situation,
        "take": take,
        "beta": beta,
        "error at most": error,
        "fastest of these": "none gets there" if taken is None else names[taken.name],
        "timed": "set-up and solve" if time == "total_time" else "solve",
        "N": np.nan if taken is None else taken["particles"],
        "time / ms": 1e3 * _time(taken, time),
        "best peer or limit": _rival(peer, names, any_rival=bool(rivals.any())),
        "its time / ms": 1e3 * _time(peer, time),
        "ours / peer": ratio,
        "ahead": _verdict(len(own), int(rivals.sum()), taken is not None, peer is not None, ratio),
        "the papers' way / ours": _time(papers, time) / _time(taken, time),
    }


def _rival(peer: pd.Series | None, names: pd.Series, any_rival: bool) -> str:
    if peer is not None:
        return str(names[peer.name])
    return "none gets there" if any_rival else "there is none"


def _verdict(own: int, rivals: int, ours: bool, peer: bool, ratio: float) -> str:
    """Who is ahead; `own` and `rivals` count the trials there are, `ours` and `peer` say who gets there."""
    if not own:
        return "not measured"
    if not rivals:
        return "no rival"
    if not ours:
        return "neither gets there" if not peer else "the peer"
    if not peer or ratio < 1.0 / _TIE:
        return "ours"
    return "a tie" if ratio <= _TIE else "the peer"


def _time(trial: pd.Series | None, time: str) -> float:
    return np.nan if trial is None else float(trial[time])


def run_time_goals(inputs: Inputs) -> Result:
    """Hold the measured run times against the goals that were set before they were measured.

    Parameters of the scene: `goals`, what is asked by the name of the goal, and `errors`, those of the Pareto front.
    """
    asked: Mapping[str, float] = inputs.parameters["goals"]
    errors = inputs.parameters["errors"]
    line, reference = trials_of(inputs, _LINE), inputs.benchmarks["reference_times"]
    middle = line[line["beta"] == 0.5]
    series = _series(middle)
    kpse = reference[(reference["scheme"] == "KPSE") & (reference["order"] == 2)]
    fourth = reference.loc[reference["order"] == 4, "solve_time"]
    rows = [
        ("beta = 0.5, error 1e-8, solve / ms", "error 1e-8", 1e3 * _least(middle, 1e-8)),
        ("beta = 0.5, error 1e-9, solve / ms", "error 1e-9", 1e3 * _least(middle, 1e-9)),
        (
            "the same by a Chebyshev series of DD, FPSE or KPSE, error 1e-8, solve / ms",
            "error 1e-8",
            1e3 * _least(series, 1e-8),
        ),
        ("the same, error 1e-9, solve / ms", "error 1e-9", 1e3 * _least(series, 1e-9)),
        (
            "set-up of our run with the least set-up and solve, error 1e-9 / ms",
            "set-up",
            1e3 * float(_ours_best(middle, 1e-9, "total_time")["setup_time"]),
        ),
        (
            "printed lattice, h = 0.0112 and C = 160, order IV, slowest scheme, solve / s",
            "printed lattice",
            float(fourth.max()),
        ),
        (
            "printed setting, KPSE of order II: the naive algorithm, its steps extrapolated, over ours, one core",
            "naive",
            float(kpse["naive_over_series"].iloc[0]),
        ),
    ]
    span = f"the worst of all errors from {errors[0]:g} to {errors[-1]:g}"
    for beta, part in line.groupby("beta"):
        what = f"beta = {beta:g}: our fastest over the fastest of all, {span}"
        rows.append((what, "front", _off_the_front(part, errors)))
    return Result(pd.DataFrame([_held(*row, float(asked[row[1]])) for row in rows]))


def _held(what: str, name: str, got: float, goal: float) -> dict[str, Any]:
    at_least = name == "naive"
    met = got >= goal if at_least else got <= goal
    return {
        "goal": what,
        "asked": f"at {'least' if at_least else 'most'} {goal:g}",
        "measured": got,
        "met": "yes" if met else "no",
    }


def _series(trials: pd.DataFrame) -> pd.DataFrame:
    steps = trials["family"].isin(["DD", "FPSE", "KPSE"]) & (trials["group"] == "ours")
    return trials[steps & trials["variant"].str.endswith(" series")]


def _ours_best(trials: pd.DataFrame, error: float, time: str) -> pd.Series:
    found = best(trials[trials["group"] == "ours"], error, time)
    return pd.Series({time: np.nan, "setup_time": np.nan}) if found is None else found


def _least(trials: pd.DataFrame, error: float) -> float:
    return float(_ours_best(trials, error, "solve_time")["solve_time"])


def _off_the_front(trials: pd.DataFrame, errors: list[float]) -> float:
    """The largest ratio, over all errors from the first to the last, of our least time to the least of all.

    Either least time, as a function of the error allowed, steps down at the errors of the trials: these and the ends
    are all that there is to look at. An error of ours that is the same but for its last digits counts as reached: two
    methods that are one but for round-off are not apart. Infinite, if somebody gets to an error that ours do not.
    """
    done = trials[~trials["failed"]].sort_values("error")
    error = done["error"].to_numpy()
    ours = np.where(done["group"] == "ours", done["solve_time"], np.inf)
    least = np.minimum.accumulate(done["solve_time"].to_numpy())
    ours = np.minimum.accumulate(ours)
    allowed = np.union1d(errors, error[(error > errors[-1]) & (error < errors[0])])
    last, ours_last = (
        np.searchsorted(error, allowed * slack, side="right") - 1 for slack in (1.0, _SAME)
    )
    reached = last >= 0
    ratios = ours[ours_last[reached]] / least[last[reached]]
    return float(ratios.max()) if len(ratios) else np.nan
