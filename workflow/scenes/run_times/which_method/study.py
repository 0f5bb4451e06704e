"""Which method to use when: each situation, what to take, what it costs, and who is faster."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from fracparticles.errors import FracparticlesError
from fracstudy.inputs import Inputs, Result
from scenes.run_times.contests import best, trials_of

__all__ = ["study"]

_TIE = 1.2  # two times within this ratio are told apart by nothing but noise


def study(inputs: Inputs, *, situations: list[dict[str, Any]]) -> Result:
    """Hold, for each situation, what to take against the best of the methods of the literature.

    A situation is a mapping: `situation`, `take` and `code`, words; `contender`; and where they differ from those of
    `_contest` the `variant`, `benchmark`, `problem`, `beta`, `error` and `time`.
    """
    trials = {name: trials_of(frame) for name, frame in inputs.benchmarks.items()}
    return Result(pd.DataFrame([_contest(trials, **situation) for situation in situations]))


def _contest(
    races: dict[str, pd.DataFrame],
    situation: str,
    take: str,
    code: str,
    contender: str,
    variant: str = "",
    benchmark: str = "work_precision",
    problem: str = "mixture",
    beta: float = 0.5,
    error: float = 1.0e-6,
    time: str = "total_time",
) -> dict[str, Any]:
    race = races[benchmark]
    trials = race[(race["beta"] == beta) & (race["problem"] == problem)]
    own = trials[
        (trials["contender"] == contender) & trials["variant"].str.contains(variant, regex=False)
    ]
    if own.empty:
        raise FracparticlesError(f"{situation}: no trial of {contender} {variant} in {benchmark}")
    ours = best(own, error, time)
    peer = best(trials[trials["group"] == "peers"], error, time)
    return {
        "situation": situation,
        "take": take,
        "code": f"`{code}`",
        "data": problem,
        "error at most": error,
        "counted": "one solve, all" if time == "total_time" else "one of a thousand solves",
        "N": ours["points"],
        "time / ms": 1e3 * ours[time],
        "best of the literature": peer["name"],
        "its time / ms": 1e3 * peer[time],
        "faster": _verdict(ours[time], peer[time]),
    }


def _verdict(ours: float, peer: float) -> str:
    if np.isnan(ours):
        return "it does not get there" if not np.isnan(peer) else "neither gets there"
    if np.isnan(peer):
        return "ours: no other gets there"
    if ours / peer > _TIE:
        return f"the literature, {ours / peer:.3g} times"
    return f"ours, {peer / ours:.3g} times" if peer / ours > _TIE else "a tie"
