"""Figs. 11-13: F at the markers, their clusters, and what represents f there."""

from typing import Any

import numpy as np
import pandas as pd

from fracparticles.markers.clusters import cluster_centres, marker_spectrum
from fracparticles.markers.stability import extremes
from fracstudy.findings import measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from scenes.lewandowski import square_profile
from scenes.lewandowski.square_profile import INFINITE, LOADINGS, SHAPES, SquareRuns, Starts, shape

_K = np.linspace(3.0, 12.0, 181)  # eps q of the spectra
_CLUSTER = ("S4", "S7")


def study(inputs: Inputs, *, run: SquareRuns, seed: int, seeds: int, compared: list[str]) -> Result:
    """Find the clusters of the markers, and how well f itself is represented on them.

    The exact solution "by the representation (6)" is sum_k f(x_k) D_k S_eps(x - x_k), with D_k half the distance
    between the neighbours of marker k. `compared` have finite support, as S4 and S7, and a positive Fourier transform;
    `INFINITE` has infinite support and one that turns negative. Random starts are judged by their mean, and by that of
    as many others.
    """
    square = SquareRuns.model_validate(run)
    shapes, first = (*SHAPES, *compared), range(seed, seed + seeds)
    again = range(seed + seeds, seed + 2 * seeds)
    starts = Starts(square, shapes, first)
    starts.measured["representation"] = _representations(square, starts)
    ours = _numbers(square, starts, first, compared)
    others = _numbers(square, Starts(square, shapes, again), again, compared)
    change = {s: _step_change(square, starts, s) for s in _CLUSTER}
    integration = measured("M-F11.integration", change=change)
    findings = [*square_profile.with_other_seeds(ours, others), integration]
    table = starts.table(["relative error", "representation", "empty"])
    apart = ours["M-F11.distance"]["apart"]
    peaks = [apart.get(s, np.nan) for s in table["S"]]
    at_random = table["loading"] == LOADINGS["random"]
    table["distance of clusters / ε"] = np.where(at_random, peaks, np.nan)
    panels = _panels(square, starts)
    for s in shapes:
        spectrum = _mean_spectrum(starts, s, square.support)
        panels.add("spectrum", s, _K, spectrum, loading="random")
    for s in SHAPES:
        panels.add("fastest", s, extremes(shape(s)).k_growth, 0.0)
    return Result(table, inputs.judged(findings), panels.frame)


def _numbers(
    square: SquareRuns, starts: Starts, seeds: range, compared: list[str]
) -> dict[str, dict[str, Any]]:
    """What is measured of these starts for each claim."""
    more = Starts(square, ("S3", "S6", INFINITE.name), seeds)
    share = {s: starts.share(s) for s in (*SHAPES, *compared)}
    share |= {s: more.share(s) for s in ("S3", "S6", INFINITE.name)}
    error = {s: starts.mean(s) for s in (*SHAPES, *compared)}
    error[INFINITE.name] = more.mean(INFINITE.name)
    over_s4 = {s: e / error["S4"] for s, e in error.items()}
    part = pd.Series(_representations(square, starts)) / starts.measured["relative error"]
    spectra = {s: _mean_spectrum(starts, s, square.support) for s in _CLUSTER}
    apart = {s: float(2.0 * np.pi / _K[int(np.argmax(mean))]) for s, mean in spectra.items()}
    onset = {s: extremes(shape(s)) for s in _CLUSTER}
    return {
        "M-F11.distance": {
            "factor": {s: max(d, 1.0 / d) for s, d in apart.items()},
            "apart": apart,
            "fastest": {s: found.wavelength for s, found in onset.items()},
            "growth": {s: found.growth for s, found in onset.items()},
        },
        "M-F11.representation": {"part": {s: part[starts.random(s)].mean() for s in _CLUSTER}},
        "M-F12.clusters": {"share": share["S7"]},
        "M-F12.cause": {
            "finite": {s: share[s] for s in compared},
            "infinite": {INFINITE.name: share[INFINITE.name]},
        },
        "M-F12.finite": {"share": {f"S{n}": share[f"S{n}"] for n in range(2, 8) if f"S{n}" in share}},
        "M-F13.none": {
            "empty": starts.measured["empty"][starts.random("S8")].max(),
            "error": error["S8"],
            "share": share["S8"],
        },
        "M-F13.smooth": {"ratio": {s: over_s4[s] for s in ("S8", INFINITE.name)}},
        "M-F13.because": {"ratio": {s: over_s4[s] for s in compared}},
    }  # fmt: skip


def _representations(square: SquareRuns, starts: Starts) -> list[float]:
    """The relative error of f itself as the markers of the end represent it, of every run."""
    return [square.relative_error(_represented(trace, square, square.z)) for trace in starts.runs]


def _represented(trace: square_profile.Trace, square: SquareRuns, z: np.ndarray) -> np.ndarray:
    """f at the markers of the end, each with its cell, as they represent it at z."""
    x = np.sort(trace.end.x)
    return trace.end.velocity.fields(x, square.f(x) * np.gradient(x), z)[0]


def _mean_spectrum(starts: Starts, name: str, epsilon: float) -> np.ndarray:
    """The mean spectrum of the markers from the random starts."""
    spectra = [
        marker_spectrum(trace.end.x, _K / epsilon, 4.0 / 3.0 * starts.within)
        for trace in starts.runs
        if (trace.shape, trace.loading) == (name, "random")
    ]
    return np.mean(spectra, axis=0)


def _step_change(square: SquareRuns, starts: Starts, name: str) -> float:
    """The relative change of E at the end by a quarter of dt, for the random start shown."""
    shown = {(trace.shape, trace.loading): trace for trace in starts.first}
    ours = shown[name, "random"]
    finer = square.having(dt=0.25 * square.dt)
    fine = finer.trace(name, "random", ours.seed, follow=False)
    return float(abs(fine.error[-1] / ours.error[-1] - 1.0)) if fine.run else float("inf")


def _panels(square: SquareRuns, starts: Starts) -> Panels:
    """Panels "field", "exact" and "representation" at the sorted markers; "centres" of clusters, y in units of eps."""
    panels = Panels()
    for trace in starts.first:
        if trace.shape in SHAPES:
            x = np.sort(trace.end.x)
            shown = {
                "field": trace.end.field(x),
                "exact": square.f(x),
                "representation": _represented(trace, square, x),
            }
            for panel, y in shown.items():
                panels.add(panel, trace.shape, x, y, loading=trace.loading)
            centres = cluster_centres(trace.end.x, starts.gap, starts.within)
            in_eps = centres / square.support
            panels.add("centres", trace.shape, centres, in_eps, loading=trace.loading)
    return panels
