"""The shape functions S1 to S8: their constants, moments, smoothness and Fourier transforms."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from fracparticles.markers.shapes import SHAPES, Shape
from fracparticles.markers.stability import extremes
from fracstudy.findings import Finding, measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels

_SEARCHED = 30.0  # the largest k that is looked at for the largest growth
_CONSTANTS = {"S5": "mu", "S6": "beta", "S7": "alpha"}  # what a shape function's own is called


def study(inputs: Inputs, *, wavenumbers: float) -> Result:
    """Integrate every shape function with the right constant and with the printed one.

    The transforms are drawn up to `wavenumbers`. The growth -k^2 S^(k) of a shape function that jumps, by J, is of the
    size 2 J k: it has no largest value.
    """
    rows, panels = [], Panels()
    x, k = np.linspace(-2.6, 2.6, 1041), np.linspace(0.0, wavenumbers, 401)
    for shape in SHAPES.values():
        found = extremes(shape, _SEARCHED)
        row = {
            "S": shape.name,
            "called": shape.title,
            "printed constant": shape.printed,
            "constant": shape.constant,
            "integral as printed": _integral(shape.as_printed()),
            "integral": _integral(shape),
            "second moment": _integral(shape, 2),
            "transform turns negative at k": found.first_zero,
            f"largest growth × ε², k < {_SEARCHED:g}": found.growth,
            "beyond": "unbounded" if shape.smoothness == 0 else "no larger",
        }
        rows.append(row)
        panels.add("shape", shape.name, x, shape(x))
        panels.add("transform", shape.name, k, shape.transform(k))
    table = pd.DataFrame(rows).replace({np.inf: np.nan})
    return Result(table, inputs.judged(_findings(table.set_index("S"))), panels.frame)


def _integral(shape: Shape, power: int = 0) -> float:
    """int S x^p dx: Gauss-Legendre, exact for the polynomials and to round-off with the Gaussian factor."""
    nodes, weights = np.polynomial.legendre.leggauss(96)
    x = 0.5 * shape.reach * (1.0 + nodes)
    return float(shape.reach * np.sum(weights * shape(x) * x**power))


def _findings(rows: pd.DataFrame) -> Iterator[Finding]:
    printed, right = rows["integral as printed"], rows["integral"]
    yield measured("M-SHAPES.normalised", miss=(printed - 1.0).abs(), integral=printed)
    for name, constant in _CONSTANTS.items():
        yield measured(
            f"M-SHAPES.{constant}",
            integral=printed[name],
            miss=abs(printed[name] - 1.0),
            miss_right=abs(right[name] - 1.0),
            constant=rows["printed constant"][name],
            right=rows["constant"][name],
        )
    slope = {name: abs(float(SHAPES[name](1.0, 1))) for name in ("S3", "S4")}
    yield measured("M-SHAPES.slope", slope=slope["S4"], quadratic=slope["S3"])
    hat, k = SHAPES["S2"], np.linspace(10.0, 20.0, 401)
    gaussian = np.exp(-0.25 * k * k)  # the transform of exp(-x^2) / sqrt(pi)
    yield measured("M-SHAPES.smoother", tail=gaussian.max() / hat.transform(k).max())
    yield measured("M-SHAPES.demanding", neighbours=SHAPES["S8"].reach / hat.reach)
