"""Figs. 11-13: F at the markers, their clusters, and what represents f there."""

from __future__ import annotations

import numpy as np

from fracparticles.markers import shape_function
from fracparticles.markers.clusters import cluster_centres, marker_spectrum
from fracparticles.markers.stability import extremes
from fracstudy.inputs import Inputs, Result, statement
from fracstudy.panels import Panels
from scenes.lewandowski.square_profile import CLOSE, LOADINGS, SHAPES, SquareRuns, Starts, Trace

__all__ = ["study"]

_K = np.linspace(3.0, 12.0, 181)  # eps q of the spectra
_CLUSTER = ("S4", "S7")


def study(inputs: Inputs, *, run: SquareRuns, seed: int, seeds: int, compared: list[str]) -> Result:
    """Find the clusters of the markers, and how well f itself is represented on them.

    The exact solution "by the representation (6)" is sum_k f(x_k) D_k S_eps(x - x_k), with D_k half the distance
    between the neighbours of marker k. Poor results come from poor representation if, on average over the random
    starts, its error is at least half of that of F, and not from the integration in time if dt / 4 changes E by less
    than a tenth. Finite support is the cause of clusters if every shape function with finite support forms them:
    `compared` has two whose Fourier transform is positive.
    """
    square = SquareRuns.model_validate(run)
    starts = Starts(square, (*SHAPES, *compared), range(seed, seed + seeds))
    measured = starts.measured
    measured["representation"] = [
        square.relative_error(_represented(trace, square, square.z)) for trace in starts.runs
    ]
    measured["part"] = measured["representation"] / measured["relative error"]
    share = {s: starts.share(s) for s in (*SHAPES, *compared)}
    power = {s: _mean_spectrum(starts, s, square.support) for s in (*SHAPES, *compared)}
    apart = {s: float(2.0 * np.pi / _K[int(np.argmax(power[s]))]) for s in _CLUSTER}
    onset = {s: extremes(shape_function(s)) for s in SHAPES}
    change = max(_step_change(square, starts, s) for s in _CLUSTER)
    part = {s: starts.mean(s, "part") for s in _CLUSTER}
    error = starts.mean("S8")
    formed = ", ".join(f"{share[s]:.0%} with {s}" for s in (*compared, "S7", "S4"))
    findings = [
        statement(
            "M-F11.distance",
            0.5 <= apart["S4"] <= 2.0,
            f"With S4 {share['S4']:.0%} of the random starts form clusters, {apart['S4']:.2f} ε apart (peak of the "
            "mean spectrum of the markers). The Fourier transform says that they grow fastest "
            f"{onset['S4'].wavelength:.2f} ε apart, by exp({onset['S4'].growth:.2f} t/ε²); then they spread.",
            "The clusters are not about ε apart.",
        ),
        statement(
            "M-F11.representation",
            min(part.values()) >= 0.5 and change < 0.1,
            f"f itself, represented on the markers of the end, has {part['S4']:.0%} of the error of F with S4 and "
            f"{part['S7']:.0%} with S7, on average; a quarter of the time step changes E by {change:.1%} at most.",
            "It explains about half of the error: the clusters also hold the wrong parts of the total.",
        ),
        statement(
            "M-F12.clusters",
            share["S7"] > 0.5,
            f"S7 forms clusters in {share['S7']:.0%} of the random starts, {apart['S7']:.2f} ε apart (fastest at "
            f"{onset['S7'].wavelength:.2f} ε, growth exp({onset['S7'].growth:.2f} t/ε²)).",
            "Started at the midpoints they have not formed by then; at random they form from the noise.",
        ),
        statement(
            "M-F12.cause",
            all(share[s] > 0.5 for s in compared),
            f"Of the random starts, clusters form in {formed}. All these have finite support.",
            f"It is the sign of the Fourier transform: those of {' and '.join(compared)} are positive, and they form "
            "no clusters although their support is finite; where it is negative, perturbations grow.",
        ),
        statement(
            "M-F13.none",
            share["S8"] < 0.5 and error <= CLOSE,
            f"S8 forms clusters in {share['S8']:.0%} of the random starts; the relative error is {error:.3f}. Its "
            "transform (1 + k²/4) exp(-k²/4) is positive.",
            "There are clusters, or the error is above 5 %.",
        ),
    ]
    table = starts.table(["relative error", "representation", "empty"])
    peaks = [apart.get(s, np.nan) for s in table["S"]]
    at_random = table["loading"] == LOADINGS["random"]
    table["distance of clusters / ε"] = np.where(at_random, peaks, np.nan)
    panels = _panels(square, starts)
    for s, mean in power.items():
        panels.add("spectrum", s, _K, mean, loading="random")
    for s in SHAPES:
        panels.add("fastest", s, onset[s].k_growth, 0.0)
    return Result(table, inputs.judged(findings), panels.frame)


def _represented(trace: Trace, square: SquareRuns, z: np.ndarray) -> np.ndarray:
    """f at the markers of the end, each with its cell, as they represent it at z."""
    x = np.sort(trace.end.x)
    return trace.end.velocity.fields(x, square.f(x) * np.gradient(x), z)[0]


def _mean_spectrum(starts: Starts, shape: str, epsilon: float) -> np.ndarray:
    """The mean spectrum of the markers from the random starts."""
    return np.mean(
        [
            marker_spectrum(trace.end.x, _K / epsilon, 4.0 / 3.0 * starts.within)
            for trace in starts.runs
            if (trace.shape, trace.loading) == (shape, "random")
        ],
        axis=0,
    )


def _step_change(square: SquareRuns, starts: Starts, shape: str) -> float:
    """The relative change of E at the end by a quarter of dt, for the random start shown."""
    shown = {(trace.shape, trace.loading): trace for trace in starts.first}
    ours = shown[shape, "random"]
    finer = square.having(dt=0.25 * square.dt)
    fine = finer.trace(shape, "random", ours.seed, follow=False)
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
