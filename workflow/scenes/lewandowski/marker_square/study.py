"""Figs. 5-7: the square profile with a small, a large and an intermediate support parameter."""

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from scipy.linalg import expm
from scipy.ndimage import gaussian_filter1d

from fracparticles.markers import shape_function
from fracparticles.special.ends import heat_kernel
from fracstudy.errors import off
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels
from scenes.lewandowski.square_profile import LOADINGS, SQUARE, SquareRuns, Trace, delay

_COARSE = 1.0  # the half-width of the square: what "large scale features" are


def study(
    inputs: Inputs, *, run: SquareRuns, supports: list[float], shown: list[float], seed: int
) -> Result:
    """Run the square profile with S8 for a range of support parameters and every start.

    `shown` are the small, the large and the intermediate one of Figs. 5, 6, 7. A run whose F turns negative at a marker
    has no results, but says when and where. The slope is the largest |F_x| on the fixed grid against the largest |f_x|,
    the delay that of the exact solution nearest to F. Maxima count above a hundredth of the largest.
    """
    square = SquareRuns.model_validate(run)
    rows, panels = [], Panels()
    readings: dict[str, pd.DataFrame] = {}
    panels.add("field", "exact", square.z, square.exact)
    seeds = {title: (loading, seed) for loading, title in LOADINGS.items()}
    for title, (loading, number) in {**seeds, "another seed": ("random", seed + 1)}.items():
        found: dict[float, dict[str, Any]] = {}
        for epsilon in sorted({*supports, *shown}):
            trace = square.having(support=epsilon).trace("S8", loading, number, follow=False)
            row: dict[str, Any] = {"loading": title, "ε": epsilon}
            if trace.run:
                found[epsilon] = {**_measured(square, trace), **_apart(square, trace, epsilon)}
                row |= {name: m for name, m in found[epsilon].items() if name not in _UNTABLED}
            if title in seeds:
                rows.append({**row, "stopped": trace.stopped.split(": a velocity")[0]})
            if title in seeds and trace.run:
                panels.add("field", loading, square.z, trace.end.field(square.z), support=epsilon)
                panels.add("error", loading, epsilon, row["relative error"])
                panels.add("slope", loading, epsilon, row["largest slope / exact"])
        readings[title] = pd.DataFrame(found).T
    table = pd.DataFrame(rows)
    table["stopped"] = table.pop("stopped")  # last, also if the first run stopped
    findings = _findings(square, readings, *map(float, shown))
    return Result(table, inputs.judged(findings), panels.frame)


def _measured(square: SquareRuns, trace: Trace) -> dict[str, Any]:
    z, end, exact = square.z, trace.end, square.exact
    step = z[1] - z[0]
    f, slope = end.velocity.fields(end.x, end.weights, z)
    inner = f[1:-1]
    maxima = (inner > f[:-2]) & (inner >= f[2:]) & (inner > 0.01 * f.max())
    tau, left = delay(z, f, square.t_final)
    norm = np.sqrt(step * np.sum(exact**2))
    return {
        "relative error": np.sqrt(step * np.sum((f - exact) ** 2)) / norm,
        "largest slope / exact": np.abs(slope).max() / np.abs(SQUARE.slope(z, square.t_final)).max(),
        "F(0) / f(0)": square.peak(f),
        "maxima": int(np.sum(maxima)),
        "delay": tau,
        "error left by the delay": left,
    }  # fmt: skip


_UNTABLED = ("excess of the coarse slope", "from the smoothed f", "steepest at", "gap there / ε")


