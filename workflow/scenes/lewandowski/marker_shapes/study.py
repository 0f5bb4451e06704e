"""The shape functions S1 to S8: their constants, moments, smoothness and Fourier transforms."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from fracparticles.markers.shapes import SHAPES, Shape
from fracparticles.markers.stability import extremes
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement
from fracstudy.panels import Panels

__all__ = ["study"]

_ROUNDOFF = 1e-13
_SEARCHED = 30.0  # the largest k that is looked at for the largest growth
# Shape functions with a constant of their own: what it is called, and why the printed one is wrong if it is.
_CONSTANTS = {
    "S5": ("mu", "The integral is not 1."),
    "S6": ("beta", "The integral of (1 - x²)² exp(-x²) is 3 sqrt(π) erf(1)/4 - 1/(2e): a factor sqrt(π) is lost."),
    "S7": ("alpha", "The integral of (1 - x²) exp(-x²) is sqrt(π) erf(1)/2 + 1/e, not with erf(1/2)."),
}  # fmt: skip


def study(inputs: Inputs, *, wavenumbers: float) -> Result:
    """Integrate every shape function with the right constant and with the printed one.

    The transforms are drawn up to `wavenumbers`. A printed constant is right if it gives the integral 1 to 1e-13. The
    growth -k^2 S^(k) of a shape function that jumps, by J, is of the size 2 J k: it has no largest value.
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
    off = (rows["integral as printed"] - 1.0).abs()
    plain = off.drop(index=list(_CONSTANTS))
    yield statement(
        "M-SHAPES.normalised",
        (plain <= _ROUNDOFF).all(),
        f"The integrals of {', '.join(plain.index)} are 1 to {plain.max():.0e}.",
        "One of the integrals is not 1.",
    )
    for name, (constant, cause) in _CONSTANTS.items():
        row = rows.loc[name]
        yield statement(
            f"M-SHAPES.{constant}",
            off[name] <= _ROUNDOFF,
            f"With the printed constant, {row['printed constant']:.6f}, the integral of {name} is "
            f"{row['integral as printed']:.6f}; {row['constant']:.6f} gives 1.",
            cause,
        )
    s3, s4 = (float(SHAPES[name](1.0, 1)) for name in ("S3", "S4"))
    yield statement(
        "M-SHAPES.slope",
        s4 == 0.0,
        f"S4'(1) = {s4:g}; S3'(1) = {s3:g}.",
        "The slope does not vanish.",
    )
