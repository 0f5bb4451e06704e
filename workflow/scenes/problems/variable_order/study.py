"""-(-Laplacian)^(alpha(x)/2) u: the order of the rows, what their interpolation costs, and the tails of a solution.

The operator is tested on u = 1 / (1 + x^2) on the line and exp(-|x|^2) in the plane, whose fractional Laplacians of any
order are closed forms. Solutions start from 1 / (1 + x^2)^2, whose own tail is below what the equation makes, and are
compared with that of a lattice which is much wider.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from fracparticles.errors import AccuracyWarning
from fracparticles.problems import Problem, solve_problem
from fracparticles.run.orders import observed_order
from fracparticles.schemes.setting import Setting
from fracparticles.variable import VariableOrder
from fracparticles.variable.closed_forms import Cauchy, Gaussian, KnownField
from fracparticles.variable.order import interpolation_bound
from fracstudy.inputs import Inputs, Result
from fracstudy.panels import Panels

__all__ = ["study"]

_SPACING = 0.25  # of the solutions, in kernels of order 8: 1e-5 and below
_TIME = 1.0
_ROWS = 101  # of different order, where the interpolation is measured
_TOLERANCES = np.geomspace(1e-2, 1e-13, 12)


def study(
    inputs: Inputs,
    *,
    middle: float,
    swing: float,
    overlap: float,
    half_width: float,
    spacings: list[float],
    orders: list[int],
    plane_half_width: float,
    plane_spacings: list[float],
    plane_orders: list[int],
    intervals: list[list[float]],
    wide: float,
    narrow: list[float],
) -> Result:
    """A row for each order and spacing of the operator, for each lattice of a solution, and for each of its tails."""
    panels = Panels()
    rows: list[dict[str, Any]] = []
    common = {"alpha": middle, "overlap": overlap, "exterior": "open"}
    for order in orders:
        line = [
            Setting(**common, order=order, n=round(half_width / h), spacing=h, far_terms=3)
            for h in spacings
        ]
        rows += _levels(line, middle, swing, panels)
    for order in plane_orders:
        plane = [
            Setting(**common, order=order, n=round(plane_half_width / h), spacing=h, dim=2)
            for h in plane_spacings
        ]
        rows += _levels(plane, middle, swing, panels)
    for least, greatest in intervals:
        _interpolation(least, greatest, overlap, panels)
    rows += _solutions(middle, swing, wide, narrow, panels)
    return Result(pd.DataFrame(rows), (), panels.frame)


def _order_at(points: Sequence[np.ndarray], middle: float, swing: float) -> np.ndarray:
    """Alpha: from one value to another on the line, a hill in the plane."""
    if len(points) == 1:
        return np.asarray(middle + swing * np.tanh(points[0]))
    return np.asarray(middle + swing * np.exp(-sum(np.square(part) for part in points)))


def _particles(setting: Setting) -> list[np.ndarray]:
    x = setting.spacing * np.arange(-setting.n, setting.n + 1.0)
    return list(np.meshgrid(*(x,) * setting.dim, indexing="ij", sparse=True))


def _levels(
    settings: Sequence[Setting], middle: float, swing: float, panels: Panels
) -> Iterator[dict[str, Any]]:
    """One row a spacing: the greatest error over the greatest value of the exact right-hand side."""
    dim, order = settings[0].dim, settings[0].order
    field: type[KnownField] = Cauchy if dim == 1 else Gaussian
    spacings, errors, nodes = [setting.spacing for setting in settings], [], []
    for setting in settings:
        at = _particles(setting)
        alpha = _order_at(at, middle, swing)
        operator = VariableOrder(setting, alpha, tail=2.0 if dim == 1 else None)
        exact = field.laplacian(at, alpha)
        errors.append(_relative(operator.apply(field.value(at)), exact))
        nodes.append(operator.nodes.size)
    panels.add("order", order, spacings, errors, dim=dim)
    observed = [np.nan, *observed_order(spacings, errors)]
    for h, error, slope, count in zip(spacings, errors, observed, nodes, strict=True):
        yield {
            "what": "operator",
            "dim": dim,
            "order": order,
            "h": h,
            "sums": count,
            "error": error,
            "observed order": slope,
        }


def _relative(ours: np.ndarray, exact: np.ndarray) -> float:
    return float(np.abs(ours - exact).max() / np.abs(exact).max())


def _interpolation(least: float, greatest: float, overlap: float, panels: Panels) -> None:
    """The greatest error of a weight, in units of D / h^alpha, against the number of sums; and its bound."""
    setting = Setting(alpha=least, overlap=overlap, n=_ROWS // 2)
    alpha = np.linspace(least, greatest, setting.size)
    point = np.zeros(setting.size)
    point[setting.n] = 1.0
    best = VariableOrder(setting, alpha, tolerance=1e-15).apply(point)
    found: dict[int, float] = {}
    for tolerance in _TOLERANCES:
        operator = VariableOrder(setting, alpha, tolerance=float(tolerance))
        found[operator.nodes.size] = float(np.abs(operator.apply(point) - best).max())
    bounds = [interpolation_bound(count, least, greatest) for count in found]
    panels.add("sums", f"{least:g}-{greatest:g}", list(found), list(found.values()), kind="ours")
    panels.add("sums", f"{least:g}-{greatest:g}", list(found), bounds, kind="bound")


def _solutions(
    middle: float, swing: float, wide: float, narrow: Sequence[float], panels: Panels
) -> Iterator[dict[str, Any]]:
    """Rows of lattices, against a wide one, and of the two tails of that."""
    reference = _solved(middle, swing, wide, "open")
    x, u = reference["x"].values, reference["u"].values
    for half_width in narrow:
        for exterior in ("open", "truncated"):
            run = _solved(middle, swing, half_width, exterior)
            exact = u[np.abs(x) <= half_width + 0.5 * _SPACING]
            error = _relative(run["u"].values, exact)
            panels.add("exterior", exterior, half_width, error)
            yield {"what": f"solution, {exterior}", "L": half_width, "error": error}
    for side, sign in (("left", -1.0), ("right", 1.0)):
        far = (sign * x >= 5.0) & (sign * x <= 0.5 * wide)
        distance, there = np.abs(x[far]), u[far]
        order = np.argsort(distance)
        distance, there = distance[order], there[order]
        some = np.unique(np.geomspace(1, distance.size, 60).round().astype(int)) - 1
        panels.add("tail", side, distance[some], there[some])
        outer = distance >= 0.25 * wide
        slope = np.polyfit(np.log(distance[outer]), np.log(there[outer]), 1)[0]
        exact_order = middle + sign * swing
        yield {"what": f"tail, {side}", "ours": -float(slope), "exact": 1.0 + exact_order}


def _solved(middle: float, swing: float, half_width: float, exterior: str) -> xr.Dataset:
    problem = Problem(
        alpha=f"{middle} + {swing}*tanh(x)", form="DD", order=8, spacing=_SPACING, half_width=half_width,
        exterior=exterior, t_final=_TIME, rtol=1e-8,
    )  # fmt: skip
    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore", AccuracyWarning
        )  # of the narrow ones, which are what is shown
        return solve_problem(problem, lambda x: (1.0 + x * x) ** -2.0)
