"""Which contender to take when: the contests that decide it, each by measurement."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from fracstudy.inputs import Inputs, Result
from scenes.run_times.contests import best, trials_of

__all__ = ["study"]

_TIE = 1.2  # two times within this ratio are told apart by nothing but noise


def study(inputs: Inputs, *, situations: list[dict[str, Any]]) -> Result:
    """Hold, for each situation, the contender to take against the best peer and against the papers' way.

    A situation is a mapping: `situation` and `take`, words; `benchmark`, `beta` and `error`; `time`, "solve_time" or
    "total_time"; `contender`, and `variant`, which that of the contender must contain; and `against`, which the
    rival's variant must end with, for a situation that not all of them can serve.
    """
    trials = {name: trials_of(frame) for name, frame in inputs.benchmarks.items()}
    return Result(pd.DataFrame([_contest(trials, **situation) for situation in situations]))


def _contest(
    benchmarks: dict[str, pd.DataFrame],
    situation: str,
    take: str,
    benchmark: str,
    beta: float,
    error: float,
    time: str,
    contender: str,
    variant: str,
    against: str = "",
) -> dict[str, Any]:
    trials = benchmarks[benchmark][lambda all_of: all_of["beta"] == beta]
    group, name = trials["group"], trials["name"]
    of_variant = trials["variant"].str.contains(variant, regex=False)
    own = trials[(group == "ours") & (trials["contender"] == contender) & of_variant]
    rivals = trials[group.isin(["peers", "limit"]) & name.str.endswith(against)]
    parts = own, rivals, trials[group == "papers"]
    ours, peer, papers = (best(part, error, time) for part in parts)
    ratio = ours[time] / peer[time]
    return {
        "situation": situation,
        "take": take,
        "beta": beta,
        "error at most": error,
        "fastest of these": _said(ours),
        "timed": "set-up and solve" if time == "total_time" else "solve",
        "N": ours["particles"],
        "time / ms": 1e3 * ours[time],
        "best peer or limit": _said(peer) if len(rivals) else "there is none",
        "its time / ms": 1e3 * peer[time],
        "ours / peer": ratio,
        "ahead": _verdict(len(own), len(rivals), ours[time], peer[time]),
        "the papers' way / ours": papers[time] / ours[time],
    }


def _said(trial: pd.Series) -> str:
    return "none gets there" if trial["name"] == "none" else str(trial["name"])


def _verdict(own: int, rivals: int, ours: float, peer: float) -> str:
    """Who is ahead, by the number of trials that there are, and the least times of those that get there."""
    if not own:
        return "not measured"
    if not rivals:
        return "no rival"
    if np.isnan(ours):
        return "neither gets there" if np.isnan(peer) else "the peer"
    if np.isnan(peer) or ours / peer < 1.0 / _TIE:
        return "ours"
    return "a tie" if ours / peer <= _TIE else "the peer"
