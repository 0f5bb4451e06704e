"""Loading markers in the plane by decoupled marginals, Sec. 2.2."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.markers import SHAPES
from fracparticles.markers.plane import TwoBlobs, decoupled, reconstruct, sequential, weighted
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement

__all__ = ["study"]

Loading = tuple[np.ndarray, np.ndarray, np.ndarray]

_NAMES = ("decoupled", "decoupled, weighted", "x first, then y")
_WAYS: dict[str, Callable[[TwoBlobs, int], Loading]] = {
    _NAMES[0]: lambda f, n: decoupled(f.quantile, f.total, (n, n)),
    _NAMES[1]: lambda f, n: weighted(f, (n, n)),
    _NAMES[2]: lambda f, n: sequential(f, (n, n)),
}
_SAME = 0.05  # relative L1 error of a finite number of markers, hardly seen in a figure


def study(inputs: Inputs) -> Result:
    """Load `TwoBlobs` in three ways and compare F with f, and with the product of the marginals.

    A loading reproduces a density if the relative L1 error of F with the largest number of markers is below 5 %.
    """
    p = inputs.parameters
    half, count = float(p["half_width"]), int(p["grid"])
    grid = np.linspace(-half, half, count)
    x, y = np.meshgrid(grid, grid, indexing="ij")
    cell = (grid[1] - grid[0]) ** 2
    rows, parts = [], []
    for a in map(float, p["a"]):
        density = TwoBlobs(a)
        f, product = density.value(x, y), density.product(x, y)
        distance = cell * float(np.abs(f - product).sum()) / density.total
        for name, load in _WAYS.items():
            for n in p["per_axis"]:
                markers = load(density, n)
                field = reconstruct(SHAPES["S8"], float(p["support"]), markers, grid, grid)
                w = markers[2]
                rows.append(
                    {
                        "a": a,
                        "loading": name,
                        "N": w.size,
                        "relative L1 error": cell * float(np.abs(field - f).sum()) / density.total,
                        "against the product of the marginals": cell
                        * float(np.abs(field - product).sum())
                        / density.total,
                        "f and that product": distance,
                        "total / sigma": float(w.sum()) / density.total,
                        "effective part of the markers": float(
                            w.sum() ** 2 / (w * w).sum() / w.size
                        ),
                    }
                )
    table = pd.DataFrame(rows)
    finest = table[table["N"] == table["N"].max()]
    for name, part in finest.groupby("loading", sort=False):
        parts.append(_part("errors", name, part["a"], part["relative L1 error"]))
    fine = np.linspace(0.0, float(p["a"][-1]), 41)
    exact = [
        cell * float(np.abs((b := TwoBlobs(a)).value(x, y) - b.product(x, y)).sum()) / b.total
        for a in fine
    ]
    parts.append(_part("errors", "exact", fine, exact))
    shown = TwoBlobs(float(p["shown"]["a"]))
    for name in _NAMES:
        xj, yj, w = _WAYS[name](shown, int(p["shown"]["per_axis"]))
        parts.append(_part(name, "markers", xj, yj, z=w / w.max()))
    coarse = grid[:: max(1, count // 96)]
    gx, gy = np.meshgrid(coarse, coarse, indexing="ij")
    parts.append(_part("density", "f", gx.ravel(), gy.ravel(), z=shown.value(gx, gy).ravel()))
    return Result(table, _findings(finest), pd.concat(parts, ignore_index=True))


def _findings(finest: pd.DataFrame) -> list[Finding]:
    def error(name: str, a: float) -> float:
        row = finest[(finest["loading"] == name) & (finest["a"] == a)]
        return float(row["relative L1 error"].iloc[0])

    paper = finest[finest["loading"] == _NAMES[0]]
    product, far = float(paper["a"].min()), float(paper["a"].max())
    gap = float((paper["relative L1 error"] - paper["f and that product"]).abs().max())
    worst = paper["relative L1 error"].max()
    said = (
        f"two blobs at (a, a) and (-a, -a): the relative L1 error is {error(_NAMES[0], product):.2g} for "
        f"a = {product:g}, a product, and {error(_NAMES[0], far):.2g} for a = {far:g}, where half of the markers "
        "are in two blobs that f does not have"
    )
    mended = ", ".join(f"{error(name, far):.2g} ({name})" for name in _NAMES[1:])
    return [
        statement(
            "M-C7.product",
            error(_NAMES[0], product) < _SAME,
            f"With {int(paper['N'].iloc[0])} markers of equal weight F differs from a product density by "
            f"{error(_NAMES[0], product):.2g} in the relative L1 norm.",
            "The error is above 5 %.",
        ),
        statement(
            "M-C7.general",
            bool(worst < _SAME),
            f"The decoupled loading of {said}. Mended loadings have {mended} there.",
            "Markers that are uniform in (xi_x, xi_y) have the density of the product of the marginals, and that is "
            f"what F shows: its error is the distance of f from that product, within {gap:.1g} for every a.",
        ),
        statement(
            "M-C7.decoupled",
            bool(worst > _SAME and error(_NAMES[2], far) < worst),
            f"They are not equivalent: {said}. The one-dimensional loading, x first and then y given x, has "
            f"{error(_NAMES[2], far):.2g}.",
            "Both loadings have the same error.",
        ),
    ]


def _part(panel: str, series: str, x: Any, y: Any, **more: Any) -> pd.DataFrame:
    return pd.DataFrame(
        {"panel": panel, "series": series, "x": np.asarray(x), "y": np.asarray(y), **more}
    )
