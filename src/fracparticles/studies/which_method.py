"""Which method to use when: the contests that decide it, each by measurement; and the goals set beforehand."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.studies.common import Inputs, Result
from fracparticles.studies.work_precision import best, trials_of

__all__ = ["run_time_goals", "which_method"]

_LINE, _PLANE = "work_precision", "work_precision_plane"
_TIE = 1.2  # two times within this ratio are told apart by nothing but noise


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
    taken = best(
        ours[(ours["family"] == family) & ours["variant"].str.contains(variant, regex=False)],
        error,
        time,
    )
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
        "timed": "set-up and solve" if time == "total_time" else "solve",
        "N": np.nan if taken is None else taken["particles"],
        "time / ms": 1e3 * _time(taken, time),
        "best peer or limit": "none" if peer is None else names[peer.name],
        "its time / ms": 1e3 * _time(peer, time),
        "ours / peer": ratio,
        "ahead": _verdict(taken is not None, peer is not None, ratio),
        "the papers' way / ours": _time(papers, time) / _time(taken, time),
    }


def _verdict(ours: bool, peer: bool, ratio: float) -> str:
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
    line, reference = trials_of(inputs, _LINE), inputs.benchmarks["reference"]
    middle = line[line["beta"] == 0.5]
    series = _series(middle)
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
            "printed setting: the naive algorithm, its steps extrapolated, over ours, one core",
            "naive",
            float(reference["naive_over_series"].min()),
        ),
    ]
    span = f"the worst of the errors {errors[0]:g} to {errors[-1]:g}"
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
    """The largest ratio, over the errors, of our least time to the least of all."""
    ratios = []
    for error in errors:
        fastest = best(trials, error, "solve_time")
        if fastest is not None:
            ratios.append(_least(trials, error) / float(fastest["solve_time"]))
    return float(np.max(ratios)) if ratios else np.nan  # nan, not met, if ours does not get there
