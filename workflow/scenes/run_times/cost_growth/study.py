"""How run time and memory grow with the number of particles, and what more particles than were measured would take.

Each quantity of the benchmark is fitted by a power of N over the upper half of the sizes. A power law of times that
leave a cache on the way is too steep beyond, so that larger sizes are extrapolated from the largest measured, which no
cache holds, by what the algorithm does: N log N, or N^2 for the sums over all pairs, and as many bytes a particle.
"""

from collections.abc import Callable
from math import ceil, log
from typing import Any

import numpy as np
import pandas as pd

from fracstudy.inputs import Inputs, Result
from fracstudy.machine import machine_note
from fracstudy.panels import Panels

# Bytes: a smaller rise of the peak is as much the allocator's steps as the particles'.
_LEAST_RISE = 4e6
_YEAR = 365.25 * 86400.0  # seconds
_BEYOND = "memory_beyond"  # what the process takes more than a tiny one

# Column of the benchmark, or of what is made of it here -> column of the table.
_COLUMNS = {
    "dim": "dim",
    "operator": "operator",
    "lattice": "N",
    "setup_time": "set-up / s",
    "application_time": "application / s",
    "applications": "applications",
    "solve_time": "solve / s",
    "naive_time": "naive application / s",
    "naive_ratio": "naive / fast",
    "naive_solve_years": "naive solve / years",
    "gigabytes": "peak memory / GB",
    "memory_per_particle": "bytes a particle",
}
_FITTED = {
    "setup_time": "setup_time",
    "application_time": "application_time",
    "naive_time": "naive_time",
    _BEYOND: "gigabytes",
}


def study(inputs: Inputs, *, extrapolate_to: float) -> Result:
    """Return times and memory of every size; below them the exponents, and what `extrapolate_to` particles would take.

    The exponent of the memory is that of what the process takes beyond a tiny one.
    """
    data = inputs.benchmarks["cost_growth"]
    rows: list[dict[str, Any]] = []
    points: list[pd.DataFrame] = []
    for (dim, kind), runs in data.groupby(["dim", "kind"], sort=False):
        runs = runs.sort_values("particles", ignore_index=True)
        runs[_BEYOND] = runs["memory_per_particle"] * runs["particles"]
        beyond = _extrapolated(runs, extrapolate_to)
        sizes = _measured(runs)
        sizes.append({"lattice": "exponent", **_exponents(runs)})
        sizes.append({"lattice": f"{_power(extrapolate_to)}, extrapolated", **beyond})
        rows += [{"dim": dim, "operator": kind, **row} for row in sizes]
        points.append(_points(runs, beyond, extrapolate_to).assign(dim=dim, kind=kind))
    table = pd.DataFrame(rows, columns=list(_COLUMNS)).rename(columns=_COLUMNS)
    table["applications"] = table["applications"].astype("Int64")
    series = pd.concat(points, ignore_index=True).assign(note=machine_note(data))
    return Result(table, (), series)


def exponent(particles: np.ndarray, values: np.ndarray) -> float:
    """Return the least-squares slope of log values against log N, ascending, over the upper half of those above zero.

    Of two sizes at least; nan if there are not so many.
    """
    known = values > 0.0
    upper = max(2, ceil(known.sum() / 2))
    if known.sum() < 2:
        return float("nan")
    n, y = np.log(particles[known][-upper:]), np.log(values[known][-upper:])
    return float(np.polynomial.Polynomial.fit(n, y, 1).convert().coef[1])


def extrapolate(
    particles: np.ndarray, values: np.ndarray, law: Callable[[float], float], target: float
) -> float:
    """Return the value at N = `target` by a law, known up to a factor, from the largest of N, ascending, that has one.

    It is nan if none has.
    """
    known = np.flatnonzero(values > 0.0)
    if not known.size:
        return float("nan")
    last = known[-1]
    return float(values[last] * (law(target) / law(float(particles[last]))))


def _fast(n: float) -> float:
    return n * log(n)


_LAWS = {"setup_time": _fast, "application_time": _fast, "naive_time": lambda n: n * n}


def _measured(runs: pd.DataFrame) -> list[dict[str, Any]]:
    rows = runs.assign(
        lattice=[_lattice(n, dim) for n, dim in zip(runs["particles"], runs["dim"], strict=True)],
        naive_ratio=runs["naive_time"] / runs["application_time"],
        gigabytes=1e-9 * runs["peak_memory"],
        memory_per_particle=runs["memory_per_particle"].where(runs[_BEYOND] >= _LEAST_RISE),
    )
    wanted = [name for name in _COLUMNS if name in rows.columns and name != "dim"]
    return rows[wanted].to_dict("records")


def _exponents(runs: pd.DataFrame) -> dict[str, float]:
    n = runs["particles"].to_numpy()
    return {column: exponent(n, runs[name].to_numpy()) for name, column in _FITTED.items()}


def _extrapolated(runs: pd.DataFrame, target: float) -> dict[str, Any]:
    """What `target` particles would take, on one core, if the memory were there."""
    n, last = runs["particles"].to_numpy(), runs.iloc[-1]
    times = {
        name: extrapolate(n, runs[name].to_numpy(), law, target) for name, law in _LAWS.items()
    }
    application, naive = times["application_time"], times["naive_time"]
    return {
        **times,
        "applications": last["applications"],
        "solve_time": last["applications"] * application,
        "naive_ratio": naive / application,
        "naive_solve_years": last["applications"] * naive / _YEAR,
        "gigabytes": 1e-9 * target * last["memory_per_particle"],
        "memory_per_particle": last["memory_per_particle"],
    }


def _points(runs: pd.DataFrame, beyond: dict[str, Any], target: float) -> pd.DataFrame:
    """What the figure draws: panel "application" (fast and naive) and "memory", with what is extrapolated."""
    drawn = [
        ("application", "fast", "application_time", beyond["application_time"]),
        ("application", "naive", "naive_time", beyond["naive_time"]),
        ("memory", "peak", "peak_memory", 1e9 * beyond["gigabytes"]),
        ("memory", "machine", "machine_memory", np.nan),
    ]
    x = np.append(runs["particles"].to_numpy(float), target)
    points = Panels()
    for panel, series, column, further in drawn:
        y = np.append(runs[column].to_numpy(float), further)
        points.add(panel, series, x, y, extrapolated=np.arange(x.size) >= len(runs))
    return points.frame[points.frame["y"] > 0.0]  # the axes are logarithmic


def _lattice(particles: float, dim: int) -> str:
    """The size as people write it, 1025^2."""
    side = round(particles ** (1.0 / dim))
    return f"{side}" if dim == 1 else f"{side}^{dim}"


def _power(target: float) -> str:
    """A round number as people write it, 10^9."""
    mantissa, _, power = f"{target:.3g}".partition("e")
    if not power:
        return mantissa
    return f"10^{int(power)}" if mantissa == "1" else f"{mantissa} 10^{int(power)}"
