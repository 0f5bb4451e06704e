"""Profiles along y = 0 and y = x in two dimensions, Fig. 8, and what the truncation does to them."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracparticles.special.stable import green
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from scenes.plane import DISK

__all__ = ["study"]

NEEDS = {"scheme": ["DD", "FPSE"], "exterior": ["truncated", "open"]}

_LINES = {"y = 0": ("u_axis", 1.0), "y = x": ("u_diagonal", np.sqrt(2.0))}
_FOLLOWS = 0.1  # a relative error that a logarithmic plot of many decades hardly shows
_OUTER = 0.8  # of a line: beyond it, its outer fifth
_SLIGHT = 2.0  # a slight deviation is less than this factor
_NEAR, _MEAN, _REACH = "largest, r <= 5", "mean, 5 < r <= D", "within 10 % up to r ="
_MEDIAN, _BELOW = "median, outer fifth", "share below exact, outer fifth"

_Curves = dict[tuple[str, str], pd.DataFrame]  # by scheme and line


def study(inputs: Inputs) -> Result:
    """Errors along the two lines near and far from the origin, truncated and open."""
    parts, rows = [], []
    for run in inputs.scalars.to_dict("records"):
        key = {"scheme": run["scheme"], "exterior": run["exterior"]}
        stored = inputs.open(**key)
        x, n = stored["x"].values, stored["x"].size // 2
        for line, (name, stretch) in _LINES.items():
            if "u" in stored:  # a run that another scene shares may hold the whole field
                field = stored["u"].values
                u = field[:, n] if line == "y = 0" else np.diagonal(field)
            else:
                u = stored[name].values
            r = x[n:] * stretch
            exact = np.asarray(green(r, run["t_final"], 1.0 + run["beta"], 2))
            part = pd.DataFrame({**key, "line": line, "r": r, "u": u[n:], "exact": exact})
            part["error"] = part["u"] / part["exact"] - 1.0
            parts.append(part)
            rows.append({**key, "line": line, **_row(part, x[-1] * (1.0 + 1e-12))})
    series = pd.concat(parts, ignore_index=True)
    table = pd.DataFrame(rows).sort_values(
        ["exterior", "scheme", "line"], ascending=[False, True, True], ignore_index=True
    )
    findings = _findings(series, table, list(inputs.scalars["run"]))
    return Result(table, inputs.judged(findings), series)


def _row(part: pd.DataFrame, half: float) -> dict[str, float]:
    r, error = part["r"], part["error"]
    far, outer = r > DISK, r > _OUTER * r.max()
    return {
        "relative error at r = 0": error.iloc[0],
        _NEAR: error[~far].abs().max(),
        _MEAN: error[far & (r <= half)].abs().mean(),
        "largest, r > 5": error[far].abs().max(),
        _MEDIAN: error[outer].median(),
        _BELOW: float((error[outer] < 0.0).mean()),
        _REACH: r[(error.abs() > _FOLLOWS).cummax()].min(),
    }


def _findings(series: pd.DataFrame, table: pd.DataFrame, files: list[str]) -> list[Finding]:
    """What the paper says of DD and FPSE, truncated: near the origin, in the two directions, at the boundary."""
    paper = NEEDS["scheme"]
    rows = table[table["scheme"].isin(paper)].set_index(["exterior", "scheme", "line"])
    here, opened = rows.loc["truncated"], rows.loc["open"]
    truncated = series[(series["exterior"] == "truncated") & series["scheme"].isin(paper)]
    curves: _Curves = dict(iter(truncated.groupby(["scheme", "line"])))

    anisotropy = {scheme: _anisotropy(curves, scheme) for scheme in paper}
    slope = {scheme: _slope(curves[scheme, "y = 0"], "u") for scheme in paper}
    exact_slope = _slope(curves["DD", "y = 0"], "exact")
    directions = {scheme: _directions(curves, scheme) for scheme in paper}
    mean = {scheme: ratio for scheme, (ratio, _) in directions.items()}
    always = {scheme: r for scheme, (_, r) in directions.items()}
    open_mean = opened[_MEAN].xs("y = 0", level="line") / opened[_MEAN].xs("y = x", level="line")
    half = curves["DD", "y = 0"]["r"].max()
    dd, fpse = here.loc["DD"], here.loc["FPSE"]
    ratio = truncated.assign(ratio=1.0 + truncated["error"]).groupby("scheme")["ratio"]
    (lowest, negative), highest = ratio.min()[paper], ratio.max()["FPSE"]
    layer = max(_particles_from_the_edge(curves["FPSE", line]) for line in _LINES)
    gain = (here[_MEDIAN] / opened[_MEDIAN]).abs()
    statements = [
        (
            "L-F8.follow",
            here[_NEAR].max() < _FOLLOWS,
            f"Largest relative error for r <= 5: {_pairs(here[_NEAR])}. It stays below 10 % up to r = "
            f"{_pairs(here[_REACH])}.",
            "The relative error exceeds 10 % within r <= 5.",
        ),
        (
            "L-F8.radial",
            max(anisotropy.values()) < 0.01
            and max(abs(ours - exact_slope) for ours in slope.values()) < 0.05,
            f"Along y = 0 and y = x, u differs at the same r <= 5 by at most "
            f"{_each(anisotropy, '{:.1g} of itself')}; between r = 2.5 and 5 it falls like {_each(slope, 'r^{:.3f}')}, "
            f"the exact solution like r^{exact_slope:.3f}.",
            "The two lines differ by more than 1 %, or the slopes by more than 0.05.",
        ),
        (
            "L-C19.diagonal",
            min(mean.values()) > 1.0 and max(always.values()) < _OUTER * half,
            f"For 5 < r <= D = {half:.3g} the mean relative error along y = 0 is {_each(mean, '{:.3g}')} times that "
            f"along y = x at the same r, and at every r from {_each(always, '{:.3g}')} on it is the larger one. "
            "Nearer, the errors of truncation and of smoothing may cancel.",
            "The error along y = x is not the smaller one.",
        ),
        (
            "L-C19.extent",
            min(mean.values()) > 2.0 and (open_mean - 1.0).abs().max() < 0.1,
            "With the open exterior, where the extent of the square matters no more, the ratio of the mean errors is "
            f"{_each(open_mean, '{:.3f}')}.",
            "The difference of the two directions does not go with the truncation.",
        ),
        (
            "L-C19.dd_below",
            dd[_MEDIAN].max() < 0.0 and dd[_BELOW].min() > 0.9,
            f"Median relative deviation in the outer fifth of each line: {_pairs(here[_MEDIAN][['DD']])}; below the "
            f"exact solution there: {_each(100.0 * dd[_BELOW], '{:.0f} %')} of the particles.",
            "DD is not below the exact solution there.",
        ),
        (
            "L-C19.fpse_above",
            fpse[_MEDIAN].min() > 0.0 and fpse[_BELOW].max() < 0.25,
            f"Median relative deviation in the outer fifth of each line: {_pairs(here[_MEDIAN][['FPSE']])}; below the "
            f"exact solution there: {_each(100.0 * fpse[_BELOW], '{:.0f} %')} of the particles, none further than "
            f"{layer} particles from the edge.",
            "FPSE is not above the exact solution there.",
        ),
        (
            "L-C19.slightly",
            min(lowest, negative) > 1.0 / _SLIGHT and highest < _SLIGHT,
            f"At the edge u is down to {lowest:.2g} times the exact solution with DD; with FPSE it is between "
            f"{negative:.2g} and {highest:.2g} times the exact solution.",
            "Slight only within the square: at its edge DD loses most of u, and FPSE has a layer, a few smoothing "
            "lengths thick, that oscillates and even becomes negative.",
        ),
        (
            "L-C19.truncation",
            gain.min() > 10.0,
            "With the open exterior the median deviation in the outer fifth is "
            + ", ".join(f"{value:.3g} ({' '.join(key)})" for key, value in gain.items())
            + " times smaller.",
            "The deviations at the boundary stay with the open exterior.",
        ),
    ]
    return [statement(*words, runs=files) for words in statements]


def _anisotropy(curves: _Curves, scheme: str) -> float:
    """Largest relative difference of u on the two lines at the same r, interpolated as u / exact, r <= 5."""
    axis, diagonal = curves[scheme, "y = 0"], curves[scheme, "y = x"]
    inside = diagonal[diagonal["r"] <= DISK]
    other = np.interp(inside["r"], axis["r"], axis["error"])
    return float(np.abs((1.0 + inside["error"]) / (1.0 + other) - 1.0).max())


def _slope(part: pd.DataFrame, column: str) -> float:
    """The logarithmic slope between r = 2.5 and 5."""
    values = np.interp([0.5 * DISK, DISK], part["r"], np.log(part[column].abs()))
    return float((values[1] - values[0]) / np.log(2.0))


def _directions(curves: _Curves, scheme: str) -> tuple[float, float]:
    """Outside the disk: the mean error on y = 0 over that on y = x at the same r; from which r on it is the larger."""
    axis, diagonal = curves[scheme, "y = 0"], curves[scheme, "y = x"]
    far = axis[axis["r"] > DISK]
    other = np.interp(far["r"], diagonal["r"], diagonal["error"].abs())
    # The last point where y = 0 is the more accurate one.
    last = np.flatnonzero(far["error"].abs() <= other)
    first = float(far["r"].iloc[last[-1] + 1 if last.size else 0 :].min())
    return float(far["error"].abs().mean() / other.mean()), first


def _particles_from_the_edge(part: pd.DataFrame) -> int:
    """How far inward of the end of a line, in its outer fifth, u lies below the exact solution."""
    r, below = part["r"].to_numpy(), part["error"].to_numpy() < 0.0
    found = np.flatnonzero(below & (r > _OUTER * r[-1]))
    return int(r.size - found[0]) if found.size else 0


def _pairs(values: pd.Series) -> str:
    return ", ".join(f"{value:.2g} ({scheme}, {line})" for (scheme, line), value in values.items())


def _each(values: dict[str, float] | pd.Series, form: str) -> str:
    return ", ".join(f"{form.format(value)} ({name})" for name, value in values.items())
