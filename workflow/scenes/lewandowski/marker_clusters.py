"""Figs. 8-16: the square profile with S4, S7 and S8 at eps = 1, on the fixed grid and that of the markers, and E(t).

The text does not say where the markers start. All three figures of a shape function are run with each of `LOADINGS`,
the random one with several seeds.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.markers import shape_function
from fracparticles.markers.stability import extremes
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from scenes.lewandowski.marker_runs import (
    LOADINGS,
    SQUARE,
    Trace,
    cluster_centres,
    delay,
    emptiness,
    fixed_grid,
    spectrum,
    trace,
    traces,
)

__all__ = ["marker_error_norm", "marker_fixed_grid", "marker_moving_grid"]

_SHAPES = ["S4", "S7", "S8"]
_CLUSTERED = 0.1  # of |x| < within empty: independent markers give a hundredth, clusters nearly all
_CLOSE = 0.05  # "good": an error of at most 5 % of the norm of f
_LINEAR = 0.95  # correlation of E with t
_NO_CLUSTERS = (
    "Started at the midpoints they have not formed by then; at random they form from the noise."
)


def marker_fixed_grid(inputs: Inputs) -> Result:
    """Figs. 8-10: F on the fixed grid at `t_final`, and its wiggles.

    Parameters of the scene: `support`, `dt`, `t_final`, `markers`, `half_width`, `grid`, `seed`, `seeds`, and `gap`,
    `within` in units of eps: markers form clusters if over a tenth of |x| < within lies in gaps wider than `gap`. F has
    wiggles if it has more than one maximum there. A statement on a shape function holds if it does for most random
    starts.
    """
    parameters = inputs.parameters
    runs = [run for run in traces(parameters, _SHAPES, int(parameters["seeds"]), False) if run.run]
    measured = _measured(parameters, runs)
    wiggly = measured["maxima"] > 1
    clustered = measured["empty"] > _CLUSTERED
    quartic = measured["S"] == "S4"
    mean = _random_mean(measured, "relative error")
    quiet = measured[(measured["loading"] == "midpoints") & quartic].iloc[0]
    share = {name: clustered[_random(measured, name)].mean() for name in _SHAPES}
    better = [_paired(measured, a, b) for a, b in (("S7", "S4"), ("S8", "S4"))]
    findings = [
        statement(
            "M-F8.wiggles",
            bool(
                clustered[quartic].any() and (wiggly >= clustered)[quartic].all() and quiet["maxima"] == 1
            ),
            f"With S4, {_of(wiggly & clustered & quartic, clustered & quartic)} runs with clusters have wiggles; "
            f"started at midpoints there are no clusters at t = {parameters['t_final']:g}, and F "
            f"has {quiet['maxima']:d} maximum.",
            "Wiggles and clusters do not go together.",
        ),
        statement(
            "M-F9.improves",
            mean["S7"] < mean["S4"],
            f"Over the random starts the relative error is {mean['S7']:.3f} with S7 and {mean['S4']:.3f} with S4; "
            f"S7 is better in {better[0]}.",
            "S7 is no better than S4.",
        ),
        statement(
            "M-F9.same",
            share["S7"] > 0.5,
            f"S7 forms clusters in {share['S7']:.0%} of the random starts, S4 in {share['S4']:.0%}.",
            _NO_CLUSTERS,
        ),
        statement(
            "M-F10.improves",
            mean["S8"] < 0.5 * mean["S4"] and share["S8"] < 0.5,
            f"Over the random starts the relative error with S8 is {mean['S8']:.3f}, {mean['S8'] / mean['S4']:.2f} "
            f"times that with S4; S8 is better in {better[1]} and forms clusters in {share['S8']:.0%}.",
            "The error is not halved, or there are clusters.",
        ),
    ]  # fmt: skip
    grid, t = fixed_grid(parameters), float(parameters["t_final"])
    parts = [
        pd.DataFrame({"panel": "field", "series": "exact", "x": grid, "y": SQUARE.value(grid, t)})
    ]
    for run in _first(runs, parameters):
        parts += [
            _panel("field", run, grid, run.end.field(grid)),
            _panel("markers", run, run.end.x, 0.0),
        ]
    columns = ["relative error", "F(0) / f(0)", "maxima", "empty"]
    return Result(_table(measured, columns), findings, pd.concat(parts, ignore_index=True))


def marker_moving_grid(inputs: Inputs) -> Result:
    """Figs. 11-13: F at the markers, their clusters, and what represents f there.

    The exact solution "by the representation (6)" is sum_k f(x_k) D_k S_eps(x - x_k), with D_k half the distance
    between the neighbours of marker k. Poor results come from poor representation if, on average over the random
    starts, its error is at least half of that of F, and not from the integration in time if dt / 4 changes E by less
    than a tenth. Finite support is the cause of clusters if every shape function with finite support forms them:
    `compared` has two whose Fourier transform is positive. Parameters as in `marker_fixed_grid`.
    """
    parameters = inputs.parameters
    seeds = int(parameters["seeds"])
    compared = list(parameters["compared"])
    runs = [run for run in traces(parameters, [*_SHAPES, *compared], seeds, False) if run.run]
    measured = _measured(parameters, runs)
    measured["representation"] = [_represented(run, parameters) for run in runs]
    clustered = measured["empty"] > _CLUSTERED
    share = {s: clustered[_random(measured, s)].mean() for s in (*_SHAPES, *compared)}
    spectra = {s: _mean_spectrum(runs, s, parameters) for s in (*_SHAPES, *compared)}
    spacing = {s: _distance(spectra[s]) for s in ("S4", "S7")}
    onset = {s: extremes(shape_function(s)) for s in _SHAPES}
    mean = _random_mean(measured, "relative error")
    fine = {s: _step_change(parameters, runs, s) for s in ("S4", "S7")}
    part = measured["representation"] / measured["relative error"]
    parts_of = {s: part[_random(measured, s)].mean() for s in ("S4", "S7")}
    findings = [
        statement(
            "M-F11.distance",
            bool(0.5 <= spacing["S4"] <= 2.0),
            f"With S4 {share['S4']:.0%} of the random starts form clusters, {spacing['S4']:.2f} ε apart (peak of the "
            "mean spectrum of the markers). The Fourier transform says that they grow fastest "
            f"{onset['S4'].wavelength:.2f} ε apart, by exp({onset['S4'].growth:.2f} t/ε²); then they spread.",
            "The clusters are not about ε apart.",
        ),
        statement(
            "M-F11.representation",
            bool(min(parts_of.values()) >= 0.5 and max(fine.values()) < 0.1),
            f"f itself, represented on the markers of the end, has {parts_of['S4']:.0%} of the error of F with S4 and "
            f"{parts_of['S7']:.0%} with S7, on average; a quarter of the time step changes E by "
            f"{max(fine.values()):.1%} at most.",
            "It explains about half of the error: the clusters also hold the wrong parts of the total.",
        ),
        statement(
            "M-F12.clusters",
            share["S7"] > 0.5,
            f"S7 forms clusters in {share['S7']:.0%} of the random starts, {spacing['S7']:.2f} ε apart (fastest at "
            f"{onset['S7'].wavelength:.2f} ε, growth exp({onset['S7'].growth:.2f} t/ε²)).",
            _NO_CLUSTERS,
        ),
        statement(
            "M-F12.cause",
            all(share[s] > 0.5 for s in compared),
            "Of the random starts, clusters form in "
            + ", ".join(f"{share[s]:.0%} with {s}" for s in (*compared, "S7", "S4"))
            + ". All these have finite support.",
            f"It is the sign of the Fourier transform: those of {' and '.join(compared)} are positive, and they form "
            "no clusters although their support is finite; where it is negative, perturbations grow.",
        ),
        statement(
            "M-F13.none",
            share["S8"] < 0.5 and mean["S8"] <= _CLOSE,
            f"S8 forms clusters in {share['S8']:.0%} of the random starts; the relative error is {mean['S8']:.3f}. Its "
            "transform (1 + k²/4) exp(-k²/4) is positive.",
            "There are clusters, or the error is above 5 %.",
        ),
    ]  # fmt: skip
    series = []
    for run in _first(runs, parameters):
        if run.shape not in _SHAPES:
            continue
        x = np.sort(run.end.x)
        f = SQUARE.value(x, float(parameters["t_final"]))
        # Runs at random: everything at the sorted markers.
        here = run.end.velocity.fields(run.end.x, run.end.weights, x)[0]
        shown = run.end.velocity.fields(x, f * _cells(x), x)[0]
        series += [
            _panel("field", run, x, here),
            _panel("exact", run, x, f),
            _panel("representation", run, x, shown),
            _panel("centres", run, _centres(run, parameters), 0.0),
        ]
    series += [
        pd.DataFrame({"panel": "spectrum", "series": s, "loading": "random", "x": at, "y": power})
        for s, (at, power) in spectra.items()
    ]
    series += [
        pd.DataFrame({"panel": "fastest", "series": s, "x": [onset[s].first_zero], "y": [onset[s].k_growth]})
        for s in _SHAPES
    ]  # fmt: skip
    table = _table(measured, ["relative error", "representation", "empty"])
    peaks = {(s, LOADINGS["random"]): _distance(spectra[s]) for s in ("S4", "S7")}
    here = zip(table["S"], table["loading"], strict=True)
    table["distance of clusters / ε"] = [peaks.get(key, np.nan) for key in here]
    return Result(table, findings, pd.concat(series, ignore_index=True))


def marker_error_norm(inputs: Inputs) -> Result:
    """Figs. 14-16: E(t).

    E grows almost linearly if it falls first, then rises by a tenth at least, and from its least value on has a
    correlation with t of 0.95 or more; the statement holds if that is so for most random starts. It falls
    exponentially rather than like a power if a straight line in t fits log E from t = 1 on better than one in log t.
    `long` changes the parameters for a longer run with S8 that tells these apart further. Others as in
    `marker_fixed_grid`.
    """
    parameters = inputs.parameters
    runs = traces(parameters, _SHAPES, int(parameters["seeds"]))
    stopped = [run for run in runs if run.run is None]
    runs = [run for run in runs if run.run]
    measured = _measured(parameters, runs)
    measured["turned"] = [run.turned for run in runs]
    measured["linearity"] = [run.linearity if run.turned else np.nan for run in runs]
    measured["least E at t"] = [run.t[run.turn] for run in runs]
    measured["E"] = [run.error[-1] for run in runs]
    measured["E / least E"] = [run.error[-1] / run.error[run.turn] for run in runs]
    grows = measured["turned"] & (measured["linearity"] >= _LINEAR)
    clustered = measured["empty"] > _CLUSTERED
    findings = [
        *_growth(measured, grows),
        _traced(measured, clustered),
        _exponential(parameters, runs, stopped),
    ]
    parts = [
        _panel("E", run, run.t, run.error).assign(clustered=clustered.iloc[i])
        for i, run in enumerate(runs)
    ]
    # The printed constant scales F, not the motion of the markers: V is a quotient.
    printed = trace(parameters, "S7", "midpoints", printed=True)
    parts.append(_panel("printed", printed, printed.t, printed.error))
    columns = ["E", "least E at t", "E / least E", "linearity", "empty"]
    table = _table(measured, columns)
    as_printed = {
        "S": "S7, printed constant",
        "loading": LOADINGS["midpoints"],
        "runs": 1,
        "E": printed.error[-1],
    }
    table = pd.concat([table, pd.DataFrame([as_printed])], ignore_index=True)
    return Result(table, findings, pd.concat(parts, ignore_index=True))


# --- what is measured -----------------------------------------------------------------------------


def _measured(parameters: Mapping[str, Any], runs: Sequence[Trace]) -> pd.DataFrame:
    grid, t = fixed_grid(parameters), float(parameters["t_final"])
    exact = SQUARE.value(grid, t)
    gap, within = _scaled(parameters)
    rows = []
    for run in runs:
        f = run.end.field(grid)
        inner = f[np.abs(grid) < within]
        rows.append(
            {
                "S": run.shape,
                "loading": run.loading,
                "seed": run.seed,
                "relative error": np.linalg.norm(f - exact) / np.linalg.norm(exact),
                "F(0) / f(0)": np.interp(0.0, grid, f) / np.interp(0.0, grid, exact),
                "maxima": int(np.sum((inner[1:-1] > inner[:-2]) & (inner[1:-1] >= inner[2:]))),
                "empty": emptiness(run.end.x, gap, within),
            }
        )
    return pd.DataFrame(rows)


def _scaled(parameters: Mapping[str, Any]) -> tuple[float, float]:
    epsilon = float(parameters["support"])
    return epsilon * float(parameters["gap"]), epsilon * float(parameters["within"])


def _centres(run: Trace, parameters: Mapping[str, Any]) -> np.ndarray:
    return cluster_centres(run.end.x, *_scaled(parameters))


def _mean_spectrum(
    runs: Sequence[Trace], shape: str, parameters: Mapping[str, Any]
) -> tuple[np.ndarray, np.ndarray]:
    """The mean spectrum of the markers from the random starts, at k in units of 1 / eps."""
    _, within = _scaled(parameters)
    k = np.linspace(3.0, 12.0, 181)
    found = [
        spectrum(run.end.x, k / float(parameters["support"]), 4.0 / 3.0 * within)
        for run in runs
        if (run.shape, run.loading) == (shape, "random")
    ]
    return k, np.mean(found, axis=0)


def _distance(mean: tuple[np.ndarray, np.ndarray]) -> float:
    """2 pi over the wavenumber of the peak."""
    k, power = mean
    return float(2.0 * np.pi / k[int(np.argmax(power))])


def _cells(x: np.ndarray) -> np.ndarray:
    """Half the distance between the neighbours of each marker; at the ends the distance to the one."""
    return np.gradient(x)


def _represented(run: Trace, parameters: Mapping[str, Any]) -> float:
    """The relative error of f represented on the markers of the end."""
    grid, t = fixed_grid(parameters), float(parameters["t_final"])
    exact, x = SQUARE.value(grid, t), np.sort(run.end.x)
    shown = run.end.velocity.fields(x, SQUARE.value(x, t) * _cells(x), grid)[0]
    return float(np.linalg.norm(shown - exact) / np.linalg.norm(exact))


def _step_change(parameters: Mapping[str, Any], runs: Sequence[Trace], shape: str) -> float:
    """The relative change of E at the end by a quarter of dt, for the random start shown."""
    ours = next(run for run in _first(runs, parameters) if (run.shape, run.loading) == (shape, "random"))  # fmt: skip
    fine = trace(
        parameters, shape, "random", ours.seed, dt=0.25 * float(parameters["dt"]), follow=False
    )
    return float(abs(fine.error[-1] / ours.error[-1] - 1.0)) if fine.run else float("inf")


def _random(measured: pd.DataFrame, shape: str) -> pd.Series:
    return (measured["S"] == shape) & (measured["loading"] == "random")


def _random_mean(measured: pd.DataFrame, column: str) -> dict[str, float]:
    found = measured[measured["loading"] == "random"].groupby("S")[column].mean()
    return {str(name): float(value) for name, value in found.items()}


def _paired(measured: pd.DataFrame, ours: str, other: str) -> str:
    """How many seeds give a smaller error with one shape function than with the other."""
    at = measured[measured["loading"] == "random"].pivot(index="seed", columns="S")["relative error"]  # fmt: skip
    at = at[[ours, other]].dropna()
    return f"{int((at[ours] < at[other]).sum())} of {len(at)}"


def _of(some: pd.Series, among: pd.Series) -> str:
    return f"{int(some.sum())} of {int(among.sum())}"


def _first(runs: Sequence[Trace], parameters: Mapping[str, Any]) -> list[Trace]:
    """Every shape function and loading once, the random one with the first seed that ran to the end."""
    shown: dict[tuple[str, str], Trace] = {}
    for run in runs:
        shown.setdefault((run.shape, run.loading), run)
    return list(shown.values())


def _panel(panel: str, run: Trace, x: np.ndarray, y: np.ndarray | float) -> pd.DataFrame:
    return pd.DataFrame(
        {"panel": panel, "series": run.shape, "loading": run.loading, "seed": run.seed, "x": x, "y": y}
    )  # fmt: skip


def _table(measured: pd.DataFrame, columns: list[str]) -> pd.DataFrame:
    """One row a shape function and loading: the median over the seeds, and the range of the random ones."""
    rows = []
    for (shape, loading), part in measured.groupby(["S", "loading"], sort=False):
        row: dict[str, Any] = {"S": shape, "loading": LOADINGS[loading], "runs": len(part)}
        row["with clusters"] = int((part["empty"] > _CLUSTERED).sum())
        for column in columns:
            row[column] = part[column].median()
        if "E" in columns:
            row["E grows"] = int(part["turned"].sum())
        rows.append(row)
    return pd.DataFrame(rows)


# --- E(t) -----------------------------------------------------------------------------------------


def _growth(measured: pd.DataFrame, grows: pd.Series) -> list[Finding]:
    findings = []
    for claim, shape in (("M-F14.grows", "S4"), ("M-F15.grows", "S7")):
        at_random, here = _random(measured, shape), measured["S"] == shape
        others = "; ".join(
            f"{LOADINGS[loading]}: E / least E = {part['E / least E'].iloc[0]:.2f}"
            for loading, part in measured[here].groupby("loading", sort=False)
            if loading != "random"
        )
        findings.append(
            statement(
                claim,
                bool(grows[at_random].mean() > 0.5),
                f"{_of(grows & at_random, at_random)} random starts turn, at t = "
                f"{measured.loc[at_random & grows, 'least E at t'].median():.2f} (median), and then grow with a "
                f"correlation with t of {measured.loc[at_random & grows, 'linearity'].median():.3f}. {others}.",
                "By then E grows for few of the random starts.",
            )
        )
    return findings


def _traced(measured: pd.DataFrame, clustered: pd.Series) -> Finding:
    """E grows where clusters are and only there: in nine of ten runs with S4 and S7."""
    near = measured["loading"] != "wide"
    with_them, without = clustered & near, ~clustered & near
    turned = measured["turned"]
    prone = measured["S"].isin(["S4", "S7"])
    agree = turned == clustered
    rank = measured.loc[near, ["empty", "E / least E"]].rank()
    correlation = float(np.corrcoef(rank["empty"], rank["E / least E"])[0, 1])
    return statement(
        "M-F14.traced",
        bool(with_them.any() and agree[prone].mean() >= 0.9),
        f"E grows where clusters are, and only there, in {_of(agree & prone, prone)} runs with S4 and S7. "
        f"Started within [-1, 1], E grows in {_of(turned & with_them, with_them)} runs with clusters and in "
        f"{_of(turned & without, without)} without (S4, S7, S8); the rank correlation of its growth with the empty "
        f"part of the line is {correlation:.2f}.",
        "Clusters explain most of the growth, not all: in some runs E grows without clusters, or does not with them.",
    )


def _exponential(
    parameters: Mapping[str, Any], runs: Sequence[Trace], stopped: Sequence[Trace]
) -> Finding:
    near = [run for run in runs if run.shape == "S8" and run.loading != "wide"]
    misfits = []
    for run in near:
        late = run.t >= min(1.0, 0.2 * run.t[-1])
        log_e, t = np.log(run.error[late]), run.t[late]
        fits = [np.polyfit(s, log_e, 1, full=True)[1][0] for s in (t, np.log(t))]
        misfits.append(np.sqrt(np.array(fits) / t.size))
    exponential, power = np.array(misfits).T
    # Wide enough and with enough markers that the tail beyond the fixed grid, and its gaps, do not count.
    changes = parameters["long"]
    end = float(changes["t_final"])
    grid = fixed_grid({**parameters, **changes})
    long = trace(parameters, "S8", "midpoints", **changes)
    half = trace(parameters, "S8", "midpoints", **{**changes, "t_final": 0.5 * end}, follow=False)
    log_at = [float(np.interp(end * part, long.t, np.log(long.error))) for part in (0.25, 0.5, 1.0)]
    slopes = np.diff(log_at) / np.log(2.0)
    late = [delay(grid, run.end.field(grid), run.t[-1]) for run in (half, long)]
    better = int((power < exponential).sum())
    halted = f" {len(stopped)} runs stop: F turns negative at a marker." if stopped else ""
    return statement(
        "M-F16.exponential",
        better < 0.5 * len(near),
        f"In {better} of {len(near)} runs a power of t fits E better from t = 1 on, with a misfit of log E of "
        f"{np.median(power):.3f} against {np.median(exponential):.3f} (medians). In a run with "
        f"{changes['markers']} markers the exponent is {slopes[0]:.2f} over t = {0.25 * end:g} to {0.5 * end:g} and "
        f"{slopes[1]:.2f} to t = {end:g}; F is nearest to the exact solution {late[0][0]:.3f} and {late[1][0]:.3f} "
        f"earlier, which leaves {late[0][1]:.0%} and {late[1][1]:.0%} of E.{halted}",
        "It is closer to a power law: the markers lag behind the exact solution by a nearly fixed time τ, and "
        "f(x, t - τ) - f(x, t) falls like τ t^(-5/4).",
    )
