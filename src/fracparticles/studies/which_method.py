"""Which method to use when: the contests that decide it, each by measurement; and the goals set beforehand."""

from __future__ import annotations

from collections.abc import Callable, Mapping
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
    and `error`; `time`, "solve_time" or "total_time"; and `family` and `variant`, which the method's must contain.
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
) -> dict[str, Any]:
    trials = trials_of(inputs, benchmark)
    trials = trials[trials["beta"] == beta]
    ours = trials[trials["group"] == "ours"]
    taken = best(
        ours[(ours["family"] == family) & ours["variant"].str.contains(variant, regex=False)],
        error,
        time,
    )
    peer = best(trials[trials["group"].isin(["peers", "limit"])], error, time)
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
        "best peer or limit": "none gets there" if peer is None else peer["family"],
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
    line = trials_of(inputs, _LINE)
    middle = line[line["beta"] == 0.5]
    reference = inputs.benchmarks["reference"]
    errors = inputs.parameters["errors"]
    measured: dict[str, tuple[str, Callable[[], float]]] = {
        "error 1e-8": (
            "beta = 0.5, error 1e-8, solve / ms",
            lambda: 1e3 * _least(middle, 1e-8, "solve_time"),
        ),
        "error 1e-9": (
            "beta = 0.5, error 1e-9, solve / ms",
            lambda: 1e3 * _least(middle, 1e-9, "solve_time"),
        ),
        "error 1e-8 by a series": (
            "the same by a Chebyshev series of DD, FPSE or KPSE, error 1e-8, solve / ms",
            lambda: 1e3 * _least(_series(middle), 1e-8, "solve_time"),
        ),
        "error 1e-9 by a series": (
            "the same, error 1e-9, solve / ms",
            lambda: 1e3 * _least(_series(middle), 1e-9, "solve_time"),
        ),
        "set-up": (
            "set-up of the run of least set-up and solve with error 1e-9 / ms",
            lambda: 1e3 * float(_ours_best(middle, 1e-9, "total_time")["setup_time"]),
        ),
        "printed lattice": (
            "printed lattice, h = 0.0112 and C = 160, order IV, slowest scheme, solve / s",
            lambda: float(reference.loc[reference["order"] == 4, "solve_time"].max()),
        ),
        "naive": (
            "printed setting, naive algorithm over ours, one core, the naive steps extrapolated",
            lambda: float(reference["naive_over_series"].min()),
        ),
        **{
            f"front, beta {beta:g}": (
                f"beta = {beta:g}: ours over the fastest of all, the worst of the errors {errors[0]:g} to {errors[-1]:g}",
                lambda beta=beta: _off_the_front(line[line["beta"] == beta], errors),
            )
            for beta in sorted(line["beta"].unique())
        },
    }
    rows = []
    for name, (what, value) in measured.items():
        goal = float(asked[name.split(",")[0]])
        at_least = name == "naive"
        got = value()
        met = got >= goal if at_least else got <= goal
        rows.append(
            {
                "goal": what,
                "asked": f"{'at least' if at_least else 'at most'} {goal:g}",
                "measured": got,
                "met": "yes" if met else "no",
            }
        )
    return Result(pd.DataFrame(rows))


def _series(trials: pd.DataFrame) -> pd.DataFrame:
    steps = trials["family"].isin(["DD", "FPSE", "KPSE"]) & (trials["group"] == "ours")
    return trials[steps & trials["variant"].str.endswith(" series")]


def _ours_best(trials: pd.DataFrame, error: float, time: str) -> pd.Series:
    found = best(trials[trials["group"] == "ours"], error, time)
    return pd.Series({time: np.nan, "setup_time": np.nan}) if found is None else found


def _least(trials: pd.DataFrame, error: float, time: str) -> float:
    return float(_ours_best(trials, error, time)[time])


def _off_the_front(trials: pd.DataFrame, errors: list[float]) -> float:
    """The largest ratio, over the errors, of our least time to the least of all."""
    ratios = []
    for error in errors:
        fastest = best(trials, error, "solve_time")
        if fastest is not None:
            ratios.append(_least(trials, error, "solve_time") / float(fastest["solve_time"]))
    return float(np.max(ratios)) if ratios else np.nan
