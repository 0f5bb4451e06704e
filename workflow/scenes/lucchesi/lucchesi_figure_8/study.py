"""Profiles along y = 0 and y = x in two dimensions, Fig. 8, and what the truncation does to them."""

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np
import pandas as pd

from fracparticles.special.stable import green
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import pick
from scenes.plane import DISC

NEEDS = {"scheme": ["DD", "FPSE"], "exterior": ["truncated", "open"]}

_LINES = {"y = 0": ("u_axis", 1.0), "y = x": ("u_diagonal", np.sqrt(2.0))}
_FOLLOWS = 0.1  # a relative error that a logarithmic plot of many decades hardly shows
_OUTER = 0.8  # of a line: beyond it, its outer fifth
_NEAR, _MEAN, _REACH = "largest, r <= 5", "mean, 5 < r <= D", "within 10 % up to r ="
_MEDIAN, _BELOW = "median, outer fifth", "share below exact, outer fifth"

_Curves = dict[tuple[str, str], pd.DataFrame]  # by scheme and line


def study(inputs: Inputs) -> Result:
    """Errors along the two lines near and far from the origin, truncated and open."""
    parts, rows = [], []
    for run in inputs.scalars.to_dict("records"):
        where = {"scheme": run["scheme"], "exterior": run["exterior"]}
        stored = inputs.open(**where)
        x, n = stored["x"].values, stored["x"].size // 2
        for line, (name, stretch) in _LINES.items():
            if "u" in stored:  # a run that another scene shares may hold the whole field
                field = stored["u"].values
                u = field[:, n] if line == "y = 0" else np.diagonal(field)
            else:
                u = stored[name].values
            r = x[n:] * stretch
            exact = np.asarray(green(r, run["t_final"], 1.0 + run["beta"], 2))
            part = pd.DataFrame({**where, "line": line, "r": r, "u": u[n:], "exact": exact})
            part["error"] = part["u"] / part["exact"] - 1.0
            parts.append(part)
            rows.append({**where, "line": line, **_row(part, x[-1] * (1.0 + 1e-12))})
    series = pd.concat(parts, ignore_index=True)
    key, down = ["exterior", "scheme", "line"], [False, True, True]
    table = pd.DataFrame(rows).sort_values(key, ascending=down, ignore_index=True)
    findings = _findings(series, table, list(inputs.scalars["run"]))
    return Result(table, inputs.judged(findings), series)


def _row(part: pd.DataFrame, half: float) -> dict[str, float]:
    r, error = part["r"], part["error"]
    far, outer = r > DISC, r > _OUTER * r.max()
    return {
        "relative error at r = 0": error.iloc[0],
        _NEAR: error[~far].abs().max(),
        _MEAN: error[far & (r <= half)].abs().mean(),
        "largest, r > 5": error[far].abs().max(),
        _MEDIAN: error[outer].median(),
        _BELOW: float((error[outer] < 0.0).mean()),
        _REACH: r[(error.abs() > _FOLLOWS).cummax()].min(),
    }


def _findings(series: pd.DataFrame, table: pd.DataFrame, files: list[str]) -> Iterator[Finding]:
    """What the paper says of DD and FPSE, truncated: near the origin, in the two directions, at the boundary."""
    paper = NEEDS["scheme"]
    rows = table[table["scheme"].isin(paper)].set_index(["exterior", "scheme", "line"])
    here, opened = rows.loc["truncated"], rows.loc["open"]
    truncated = pick(series, exterior="truncated")
    truncated = truncated[truncated["scheme"].isin(paper)]
    curves: _Curves = dict(iter(truncated.groupby(["scheme", "line"])))

    def by_curve(quantity: Callable[[pd.DataFrame], float]) -> pd.Series:
        return pd.Series({key: quantity(part) for key, part in curves.items()})

    slope = pd.Series({scheme: _slope(curves[scheme, "y = 0"], "u") for scheme in paper})
    exact_slope = _slope(curves["DD", "y = 0"], "exact")
    decades = by_curve(lambda part: np.log10(part["exact"].max() / part["exact"].min()))
    directions = {scheme: _directions(curves, scheme) for scheme in paper}
    axis, diagonal = (opened[_MEAN].xs(line, level="line") for line in ("y = 0", "y = x"))
    median, below, ratio = here[_MEDIAN], here[_BELOW], 1.0 + truncated["error"]
    ratio = ratio.groupby([truncated["scheme"], truncated["line"]])
    logarithms = np.log10(1.0 + median).abs() / decades
    found = partial(measured, runs=files)
    far = by_curve(_plotted) / decades
    yield found("L-F8.follow", near=here[_NEAR], far=far, reach=here[_REACH])
    yield found(
        "L-F8.radial",
        anisotropy={scheme: _anisotropy(curves, scheme) for scheme in paper},
        decay=(slope / exact_slope - 1.0).abs(),
        slope=slope,
        exact=exact_slope,
    )
    yield found(
        "L-C19.diagonal",
        ratio={scheme: ratio for scheme, (ratio, _) in directions.items()},
        always={scheme: r for scheme, (_, r) in directions.items()},
        half=curves["DD", "y = 0"]["r"].max(),
    )
    yield found("L-C19.extent", difference=(axis / diagonal - 1.0).abs())
    yield found("L-C19.dd_below", median=median[["DD"]], share=100.0 * below[["DD"]])
    layer = max(_particles_from_the_edge(curves["FPSE", line]) for line in _LINES)
    share = 100.0 * (1.0 - below[["FPSE"]])
    yield found("L-C19.fpse_above", median=median[["FPSE"]], share=share, layer=layer)
    yield found(
        "L-C19.slightly",
        deviation=median.abs(),
        least=ratio.min(),
        greatest=ratio.max(),
        others={"the decades that are plotted for the value": {"deviation": logarithms}},
    )
    yield found("L-C19.truncation", gain=(median / opened[_MEDIAN]).abs())


def _plotted(part: pd.DataFrame) -> float:
    """The largest |log10(u / exact)| from the disc to the outer fifth of a line."""
    between = (part["r"] > DISC) & (part["r"] <= _OUTER * part["r"].max())
    return float(np.abs(np.log10(1.0 + part["error"][between])).max())


def _anisotropy(curves: _Curves, scheme: str) -> float:
    """Largest relative difference of u on the two lines at the same r, interpolated as u / exact, r <= 5."""
    axis, diagonal = curves[scheme, "y = 0"], curves[scheme, "y = x"]
    inside = diagonal[diagonal["r"] <= DISC]
    other = np.interp(inside["r"], axis["r"], axis["error"])
    return float(np.abs((1.0 + inside["error"]) / (1.0 + other) - 1.0).max())


def _slope(part: pd.DataFrame, column: str) -> float:
    """The logarithmic slope between r = 2.5 and 5."""
    values = np.interp([0.5 * DISC, DISC], part["r"], np.log(part[column].abs()))
    return float((values[1] - values[0]) / np.log(2.0))


def _directions(curves: _Curves, scheme: str) -> tuple[float, float]:
    """Outside the disc: the mean error on y = 0 over that on y = x at the same r; from which r on it is the larger."""
    axis, diagonal = curves[scheme, "y = 0"], curves[scheme, "y = x"]
    far = axis[axis["r"] > DISC]
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