def _apart(square: SquareRuns, trace: Trace, epsilon: float) -> dict[str, float]:
    """The slope of what is wider than the square in F, the distance of F from S_eps * f, and where F is steepest."""
    z, f, exact = square.z, trace.end.field(square.z), square.exact
    step = z[1] - z[0]
    wide = partial(gaussian_filter1d, sigma=_COARSE / step, mode="constant")
    coarse, coarse_exact = (np.abs(np.gradient(wide(g), step)).max() for g in (f, exact))
    steepest = z[np.abs(np.gradient(f, step)).argmax()]
    x = np.sort(trace.end.x)
    gap = np.interp(steepest, 0.5 * (x[1:] + x[:-1]), np.diff(x))
    kernel = shape_function("S8")((z[:, None] - z) / epsilon) / epsilon
    smoothed = step * kernel @ exact
    return {
        "excess of the coarse slope": float(coarse / coarse_exact - 1.0),
        "from the smoothed f": float(np.linalg.norm(f - smoothed) / np.linalg.norm(f - exact)),
        "steepest at": float(abs(steepest)),
        "gap there / ε": float(gap / epsilon),
    }


def _findings(
    square: SquareRuns, readings: dict[str, pd.DataFrame], small: float, large: float, middle: float
) -> Iterator[Finding]:
    """Each by the midpoints of [-1, 1], and by the other starts that the print leaves open."""

    def found(claim: str, epsilon: float, shift: float = 0.0, **columns: str) -> Finding:
        each = {
            title: {name: of.loc[epsilon, column] - shift for name, column in columns.items()}
            for title, of in readings.items()
            if epsilon in of.index
        }
        numbers = each.pop(next(iter(each)))
        return measured(claim, others=each, **numbers)

    def supports(of: pd.DataFrame) -> dict[str, Any]:
        """The error at the intermediate eps over the least one, and the greatest over the least."""
        error, best = of["relative error"], of["relative error"].idxmin()
        few = error.reindex([small, middle, large]).min()
        ratio = {"of the three of Figs. 5 to 7": error[middle] / few}
        ratio["of all that were tried"] = error[middle] / error[best]
        excess = {name: m - 1.0 for name, m in ratio.items()}
        return {"ratio": ratio, "excess": excess, "best": best, "range": error.max() / error[best]}

    yield measured("M-F5.exact", gap=_closed_form(square))
    yield found("M-F5.slope", small, 1.0, excess="largest slope / exact")
    coarse, gap = "excess of the coarse slope", "gap there / ε"
    yield found("M-F5.cause", small, excess=coarse, place="steepest at", gap=gap)
    yield found("M-F5.oscillates", small, maxima="maxima")
    slope, left = "largest slope / exact", "error left by the delay"
    yield found("M-F6.slope", large, slope=slope, late="delay", left=left)
    yield found("M-F6.smoothed", large, peak="F(0) / f(0)", distance="from the smoothed f")
    yield found("M-F7.good", middle, error="relative error")
    others = {title: supports(of) for title, of in readings.items() if middle in of.index}
    ours = others.pop(next(iter(others)))
    for claim in ("M-F7.optimal", "M-F7.crucial"):
        yield measured(claim, others=others, **ours)
    error, lines = readings[LOADINGS["midpoints"]]["relative error"], _lines(square)
    ratio = {f"ε = {middle:g}": error[middle] / lines, "the best ε": error.min() / lines}
    yield measured("M-F7.accuracy", ratio=ratio, lines=lines)


def _closed_form(square: SquareRuns) -> float:
    """The difference of the two erf from the integral over the square, by Gauss's rule, relative to the maximum."""
    nodes, weights = np.polynomial.legendre.leggauss(64)
    heat = heat_kernel(square.z[:, None] - nodes, square.t_final)
    return off(heat @ weights, square.exact)


def _lines(square: SquareRuns) -> float:
    """The relative error of second differences, in as many cells of [-L, L] as there are markers, exact in time."""
    h = 2.0 * square.half_width / square.markers
    x = -square.half_width + h * (np.arange(square.markers) + 0.5)
    inside = np.clip((1.0 - np.abs(x)) / h + 0.5, 0.0, 1.0)  # the part of a cell
    second = (np.eye(x.size, k=1) - 2.0 * np.eye(x.size) + np.eye(x.size, k=-1)) / h**2
    f, exact = expm(square.t_final * second) @ inside, square.f(x)
    return float(np.linalg.norm(f - exact) / np.linalg.norm(exact))
