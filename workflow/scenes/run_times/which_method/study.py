"""Which method to use when: each situation, what to take, what it costs, and who is faster."""

from typing import Any

import numpy as np
import pandas as pd

from fracparticles.errors import FracparticlesError
from fracstudy.inputs import Inputs, Result
from scenes.run_times.contests import best, duration, trials_of

_TIE = 1.2  # two times within this ratio are told apart by nothing but noise
_BLOCK = "block_time"

# Our time, the fastest of the literature, and its time.
_Contest = tuple[float, str, float]


def study(inputs: Inputs, *, situations: list[dict[str, Any]]) -> Result:
    """Compare, for each situation, what to take with the fastest method of the literature.

    A situation is a mapping: `situation`, `take` and `code`, words; `contender`; and, where they differ from the
    defaults, `problem`, `error` and what `_from_race` takes. `measured` is the scene that timed it: a race, or a table
    of least times.
    """
    return Result(pd.DataFrame([_row(inputs, **situation) for situation in situations]))


def _row(
    inputs: Inputs,
    situation: str,
    take: str,
    code: str,
    contender: str,
    measured: str = "work_precision",
    problem: str = "mixture",
    error: float = 1.0e-6,
    **more: Any,
) -> dict[str, Any]:
    if measured in inputs.tables:
        contest = _from_table(inputs.tables[measured], contender, problem, error)
    else:
        contest = _from_race(inputs.benchmarks[measured], contender, problem, error, **more)
    if contest is None:
        raise FracparticlesError(f"{situation}: no trial of {contender} in {measured}")
    ours, peer, theirs = contest
    many = " each" if more.get("time") == _BLOCK else ""
    return {
        "situation": situation,
        "take": take,
        "code": f"`{code}`",
        "cost": f"{duration(ours)}{many} to {error:g}" if ours > 0.0 else f"{error:g} not reached",
        "faster": _faster(ours, peer, theirs),
    }


def _from_race(
    race: pd.DataFrame,
    contender: str,
    problem: str,
    error: float,
    variant: str = "",
    beta: float = 0.5,
    time: str = "total_time",
) -> _Contest | None:
    trials = trials_of(race)
    trials = trials[(trials["beta"] == beta) & (trials["problem"] == problem)]
    own = trials[
        (trials["contender"] == contender) & trials["variant"].str.contains(variant, regex=False)
    ]
    if own.empty:
        return None
    peer = best(trials[trials["group"] == "peers"], error, time)
    return best(own, error, time)[time], peer["name"], peer[time]


def _from_table(table: pd.DataFrame, contender: str, problem: str, error: float) -> _Contest | None:
    rows = table[table["problem"] == problem].set_index("contender")
    if contender not in rows.index:
        return None
    seconds = 1e-3 * rows[f"to {error:.0e} / ms"]
    peers = seconds[rows["group"] == "peer"].dropna()
    peer = (peers.idxmin(), peers.min()) if len(peers) else ("none", np.nan)
    return seconds[contender], *peer


def _faster(ours: float, peer: str, theirs: float) -> str:
    if np.isnan(theirs):
        return "nobody gets there" if np.isnan(ours) else "nobody (no other gets there)"
    if np.isnan(ours):
        return f"{peer} (this does not get there)"
    if max(ours, theirs) <= _TIE * min(ours, theirs):
        return f"nobody ({peer}: a tie)"
    if theirs < ours:
        return f"{peer} ({_two_digits(ours / theirs)} times)"
    return f"nobody ({peer}: {_two_digits(theirs / ours)} times as long)"


def _two_digits(ratio: float) -> str:
    return f"{float(f'{ratio:.2g}'):g}"
