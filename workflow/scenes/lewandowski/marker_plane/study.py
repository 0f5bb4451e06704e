"""Loading markers in the plane by decoupled marginals, Sec. 2.2."""

from collections.abc import Callable, Iterator, Mapping
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.markers import SHAPES
from fracparticles.markers.plane import TwoBlobs, decoupled, reconstruct, sequential, weighted
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels, pick

Loading = tuple[np.ndarray, np.ndarray, np.ndarray]

_PAPER, _WEIGHTED, _SEQUENTIAL = "decoupled", "decoupled, weighted", "x first, then y"
_WAYS: dict[str, Callable[[TwoBlobs, int], Loading]] = {
    _PAPER: lambda f, n: decoupled(f.quantile, f.total, (n, n)),
    _WEIGHTED: lambda f, n: weighted(f, (n, n)),
    _SEQUENTIAL: lambda f, n: sequential(f, (n, n)),
}
_PER_EPS = 10.0  # markers, for the number of neighbours


def study(
    inputs: Inputs,
    *,
    a: list[float],
    per_axis: list[int],
    support: float,
    half_width: float,
    grid: int,
    shown: dict[str, Any],
) -> Result:
    """Load `TwoBlobs` in three ways, compare F with f and the product of the marginals, and let a Gaussian spread."""
    z = np.linspace(-half_width, half_width, grid)
    x, y = np.meshgrid(z, z, indexing="ij")
    cell = (z[1] - z[0]) ** 2

    def distance(one: np.ndarray, other: np.ndarray) -> float:
        return cell * float(np.abs(one - other).sum()) / TwoBlobs(0.0).total

    def field(markers: Loading) -> np.ndarray:
        return reconstruct(SHAPES["S8"], support, markers, z, z)

    rows, even = [], {}
    for part in a:
        density = TwoBlobs(part)
        f, independent = density.value(x, y), density.product(x, y)
        even[part] = distance(field(_even(density, per_axis[-1], half_width)), f)
        for (name, load), n in product(_WAYS.items(), per_axis):
            markers = load(density, n)
            ours, w = field(markers), markers[2]
            row = {
                "a": part,
                "loading": name,
                "N": w.size,
                "relative L1 error": distance(ours, f),
                "F against the product": distance(ours, independent),
                "f against the product": distance(f, independent),
                "total / sigma": float(w.sum()) / density.total,
                "effective part of the markers": float(w.sum() ** 2 / (w * w).sum() / w.size),
            }
            rows.append(row)
    table, panels = pd.DataFrame(rows), Panels()
    finest = pick(table, N=table["N"].max())
    panels.add("errors", finest["loading"], finest["a"], finest["relative L1 error"])
    for part in np.linspace(0.0, a[-1], 41):
        density = TwoBlobs(part)
        apart = distance(density.value(x, y), density.product(x, y))
        panels.add("errors", "exact", part, apart)
    density = TwoBlobs(shown["a"])
    for name, load in _WAYS.items():
        xj, yj, w = load(density, shown["per_axis"])
        panels.add(name, "markers", xj, yj, z=w / w.max())
    some = np.ix_(*2 * [np.arange(0, grid, max(1, grid // 96))])
    f = density.value(x[some], y[some])
    panels.add("density", "f", x[some].ravel(), y[some].ravel(), z=f.ravel())
    findings = _findings(finest, even, _diffused(min(24, per_axis[-1]), support, z))
    return Result(table, inputs.judged(findings), panels.frame)


def _findings(
    finest: pd.DataFrame, even: Mapping[float, float], diffused: float
) -> Iterator[Finding]:
    error = finest.pivot(index="a", columns="loading", values="relative L1 error")
    paper, far = pick(finest, loading=_PAPER), error.index.max()
    gap = (paper["relative L1 error"] - paper["f against the product"]).abs().max()
    mended = error.loc[far, [_WEIGHTED, _SEQUENTIAL]]
    yield measured("M-C7.general", error=error[_PAPER], mended=mended, gap=gap, far=far)
    ratio = error.loc[far, _PAPER] / error.loc[far, _SEQUENTIAL]
    yield measured("M-C7.decoupled", ratio=ratio, error=error.loc[far, [_PAPER, _SEQUENTIAL]])
    yield measured("M-C7.simple", error=error[_SEQUENTIAL].max())
    yield measured("M-C7.uniform", error=pd.Series(even).rename_axis("a"))
    yield measured("M-C7.plane_diffusion", error=diffused)
    yield measured("M-C7.complexity", neighbours=[2.0 * _PER_EPS, np.pi * _PER_EPS**2])


def _even(density: TwoBlobs, per_axis: int, half_width: float) -> Loading:
    """Markers at equal distances in the square, with W = f h^2."""
    h = 2.0 * half_width / per_axis
    along = -half_width + h * (np.arange(per_axis) + 0.5)
    x, y = (part.ravel() for part in np.meshgrid(along, along, indexing="ij"))
    return x, y, h * h * density.value(x, y)


def _diffused(per_axis: int, epsilon: float, z: np.ndarray) -> float:
    """The relative L1 error of F after t = 1/2, from uniform markers of a Gaussian: (7) in the plane, S8 S8."""
    density, s8, dt = TwoBlobs(0.0), SHAPES["S8"], 0.125 * epsilon**2
    x, y, w = _even(density, per_axis, 2.5)
    steps = round(0.5 / dt)

    def velocity(p: np.ndarray) -> np.ndarray:
        dx, dy = ((q[:, None] - q) / epsilon for q in p)
        sx, sy = s8(dx), s8(dy)
        return -np.stack([(s8(dx, 1) * sy) @ w, (sx * s8(dy, 1)) @ w]) / (epsilon * (sx * sy) @ w)

    p = np.stack([x, y])
    for _ in range(steps):
        p = p + dt * velocity(p + 0.5 * dt * velocity(p))
    width = 1.0 + 4.0 * steps * dt
    r2 = z[:, None] ** 2 + z**2
    exact = 2.0 * np.exp(-r2 / width) / width
    field = reconstruct(s8, epsilon, (p[0], p[1], w), z, z)
    return float(np.abs(field - exact).sum() / exact.sum())
