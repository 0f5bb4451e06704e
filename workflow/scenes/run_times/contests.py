"""What benchmarks say: columns in units, who is fastest with an error, who is on the front."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

TIMES = {
    "total_time": "time of one solve with set-up / s",
    "block_time": "time per solve, a thousand at once / s",
}


_UNITS = {"ms": 1e3, "ns a particle": 1e9, "ns a point": 1e9, "MB": 1e-6}


def columns(data: pd.DataFrame, names: Mapping[str, str]) -> pd.DataFrame:
    """Return columns of a benchmark by their headings, in the unit that a heading ends with: "set-up / ms"."""
    units = {heading: _UNITS.get(heading.rpartition(" / ")[2]) for heading in names}
    return pd.DataFrame(
        {h: data[name] if units[h] is None else units[h] * data[name] for h, name in names.items()}
    )


def trials_of(frame: pd.DataFrame) -> pd.DataFrame:
    """Return the trials of a race with their full names, total times and failures."""
    variant = frame["variant"].where(frame["variant"] == "", ", " + frame["variant"])
    return frame.assign(
        name=frame["contender"] + variant,
        points=frame["points"].astype(float),
        total_time=frame["setup_time"] + frame["solve_time"],
        failed=~np.isfinite(frame["error"]) | (frame["failure"].astype(str) != ""),
    )


def best(trials: pd.DataFrame, error: float, time: str = "total_time") -> pd.Series:
    """Return the trial of least `time` whose error is at most `error`, "none" and nan if there is none."""
    reached = trials[~trials["failed"] & (trials["error"] <= error) & trials[time].notna()]
    if len(reached):
        return reached.loc[reached[time].idxmin()]
    return pd.Series({**dict.fromkeys(trials.columns, np.nan), "name": "none"})


def front(trials: pd.DataFrame, time: str) -> pd.Series:
    """Return which trials are on the Pareto front: none is as fast and has a smaller error."""
    ordered = trials[~trials["failed"].astype(bool)].dropna(subset=[time])
    ordered = ordered.sort_values([time, "error"])
    so_far = ordered["error"].cummin().shift(fill_value=np.inf)
    return (ordered["error"] < so_far).reindex(trials.index, fill_value=False)


def duration(seconds: float) -> str:
    """Return a time to two digits, in the unit in which it is a number from 1 on."""
    units = ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs"))
    unit, name = next((pair for pair in units if seconds >= pair[0]), (1e-9, "ns"))
    value = seconds / unit
    return f"{value:.0f} {name}" if value >= 9.95 else f"{value:.1f} {name}"
