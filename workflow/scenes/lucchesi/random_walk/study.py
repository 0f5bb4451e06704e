"""The random walk beside the particle schemes, Sec. 4.1 (asserted there after Ref. [14], not shown)."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise, product
from typing import Any

import numpy as np
import pandas as pd
from scipy.special import kolmogorov

from fracparticles.moving import random_walk
from fracparticles.moving.random_walk import cell_counts, cell_masses, expected_deviation, walk
from fracparticles.moving.walkers import few_walkers_beyond, walkers_to_equal
from fracparticles.special.stable import green, mean_radius, tail_mass
from fracstudy.findings import Finding, measured
from fracstudy.inputs import ORDERS, Inputs, Result
from fracstudy.panels import Panels, pick

NEEDS = {"scheme": ["KPSE"], "order": [4], "exterior": ["truncated", "open"]}

_RIVAL, _OPEN = "KPSE IV, truncated", "KPSE IV, open"  # the paper's setting, and ours
_TESTED = 10**6  # walkers of a Kolmogorov-Smirnov test at most, for it sorts them


@dataclass(frozen=True)
class _Cells:
    """Equal cells of [-half, half], and the exact mass of each at the time t."""

    number: int
    half: float
    t: float
    alpha: float

    @property
    def edges(self) -> np.ndarray:
        return np.linspace(-self.half, self.half, self.number + 1)

    @property
    def masses(self) -> np.ndarray:
        return cell_masses(self.edges, self.t, self.alpha)

    def shares(self, x: np.ndarray, n: int) -> np.ndarray:
        """N_k / n of as many disjoint ensembles of n walkers as there are, shape (ensembles, cells)."""
        ensembles = x.size // n
        return cell_counts(x[: ensembles * n], self.half, self.number, ensembles) / n


def study(
    inputs: Inputs,
    *,
    seed: int,
    earlier: list[float],
    walk_steps: list[float],
    walkers: list[int],
    increments: int,
    cells: int,
    tail: float,
    zones: list[float],
    shown: list[int],
    reach: float,
) -> Result:
    """Error of the walk against the number of walkers, the law at its end, its tails, and the particle schemes' error.

    The error is (48) on the `cells` equal cells of [-5 R_alpha, 5 R_alpha]: sum_k |N_k/n - p_k| / sum_k p_k, with p_k
    the exact mass of a cell, so that the width of the cells adds no error of its own. It is the mean over as many
    disjoint ensembles of n walkers as there are.

    The walk is that of the runs, of KPSE, and is looked at at their end and at the times `earlier`, for each of the
    `walk_steps`; `increments` is how many may be drawn at any step but the first. Walkers are counted beyond `tail`,
    the deviation of a cell within the `zones`, both in |x| / R_alpha. The figure has two numbers of walkers, `shown`,
    the larger one that of the zones, up to |x| / R_alpha = `reach`.
    """
    run = inputs.select(scheme="KPSE", order=4, exterior="truncated").iloc[0]
    alpha, start, final = 1.0 + run["beta"], run["t_initial"], run["t_final"]
    times, unit = [*earlier, final], mean_radius(alpha)
    at = {t: _Cells(cells, 5.0 * unit, t, alpha) for t in times}
    legs = np.diff([start, *times])

    def walked(count: int, dt: float, *seeds: int) -> dict[float, np.ndarray]:
        steps = [max(1, round(leg / dt)) for leg in legs]
        return _walk(alpha, count, [start, *times], steps, np.random.default_rng(seeds))

    walks = []
    for number, dt in enumerate(walk_steps):
        steps = sum(max(1, round(leg / dt)) for leg in legs)
        affordable = [n for n in walkers if number == 0 or n * steps <= increments]
        walks.append(walked(max(affordable), dt, seed, number))
    rows = [
        _row(at[t], tail, dt, x, n)
        for dt, positions in zip(walk_steps, walks, strict=True)
        for (t, x), n in product(positions.items(), walkers)
        if n <= x.size
    ]
    found, rivals = pd.DataFrame(rows), _rivals(inputs, at[final])
    table = pd.concat([found, rivals.drop(columns="run")], ignore_index=True)
    table = table.astype({column: "Int64" for column in ("walkers", "ensembles")})
    x, last = walks[0][final], found[found["t"] == final]
    findings: list[Finding] = []
    if inputs.items:
        wide = _Cells(round(cells * zones[-1] / 5.0), zones[-1] * unit, final, alpha)
        other = walked(max(shown), walk_steps[0], seed + 1, 0)
        again = pd.DataFrame(_row(at[t], tail, walk_steps[0], y, y.size) for t, y in other.items())
        another = f"another seed, {max(shown):.0e} walkers"
        findings = [
            _matches(found, {another: again}),
            _visible(wide, x, walkers, zones, rivals, {another: other[final]}),
            _tails(wide, x, max(shown), zones, {another: other[final]}),
        ]
    far = _Cells(2 * round(cells * reach / 10.0), reach * unit, final, alpha)
    panels = Panels()
    _densities(panels, inputs, far, x, shown)
    _errors(panels, last, rivals)
    return Result(table, findings, panels.frame)


def _walk(
    alpha: float, count: int, times: list[float], steps: list[int], generator: np.random.Generator
) -> dict[float, np.ndarray]:
    """The positions of `count` walkers at each time but the first."""
    x = walk(np.zeros(count), alpha, times[0], generator)
    positions = {}
    for (begin, end), number in zip(pairwise(times), steps, strict=True):
        x = positions[end] = walk(x, alpha, end - begin, generator, number)
    return positions


def _row(cells: _Cells, tail: float, dt: float, x: np.ndarray, n: int) -> dict[str, Any]:
    t, alpha, masses = cells.t, cells.alpha, cells.masses
    errors = np.abs(cells.shares(x, n) - masses).sum(axis=1) / masses.sum()
    beyond, width = tail * mean_radius(alpha), 2.0 * cells.half / cells.number
    probability = math.nan
    if n <= _TESTED:
        probability = kolmogorov(math.sqrt(n) * random_walk.kolmogorov_smirnov(x[:n], t, alpha))
    return {
        "method": "random walk",
        "t": t,
        "dt": dt,
        "walkers": n,
        "ensembles": errors.size,
        "relative error": errors.mean(),
        "expected": expected_deviation(masses, n).sum() / masses.sum(),
        "Kolmogorov-Smirnov p": probability,
        f"expected beyond {tail:g} R": n * tail_mass(beyond, t, alpha),
        f"found beyond {tail:g} R": (np.abs(x[:n]) > beyond).sum(),
        "fewer than 10 a cell beyond |x| =": few_walkers_beyond(n, width, t, alpha),
    }


def _rivals(inputs: Inputs, cells: _Cells) -> pd.DataFrame:
    """The runs of KPSE, and the walkers that would equal them in these cells and in cells of width h."""
    rows = []
    for run in inputs.select(scheme="KPSE", t_final=cells.t).to_dict("records"):
        number, error = round(2.0 * cells.half / run["particle_spacing"]), run["relative_l1_error"]
        fine = _Cells(max(1, number), cells.half, cells.t, cells.alpha)
        row = {
            "method": f"{run['scheme']} {ORDERS[run['order']]}, {run['exterior']}",
            "t": cells.t,
            "dt": run["dt"],
            "relative error": error,
            "walkers to equal it": walkers_to_equal(cells.masses, error),
            "walkers, cells of width h": walkers_to_equal(fine.masses, error),
            "run": run["run"],
        }
        rows.append(row)
    return pd.DataFrame(rows)


def _matches(found: pd.DataFrame, again: Mapping[str, pd.DataFrame]) -> Finding:
    """The error with the most walkers, by time, and whether their law is that of the solution."""

    def numbers(rows: pd.DataFrame) -> dict[str, Any]:
        best = rows[rows["walkers"] == rows["walkers"].max()].drop_duplicates("t")
        p = rows["Kolmogorov-Smirnov p"].dropna()
        # The least of several p-values is below p with a probability of at most their number times p.
        return {"error": best.set_index("t")["relative error"], "p": min(1.0, p.min() * len(p))}

    longest = found[found["dt"] == found["dt"].max()]
    logs = np.log(longest[["walkers", "relative error"]]).groupby(longest["t"])
    rates = [np.polyfit(n, e, 1)[0] for n, e in (part.T.to_numpy() for _, part in logs)]
    return measured(
        "L-C3.matches",
        others={name: numbers(rows) for name, rows in again.items()},
        **numbers(found),
        walkers=found["walkers"].max(),
        rate=np.mean(rates),
    )


def _visible(
    cells: _Cells,
    x: np.ndarray,
    walkers: list[int],
    zones: list[float],
    rivals: pd.DataFrame,
    again: Mapping[str, np.ndarray],
) -> Finding:
    """The deviation of the density where it is largest, and the walkers that would equal the particle scheme."""

    def numbers(x: np.ndarray) -> dict[str, Any]:
        counts = [n for n in walkers if n <= x.size]
        return {"deviation": {f"{n:.0e}": max(_deviations(cells, x, n, zones)[0]) for n in counts}}

    paper, ours = (rivals.set_index("method").loc[name] for name in (_RIVAL, _OPEN))
    return measured(
        "L-C3.visible",
        runs=[paper["run"], ours["run"]],
        others={name: numbers(other) for name, other in again.items()},
        **numbers(x),
        truncated=paper["relative error"],
        equal=paper["walkers to equal it"],
        opened=ours["relative error"],
        equal_opened=ours["walkers to equal it"],
    )


def _tails(
    cells: _Cells, x: np.ndarray, n: int, zones: list[float], again: Mapping[str, np.ndarray]
) -> Finding:
    """How the deviation of the density grows from zone to zone, relative and absolute."""

    def numbers(deviations: list[float]) -> dict[str, Any]:
        growth = np.divide(deviations[1:], deviations[:-1]).min()
        return {"growth": growth, "ratio": deviations[-1] / deviations[0]}

    relative, absolute = _deviations(cells, x, n, zones)
    others = {name: numbers(_deviations(cells, y, n, zones)[0]) for name, y in again.items()}
    return measured(
        "L-C3.tails",
        others={**others, "the absolute deviation": numbers(absolute)},
        **numbers(relative),
        relative={f"{low:g}": m for low, m in zip(zones[:-1], relative, strict=True)},
        absolute=absolute,
        walkers=n,
    )


def _deviations(
    cells: _Cells, x: np.ndarray, n: int, zones: list[float]
) -> tuple[list[float], list[float]]:
    """Root mean square deviation of the density in the cells of each zone: of itself, and of the peak."""
    masses = cells.masses
    deviation = cells.shares(x[:n], n)[0] - masses
    centre = 0.5 * np.abs(cells.edges[1:] + cells.edges[:-1]) / mean_radius(cells.alpha)
    here = [(centre >= low) & (centre < high) for low, high in pairwise(zones)]
    relative = [math.sqrt(((deviation / masses)[zone] ** 2).mean()) for zone in here]
    return relative, [math.sqrt((deviation[zone] ** 2).mean()) / masses.max() for zone in here]


def _densities(
    panels: Panels, inputs: Inputs, cells: _Cells, x: np.ndarray, shown: list[int]
) -> None:
    """Panel "density": exact, walk of n walkers, KPSE. Only x > 0 is shown, as in Fig. 2."""
    t, alpha, half, width = cells.t, cells.alpha, cells.half, 2.0 * cells.half / cells.number
    fine = np.geomspace(0.5 * width, half, 241)
    panels.add("density", "exact", fine, green(fine, t, alpha))
    right = cells.number // 2
    centre = (np.arange(right) + 0.5) * width
    for n in shown:
        few = few_walkers_beyond(n, width, t, alpha)
        density = cells.shares(x[:n], n)[0, right:] / width
        panels.add("density", "walk", centre, density, walkers=n, few_beyond=few)
    run = inputs.open(scheme="KPSE", order=4, exterior="truncated", t_final=t)
    at = np.geomspace(0.5 * width, 0.9 * min(half, float(run["x"][-1])), 13)
    u = run["u"].sel(x=at, method="nearest")
    panels.add("density", "KPSE", u["x"].to_numpy(), u.to_numpy())


def _errors(panels: Panels, last: pd.DataFrame, rivals: pd.DataFrame) -> None:
    """Panel "error": walk at each dt, expected, KPSE."""
    for dt, part in last.groupby("dt"):
        panels.add("error", "walk", part["walkers"], part["relative error"], dt=dt)
    law = pick(last, dt=last["dt"].max())
    panels.add("error", "expected", law["walkers"], law["expected"])
    panels.add("error", rivals["method"], rivals["walkers to equal it"], rivals["relative error"])
