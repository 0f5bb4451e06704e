"""The cubic spline of Fig. 2, and what it does on equally spaced particles."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.sph.cubic_spline import SUPPORT, spline, spline_gradient, spline_integral
from fracparticles.sph.derivatives import correction
from fracstudy.inputs import Inputs, Result, statement

__all__ = ["kernel_sums", "study"]

_RADII = (0.0, 0.5, 1.0, 1.5, 2.0)
_PIECES = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])  # the spline is a polynomial between these
_OUTSIDE = 1.0 + 1e-9
_ROUNDOFF = 1e-13


def kernel_sums(ratio: float, offset: float = 0.0) -> tuple[float, float]:
    """Return sum_j s W(x_i - x_j) and L_i of (19) on an infinite line of particles, h = ratio s.

    `offset`, in units of s, is the distance of the point from the nearest particle.
    """
    reach = int(np.ceil(SUPPORT * ratio)) + 1
    x = np.arange(-reach, reach + 1.0)
    factor = correction(np.array([offset]), x, np.ones_like(x), ratio)
    return float(np.sum(spline(offset - x, ratio))), float(factor[0])


def study(inputs: Inputs, *, smoothing_ratio: float, ratios: list[float]) -> Result:
    """Tabulate W, W' and W~, and check them against each other piece by piece.

    `smoothing_ratio` is the h / s of the paper, `ratios` the range drawn. The derivative and the integral hold if
    Gauss-Legendre quadrature of W' over each piece gives the change of W, and that of W the change of W~, to 1e-13
    (polynomials of degree 3 and 2: five nodes are exact).
    """
    q = np.array(_RADII)
    shown = {"h W": spline, "h² W'": spline_gradient, "W~": spline_integral}
    table = pd.DataFrame({"x / h": q, **{name: of(q, 1.0) for name, of in shown.items()}})
    table["W~ at -x"] = spline_integral(-q, 1.0)
    slope = _largest_gap(spline_gradient, spline)
    integral = _largest_gap(spline, spline_integral)
    inside, beyond = spline(SUPPORT / _OUTSIDE, 1.0), spline(SUPPORT * _OUTSIDE, 1.0)
    total, factor = kernel_sums(smoothing_ratio)
    findings = [
        statement(
            "S-F2.support",
            bool(inside > 0.0 and beyond == 0.0),
            f"W at |x| = 2 h (1 - 1e-9) is {inside:.1e} / h, beyond 2 h it is {beyond:g}.",
            "The support ends elsewhere.",
        ),
        statement(
            "S-F2.analytic",
            max(slope, integral) <= _ROUNDOFF,
            f"Piece by piece, quadrature of W' gives W to {slope:.1e} / h and quadrature of W gives W~ to "
            f"{integral:.1e}; W~ ends at {spline_integral(SUPPORT, 1.0):.15g}. At h = {smoothing_ratio:g} s the sum of "
            f"s W over the particles is {total:.6f}, and L of (19) is {factor:.6f}.",
            "Derivative or integral is not that of W.",
        ),
    ]
    return Result(table, findings if "S-F2" in inputs.items else (), _series(*ratios))


def _largest_gap(integrand: Callable[..., Any], antiderivative: Callable[..., Any]) -> float:
    nodes, weights = np.polynomial.legendre.leggauss(5)
    x = _PIECES[:-1, None] + 0.5 * (nodes + 1.0)
    by_quadrature = 0.5 * integrand(x, 1.0) @ weights
    return float(np.abs(by_quadrature - np.diff(antiderivative(_PIECES, 1.0))).max())


def _series(low: float, high: float) -> pd.DataFrame:
    """Panels "kernel" (curves W, dW, integral) and "sums" (sum, L, by h / s)."""
    q, ratios = np.linspace(-2.5, 2.5, 501), np.linspace(low, high, 241)
    sums = np.array([kernel_sums(ratio) for ratio in ratios])
    curves = {
        ("kernel", "W"): (q, spline(q, 1.0)),
        ("kernel", "dW"): (q, spline_gradient(q, 1.0)),
        ("kernel", "integral"): (q, spline_integral(q, 1.0)),
        ("sums", "sum"): (ratios, sums[:, 0]),
        ("sums", "L"): (ratios, sums[:, 1]),
    }
    return pd.concat(
        [
            pd.DataFrame({"panel": panel, "curve": name, "x": x, "y": y})
            for (panel, name), (x, y) in curves.items()
        ],
        ignore_index=True,
    )
