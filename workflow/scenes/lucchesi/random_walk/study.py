"""The random walk beside the particle schemes, Sec. 4.1 (asserted there after Ref. [14], not shown)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import brentq
from scipy.special import kolmogorov

from fracparticles.moving.random_walk import (
    cell_counts,
    cell_masses,
    expected_deviation,
    kolmogorov_smirnov,
    walk,
)
from fracparticles.special.stable import green, mean_radius, tail_mass
from fracstudy.claims import Finding
from fracstudy.inputs import ORDERS, Inputs, Result, statement

__all__ = ["few_walkers_beyond", "study", "walkers_to_equal"]

_CLOSE = 0.01  # a relative error up to this is a close match, one above it can be seen in a plot
_RIVAL, _OPEN = "KPSE IV, truncated", "KPSE IV, open"  # the paper's setting, and ours
_UNLIKELY = 0.01  # p-value below which the walkers would not have the law of the solution
_FEW = 10  # walkers in a cell: a relative deviation of a third
_TESTED = 10**6  # walkers of a Kolmogorov-Smirnov test at most, for it sorts them


def walkers_to_equal(masses: np.ndarray, error: float) -> float:
    """Return the n at which sum_k E |N_k/n - p_k| / sum_k p_k = error, E |...| = (2 p_k (1 - p_k) / (pi n))^(1/2)."""
    root = np.sqrt(masses * (1.0 - masses)).sum() / masses.sum()
    return float(2.0 / math.pi * (root / error) ** 2)


def few_walkers_beyond(walkers: int, width: float, t: float, alpha: float) -> float:
    """Return the |x| beyond which a cell of that width expects fewer than 10 walkers: n width G(x, t) = 10."""
    level = _FEW / (walkers * width)
    if green(0.0, t, alpha) <= level:
        return 0.0
    far = 1.0
    while green(far, t, alpha) > level:
        far *= 2.0
    return float(brentq(lambda x: green(x, t, alpha) - level, 0.0, far))


def study(inputs: Inputs) -> Result:
    """Error of the walk against the number of walkers, the law at its end, its tails, and the particle schemes' error.

    The error is (48) on the `cells` equal cells of [-5 R_alpha, 5 R_alpha]: sum_k |N_k/n - p_k| / sum_k p_k, with p_k
    the exact mass of a cell, so that the width of the cells adds no error of its own. It is the mean over as many
    disjoint ensembles of n walkers as there are.

    Parameters of the scene: `seed`; `t_initial`; `times`, rising, where the walk is looked at; `dt`, a list;
    `walkers`, a list; `increments`, how many may be drawn up to the last time at any dt but the first; `cells`;
    `tail`, the |x| / R_alpha beyond which walkers are counted; `zones` of |x| / R_alpha for the deviation of a cell;
    `shown`, two numbers of walkers for the figure, the larger one that of the zones, and `reach`, the largest
    |x| / R_alpha of the figure. Runs: KPSE at the last of the times.
    """
    parameters = inputs.parameters
    alpha = 1.0 + float(parameters["beta"])
    walks = [_walk(parameters, alpha, number) for number in range(len(parameters["walk_steps"]))]
    rows = [
        _row(parameters, alpha, dt, t, x, n)
        for dt, positions in zip(parameters["walk_steps"], walks, strict=True)
        for t, x in positions.items()
        for n in parameters["walkers"]
        if n <= x.size
    ]
    final = float(parameters["times"][-1])
    rivals = _rivals(inputs, alpha, final)
    zones = _zones(parameters, alpha, final, walks[0][final])
    measured = pd.DataFrame(rows)
    table = pd.concat([measured, pd.DataFrame(rivals).drop(columns="run")], ignore_index=True)
    table = table.astype({column: "Int64" for column in ("walkers", "ensembles")})
    findings = [_matches(inputs, measured), *_visible(inputs, measured, rivals, zones)]
    series = _series(inputs, alpha, walks[0][final], measured[measured["t"] == final], rivals)
    return Result(table, findings, series)


def _walk(parameters: Mapping[str, Any], alpha: float, number: int) -> dict[float, np.ndarray]:
    """The positions at each time, by steps of about dt, of as many walkers as may be afforded."""
    dt, times = float(parameters["walk_steps"][number]), [float(t) for t in parameters["times"]]
    start = float(parameters["t_initial"])
    legs = np.diff([start, *times])
    steps = [max(1, round(leg / dt)) for leg in legs]
    affordable = [
        n
        for n in parameters["walkers"]
        if number == 0 or n * sum(steps) <= float(parameters["increments"])
    ]
    generator = np.random.default_rng([int(parameters["seed"]), number])
    x = walk(np.zeros(max(affordable)), alpha, start, generator)
    positions = {}
    for t, leg, count in zip(times, legs, steps, strict=True):
        x = walk(x, alpha, float(leg), generator, count)
        positions[t] = x
    return positions


def _row(
    parameters: Mapping[str, Any], alpha: float, dt: float, t: float, x: np.ndarray, n: int
) -> dict[str, Any]:
    half, cells = 5.0 * mean_radius(alpha), int(parameters["cells"])
    masses = cell_masses(np.linspace(-half, half, cells + 1), t, alpha)
    ensembles = x.size // n
    counts = cell_counts(x[: ensembles * n], half, cells, ensembles)
    errors = np.abs(counts / n - masses).sum(axis=1) / masses.sum()
    beyond = float(parameters["tail"]) * mean_radius(alpha)
    probability = math.nan
    if n <= _TESTED:
        probability = kolmogorov(math.sqrt(n) * kolmogorov_smirnov(x[:n], t, alpha))
    return {
        "method": "random walk",
        "t": t,
        "dt": dt,
        "walkers": n,
        "ensembles": ensembles,
        "relative error": errors.mean(),
        "expected": expected_deviation(masses, n).sum() / masses.sum(),
        "Kolmogorov-Smirnov p": probability,
        f"expected beyond {parameters['tail']:g} R": n * tail_mass(beyond, t, alpha),
        f"found beyond {parameters['tail']:g} R": (np.abs(x[:n]) > beyond).sum(),
        "fewer than 10 a cell beyond |x| =": few_walkers_beyond(n, 2.0 * half / cells, t, alpha),
    }


def _rivals(inputs: Inputs, alpha: float, t: float) -> list[dict[str, Any]]:
    """The runs of KPSE, and the walkers that would equal them in these cells and in cells of width h."""
    half, cells = 5.0 * mean_radius(alpha), int(inputs.parameters["cells"])
    rows = []
    for run in inputs.select(t_final=t).to_dict("records"):
        fine = max(1, round(2.0 * half / run["particle_spacing"]))
        walkers = [
            walkers_to_equal(
                cell_masses(np.linspace(-half, half, number + 1), t, alpha),
                run["relative_l1_error"],
            )
            for number in (cells, fine)
        ]
        rows.append(
            {
                "method": f"{run['scheme']} {ORDERS[run['order']]}, {run['exterior']}",
                "t": t,
                "dt": run["dt"],
                "relative error": run["relative_l1_error"],
                "walkers to equal it": walkers[0],
                "the same, cells of width h": walkers[1],
                "run": run["run"],
            }
        )
    return rows


def _zones(
    parameters: Mapping[str, Any], alpha: float, t: float, x: np.ndarray
) -> list[dict[str, float]]:
    """Deviation of the density in a cell from the exact one, root mean square over the cells of each zone."""
    n, edges = int(max(parameters["shown"])), parameters["zones"]
    cells = round(int(parameters["cells"]) * edges[-1] / 5.0)
    half = edges[-1] * mean_radius(alpha)
    bounds = np.linspace(-half, half, cells + 1)
    counts = cell_counts(x[: x.size // n * n], half, cells, x.size // n)
    masses = cell_masses(bounds, t, alpha)
    deviation = counts / n - masses
    centre = 0.5 * np.abs(bounds[1:] + bounds[:-1]) / mean_radius(alpha)
    zones = []
    for low, high in pairwise(edges):
        here = (centre >= low) & (centre < high)
        zones.append(
            {
                "low": low,
                "high": high,
                "relative": math.sqrt(((deviation / masses)[:, here] ** 2).mean()),
                "absolute": math.sqrt((deviation[:, here] ** 2).mean()) / masses.max(),
            }
        )
    return zones


def _matches(inputs: Inputs, measured: pd.DataFrame) -> Finding:
    most = measured["walkers"].max()
    best = measured[measured["walkers"] == most].set_index("t")["relative error"]
    p = measured["Kolmogorov-Smirnov p"].dropna()
    # The least of several p-values is below this with a probability of at most 1 %, dependent or not.
    unlikely = _UNLIKELY / len(p)
    steps = sorted(measured["dt"].unique(), reverse=True)
    longest = measured[measured["dt"] == measured["dt"].max()]
    rate = np.mean(
        [
            np.polyfit(np.log(part["walkers"]), np.log(part["relative error"]), 1)[0]
            for _, part in longest.groupby("t")
        ]
    )
    return statement(
        "L-C3.matches",
        bool((best < _CLOSE).all() and p.min() > unlikely),
        f"With {most:.0e} walkers the error is "
        + " and ".join(f"{e:.2%} at t = {t:g}" for t, e in best.items())
        + f"; it falls like n^{rate:.3f}. At every dt ({', '.join(f'{dt:g}' for dt in steps)}) and number of walkers "
        f"their law is that of the exact solution: the least of {len(p)} Kolmogorov-Smirnov p-values is "
        f"{p.min():.3f}.",
        "The law of the walkers is another one."
        if p.min() <= unlikely
        else "There are too few walkers to come within 1 % of the solution.",
    )


def _visible(
    inputs: Inputs,
    measured: pd.DataFrame,
    rivals: list[dict[str, Any]],
    zones: list[dict[str, float]],
) -> list[Finding]:
    final = float(inputs.parameters["times"][-1])
    longest = measured[(measured["t"] == final) & (measured["dt"] == measured["dt"].max())]
    errors = longest.set_index("walkers")["relative error"]
    ratio = errors / longest.set_index("walkers")["expected"]
    rival = {row["method"]: row for row in rivals}
    level = rival[_RIVAL]["relative error"]
    relative = [zone["relative"] for zone in zones]
    absolute = [zone["absolute"] for zone in zones]
    spelled = ", ".join(f"{r:.2g}" for r in relative)
    starts = ", ".join(f"{zone['low']:g}" for zone in zones)
    return [
        statement(
            "L-C3.visible",
            bool((errors > _CLOSE).any() and errors.min() > 10.0 * level),
            f"The error at t = {final:g} is "
            + ", ".join(f"{e:.2%} with {n:.0e}" for n, e in errors.items())
            + f" walkers, {ratio.min():.3f} to {ratio.max():.3f} of what counting independent walkers must give. To "
            f"equal {_RIVAL}, {level:.2g}, would take {rival[_RIVAL]['walkers to equal it']:.1e} walkers; with the "
            f"open exterior, {rival[_OPEN]['relative error']:.2g}, {rival[_OPEN]['walkers to equal it']:.1e}.",
            "The statistical error is below 1 %, or near that of the particle scheme.",
            [rival[_RIVAL]["run"], rival[_OPEN]["run"]],
        ),
        statement(
            "L-C3.tails",
            bool((np.diff(relative) > 0.0).all() and relative[-1] > 10.0 * relative[0]),
            f"With {max(inputs.parameters['shown']):.0e} walkers the density in a cell is off by, root mean square, "
            f"{spelled} of itself between |x| / R_alpha = "
            f"{starts} and {zones[-1]['high']:g}. Absolutely the deviation "
            f"falls, from {absolute[0]:.1e} to {absolute[-1]:.1e} of the peak: the tails are worst on a relative scale "
            "only.",
            "The relative deviation does not grow outwards like this.",
        ),
    ]


def _series(
    inputs: Inputs,
    alpha: float,
    x: np.ndarray,
    measured: pd.DataFrame,
    rivals: list[dict[str, Any]],
) -> pd.DataFrame:
    """Panels "density" (exact, walk of n walkers, KPSE) and "error" (walk at each dt, expected, KPSE)."""
    parameters, t = inputs.parameters, float(inputs.parameters["times"][-1])
    half = float(parameters["reach"]) * mean_radius(alpha)
    cells = 2 * round(int(parameters["cells"]) * parameters["reach"] / 10.0)
    width = 2.0 * half / cells
    parts = []
    fine = np.geomspace(0.5 * width, half, 241)
    parts.append(_part("density", "exact", fine, green(fine, t, alpha)))
    # Only x > 0 is shown, as in Fig. 2.
    centre = (np.arange(cells // 2) + 0.5) * width
    for n in parameters["shown"]:
        counts = cell_counts(x[:n], half, cells)[0, cells // 2 :]
        few = few_walkers_beyond(n, width, t, alpha)
        parts.append(
            _part("density", "walk", centre, counts / (n * width), walkers=n, few_beyond=few)
        )
    run = inputs.open(scheme="KPSE", order=4, exterior="truncated", t_final=t)
    at = np.geomspace(0.5 * width, 0.9 * min(half, float(run["x"][-1])), 13)
    u = run["u"].sel(x=at, method="nearest")
    parts.append(_part("density", "KPSE", u["x"].to_numpy(), u.to_numpy()))
    for dt, part in measured.groupby("dt"):
        parts.append(_part("error", "walk", part["walkers"], part["relative error"], dt=dt))
    law = measured[measured["dt"] == measured["dt"].max()]
    parts.append(_part("error", "expected", law["walkers"], law["expected"]))
    for row in rivals:
        place, level = [row["walkers to equal it"]], [row["relative error"]]
        parts.append(_part("error", row["method"], place, level))
    return pd.concat(parts, ignore_index=True)


def _part(panel: str, series: str, x: Any, y: Any, **more: Any) -> pd.DataFrame:
    return pd.DataFrame(
        {"panel": panel, "series": series, "x": np.asarray(x), "y": np.asarray(y), **more}
    )
