"""Profiles along y = 0 and y = x in two dimensions, Fig. 8, and what the truncation does to them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from fracparticles.special.stable import green
from fracstudy.inputs import Inputs, Result, statement
from scenes.beyond.solution_map_2d.study import DISK

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["study"]

_LINES = {"y = 0": "u_axis", "y = x": "u_diagonal"}
_FOLLOWS = 0.1  # a relative error that a logarithmic plot of many decades hardly shows
_OUTER = 0.8  # of a line: beyond it, its outer fifth
_SLIGHT = 2.0  # a slight deviation is less than this factor
_PAPER = ["DD", "FPSE"]


def study(inputs: Inputs) -> Result:
    """Errors along the two lines near and far from the origin, truncated and open."""
    parts, rows = [], []
    for run in inputs.scalars.to_dict("records"):
        key = {"scheme": run["scheme"], "exterior": run["exterior"]}
        stored = inputs.open(**key)
        x, n = stored["x"].values, stored["x"].size // 2
        for line in _LINES:
            u = _along(stored, line)[n:]
            r = x[n:] * (1.0 if line == "y = 0" else np.sqrt(2.0))
            exact = np.asarray(green(r, run["t_final"], 1.0 + run["beta"], 2))
            part = pd.DataFrame({**key, "line": line, "r": r, "u": u, "exact": exact})
            part["error"] = part["u"] / part["exact"] - 1.0
            parts.append(part)
            rows.append({**key, "line": line, **_row(part, x[-1] * (1.0 + 1e-12))})
    series = pd.concat(parts, ignore_index=True)
    table = pd.DataFrame(rows).sort_values(
        ["exterior", "scheme", "line"], ascending=[False, True, True]
    )
    table = table.reset_index(drop=True)
    files = list(inputs.scalars["run"])
    truncated = {
        (scheme, line): part
        for (scheme, exterior, line), part in series.groupby(["scheme", "exterior", "line"])
        if exterior == "truncated" and scheme in _PAPER
    }
    findings = [
        *_shape(truncated, files),
        *_directions(truncated, table, files),
        *_boundary(truncated, table, files),
    ]
    return Result(table, findings, series)


def _along(stored: xr.Dataset, line: str) -> np.ndarray:
    """The strengths along a line; a run that another scene shares may hold the whole field."""
    if "u" not in stored:
        return stored[_LINES[line]].values
    u = stored["u"].values
    return u[:, u.shape[1] // 2] if line == "y = 0" else np.diagonal(u)


def _row(part: pd.DataFrame, half: float) -> dict[str, float]:
    r, error = part["r"], part["error"]
    far, outer = r > DISK, r > _OUTER * r.max()
    return {
        "relative error at r = 0": error.iloc[0],
        "largest, r <= 5": error[~far].abs().max(),
        "mean, 5 < r <= D": error[far & (r <= half)].abs().mean(),
        "largest, r > 5": error[far].abs().max(),
        "median, outer fifth": error[outer].median(),
        "share below exact, outer fifth": float((error[outer] < 0.0).mean()),
        "within 10 % up to r =": r[(error.abs() > _FOLLOWS).cummax()].min(),
    }


def _shape(truncated: dict, files: list[str]) -> list:
    near = {
        key: float(part["error"][part["r"] <= DISK].abs().max()) for key, part in truncated.items()
    }
    anisotropy = {scheme: _anisotropy(truncated, scheme) for scheme in _PAPER}
    slopes = {
        key: (_slope(part, "u"), _slope(part, "exact"))
        for key, part in truncated.items()
        if key[1] == "y = 0"
    }
    reach = {
        key: float(part["r"][(part["error"].abs() > _FOLLOWS).cummax()].min())
        for key, part in truncated.items()
    }
    return [
        statement(
            "L-F8.follow",
            max(near.values()) < _FOLLOWS,
            f"Largest relative error for r <= 5: {_spell(near)}. It stays below 10 % up to r = {_spell(reach)}.",
            "The relative error exceeds 10 % within r <= 5.",
            files,
        ),
        statement(
            "L-F8.radial",
            max(anisotropy.values()) < 0.01
            and max(abs(ours - exact) for ours, exact in slopes.values()) < 0.05,
            "Along y = 0 and y = x, u differs at the same r <= 5 by at most "
            + ", ".join(f"{value:.1g} of itself ({scheme})" for scheme, value in anisotropy.items())
            + "; between r = 2.5 and 5 it falls like "
            + ", ".join(f"r^{ours:.3f} ({key[0]})" for key, (ours, _) in slopes.items())
            + f", the exact solution like r^{next(iter(slopes.values()))[1]:.3f}.",
            "The two lines differ by more than 1 %, or the slopes by more than 0.05.",
            files,
        ),
    ]


def _anisotropy(truncated: dict, scheme: str) -> float:
    """Largest relative difference of u on the two lines at the same r, interpolated as u / exact, r <= 5."""
    axis, diagonal = truncated[scheme, "y = 0"], truncated[scheme, "y = x"]
    inside = diagonal[diagonal["r"] <= DISK]
    other = np.interp(inside["r"], axis["r"], axis["error"])
    return float(np.abs((1.0 + inside["error"]) / (1.0 + other) - 1.0).max())


def _slope(part: pd.DataFrame, column: str) -> float:
    """The logarithmic slope between r = 2.5 and 5."""
    values = np.interp([0.5 * DISK, DISK], part["r"], np.log(part[column].abs()))
    return float((values[1] - values[0]) / np.log(2.0))


def _directions(truncated: dict, table: pd.DataFrame, files: list[str]) -> list:
    """At the same r between the disk and the boundary at r = D: the error on y = 0 over that on y = x."""
    half = truncated["DD", "y = 0"]["r"].max()
    mean, always = {}, {}
    for scheme in _PAPER:
        axis, diagonal = truncated[scheme, "y = 0"], truncated[scheme, "y = x"]
        far = axis[axis["r"] > DISK]
        other = np.interp(far["r"], diagonal["r"], diagonal["error"].abs())
        mean[scheme] = float(far["error"].abs().mean() / other.mean())
        worse = far["error"].abs().to_numpy() > other
        # The last point where y = 0 is the more accurate one.
        last = np.flatnonzero(~worse)
        always[scheme] = float(far["r"].iloc[last[-1] + 1 if last.size else 0])
    opened = _open_ratio(table)
    return [
        statement(
            "L-C19.diagonal",
            min(mean.values()) > 1.0 and max(always.values()) < _OUTER * half,
            f"For 5 < r <= D = {half:.3g} the mean relative error along y = 0 is "
            + ", ".join(f"{ratio:.3g} ({scheme})" for scheme, ratio in mean.items())
            + " times that along y = x at the same r, and at every r from "
            + ", ".join(f"{r:.3g} ({scheme})" for scheme, r in always.items())
            + " on it is the larger one. Nearer, the errors of truncation and of smoothing may cancel.",
            "The error along y = x is not the smaller one.",
            files,
        ),
        statement(
            "L-C19.extent",
            min(mean.values()) > 2.0 and max(abs(ratio - 1.0) for ratio in opened.values()) < 0.1,
            "With the open exterior, where the extent of the square matters no more, the ratio of the mean errors is "
            + ", ".join(f"{ratio:.3f} ({scheme})" for scheme, ratio in opened.items())
            + ".",
            "The difference of the two directions does not go with the truncation.",
            files,
        ),
    ]


def _open_ratio(table: pd.DataFrame) -> dict[str, float]:
    opened = table[table["exterior"] == "open"].set_index(["scheme", "line"])
    column = "mean, 5 < r <= D"
    return {
        scheme: float(opened.loc[(scheme, "y = 0"), column] / opened.loc[(scheme, "y = x"), column])
        for scheme in _PAPER
    }


def _boundary(truncated: dict, table: pd.DataFrame, files: list[str]) -> list:
    rows = table[table["scheme"].isin(_PAPER)].set_index(["exterior", "scheme", "line"])
    median = {key: float(rows.loc[("truncated", *key), "median, outer fifth"]) for key in truncated}
    below = {
        key: float(rows.loc[("truncated", *key), "share below exact, outer fifth"])
        for key in truncated
    }
    ratio = {
        key: (float(part["u"].min() / part["u"].max()), float((1.0 + part["error"]).max()),
              float((1.0 + part["error"]).min()))
        for key, part in truncated.items()
    }  # fmt: skip
    gain = {
        key: abs(median[key] / float(rows.loc[("open", *key), "median, outer fifth"]))
        for key in truncated
    }
    lowest = min(low for key, (_, _, low) in ratio.items() if key[0] == "DD")
    highest = max(high for key, (_, high, _) in ratio.items() if key[0] == "FPSE")
    negative = min(low for key, (_, _, low) in ratio.items() if key[0] == "FPSE")
    layer = max(_particles_from_the_edge(truncated["FPSE", line], _OUTER) for line in _LINES)
    dd, fpse = ({k: v for k, v in median.items() if k[0] == scheme} for scheme in _PAPER)
    shares = {scheme: {k: v for k, v in below.items() if k[0] == scheme} for scheme in _PAPER}
    return [
        statement(
            "L-C19.dd_below",
            max(dd.values()) < 0.0 and min(shares["DD"].values()) > 0.9,
            f"Median relative deviation in the outer fifth of each line: {_spell(dd)}; below the exact solution there: "
            f"{_percent(shares['DD'])} of the particles.",
            "DD is not below the exact solution there.",
            files,
        ),
        statement(
            "L-C19.fpse_above",
            min(fpse.values()) > 0.0 and max(shares["FPSE"].values()) < 0.25,
            f"Median relative deviation in the outer fifth of each line: {_spell(fpse)}; below the exact solution "
            f"there: {_percent(shares['FPSE'])} of the particles, none further than {layer} particles from the edge.",
            "FPSE is not above the exact solution there.",
            files,
        ),
        statement(
            "L-C19.slightly",
            lowest > 1.0 / _SLIGHT and negative > 1.0 / _SLIGHT and highest < _SLIGHT,
            f"At the edge u is down to {lowest:.2g} times the exact solution with DD; with FPSE it is between "
            f"{negative:.2g} and {highest:.2g} times the exact solution.",
            "Slight only within the square: at its edge DD loses most of u, and FPSE has a layer, a few smoothing "
            "lengths thick, that oscillates and even becomes negative.",
            files,
        ),
        statement(
            "L-C19.truncation",
            min(gain.values()) > 10.0,
            "With the open exterior the median deviation in the outer fifth is "
            + ", ".join(f"{value:.3g} ({' '.join(key)})" for key, value in gain.items())
            + " times smaller.",
            "The deviations at the boundary stay with the open exterior.",
            files,
        ),
    ]


def _particles_from_the_edge(part: pd.DataFrame, outer: float) -> int:
    """How far inward of the end of a line, from `outer` of its length on, u lies below the exact solution."""
    r, below = part["r"].to_numpy(), part["error"].to_numpy() < 0.0
    found = np.flatnonzero(below & (r > outer * r[-1]))
    return int(r.size - found[0]) if found.size else 0


def _spell(values: dict[tuple[str, str], float]) -> str:
    return ", ".join(f"{value:.2g} ({scheme}, {line})" for (scheme, line), value in values.items())


def _percent(values: dict[tuple[str, str], float]) -> str:
    return ", ".join(f"{100.0 * value:.0f} % ({line})" for (_, line), value in values.items())
