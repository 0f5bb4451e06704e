"""What the trials of a benchmark say: who is fastest with an error, who is on the front; and how they are drawn."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from fracstudy.peers import PEERS

__all__ = ["LOOKS", "best", "front", "trials_of"]

# How contenders that are no scheme look: muted colours and hollow markers; the limit is black.
LOOKS: dict[str, dict[str, Any]] = {
    **{
        peer.name: {"label": peer.label, "color": peer.colour, "marker": peer.marker}
        for peer in PEERS.values()
    },
    "random walk": {"label": "random walk", "color": "#E69F00", "marker": "X"},
}


def trials_of(frame: pd.DataFrame) -> pd.DataFrame:
    """Return the trials of a benchmark with their full names, total times and failures."""
    return frame.assign(
        name=frame["contender"] + ", " + frame["variant"],
        particles=frame["particles"].astype(float),
        total_time=frame["setup_time"] + frame["solve_time"],
        failed=~np.isfinite(frame["error"]) | (frame["failure"].astype(str) != ""),
    )


def best(trials: pd.DataFrame, error: float, time: str) -> pd.Series:
    """Return the trial of least `time` whose error is at most `error`, "none" and nan if there is none."""
    reached = trials[~trials["failed"] & (trials["error"] <= error)]
    if len(reached):
        return reached.loc[reached[time].idxmin()]
    return pd.Series({**dict.fromkeys(trials.columns, np.nan), "name": "none"})


def front(trials: pd.DataFrame, time: str) -> pd.Series:
    """Return which trials are on the Pareto front: none is as fast and has a smaller error."""
    ordered = trials[~trials["failed"].astype(bool)].sort_values([time, "error"])
    so_far = ordered["error"].cummin().shift(fill_value=np.inf)
    return (ordered["error"] < so_far).reindex(trials.index, fill_value=False)
