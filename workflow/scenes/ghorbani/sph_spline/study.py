"""The cubic spline of Fig. 2, and what it does on equally spaced particles."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd

from fracparticles.sph.cubic_spline import SUPPORT, spline, spline_gradient, spline_integral
from fracparticles.sph.derivatives import correction
from fracstudy.findings import measured
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels

_RADII = (0.0, 0.5, 1.0, 1.5, 2.0)
_PIECES = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])  # the spline is a polynomial between these
_OUTSIDE = 1.0 + 1e-9
_LENGTHS = (0.01375, 1.0, 3.0)  # the first is that of the paper, 1.1 s


def kernel_sums(ratio: float, offset: float = 0.0) -> tuple[float, float]:
    """Return sum_j s W(x_i - x_j) and L_i of (19) on an infinite line of particles, h = ratio s.

    `offset`, in units of s, is the distance of the point from the nearest particle.
    """
    reach = int(np.ceil(SUPPORT * ratio)) + 1
    x = np.arange(-reach, reach + 1.0)
    factor = correction(np.array([offset]), x, np.ones_like(x), ratio)
    return float(np.sum(spline(offset - x, ratio))), float(factor[0])


def study(inputs: Inputs, *, smoothing_ratio: float, ratios: list[float]) -> Result:
    """Tabulate W, W' and W~, and check them against each other piece by piece, by Gauss-Legendre quadrature.

    `smoothing_ratio` is the h / s of the paper, `ratios` the range drawn. The pieces are polynomials,
    of degree 3 at most, for which five nodes are exact.
    """
    q = np.array(_RADII)
    shown = {"h W": spline, "h² W'": spline_gradient, "W~": spline_integral}
    table = pd.DataFrame({"x / h": q, **{name: of(q, 1.0) for name, of in shown.items()}})
    table["W~ at -x"] = spline_integral(-q, 1.0)
    inside, beyond = (float(spline(SUPPORT * x, 1.0)) for x in (1.0 / _OUTSIDE, _OUTSIDE))
    excess = {f"h = {h:g}": abs(_by_pieces(spline, h).sum() - 1.0) for h in _LENGTHS}
    gap = {"derivative": _largest_gap(spline_gradient, spline)}
    gap["integral"] = _largest_gap(spline, spline_integral)
    total, factor = kernel_sums(smoothing_ratio)
    sums: dict[str, Any] = {"ratio": smoothing_ratio, "total": total, "factor": factor}
    findings = [
        measured("S-F2.support", inside=inside, beyond=beyond),
        measured("S-F2.unit_mass", excess=excess),
        measured("S-F2.analytic", gap=gap, end=spline_integral(SUPPORT, 1.0), **sums),
    ]
    return Result(table, findings if "S-F2" in inputs.items else (), _series(*ratios))


def _by_pieces(integrand: Callable[..., Any], h: float = 1.0) -> np.ndarray:
    """The integral over each piece."""
    nodes, weights = np.polynomial.legendre.leggauss(5)
    x = h * (_PIECES[:-1, None] + 0.5 * (nodes + 1.0))
    return 0.5 * h * integrand(x, h) @ weights


def _largest_gap(integrand: Callable[..., Any], antiderivative: Callable[..., Any]) -> float:
    gap = _by_pieces(integrand) - np.diff(antiderivative(_PIECES, 1.0))
    return float(np.abs(gap).max())


def _series(low: float, high: float) -> pd.DataFrame:
    """Panels "kernel" (curves W, dW, integral) and "sums" (sum, L, by h / s)."""
    q, ratios = np.linspace(-2.5, 2.5, 501), np.linspace(low, high, 241)
    sums = np.array([kernel_sums(ratio) for ratio in ratios])
    panels = Panels()
    for name, of in (("W", spline), ("dW", spline_gradient), ("integral", spline_integral)):
        panels.add("kernel", curve=name, x=q, y=of(q, 1.0))
    for name, column in zip(("sum", "L"), sums.T, strict=True):
        panels.add("sums", curve=name, x=ratios, y=column)
    return panels.frame
