"""Loading markers in the plane by decoupled marginals, Sec. 2.2."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.markers import SHAPES
from fracparticles.markers.plane import TwoBlobs, decoupled, reconstruct, sequential, weighted
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from fracstudy.panels import Panels, pick

__all__ = ["study"]

Loading = tuple[np.ndarray, np.ndarray, np.ndarray]

_PAPER, _WEIGHTED, _SEQUENTIAL = "decoupled", "decoupled, weighted", "x first, then y"
_WAYS: dict[str, Callable[[TwoBlobs, int], Loading]] = {
    _PAPER: lambda f, n: decoupled(f.quantile, f.total, (n, n)),
    _WEIGHTED: lambda f, n: weighted(f, (n, n)),
    _SEQUENTIAL: lambda f, n: sequential(f, (n, n)),
}
_SAME = 0.05  # relative L1 error of a finite number of markers, hardly seen in a figure


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
    """Load `TwoBlobs` in three ways and compare F with f, and with the product of the marginals.

    A loading reproduces a density if the relative L1 error of F with the largest number of markers is below 5 %.
    """
    z = np.linspace(-half_width, half_width, grid)
    x, y = np.meshgrid(z, z, indexing="ij")
    cell = (z[1] - z[0]) ** 2

    def distance(one: np.ndarray, other: np.ndarray) -> float:
        return cell * float(np.abs(one - other).sum()) / TwoBlobs(0.0).total

    rows = []
    for part in a:
        density = TwoBlobs(part)
        f, product = density.value(x, y), density.product(x, y)
        for name, load in _WAYS.items():
            for n in per_axis:
                markers = load(density, n)
                field, w = reconstruct(SHAPES["S8"], support, markers, z, z), markers[2]
                row = {
                    "a": part,
                    "loading": name,
                    "N": w.size,
                    "relative L1 error": distance(field, f),
                    "against the product of the marginals": distance(field, product),
                    "f and that product": distance(f, product),
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
    return Result(table, inputs.judged(_findings(finest)), panels.frame)


def _findings(finest: pd.DataFrame) -> Iterator[Finding]:
    error = finest.pivot(index="a", columns="loading", values="relative L1 error")
    paper, product, far = pick(finest, loading=_PAPER), error.index.min(), error.index.max()
    gap = float((paper["relative L1 error"] - paper["f and that product"]).abs().max())
    right, wrong, worst = error[_PAPER][product], error[_PAPER][far], error[_PAPER].max()
    said = (
        f"two blobs at (a, a) and (-a, -a): the relative L1 error is {right:.2g} for a = {product:g}, a product, and "
        f"{wrong:.2g} for a = {far:g}, where half of the markers are in two blobs that f does not have"
    )
    mended = ", ".join(f"{error[name][far]:.2g} ({name})" for name in (_WEIGHTED, _SEQUENTIAL))
    yield statement(
        "M-C7.product",
        right < _SAME,
        f"With {paper['N'].iloc[0]} markers of equal weight F differs from a product density by {right:.2g} in the "
        "relative L1 norm.",
        "The error is above 5 %.",
    )
    yield statement(
        "M-C7.general",
        worst < _SAME,
        f"The decoupled loading of {said}. Mended loadings have {mended} there.",
        "Markers that are uniform in (xi_x, xi_y) have the density of the product of the marginals, and that is "
        f"what F shows: its error is the distance of f from that product, within {gap:.1g} for every a.",
    )
    yield statement(
        "M-C7.decoupled",
        worst > _SAME and error[_SEQUENTIAL][far] < worst,
        f"They are not equivalent: {said}. The one-dimensional loading, x first and then y given x, has "
        f"{error[_SEQUENTIAL][far]:.2g}.",
        "Both loadings have the same error.",
    )
