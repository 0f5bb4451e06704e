"""The shape functions S1 to S8: their constants, moments, smoothness and Fourier transforms."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fracparticles.markers.shapes import SHAPES, Shape
from fracparticles.markers.stability import extremes
from fracstudy.claims import Finding
from fracstudy.inputs import Inputs, Result, statement

__all__ = ["study"]

_ROUNDOFF = 1e-13
_SEARCHED = 30.0  # the largest k that is looked at for the largest growth


def study(inputs: Inputs) -> Result:
    """Integrate every shape function with the right constant and with the printed one.

    Parameters of the scene: `wavenumbers`, the largest drawn. A printed constant is right if it gives the integral 1
    to 1e-13. The growth -k^2 S^(k) of a shape function that jumps, by J, is of the size 2 J k: it has no largest value.
    """
    rows = []
    for shape in SHAPES.values():
        found = extremes(shape, _SEARCHED)
        rows.append(
            {
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
        )
    table = pd.DataFrame(rows)
    return Result(table.replace({np.inf: np.nan}), _findings(table), _series(inputs))


def _integral(shape: Shape, power: int = 0) -> float:
    """int S x^p dx: Gauss-Legendre, exact for the polynomials and to round-off with the Gaussian factor."""
    nodes, weights = np.polynomial.legendre.leggauss(96)
    x = 0.5 * shape.reach * (1.0 + nodes)
    return float(shape.reach * np.sum(weights * shape(x) * x**power))


def _findings(table: pd.DataFrame) -> list[Finding]:
    rows = table.set_index("S")
    printed = (rows["integral as printed"] - 1.0).abs()
    plain = [name for name in rows.index if name not in ("S5", "S6", "S7")]
    findings = [
        statement(
            "M-SHAPES.normalised",
            bool((printed[plain] <= _ROUNDOFF).all()),
            f"The integrals of {', '.join(plain)} are 1 to {printed[plain].max():.0e}.",
            "One of the integrals is not 1.",
        )
    ]
    for name, claim, cause in (
        ("S5", "mu", "The integral is not 1."),
        ("S6", "beta", "The integral of (1 - x²)² exp(-x²) is 3 sqrt(π) erf(1)/4 - 1/(2e): a factor sqrt(π) is lost."),
        ("S7", "alpha", "The integral of (1 - x²) exp(-x²) is sqrt(π) erf(1)/2 + 1/e, not with erf(1/2)."),
    ):  # fmt: skip
        row = rows.loc[name]
        findings.append(
            statement(
                f"M-SHAPES.{claim}",
                bool(printed[name] <= _ROUNDOFF),
                f"With the printed constant, {row['printed constant']:.6f}, the integral of {name} is "
                f"{row['integral as printed']:.6f}; {row['constant']:.6f} gives 1.",
                cause,
            )
        )
    slope = {name: float(SHAPES[name](1.0, 1)) for name in ("S3", "S4")}
    findings.append(
        statement(
            "M-SHAPES.slope",
            slope["S4"] == 0.0,
            f"S4'(1) = {slope['S4']:g}; S3'(1) = {slope['S3']:g}.",
            "The slope does not vanish.",
        )
    )
    return findings


def _series(inputs: Inputs) -> pd.DataFrame:
    """Panels "shape" and "transform", a curve for each shape function."""
    x = np.linspace(-2.6, 2.6, 1041)
    k = np.linspace(0.0, float(inputs.parameters["wavenumbers"]), 401)
    panels = [
        pd.DataFrame({"panel": panel, "series": s.name, "x": at, "y": y})
        for s in SHAPES.values()
        for panel, at, y in (("shape", x, s(x)), ("transform", k, s.transform(k)))
    ]
    return pd.concat(panels, ignore_index=True)
