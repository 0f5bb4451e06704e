"""The random walk beside the particle schemes, Sec. 4.1 (asserted there after Ref. [14], not shown)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise, product
from typing import Any

import numpy as np
import pandas as pd
from scipy.special import kolmogorov

from fracparticles.moving.random_walk import (
    cell_counts,
    cell_masses,
    expected_deviation,
    kolmogorov_smirnov,
    walk,
)
from fracparticles.moving.walkers import few_walkers_beyond, walkers_to_equal
from fracparticles.special.stable import green, mean_radius, tail_mass
from fracstudy.claims import Finding
from fracstudy.inputs import ORDERS, Inputs, Result, listed, statement

__all__ = ["study"]

NEEDS = {"scheme": ["KPSE"], "order": [4], "exterior": ["truncated", "open"]}

_CLOSE = 0.01  # a relative error up to this is a close match, one above it can be seen in a plot
_RIVAL, _OPEN = "KPSE IV, truncated", "KPSE IV, open"  # the paper's setting, and ours
_UNLIKELY = 0.01  # p-value below which the walkers would not have the law of the solution
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
    walks = []
    for number, dt in enumerate(walk_steps):
        steps = [max(1, round(leg / dt)) for leg in np.diff([start, *times])]
        affordable = [n for n in walkers if number == 0 or n * sum(steps) <= increments]
        generator = np.random.default_rng([seed, number])
        walks.append(_walk(alpha, max(affordable), [start, *times], steps, generator))
    rows = [
        _row(at[t], tail, dt, x, n)
        for dt, positions in zip(walk_steps, walks, strict=True)
        for (t, x), n in product(positions.items(), walkers)
        if n <= x.size
    ]
    measured, rivals = pd.DataFrame(rows), _rivals(inputs, at[final])
    table = pd.concat([measured, rivals.drop(columns="run")], ignore_index=True)
    table = table.astype({column: "Int64" for column in ("walkers", "ensembles")})
    x, last = walks[0][final], measured[measured["t"] == final]
    wide = _Cells(round(cells * zones[-1] / 5.0), zones[-1] * unit, final, alpha)
    findings: list[Finding] = []
    if inputs.items:
        findings = [_matches(measured), _visible(last, rivals), _tails(wide, x, max(shown), zones)]
    far = _Cells(2 * round(cells * reach / 10.0), reach * unit, final, alpha)
    series = [*_densities(inputs, far, x, shown), *_errors(last, rivals)]
    return Result(table, findings, pd.concat(series, ignore_index=True))


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
        probability = kolmogorov(math.sqrt(n) * kolmogorov_smirnov(x[:n], t, alpha))
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
        rows.append(
            {
                "method": f"{run['scheme']} {ORDERS[run['order']]}, {run['exterior']}",
                "t": cells.t,
                "dt": run["dt"],
                "relative error": error,
                "walkers to equal it": walkers_to_equal(cells.masses, error),
                "the same, cells of width h": walkers_to_equal(fine.masses, error),
                "run": run["run"],
            }
        )
    return pd.DataFrame(rows)


def _matches(measured: pd.DataFrame) -> Finding:
    most = measured["walkers"].max()
    best = measured[measured["walkers"] == most].set_index("t")["relative error"]
    p = measured["Kolmogorov-Smirnov p"].dropna()
    # The least of several p-values is below this with a probability of at most 1 %, dependent or not.
    unlikely = _UNLIKELY / len(p)
    steps = listed(sorted(measured["dt"].unique(), reverse=True))
    longest = measured[measured["dt"] == measured["dt"].max()]
    logs = np.log(longest[["walkers", "relative error"]]).groupby(longest["t"])
    rate = np.mean(
        [np.polyfit(n, error, 1)[0] for n, error in (part.T.to_numpy() for _, part in logs)]
    )
    few = "There are too few walkers to come within 1 % of the solution."
    return statement(
        "L-C3.matches",
        (best < _CLOSE).all() and p.min() > unlikely,
        f"With {most:.0e} walkers the error is "
        + " and ".join(f"{e:.2%} at t = {t:g}" for t, e in best.items())
        + f"; it falls like n^{rate:.3f}. At every dt ({steps}) and number of walkers their law is that of the exact "
        f"solution: the least of {len(p)} Kolmogorov-Smirnov p-values is {p.min():.3f}.",
        "The law of the walkers is another one." if p.min() <= unlikely else few,
    )


def _visible(last: pd.DataFrame, rivals: pd.DataFrame) -> Finding:
    longest = last[last["dt"] == last["dt"].max()].set_index("walkers")
    errors = longest["relative error"]
    ratio = errors / longest["expected"]
    found = ", ".join(f"{e:.2%} with {n:.0e}" for n, e in errors.items())
    paper, ours = (rivals.set_index("method").loc[name] for name in (_RIVAL, _OPEN))
    return statement(
        "L-C3.visible",
        (errors > _CLOSE).any() and errors.min() > 10.0 * paper["relative error"],
        f"The error at t = {paper['t']:g} is {found} walkers, {ratio.min():.3f} to {ratio.max():.3f} of what counting "
        f"independent walkers must give. To equal {_RIVAL}, {paper['relative error']:.2g}, would take "
        f"{paper['walkers to equal it']:.1e} walkers; with the open exterior, {ours['relative error']:.2g}, "
        f"{ours['walkers to equal it']:.1e}.",
        "The statistical error is below 1 %, or near that of the particle scheme.",
        [paper["run"], ours["run"]],
    )


def _tails(cells: _Cells, x: np.ndarray, n: int, zones: list[float]) -> Finding:
    """Deviation of the density in a cell from the exact one, root mean square over the cells of each zone."""
    masses = cells.masses
    deviation = cells.shares(x, n) - masses
    centre = 0.5 * np.abs(cells.edges[1:] + cells.edges[:-1]) / mean_radius(cells.alpha)
    here = [(centre >= low) & (centre < high) for low, high in pairwise(zones)]
    relative = [math.sqrt(((deviation / masses)[:, zone] ** 2).mean()) for zone in here]
    absolute = [math.sqrt((deviation[:, zone] ** 2).mean()) / masses.max() for zone in here]
    return statement(
        "L-C3.tails",
        bool((np.diff(relative) > 0.0).all()) and relative[-1] > 10.0 * relative[0],
        f"With {n:.0e} walkers the density in a cell is off by, root mean square, {listed(relative, '.2g')} of itself "
        f"between |x| / R_alpha = {listed(zones[:-1])} and {zones[-1]:g}. Absolutely the deviation falls, from "
        f"{absolute[0]:.1e} to {absolute[-1]:.1e} of the peak: the tails are worst on a relative scale only.",
        "The relative deviation does not grow outwards like this.",
    )


def _densities(
    inputs: Inputs, cells: _Cells, x: np.ndarray, shown: list[int]
) -> Iterator[pd.DataFrame]:
    """Panel "density": exact, walk of n walkers, KPSE. Only x > 0 is shown, as in Fig. 2."""
    t, alpha, half, width = cells.t, cells.alpha, cells.half, 2.0 * cells.half / cells.number
    fine = np.geomspace(0.5 * width, half, 241)
    yield _part("density", "exact", fine, green(fine, t, alpha))
    right = cells.number // 2
    centre = (np.arange(right) + 0.5) * width
    for n in shown:
        few = few_walkers_beyond(n, width, t, alpha)
        density = cells.shares(x[:n], n)[0, right:] / width
        yield _part("density", "walk", centre, density, walkers=n, few_beyond=few)
    run = inputs.open(scheme="KPSE", order=4, exterior="truncated", t_final=t)
    at = np.geomspace(0.5 * width, 0.9 * min(half, float(run["x"][-1])), 13)
    u = run["u"].sel(x=at, method="nearest")
    yield _part("density", "KPSE", u["x"].to_numpy(), u.to_numpy())


def _errors(last: pd.DataFrame, rivals: pd.DataFrame) -> Iterator[pd.DataFrame]:
    """Panel "error": walk at each dt, expected, KPSE."""
    for dt, part in last.groupby("dt"):
        yield _part("error", "walk", part["walkers"], part["relative error"], dt=dt)
    law = last[last["dt"] == last["dt"].max()]
    yield _part("error", "expected", law["walkers"], law["expected"])
    for name, row in rivals.set_index("method").iterrows():
        yield _part("error", str(name), [row["walkers to equal it"]], [row["relative error"]])


def _part(panel: str, series: str, x: Any, y: Any, **more: Any) -> pd.DataFrame:
    points = {"x": np.asarray(x), "y": np.asarray(y)}
    return pd.DataFrame({"panel": panel, "series": series, **points, **more})
