"""-(-Laplacian)^(alpha(x)/2) u: its order in h, how many orders the rows are interpolated from, and its tails.

alpha(x) = mean + change tanh(x) on the line, mean + change exp(-|x|^2) in the plane. The error is the greatest over the
particles, over the greatest value of the exact right-hand side.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from scipy.special import gamma

from fracparticles.problems import Problem, solve_problem
from fracparticles.schemes import SCHEMES
from fracparticles.schemes.base import OnePass
from fracparticles.schemes.setting import Setting
from fracparticles.variable import VariableOrder
from fracparticles.variable.closed_forms import Cauchy, Gaussian
from fracparticles.variable.order import interpolation_bound
from fracstudy.errors import off
from fracstudy.inputs import Inputs, Result
from fracstudy.orders import observed
from fracstudy.panels import Panels

_solved = partial(solve_problem, estimate=False)  # the errors are measured
_ROWS = 60  # half the particles on which rows are compared with those of their own order
_MOMENTS = 16  # intervals of time over which the mass is integrated
_SIDES = {"left": -1.0, "right": 1.0}


def study(
    inputs: Inputs,
    *,
    mean: float,
    change: float,
    overlap: float,
    half_width: float,
    spacings: list[float],
    orders: list[int],
    plane_half_width: float,
    plane_spacings: list[float],
    plane_order: int,
    ranges: list[list[float]],
    tolerances: list[float],
    wide: float,
    wide_spacing: float,
    time: float,
    narrow: list[float],
) -> Result:
    """A row for each number: part, case, where, ours, and what it should be or be below."""
    panels = Panels()
    rows: list[dict[str, Any]] = []
    common: dict[str, Any] = {"alpha": mean, "overlap": overlap, "exterior": "open"}
    for order in orders:
        settings = [
            Setting(**common, order=order, n=round(half_width / h), spacing=h, far_terms=3)
            for h in spacings
        ]
        rows += _levels(settings, change, panels)
    settings = [
        Setting(**common, order=plane_order, dim=2, n=round(plane_half_width / h), spacing=h)
        for h in plane_spacings
    ]
    rows += _levels(settings, change, panels)
    for low, high in ranges:
        rows += _interpolation(low, high, tolerances, panels)
    rows.append(_constant(mean, overlap))
    rows += _tails(mean, change, wide, wide_spacing, time, narrow, panels)
    columns = ["part", "case", "at", "ours", "observed order", "theory"]
    return Result(pd.DataFrame(rows, columns=columns), (), panels.frame)


def _levels(settings: Sequence[Setting], change: float, panels: Panels) -> Iterator[dict[str, Any]]:
    """The error for each spacing, against the closed form with the order of each place."""
    errors = []
    for setting in settings:
        at = setting.positions
        field = Cauchy if setting.dim == 1 else Gaussian
        varied = np.tanh(at[0]) if setting.dim == 1 else Gaussian.value(at)
        alpha = setting.alpha + change * varied
        exact = field.laplacian(at, alpha)
        rate = VariableOrder(setting, alpha, tail=setting.dim + 1.0).apply(field.value(at))
        errors.append(off(rate, exact))
    spacings = [setting.spacing for setting in settings]
    dim, order = settings[0].dim, settings[0].order
    case = f"{'line' if dim == 1 else 'plane'}, order {order}"
    panels.add("error", case, spacings, errors, order=order, dim=dim)
    for h, error, slope in zip(spacings, errors, observed(spacings, errors), strict=True):
        yield {**_row("error", case, h, error), "observed order": slope}


def _row(part: str, case: str, at: float, ours: float, theory: float = np.nan) -> dict[str, Any]:
    return {"part": part, "case": case, "at": at, "ours": ours, "theory": theory}


def _interpolation(
    low: float, high: float, tolerances: Sequence[float], panels: Panels
) -> Iterator[dict[str, Any]]:
    """The rows against those summed with the kernel of their own order: the greatest Euclidean norm of a difference.

    The norm of a row is no more than the greatest value of its symbol, which is what the bound is for.
    """
    setting = Setting(alpha=low, order=4, n=_ROWS)
    i = np.arange(setting.size, dtype=float)
    alpha = np.linspace(low, high, setting.size)
    scheme = SCHEMES["DD"]
    assert isinstance(scheme, OnePass)
    own = np.array(
        [scheme.weights(np.abs(i - k), replace(setting, alpha=a)) for k, a in enumerate(alpha)]
    )
    found: dict[int, float] = {}
    for tolerance in tolerances:
        operator = VariableOrder(setting, alpha, tolerance=tolerance)
        nodes = operator.nodes.size
        if nodes not in found:
            ours = np.array([operator.apply(e) for e in np.eye(setting.size)]).T
            found[nodes] = float(np.linalg.norm(ours - own, axis=1).max())
    case = f"{low:g} to {high:g}"
    bounds = [interpolation_bound(nodes, low, high) for nodes in found]
    panels.add("interpolation", case, list(found), list(found.values()), bound=bounds)
    for (nodes, worst), bound in zip(found.items(), bounds, strict=True):
        yield _row("interpolation", case, nodes, worst, bound)


def _constant(alpha: float, overlap: float) -> dict[str, Any]:
    """A constant order against the operator of DD."""
    setting = Setting(alpha=alpha, overlap=overlap, order=4, n=400, spacing=0.1, exterior="open")
    u = Cauchy.value(setting.positions)
    plain = SCHEMES["DD"].operator(setting).apply(u)
    ours = VariableOrder(setting, alpha).apply(u)
    return _row("constant order", "line", np.nan, off(ours, plain), 0.0)


def _tails(
    mean: float,
    change: float,
    wide: float,
    h: float,
    time: float,
    narrow: Sequence[float],
    panels: Panels,
) -> Iterator[dict[str, Any]]:
    """A run from a bell on a wide lattice: its tails, its mass, and what a narrow lattice makes of it.

    Far away du/dt = c(alpha) M(t) / |x|^(1 + alpha) with the alpha of the place and the mass M, so that u falls like
    c(alpha) int M dt / |x|^(1 + alpha): c(alpha) = Gamma(1 + alpha) sin(pi alpha / 2) / pi.
    """
    alpha_of_x, times = f"{mean} + {change}*tanh(x)", np.linspace(0.0, time, _MOMENTS + 1)[1:]
    lattice = {"form": "DD", "half_width": wide, "spacing": h, "rtol": 1e-10}
    problem = Problem(alpha=alpha_of_x, times=tuple(times.tolist()), **lattice)
    run = _solved(problem, lambda x: np.exp(-x * x))
    x, u = run["x"].values, run["u"].values[-1]
    first = np.exp(-x * x).sum() * h
    masses = np.array([first, *(run["u"].values.sum(axis=1) * h)])
    impulse = float(np.trapezoid(masses, dx=time / _MOMENTS))
    for side, sign in _SIDES.items():
        alpha = mean + sign * change
        expected = gamma(1.0 + alpha) * np.sin(0.5 * np.pi * alpha) / np.pi * impulse
        out = (sign * x >= 2.0) & (sign * x <= 0.8 * wide)
        r, values = sign * x[out][:: int(sign)], u[out][:: int(sign)]
        some = np.unique(np.geomspace(1, r.size, 30).astype(int)) - 1
        r, values = r[some], values[some]
        theory = expected * r ** (-1.0 - alpha)
        panels.add("tail", side, r, values, theory=theory, alpha=alpha)
        share = values[-1] * r[-1] ** (1.0 + alpha) / expected
        power = -np.log(values[-1] / values[-2]) / np.log(r[-1] / r[-2])
        yield _row("tail, exponent", side, r[-1], power, 1.0 + alpha)
        yield _row("tail, amplitude", side, r[-1], share, 1.0)
    yield _row("mass", "line", time, float(masses[-1] / masses[0]))
    yield from _narrowed(mean, change, x, u, h, narrow, panels)


def _narrowed(
    mean: float,
    change: float,
    x: np.ndarray,
    u: np.ndarray,
    h: float,
    narrow: Sequence[float],
    panels: Panels,
) -> Iterator[dict[str, Any]]:
    """du/dt on a part of the lattice, with a tail of each end, with one of the mean order, and without any."""

    def rate(n: int, tail: Any) -> np.ndarray:
        exterior = "truncated" if tail == "none" else "open"
        setting = Setting(alpha=mean, order=4, n=n, spacing=h, exterior=exterior)
        middle = slice(x.size // 2 - n, x.size // 2 + n + 1)
        alpha = mean + change * np.tanh(x[middle])
        given = 1.0 + mean if tail == "one for both" else None
        return VariableOrder(setting, alpha, tail=given).apply(u[middle])

    whole = rate(x.size // 2, "own")
    for tail in ("own", "one for both", "none"):
        errors = []
        for half_width in narrow:
            n = round(half_width / h)
            middle = slice(x.size // 2 - n, x.size // 2 + n + 1)
            errors.append(off(rate(n, tail), whole[middle], np.abs(whole).max()))
            yield _row("exterior", tail, half_width, errors[-1])
        panels.add("exterior", tail, narrow, errors)
